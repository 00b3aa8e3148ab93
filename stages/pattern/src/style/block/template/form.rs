//! The forms of garments: which edges a half of the flat garment has, and how they usually run.
//!
//! A half runs counter-clockwise from the axis below to the axis above. Directions and bows are
//! beliefs with a spread: they choose between ways to lay a template over an outline, and weigh
//! little against the outline itself. They were set by the proportions of basic blocks (Aldrich,
//! Metric Pattern Cutting, 2008) and not by the photos that are measured.

use toile_core::artifact::EdgeRole;

/// An edge of a form.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EdgeForm {
    pub role: EdgeRole,
    /// Direction of its chord, degrees from across, counter-clockwise; and the spread.
    pub way: [f64; 2],
    /// How far it usually stands to the left of its chord (into the garment), in chord lengths; and
    /// the spread.
    pub bow: [f64; 2],
    /// Least and greatest length of its chord, as shares of the garment's size (the root of its
    /// area).
    pub chord: [f64; 2],
    /// Whether each half has its own end of it: sleeves lie as they fall.
    pub own_end: bool,
}

/// What a form must show, each with what is said where it does not.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Mark {
    /// The outline turns inwards where an edge starts, by so many degrees at least.
    Dent(usize, f64, &'static str),
    /// The outline turns outwards where an edge starts, by so many degrees at least.
    Corner(usize, f64, &'static str),
    /// An edge curves into the garment by so much of its chord at least.
    Hollow(usize, f64, &'static str),
    /// An edge bows by no more than so much of its chord.
    Level(usize, f64, &'static str),
    /// The first edge reaches from side to side by no more than so much of the second.
    Narrower(usize, usize, f64, &'static str),
    /// An edge ends as far from the axis as the one before it comes near to it, times this number,
    /// or further.
    Beyond(usize, f64, &'static str),
    /// An edge rises by no more than so many degrees from across.
    Below(usize, f64, &'static str),
}

/// A form: its word in messages, and its edges.
#[derive(Debug)]
pub(crate) struct Form {
    /// With its article.
    pub word: &'static str,
    /// What makes it this form and no other.
    pub marks: &'static [Mark],
    /// Its edges from the axis below to the axis above.
    pub edges: &'static [EdgeForm],
}

const fn edge(role: EdgeRole, way: [f64; 2], bow: [f64; 2], chord: [f64; 2]) -> EdgeForm {
    EdgeForm { role, way, bow, chord, own_end: false }
}

const fn own(role: EdgeRole, way: [f64; 2], bow: [f64; 2], chord: [f64; 2]) -> EdgeForm {
    EdgeForm { role, way, bow, chord, own_end: true }
}

const NO_ARMHOLE: &str = "its sides run up to the shoulders without an armhole";
const NO_SHOULDER: &str = "it has no shoulder beside the neck";
const NO_ARMPIT: &str = "its sides run up without an armpit";

const HEM: EdgeForm = edge(EdgeRole::Hem, [2.0, 10.0], [0.0, 0.06], [0.15, 1.2]);
const SIDE: EdgeForm = edge(EdgeRole::Side, [92.0, 10.0], [0.0, 0.05], [0.3, 2.0]);
const SHOULDER: EdgeForm = edge(EdgeRole::Shoulder, [158.0, 14.0], [0.0, 0.06], [0.06, 0.5]);
const NECK: EdgeForm = edge(EdgeRole::Neck, [200.0, 30.0], [0.1, 0.15], [0.06, 0.6]);

/// No sleeves: vest, strap top, muscle tank.
pub(crate) const VEST: Form = Form {
    word: "a vest",
    marks: &[Mark::Hollow(2, 0.03, NO_ARMHOLE), Mark::Corner(3, 25.0, NO_SHOULDER)],
    edges: &[
        HEM,
        SIDE,
        edge(EdgeRole::Armhole, [97.0, 20.0], [0.12, 0.15], [0.12, 0.7]),
        edge(EdgeRole::Shoulder, [160.0, 20.0], [0.0, 0.06], [0.03, 0.4]),
        NECK,
    ],
};

/// A sleeveless dress whose skirt flares from the waist.
pub(crate) const DRESS: Form = Form {
    word: "a dress without sleeves",
    marks: &[
        Mark::Dent(2, 12.0, "its sides run up without a waist"),
        Mark::Hollow(3, 0.03, NO_ARMHOLE),
        Mark::Corner(4, 25.0, NO_SHOULDER),
    ],
    edges: &[
        HEM,
        edge(EdgeRole::Skirt, [100.0, 12.0], [0.0, 0.06], [0.3, 1.6]),
        edge(EdgeRole::Side, [80.0, 12.0], [0.0, 0.05], [0.15, 0.8]),
        edge(EdgeRole::Armhole, [100.0, 18.0], [0.15, 0.15], [0.12, 0.6]),
        edge(EdgeRole::Shoulder, [160.0, 20.0], [0.0, 0.06], [0.02, 0.3]),
        NECK,
    ],
};

/// A dress with sleeves, whose skirt flares from the waist.
pub(crate) const SLEEVED: Form = Form {
    word: "a dress with sleeves",
    marks: &[
        Mark::Dent(2, 12.0, "its sides run up without a waist"),
        Mark::Dent(3, 25.0, NO_ARMPIT),
        Mark::Below(3, 65.0, NO_ARMPIT),
    ],
    edges: &[
        HEM,
        edge(EdgeRole::Skirt, [100.0, 10.0], [0.0, 0.06], [0.4, 1.6]),
        edge(EdgeRole::Side, [80.0, 12.0], [0.0, 0.05], [0.15, 0.7]),
        own(EdgeRole::Underarm, [-35.0, 35.0], [0.0, 0.08], [0.02, 1.3]),
        own(EdgeRole::Cuff, [55.0, 30.0], [0.0, 0.06], [0.05, 0.45]),
        edge(EdgeRole::Top, [145.0, 25.0], [0.0, 0.08], [0.1, 1.6]),
        SHOULDER,
        NECK,
    ],
};

/// Sleeves that end above the elbow.
pub(crate) const TEE: Form = Form {
    word: "a T-shirt",
    marks: &[Mark::Dent(2, 25.0, NO_ARMPIT), Mark::Below(2, 65.0, NO_ARMPIT)],
    edges: &[
        HEM,
        SIDE,
        own(EdgeRole::Underarm, [-35.0, 30.0], [0.0, 0.08], [0.02, 0.45]),
        own(EdgeRole::Cuff, [55.0, 25.0], [0.0, 0.05], [0.16, 0.5]),
        edge(EdgeRole::Top, [145.0, 20.0], [0.0, 0.06], [0.1, 0.7]),
        SHOULDER,
        NECK,
    ],
};

/// Sleeves that end below the elbow.
pub(crate) const LONG: Form = Form {
    word: "a top with long sleeves",
    marks: &[Mark::Dent(2, 25.0, NO_ARMPIT), Mark::Below(2, 65.0, NO_ARMPIT)],
    edges: &[
        HEM,
        SIDE,
        own(EdgeRole::Underarm, [-40.0, 35.0], [0.0, 0.08], [0.45, 1.6]),
        own(EdgeRole::Cuff, [50.0, 35.0], [0.0, 0.06], [0.06, 0.35]),
        edge(EdgeRole::Top, [135.0, 25.0], [0.0, 0.08], [0.5, 1.8]),
        SHOULDER,
        NECK,
    ],
};

/// Sleeves that end below the elbow, and a hood.
pub(crate) const HOODED: Form = Form {
    word: "a top with a hood",
    marks: &[
        Mark::Dent(2, 25.0, NO_ARMPIT),
        Mark::Below(2, 65.0, NO_ARMPIT),
        Mark::Dent(6, 15.0, "it has no hood above its shoulders"),
    ],
    edges: &[
        HEM,
        SIDE,
        own(EdgeRole::Underarm, [-40.0, 35.0], [0.0, 0.08], [0.45, 1.6]),
        own(EdgeRole::Cuff, [50.0, 35.0], [0.0, 0.06], [0.06, 0.35]),
        edge(EdgeRole::Top, [135.0, 25.0], [0.0, 0.08], [0.5, 1.8]),
        SHOULDER,
        edge(EdgeRole::Crown, [115.0, 15.0], [-0.3, 0.12], [0.2, 0.8]),
    ],
};

/// Sleeves cut in one with front and back, without an armpit: batwing, and cap sleeves so short
/// that the outline hardly shows them.
pub(crate) const GROWN: Form = Form {
    word: "a top with grown-on sleeves",
    marks: &[
        Mark::Beyond(2, 0.98, "its shoulders do not reach to its sides"),
        Mark::Corner(3, 30.0, NO_SHOULDER),
        Mark::Level(2, 0.12, "its cuffs are not even"),
    ],
    edges: &[
        HEM,
        edge(EdgeRole::Side, [82.0, 14.0], [0.08, 0.1], [0.3, 1.6]),
        edge(EdgeRole::Cuff, [80.0, 25.0], [0.0, 0.05], [0.1, 0.5]),
        edge(EdgeRole::Shoulder, [155.0, 14.0], [0.0, 0.06], [0.25, 0.9]),
        NECK,
    ],
};

/// Waist to hem.
pub(crate) const SKIRT: Form = Form {
    word: "a skirt",
    marks: &[
        Mark::Corner(3, 40.0, "it has no waist"),
        Mark::Narrower(3, 0, 0.95, "its waist is as wide as its hem"),
        Mark::Level(0, 0.15, "its hem is not even"),
        Mark::Level(3, 0.2, "its waist is not even"),
    ],
    edges: &[
        edge(EdgeRole::Hem, [5.0, 12.0], [0.0, 0.1], [0.2, 1.5]),
        edge(EdgeRole::Side, [98.0, 12.0], [0.0, 0.06], [0.3, 2.5]),
        edge(EdgeRole::Hip, [105.0, 15.0], [0.0, 0.06], [0.06, 0.8]),
        edge(EdgeRole::Waist, [180.0, 8.0], [0.0, 0.08], [0.1, 0.9]),
    ],
};

/// Two legs.
pub(crate) const TROUSERS: Form = Form {
    word: "a pair of trousers",
    marks: &[Mark::Below(0, -50.0, "it has no legs"), Mark::Corner(4, 40.0, "it has no waist")],
    edges: &[
        own(EdgeRole::Inseam, [-86.0, 12.0], [0.0, 0.05], [0.1, 2.5]),
        own(EdgeRole::Hem, [5.0, 12.0], [0.0, 0.06], [0.08, 0.6]),
        edge(EdgeRole::Outseam, [95.0, 10.0], [0.0, 0.06], [0.2, 3.5]),
        edge(EdgeRole::Hip, [103.0, 15.0], [0.0, 0.08], [0.06, 0.8]),
        edge(EdgeRole::Waist, [180.0, 8.0], [0.0, 0.06], [0.12, 0.7]),
    ],
};

/// Two short or long legs, and a top with sleeves: a child's one-piece.
pub(crate) const ONEPIECE: Form = Form {
    word: "a one-piece",
    marks: &[
        Mark::Below(0, -40.0, "it has no legs"),
        Mark::Dent(3, 25.0, NO_ARMPIT),
        Mark::Below(3, 65.0, NO_ARMPIT),
    ],
    edges: &[
        own(EdgeRole::Inseam, [-78.0, 20.0], [0.0, 0.06], [0.04, 1.4]),
        own(EdgeRole::Hem, [10.0, 20.0], [0.0, 0.06], [0.06, 0.6]),
        edge(EdgeRole::Side, [92.0, 10.0], [0.0, 0.06], [0.4, 2.6]),
        own(EdgeRole::Underarm, [-38.0, 35.0], [0.0, 0.08], [0.02, 1.3]),
        own(EdgeRole::Cuff, [55.0, 30.0], [0.0, 0.06], [0.05, 0.5]),
        edge(EdgeRole::Top, [140.0, 25.0], [0.0, 0.08], [0.1, 1.6]),
        SHOULDER,
        NECK,
    ],
};

/// Two short or long legs, and a top without sleeves.
pub(crate) const ROMPER: Form = Form {
    word: "a one-piece without sleeves",
    marks: &[
        Mark::Below(0, -40.0, "it has no legs"),
        Mark::Hollow(3, 0.03, NO_ARMHOLE),
        Mark::Corner(4, 25.0, NO_SHOULDER),
    ],
    edges: &[
        own(EdgeRole::Inseam, [-78.0, 20.0], [0.0, 0.06], [0.04, 1.4]),
        own(EdgeRole::Hem, [10.0, 20.0], [0.0, 0.06], [0.06, 0.6]),
        edge(EdgeRole::Side, [92.0, 10.0], [0.0, 0.06], [0.4, 2.6]),
        edge(EdgeRole::Armhole, [97.0, 20.0], [0.12, 0.15], [0.12, 0.6]),
        edge(EdgeRole::Shoulder, [160.0, 20.0], [0.0, 0.06], [0.03, 0.4]),
        NECK,
    ],
};

impl Form {
    /// Whether it consists of two legs.
    pub(crate) fn has_legs(&self) -> bool {
        self.begins_at_fork() && self.ends_at(EdgeRole::Waist)
    }

    /// Whether its halves meet in a fork below: it has legs, and nothing else or a top.
    pub(crate) fn begins_at_fork(&self) -> bool {
        self.edges.first().is_some_and(|e| e.role == EdgeRole::Inseam)
    }

    /// Whether its last edge is that one.
    pub(crate) fn ends_at(&self, role: EdgeRole) -> bool {
        self.edges.last().is_some_and(|e| e.role == role)
    }

    /// Whether it hangs from the neck, and not from the waist.
    pub(crate) fn hangs_from_neck(&self) -> bool {
        self.ends_at(EdgeRole::Neck) || self.ends_at(EdgeRole::Crown)
    }

    /// The number of an edge.
    pub(crate) fn at(&self, role: EdgeRole) -> Option<usize> {
        self.edges.iter().position(|e| e.role == role)
    }

    /// The number of the edge that starts at the armpit; none where nothing tells where that is.
    pub(crate) fn armpit(&self) -> Option<usize> {
        self.underarm().or_else(|| self.at(EdgeRole::Armhole))
    }

    /// The number of its underarm edge: it has set-in sleeves.
    pub(crate) fn underarm(&self) -> Option<usize> {
        self.at(EdgeRole::Underarm)
    }
}
