//! A child's one-piece with short sleeves and short legs: two fronts and two backs, each from the
//! shoulder to the leg, sewn along the middle, the crotch and the inseams.
//!
//! For the mannequin of 110 cm, bust 58, waist 54 and hip 60 cm: 66 cm at the bust, 70 cm at the
//! hip.

use super::{DraftGarment, DraftPanel, PlanePoint, curve, line, sleeve};

/// A front or back on the wearer's left, x from the middle of the body, y from the floor.
struct OnePieceHalf {
    /// The end of the crotch curve, and where it leaves the centre seam.
    fork: PlanePoint,
    seat: f64,
    /// The inseam at the hem.
    inner: PlanePoint,
    /// The centre seam at the neck.
    neck: f64,
    /// How far towards the shoulder the neckline stays level.
    round: f64,
    /// Controls of the armhole, from armpit to shoulder.
    armhole: [PlanePoint; 2],
}

/// Hem, hip, armpit, shoulder and neck at the shoulder, of front and back alike.
const SIDE: [PlanePoint; 3] = [[16.6, 31.0], [17.4, 48.0], [16.5, 74.0]];
const SHOULDER: PlanePoint = [12.0, 86.8];
const NECK: PlanePoint = [6.4, 89.6];

const FRONT: OnePieceHalf = OnePieceHalf {
    fork: [-3.5, 38.5],
    seat: 45.0,
    inner: [-1.5, 31.0],
    neck: 84.0,
    round: 0.9,
    armhole: [[12.0, 74.0], [10.5, 80.0]],
};
const BACK: OnePieceHalf = OnePieceHalf {
    fork: [-6.0, 38.5],
    seat: 46.5,
    inner: [-4.0, 31.0],
    neck: 87.8,
    round: 0.6,
    armhole: [[12.5, 74.0], [11.2, 80.0]],
};

/// A left piece before the body.
fn piece(name: &str, p: &OnePieceHalf) -> DraftPanel {
    let [hem, hip, armpit] = SIDE;
    let (neck, seat) = ([0.0, p.neck], [0.0, p.seat]);
    let corners = [p.inner, hem, hip, armpit, SHOULDER, NECK, neck, seat, p.fork];
    let edges = [
        line("hem"),
        curve("side_leg", hem, hip, &[[17.8, 43.0]]),
        curve("side", hip, armpit, &[[16.2, 63.0]]),
        curve("armhole", armpit, SHOULDER, &p.armhole),
        line("shoulder"),
        // The neckline is level in the middle.
        curve("neck", NECK, neck, &[[NECK[0] * p.round, p.neck]]),
        line("centre"),
        curve("crotch", seat, p.fork, &[[0.0, p.fork[1]]]),
        line("inseam"),
    ];
    DraftPanel::new(name, "body", &corners, &edges, [4.0, 0.0, 13.0])
}

fn half_sleeve(name: &str, p: &OnePieceHalf) -> DraftPanel {
    let armhole = curve("", SIDE[2], SHOULDER, &p.armhole).length(SIDE[2], SHOULDER);
    // The cap is eased into the armhole by a hundredth.
    let half = sleeve::HalfSleeve {
        under: 4.5,
        high: 5.5,
        cap: armhole * 1.01,
        narrow: 1.0,
        axis: [13.5, 79.3],
        gap: 4.0,
        z: 8.0,
    };
    half.panel(name)
}

pub(super) fn onepiece() -> DraftGarment {
    let mut panels = Vec::new();
    let front = piece("left_front", &FRONT);
    let back = piece("", &BACK).behind("left_back");
    panels.extend([front.mirrored("right_front"), back.mirrored("right_back"), front, back]);
    let front = half_sleeve("left_sleeve_front", &FRONT);
    let back = half_sleeve("", &BACK).behind("left_sleeve_back");
    panels.extend([front.mirrored("right_sleeve_front"), back.mirrored("right_sleeve_back"), front, back]);
    let mut g = DraftGarment { panels, stitches: Vec::new() };
    for side in ["left", "right"] {
        let [front, back] = ["front", "back"].map(|half| format!("{side}_{half}"));
        for edge in ["side_leg", "side", "shoulder", "inseam"] {
            g.stitch(&front, edge, &back, edge);
        }
        for half in ["front", "back"] {
            g.stitch(&format!("{side}_{half}"), "armhole", &format!("{side}_sleeve_{half}"), "cap");
        }
        let [front, back] = ["front", "back"].map(|half| format!("{side}_sleeve_{half}"));
        for edge in ["over_arm", "under_arm"] {
            g.stitch(&front, edge, &back, edge);
        }
    }
    for half in ["front", "back"] {
        for edge in ["centre", "crotch"] {
            g.stitch(&format!("left_{half}"), edge, &format!("right_{half}"), edge);
        }
    }
    g
}
