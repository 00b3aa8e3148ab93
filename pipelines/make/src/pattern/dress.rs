//! A dress: bodice with bust and waist darts, skirt gathered to the waist seam, short set-in
//! sleeves.
//!
//! For the mannequin of 172 cm, bust 88 and waist 70 cm: 95 cm at the bust, 74 cm at the waist.

use super::{DraftGarment, DraftPanel, PlanePoint, bent, curve, dart, distance, line, sleeve};

/// The height of the waist seam above the floor.
const WAIST: f64 = 109.0;
/// Half of the waist, darts closed, before and behind.
const HALVES: [f64; 2] = [19.0, 18.0];
/// Half of the waist between the middle and the dart.
const INNER: f64 = 7.5;
/// What the skirt is wider than the waist.
const GATHER: f64 = 1.6;
/// The side seam above the bust dart.
const ABOVE: f64 = 3.5;

/// Corners of the bodice on the wearer's left, from its middle at the waist.
struct Bodice {
    waist: PlanePoint,
    armpit: PlanePoint,
    shoulder: PlanePoint,
    neck: PlanePoint,
    /// Controls of the armhole, from armpit to shoulder.
    armhole: [PlanePoint; 2],
    depth: f64,
    half: f64,
    dart: f64,
}

const FRONT: Bodice = Bodice {
    waist: [22.5, 0.0],
    armpit: [24.0, 20.0],
    shoulder: [18.5, 40.2],
    neck: [8.5, 44.6],
    armhole: [[18.0, 19.5], [15.8, 29.0]],
    depth: 10.0,
    half: HALVES[0],
    dart: 13.0,
};
const BACK: Bodice = Bodice {
    waist: [21.0, 0.0],
    armpit: [23.5, 16.5],
    shoulder: [18.5, 39.5],
    neck: [8.5, 43.9],
    armhole: [[18.5, 16.0], [17.0, 27.0]],
    depth: 2.5,
    half: HALVES[1],
    dart: 14.0,
};

fn mirror([x, y]: PlanePoint) -> PlanePoint {
    [-x, y]
}

/// A bodice before the body; the bust dart takes in what the side is longer than `side`, if it is
/// to.
fn bodice(name: &str, b: &Bodice, side: Option<f64>) -> DraftPanel {
    let width = b.waist[0] - b.half;
    let [inner, tip, outer] = dart([0.0, 0.0], b.waist, INNER + width / 2.0, width, b.dart);
    let long = distance(b.waist, b.armpit);
    let mouth = side.map_or(0.0, |s| long - s);
    let bust = dart(b.waist, b.armpit, long - ABOVE - mouth / 2.0, mouth, 11.0);
    // Without a dart the three corners are one.
    let sides = if side.is_some() { &bust[..] } else { &bust[..1] };
    let mut corners = vec![mirror(outer), mirror(tip), mirror(inner), inner, tip, outer, b.waist];
    corners.extend(sides);
    corners.extend([b.armpit, b.shoulder, b.neck, mirror(b.neck), mirror(b.shoulder), mirror(b.armpit)]);
    corners.extend(sides.iter().rev().map(|p| mirror(*p)));
    corners.push(mirror(b.waist));
    let armhole = curve("armhole_left", b.armpit, b.shoulder, &b.armhole);
    let mut edges = vec![
        line("dart_right_outer"),
        line("dart_right_inner"),
        line("waist_middle"),
        line("dart_left_inner"),
        line("dart_left_outer"),
        line("waist_left"),
        line("side_left_low"),
    ];
    if side.is_some() {
        edges.extend([line("bust_left_low"), line("bust_left_high")]);
    }
    edges.extend([
        line("side_left_high"),
        armhole.clone(),
        line("shoulder_left"),
        // The lowest point of a parabola lies at half the height of its control.
        bent("neck", 0.5, 2.0 * b.depth / (2.0 * b.neck[0])),
        line("shoulder_right"),
        super::DraftEdge { name: "armhole_right", ..armhole.reversed(1.0) },
        line("side_right_high"),
    ]);
    if side.is_some() {
        edges.extend([line("bust_right_high"), line("bust_right_low")]);
    }
    edges.extend([line("side_right_low"), line("waist_right")]);
    DraftPanel::new(name, "body", &corners, &edges, [0.0, WAIST, 20.0])
}

/// Half of the skirt before the body; its upper edge has the parts of the bodice's waist.
fn skirt(name: &str, half: f64) -> DraftPanel {
    let (inner, outer, hem) = (GATHER * INNER, GATHER * half, GATHER * half + 9.0);
    let long = 56.0;
    let corners = [[-hem, -long], [hem, -long], [outer, 0.0], [inner, 0.0], [-inner, 0.0], [-outer, 0.0]];
    let edges = [
        line("hem"),
        line("side_left"),
        line("waist_left"),
        line("waist_middle"),
        line("waist_right"),
        line("side_right"),
    ];
    DraftPanel::new(name, "body", &corners, &edges, [0.0, WAIST - 2.0, 20.0])
}

fn half_sleeve(name: &str, b: &Bodice) -> DraftPanel {
    let armhole = curve("", b.armpit, b.shoulder, &b.armhole).length(b.armpit, b.shoulder);
    // The cap is eased into the armhole by a hundredth.
    let half = sleeve::HalfSleeve {
        under: 7.0,
        high: 12.0,
        cap: armhole * 1.01,
        narrow: 2.0,
        axis: [19.0, 133.0],
        gap: 3.0,
        z: 10.0,
    };
    half.panel(name)
}

pub(super) fn dress() -> DraftGarment {
    let side = distance(BACK.waist, BACK.armpit);
    let mut panels = vec![
        bodice("front", &FRONT, Some(side)),
        bodice("", &BACK, None).behind("back"),
        skirt("skirt_front", HALVES[0]),
        skirt("", HALVES[1]).behind("skirt_back"),
    ];
    let front = half_sleeve("left_sleeve_front", &FRONT);
    let back = half_sleeve("", &BACK).behind("left_sleeve_back");
    panels.extend([front.mirrored("right_sleeve_front"), back.mirrored("right_sleeve_back"), front, back]);
    let mut g = DraftGarment { panels, stitches: Vec::new() };
    for edge in ["shoulder_left", "shoulder_right", "side_left_low", "side_left_high"] {
        g.stitch("front", edge, "back", edge);
    }
    for edge in ["side_right_low", "side_right_high"] {
        g.stitch("front", edge, "back", edge);
    }
    g.stitch("front", "bust_left_low", "front", "bust_left_high");
    g.stitch("front", "bust_right_low", "front", "bust_right_high");
    for half in ["front", "back"] {
        g.stitch(half, "dart_left_inner", half, "dart_left_outer");
        g.stitch(half, "dart_right_inner", half, "dart_right_outer");
        for edge in ["waist_left", "waist_middle", "waist_right"] {
            g.stitch(half, edge, &format!("skirt_{half}"), edge);
        }
    }
    for edge in ["side_left", "side_right"] {
        g.stitch("skirt_front", edge, "skirt_back", edge);
    }
    for (side, armhole) in [("left", "armhole_left"), ("right", "armhole_right")] {
        let [front, back] = ["front", "back"].map(|half| format!("{side}_sleeve_{half}"));
        g.stitch("front", armhole, &front, "cap");
        g.stitch("back", armhole, &back, "cap");
        for edge in ["over_arm", "under_arm"] {
            g.stitch(&front, edge, &back, edge);
        }
    }
    g
}
