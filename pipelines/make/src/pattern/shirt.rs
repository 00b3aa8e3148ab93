//! A shirt with set-in sleeves, a stand collar and cuffs.

use super::{DraftGarment, DraftPanel, PlanePoint, bent, line};

/// Degrees between the mannequin's arms and the vertical.
const ARM: f64 = 60.0;
/// The end of the sleeve on the arm's axis: x and y.
const CUFF_END: PlanePoint = [56.0, 112.0];

/// A shirt: front, back, sleeves in two halves each, a stand collar in two halves, cuffs in two
/// halves each.
pub(super) fn shirt() -> DraftGarment {
    let (hem, armpit, shoulder, neck) = ([27.0, 0.0], [27.0, 33.5], [19.5, 57.4], [8.0, 61.6]);
    let torso = |name: &str, depth: f64, scoop: f64, z: f64| {
        let corners = [
            [-hem[0], 0.0],
            hem,
            armpit,
            shoulder,
            neck,
            [-neck[0], neck[1]],
            [-shoulder[0], shoulder[1]],
            [-armpit[0], armpit[1]],
        ];
        let edges = [
            line("hem"),
            line("side_left"),
            bent("armhole_left", 0.3, scoop),
            line("shoulder_left"),
            // The lowest point of a parabola lies at half the height of its control.
            bent("neck", 0.5, 2.0 * depth / (2.0 * neck[0])),
            line("shoulder_right"),
            bent("armhole_right", 0.7, scoop),
            line("side_right"),
        ];
        DraftPanel::new(name, "body", &corners, &edges, [0.0, 85.0, z])
    };
    let (front_scoop, back_scoop) = (0.16, 0.10);
    let front = torso("front", 9.0, front_scoop, 22.0);
    let back = torso("back", 2.0, back_scoop, 22.0).behind("back");
    let (low, high) = ([-11.5, 34.0], [11.5, 42.0]);
    let sleeve = |name: &str, scoop: f64, z: f64| {
        // The cap is eased into the armhole by a hundredth.
        let armhole = bent("", 0.3, scoop).length(armpit, shoulder) * 1.01;
        let cap = bend_for(armhole, high, low, 0.5);
        let corners = [[-7.0, 0.0], [7.0, 0.0], high, low];
        let edges = [line("wrist"), line("over_arm"), bent("cap", 0.5, -cap), line("under_arm")];
        DraftPanel {
            turn: ARM,
            ..DraftPanel::new(name, "arm", &corners, &edges, [CUFF_END[0], CUFF_END[1], z])
        }
    };
    let cuff = |name: &str, z: f64| {
        let corners = [[-5.5, -6.0], [5.5, -6.0], [5.5, -1.0], [-5.5, -1.0]];
        let edges = [line("hem"), line("over_arm"), line("wrist"), line("under_arm")];
        DraftPanel {
            turn: ARM,
            ..DraftPanel::new(name, "arm", &corners, &edges, [CUFF_END[0], CUFF_END[1], z])
        }
    };
    let collar = |name: &str, depth: f64, z: f64| {
        let half = bent("", 0.5, 2.0 * depth / (2.0 * neck[0])).length(neck, [-neck[0], neck[1]]) / 2.0;
        let corners = [[-half, 0.0], [half, 0.0], [half, 4.0], [-half, 4.0]];
        let edges = [line("neck"), line("end_left"), line("edge"), line("end_right")];
        DraftPanel::new(name, "body", &corners, &edges, [0.0, 148.0, z])
    };
    let mut panels = vec![
        front,
        back,
        collar("collar_front", 9.0, 16.0),
        collar("collar_back", 2.0, 16.0).behind("collar_back"),
    ];
    for (part, of) in [("sleeve", true), ("cuff", false)] {
        let made = |name: &str, scoop: f64| if of { sleeve(name, scoop, 10.0) } else { cuff(name, 9.0) };
        let front = made(&format!("left_{part}_front"), front_scoop);
        let back = made("", back_scoop).behind(&format!("left_{part}_back"));
        let others =
            [front.mirrored(&format!("right_{part}_front")), back.mirrored(&format!("right_{part}_back"))];
        panels.extend([front, back]);
        panels.extend(others);
    }
    let mut g = DraftGarment { panels, stitches: Vec::new() };
    for edge in ["shoulder_left", "shoulder_right", "side_left", "side_right"] {
        g.stitch("front", edge, "back", edge);
    }
    for (side, armhole) in [("left", "armhole_left"), ("right", "armhole_right")] {
        let of = |part: &str| format!("{side}_{part}");
        for half in ["front", "back"] {
            g.stitch(half, armhole, &of(&format!("sleeve_{half}")), "cap");
            g.stitch(&of(&format!("sleeve_{half}")), "wrist", &of(&format!("cuff_{half}")), "wrist");
        }
        for part in ["sleeve", "cuff"] {
            for edge in ["over_arm", "under_arm"] {
                g.stitch(&of(&format!("{part}_front")), edge, &of(&format!("{part}_back")), edge);
            }
        }
    }
    g.stitch("front", "neck", "collar_front", "neck");
    g.stitch("back", "neck", "collar_back", "neck");
    g.stitch("collar_front", "end_left", "collar_back", "end_left");
    g.stitch("collar_front", "end_right", "collar_back", "end_right");
    g
}

/// How far a curve over that chord must bend to have that length; 0 where the chord is longer.
fn bend_for(wanted: f64, from: PlanePoint, to: PlanePoint, along: f64) -> f64 {
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if bent("", along, middle).length(from, to) < wanted { low = middle } else { high = middle }
    }
    low
}
