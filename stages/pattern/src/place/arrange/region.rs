//! Where on the body each piece is worn, for patterns that do not say.
//!
//! Method: words of the piece's name first (a table of English words and of the short forms of CAD
//! programs; words that all pieces have in common are the garment's), then its seams: a piece that
//! is sewn to itself and to its mirror image is a leg, fronts and backs that meet at their upper
//! ends have shoulders, a long narrow piece at the upper end of others is a waistband. Which half
//! is left comes from where the seam in the middle lies; which arm a sleeve is for, from the
//! armhole that it is sewn into. Cost: edges of seams. Limits: sleeves of several pieces, collars,
//! cuffs, hoods and yokes are not placed; a piece without a word needs one of the seams above.

use super::patches::{names, without};
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// Words of a front.
const FRONT: [&str; 6] = ["front", "fronts", "frt", "fr", "fnt", "ft"];
/// Words of a back.
const BACK: [&str; 5] = ["back", "backs", "bk", "bck", "bac"];
/// Words of a waistband.
const BAND: [&str; 3] = ["waistband", "wb", "waistbd"];
/// Words of a sleeve.
const SLEEVE: [&str; 3] = ["sleeve", "sleeves", "slv"];
/// Words of pieces that are not placed.
const OTHER: [&str; 12] = [
    "collar", "col", "cuff", "hood", "yoke", "pocket", "pkt", "facing", "lining", "binding", "strap",
    "placket",
];
/// A piece this many times longer than wide may be a band.
const NARROW: f64 = 3.0;
/// Above this share of a piece's height lies a shoulder.
const HIGH: f64 = 0.7;

/// The part of the body that a piece covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Region {
    /// Chest and back, hanging from the shoulders.
    Trunk,
    /// From the waist down, around both legs.
    Skirt,
    /// One leg.
    Leg(Hand),
    /// A band around the waist.
    Waist,
    /// An arm, in one piece.
    Arm(Hand),
    /// Where the user says.
    ByHand,
}

/// The side of the body that a piece covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// Before the body.
    Front,
    /// Behind it.
    Back,
    /// All around.
    Around,
}

/// What was decided of a piece.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Decided {
    pub(super) region: Region,
    pub(super) side: Side,
    /// That of a half front or back.
    pub(super) hand: Option<Hand>,
    /// What speaks for it.
    pub(super) why: String,
}

impl Decided {
    fn by_hand(why: &str) -> Self {
        Decided { region: Region::ByHand, side: Side::Around, hand: None, why: why.to_owned() }
    }
}

/// Edges of two pieces, or twice of one, that a seam joins.
pub(super) struct Joint {
    /// The numbers of the pieces.
    pub(super) pieces: [usize; 2],
    /// The numbers of the edges of each.
    pub(super) edges: [Vec<usize>; 2],
    /// The point of each that lies in the middle of what they have in common.
    pub(super) middle: [Point2; 2],
    /// How much that is of the seam.
    pub(super) share: f64,
}

/// An edge in a side of a seam: of which piece, and from where to where it runs as shares of the
/// side.
struct SeamStretch {
    piece: usize,
    edge: usize,
    reversed: bool,
    from: f64,
    to: f64,
}

/// A side of a seam as stretches.
fn stretches(pattern: &Pattern, side: &[EdgeUse]) -> Vec<SeamStretch> {
    let known = side.iter().filter_map(|u| {
        let piece = pattern.pieces.iter().position(|p| p.name == u.edge.panel)?;
        Some((piece, pattern.pieces[piece].edge_number(&u.edge.edge)?, u.reversed))
    });
    let (mut out, mut at) = (Vec::new(), 0.0);
    for (piece, edge, reversed) in known {
        let from = at;
        at += pattern.pieces[piece].outer.path(edge).length();
        out.push(SeamStretch { piece, edge, reversed, from, to: at });
    }
    out.iter_mut().for_each(|s| (s.from, s.to) = (s.from / at, s.to / at));
    out
}

/// The edges of one piece in a side, where they begin and where they end.
fn of_piece(side: &[SeamStretch], piece: usize) -> (Vec<usize>, f64, f64) {
    let own = || side.iter().filter(|s| s.piece == piece);
    let (from, to) = (own().map(|s| s.from), own().map(|s| s.to));
    (own().map(|s| s.edge).collect(), from.fold(1.0, f64::min), to.fold(0.0, f64::max))
}

/// The point of a piece at a share of a side.
fn at_share(pattern: &Pattern, side: &[SeamStretch], piece: usize, share: f64) -> Point2 {
    let own = || side.iter().filter(|s| s.piece == piece);
    let Some(s) = own().find(|s| share <= s.to).or_else(|| own().next_back()) else {
        return Point2::origin();
    };
    let path = pattern.pieces[piece].outer.path(s.edge);
    let along = ((share - s.from) / (s.to - s.from).max(1e-12)).clamp(0.0, 1.0) * path.length();
    path.at(if s.reversed { path.length() - along } else { along })
}

/// The seams of a pattern, piece by piece.
pub(super) fn joints(pattern: &Pattern) -> Vec<Joint> {
    let pieces = |side: &[SeamStretch]| side.iter().map(|s| s.piece).collect::<BTreeSet<usize>>();
    let mut out = Vec::new();
    for seam in &pattern.seams {
        let sides: Vec<Vec<SeamStretch>> = seam.sides.iter().map(|s| stretches(pattern, s)).collect();
        for (n, one) in sides.iter().enumerate() {
            for other in &sides[n + 1..] {
                let pairs =
                    pieces(one).into_iter().flat_map(|i| pieces(other).into_iter().map(move |j| (i, j)));
                out.extend(pairs.filter_map(|pair| joint(pattern, [one, other], pair)));
            }
        }
    }
    out
}

/// What two sides of a seam join of two pieces; none where these lie nowhere beside each other.
fn joint(pattern: &Pattern, [one, other]: [&[SeamStretch]; 2], (i, j): (usize, usize)) -> Option<Joint> {
    let ((a, a_from, a_to), (b, b_from, b_to)) = (of_piece(one, i), of_piece(other, j));
    let (from, to) = (a_from.max(b_from), a_to.min(b_to));
    let share = f64::midpoint(from, to);
    let middle = [at_share(pattern, one, i, share), at_share(pattern, other, j, share)];
    (to - from > 1e-6).then_some(Joint { pieces: [i, j], edges: [a, b], middle, share: to - from })
}

/// Region and side of every piece, in their order. Those in `keyed` are not looked at; one in
/// `dragged` that nothing decides is placed by hand alone.
///
/// Errors: the first piece that nothing decides, or that is sewn to nothing, with the remedy.
pub(super) fn decide(
    pattern: &Pattern,
    keyed: &BTreeSet<String>,
    dragged: &BTreeSet<String>,
) -> Result<Vec<Decided>, StageError> {
    if joints(pattern).is_empty() {
        return Err(StageError::invalid("the pattern has no seams: its pieces would fall to the floor")
            .hint("give its reader the file of seams that you have looked through as `seams`"));
    }
    let taken = |(piece, decision): (&Piece, Decision)| match decision {
        Decision::Undecided(_) if dragged.contains(&piece.name) => Ok(Decided::by_hand("its place by hand")),
        Decision::Made(decided) => Ok(decided),
        Decision::Undecided(e) | Decision::Loose(e) => Err(e),
    };
    pattern.pieces.iter().zip(decisions(pattern, keyed)).map(taken).collect()
}

/// The pieces that a user must place: those that nothing places, but for patches.
pub fn undecided(pattern: &Pattern) -> Vec<String> {
    let worn = without(pattern, &names(pattern));
    if worn.pieces.iter().any(|p| p.pose.is_some()) {
        let poseless = worn.pieces.iter().filter(|p| p.pose.is_none());
        return poseless.map(|p| p.name.clone()).collect();
    }
    let all = worn.pieces.iter().zip(decisions(&worn, &BTreeSet::new()));
    let is_undecided =
        |(p, d): (&Piece, Decision)| matches!(d, Decision::Undecided(_)).then(|| p.name.clone());
    all.filter_map(is_undecided).collect()
}

/// What the rules say of a piece.
enum Decision {
    Made(Decided),
    /// Nothing decides where it stands.
    Undecided(StageError),
    /// It is sewn to nothing.
    Loose(StageError),
}

/// What is decided of every piece, in their order; those in `keyed` are not looked at.
fn decisions(pattern: &Pattern, keyed: &BTreeSet<String>) -> Vec<Decision> {
    let joints = joints(pattern);
    let words = own_words(pattern);
    let pieces = &pattern.pieces;
    let decided = |i: usize| -> Result<Decided, StageError> {
        let name = &pieces[i].name;
        let is = |table: &[&str]| words[i].iter().find(|w| table.contains(&w.as_str())).cloned();
        let unclear = |what: String| {
            StageError::invalid(what).hint(
                "call it front, back or waistband, place it by `hand_places` or `key_points` of `Arrange`, or give its pattern places around the body, as GarmentCode files have",
            )
        };
        if let Some(word) = is(&OTHER) {
            return Err(unclear(format!(
                "nothing places the piece \"{name}\", a \"{word}\" by its name, without a pose"
            )));
        }
        let twin = |j: &Joint| j.pieces[0] != j.pieces[1] && j.pieces.contains(&i) && twins(pieces, j.pieces);
        let itself = joints.iter().any(|j| j.pieces == [i, i]);
        if let Some(word) = is(&BAND) {
            let why = format!("the word \"{word}\" in its name");
            return Ok(Decided { region: Region::Waist, side: Side::Around, hand: None, why });
        }
        if let Some(word) = is(&SLEEVE) {
            let hand = sleeve_hand(i, pieces, &joints, &words).ok_or_else(|| {
                unclear(format!("nothing tells whether the sleeve \"{name}\" is the left or the right one"))
            })?;
            let why = format!("the word \"{word}\" in its name, and the armhole that it is sewn into");
            return Ok(Decided { region: Region::Arm(hand), side: Side::Around, hand: None, why });
        }
        match face(&words[i]) {
            None if itself && joints.iter().any(&twin) => {
                let hand = leg_hand(i, pieces, &joints).ok_or_else(|| {
                    unclear(format!("nothing tells the front of the leg \"{name}\" from its back"))
                })?;
                let why =
                    "it is sewn to itself and to its mirror image; its rise is longer behind".to_owned();
                Ok(Decided { region: Region::Leg(hand), side: Side::Around, hand: None, why })
            }
            None if is_band(&pieces[i]) && sews_tops(i, pieces, &joints) => {
                let why = "a narrow piece along the upper ends of others".to_owned();
                Ok(Decided { region: Region::Waist, side: Side::Around, hand: None, why })
            }
            None => Err(unclear(format!("nothing says where the piece \"{name}\" stands"))),
            Some((side, word)) => {
                let shoulder = joints.iter().any(|j| j.pieces.contains(&i) && is_shoulder(j, pieces));
                let own_side = |j: &&Joint| twin(j);
                let hand = joints.iter().find(own_side).map(|j| half_hand(i, j, pieces, side));
                let (region, because) = match shoulder {
                    true => {
                        (Region::Trunk, "it is sewn at its upper end beside the middle, as shoulders are")
                    }
                    false => (Region::Skirt, "none of its seams is a shoulder"),
                };
                Ok(Decided { region, side, hand, why: format!("the word \"{word}\" in its name; {because}") })
            }
        }
    };
    let decision = |i: usize| {
        let name = &pieces[i].name;
        if keyed.contains(name) {
            return Decision::Made(Decided::by_hand("its key points"));
        }
        if !joints.iter().any(|j| j.pieces.contains(&i)) {
            let e = StageError::invalid(format!("the piece \"{name}\" is sewn to nothing and would fall"));
            return Decision::Loose(e.hint(
                "write its seams into the file that the reader takes as `seams`, or take the piece out",
            ));
        }
        decided(i).map_or_else(Decision::Undecided, Decision::Made)
    };
    (0..pieces.len()).map(decision).collect()
}

/// Whether words tell a front or a back, and which does.
fn face(words: &BTreeSet<String>) -> Option<(Side, String)> {
    let is = |table: &[&str]| words.iter().find(|w| table.contains(&w.as_str())).cloned();
    match (is(&FRONT), is(&BACK)) {
        (Some(w), None) => Some((Side::Front, w)),
        (None, Some(w)) => Some((Side::Back, w)),
        _ => None,
    }
}

/// The arm of a sleeve: the side of the body of the armholes that it is sewn to, by length.
fn sleeve_hand(i: usize, pieces: &[Piece], joints: &[Joint], words: &[BTreeSet<String>]) -> Option<Hand> {
    let (mut sum, mut all) = (0.0, 0.0);
    for j in joints {
        for k in (0..2).filter(|k| j.pieces[*k] == i && j.pieces[1 - *k] != i) {
            let other = j.pieces[1 - k];
            let Some((side, _)) = face(&words[other]) else { continue };
            let (at, length) = middle(&pieces[other], &j.edges[1 - k]);
            let twin = joints.iter().find(|t| t.pieces.contains(&other) && twins(pieces, t.pieces));
            let (lo, hi) = bounds(&pieces[other]);
            // Seen from outside, the wearer's left is at the right before and at the left behind.
            let before = Hand::of(at.x - (lo.x + hi.x) / 2.0);
            let whole = if side == Side::Front { before } else { before.other() };
            all += length;
            sum += length * twin.map_or(whole, |t| half_hand(other, t, pieces, side)).sign();
        }
    }
    (f64::abs(sum) > 0.5 * all).then(|| Hand::of(sum))
}

/// The words of each name, small, without those that all pieces have.
fn own_words(pattern: &Pattern) -> Vec<BTreeSet<String>> {
    let words = |p: &Piece| -> BTreeSet<String> {
        let parts = p.name.split(|c: char| !c.is_alphabetic());
        parts.filter(|w| !w.is_empty()).map(str::to_lowercase).collect()
    };
    // A word that a name has twice is its own where others have it once.
    let twice = |p: &Piece, w: &str| {
        p.name.split(|c: char| !c.is_alphabetic()).filter(|x| x.to_lowercase() == w).count() > 1
    };
    let all: Vec<BTreeSet<String>> = pattern.pieces.iter().map(words).collect();
    let common = |w: &String| all.len() > 1 && all.iter().all(|s| s.contains(w));
    let own = |(p, s): (&Piece, &BTreeSet<String>)| {
        s.iter().filter(|w| !common(w) || twice(p, w)).cloned().collect()
    };
    pattern.pieces.iter().zip(&all).map(own).collect()
}

/// Whether two pieces are each other's mirror image, by their names.
fn twins(pieces: &[Piece], [a, b]: [usize; 2]) -> bool {
    let is = |x: &str, y: &str| x.strip_suffix("_mirrored") == Some(y);
    is(&pieces[a].name, &pieces[b].name) || is(&pieces[b].name, &pieces[a].name)
}

/// Least and greatest corner of a piece.
pub(super) fn bounds(p: &Piece) -> (Point2, Point2) {
    let points = p.outer.points().0;
    let first = points.first().copied().unwrap_or_else(Point2::origin);
    points.iter().fold((first, first), |(lo, hi), q| (lo.inf(q), hi.sup(q)))
}

/// The middle of some edges by length, and their length.
pub(super) fn middle(p: &Piece, edges: &[usize]) -> (Point2, f64) {
    let (mut sum, mut length) = (Vector2::zeros(), 0.0);
    for &k in edges {
        let path = p.outer.path(k);
        for w in path.points().windows(2) {
            let d = (w[1] - w[0]).norm();
            sum += nalgebra::center(&w[0], &w[1]).coords * d;
            length += d;
        }
    }
    (Point2::from(sum / length.max(1e-12)), length)
}

fn is_band(p: &Piece) -> bool {
    let (lo, hi) = bounds(p);
    let size = hi - lo;
    size.amax() >= NARROW * size.amin()
}

/// Whether the piece is sewn to the upper end of another.
fn sews_tops(i: usize, pieces: &[Piece], joints: &[Joint]) -> bool {
    joints.iter().any(|j| {
        (0..2).any(|k| {
            j.pieces[k] == i && j.pieces[1 - k] != i && is_high(&pieces[j.pieces[1 - k]], &j.edges[1 - k])
        })
    })
}

fn is_high(p: &Piece, edges: &[usize]) -> bool {
    let (lo, hi) = bounds(p);
    middle(p, edges).0.y > lo.y + HIGH * (hi.y - lo.y)
}

/// A shoulder: high in both pieces, more across than along.
fn is_shoulder(j: &Joint, pieces: &[Piece]) -> bool {
    j.pieces[0] != j.pieces[1]
        && (0..2).all(|k| {
            let p = &pieces[j.pieces[k]];
            let level = j.edges[k].iter().all(|&e| {
                let path = p.outer.path(e);
                let way = path.at(path.length()) - path.at(0.0);
                way.x.abs() > way.y.abs()
            });
            level && is_high(p, &j.edges[k])
        })
}

/// The hand of a half front or back, whose edge in the middle is sewn to its mirror image.
fn half_hand(i: usize, j: &Joint, pieces: &[Piece], side: Side) -> Hand {
    let k = usize::from(j.pieces[0] != i);
    let (lo, hi) = bounds(&pieces[i]);
    let at_left = middle(&pieces[i], &j.edges[k]).0.x < (lo.x + hi.x) / 2.0;
    // Seen from outside, the wearer's left is at the right before and at the left behind.
    if at_left == (side == Side::Front) { Hand::Left } else { Hand::Right }
}

/// The hand of a leg in one piece: the rise is longer behind, and behind is at the right of a left
/// leg seen from outside.
fn leg_hand(i: usize, pieces: &[Piece], joints: &[Joint]) -> Option<Hand> {
    let mut rises: Vec<(f64, f64)> = Vec::new();
    for j in joints.iter().filter(|j| j.pieces[0] != j.pieces[1] && twins(pieces, j.pieces)) {
        for k in 0..2 {
            if j.pieces[k] == i {
                let (at, length) = middle(&pieces[i], &j.edges[k]);
                rises.push((length, at.x));
            }
        }
    }
    let [a, b] = rises[..] else { return None };
    let (behind, before) = if a.0 > b.0 { (a, b) } else { (b, a) };
    let clear = behind.0 > 1.02 * before.0 && behind.1 != before.1;
    clear.then(|| Hand::of(behind.1 - before.1))
}
