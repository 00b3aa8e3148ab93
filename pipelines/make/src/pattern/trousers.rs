//! Straight trousers: two fronts and two backs with a dart each, and a waistband in two halves.
//!
//! For the mannequin of 172 cm, waist 70 and hip 96 cm: 72 cm at the waist, 100 cm at the hip.

use super::{DraftGarment, DraftPanel, PlanePoint, curve, dart, distance, line};

/// The height of the hem above the floor.
const HEM: f64 = 9.0;
/// Half of the waistband before and behind.
const BAND: [f64; 2] = [18.5, 17.5];
/// The side seam, at the hem, at the hip, above it and at the waist, from the middle of the body.
const SIDE: [PlanePoint; 4] = [[20.0, 0.0], [25.2, 76.0], [25.4, 86.0], [22.0, 98.5]];

/// What sets the front of a leg apart from its back.
struct TrouserLeg {
    /// The end of the crotch curve.
    fork: PlanePoint,
    /// Where the crotch curve leaves the centre seam.
    seat: PlanePoint,
    /// The centre seam at the waist.
    centre: PlanePoint,
    /// The inseam at the hem.
    inner: f64,
    /// How deep the dart is; its width is what the waist is too wide.
    dart: f64,
    band: f64,
}

const FRONT: TrouserLeg = TrouserLeg {
    fork: [-5.5, 63.0],
    seat: [0.0, 71.0],
    centre: [1.0, 98.0],
    inner: -1.0,
    dart: 9.0,
    band: BAND[0],
};
const BACK: TrouserLeg = TrouserLeg {
    fork: [-10.5, 62.5],
    seat: [-0.5, 73.0],
    centre: [2.5, 100.5],
    inner: -3.0,
    dart: 12.0,
    band: BAND[1],
};

/// A left leg's panel before the body.
fn leg(name: &str, leg: &TrouserLeg) -> DraftPanel {
    let [hem, hip, above, waist] = SIDE;
    let wide = distance(waist, leg.centre);
    let [outer, tip, inner] = dart(waist, leg.centre, wide / 2.0, wide - leg.band, leg.dart);
    let corners = [[leg.inner, 0.0], hem, hip, waist, outer, tip, inner, leg.centre, leg.seat, leg.fork];
    // The crotch curve ends level.
    let crotch = [leg.seat[0], leg.fork[1]];
    let edges = [
        line("hem"),
        line("side_leg"),
        curve("side_hip", hip, waist, &[above]),
        line("waist_outer"),
        line("dart_outer"),
        line("dart_inner"),
        line("waist_inner"),
        line("centre"),
        curve("fork", leg.seat, leg.fork, &[crotch]),
        line("inseam"),
    ];
    DraftPanel::new(name, "leg", &corners, &edges, [6.0, HEM, 20.0])
}

fn band(name: &str, half: f64) -> DraftPanel {
    let corners = [
        [-half, 0.0],
        [-half / 2.0, 0.0],
        [0.0, 0.0],
        [half / 2.0, 0.0],
        [half, 0.0],
        [half, 4.0],
        [-half, 4.0],
    ];
    let edges = [
        line("right_outer"),
        line("right_inner"),
        line("left_inner"),
        line("left_outer"),
        line("end_left"),
        line("top"),
        line("end_right"),
    ];
    DraftPanel::new(name, "body", &corners, &edges, [0.0, HEM + 100.0, 18.0])
}

pub(super) fn trousers() -> DraftGarment {
    let front = leg("left_front", &FRONT);
    let back = leg("", &BACK).behind("left_back");
    let panels = vec![
        front.mirrored("right_front"),
        back.mirrored("right_back"),
        front,
        back,
        band("band_front", BAND[0]),
        band("", BAND[1]).behind("band_back"),
    ];
    let mut g = DraftGarment { panels, stitches: Vec::new() };
    for side in ["left", "right"] {
        let [front, back] = ["front", "back"].map(|half| format!("{side}_{half}"));
        for edge in ["side_leg", "side_hip", "inseam"] {
            g.stitch(&front, edge, &back, edge);
        }
        let names: [&'static str; 2] =
            if side == "left" { ["left_outer", "left_inner"] } else { ["right_outer", "right_inner"] };
        for (leg, band) in [(&front, "band_front"), (&back, "band_back")] {
            g.stitch(leg, "dart_outer", leg, "dart_inner");
            g.stitch(leg, "waist_outer", band, names[0]);
            g.stitch(leg, "waist_inner", band, names[1]);
        }
    }
    for half in ["front", "back"] {
        for edge in ["centre", "fork"] {
            g.stitch(&format!("left_{half}"), edge, &format!("right_{half}"), edge);
        }
    }
    g.stitch("band_front", "end_left", "band_back", "end_left");
    g.stitch("band_front", "end_right", "band_back", "end_right");
    g
}
