//! The look of the cloth itself: weave or knit, creases, bindings and stitch lines.

use crate::colour::{LinearColour, blend, scale, smoothstep};
use crate::garment::PlanePoint;
use crate::near::NearestEdge;
use crate::noise::{fractal, hash, value};

/// How the yarns lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Structure {
    /// Warp and weft cross.
    Woven,
    /// Columns of loops.
    Knit,
}

/// What a rim of the garment is finished with.
#[derive(Debug, Clone, Copy)]
pub(crate) enum RimFinish {
    /// Cut by a seam: only slightly rolled.
    Seam,
    /// A binding of that width and colour, mm.
    Bound(f64, LinearColour),
    /// Turned in and stitched with two rows at that depth, mm.
    Hemmed(f64),
}

/// Pitch of the visible yarn structure, mm; a little over two pixels, so that it survives the lens.
const PITCH: f64 = 1.15;

/// Light that the yarns at `p` give back, about 1.
pub(crate) fn yarns(structure: Structure, seed: u64, p: PlanePoint) -> f64 {
    // Yarns are never straight nor evenly thick: slubs run along them.
    let wander = 0.5 * value(seed, p[0] / 19.0, p[1] / 23.0);
    let (x, y) = ((p[0] + wander) / PITCH, (p[1] + wander) / PITCH);
    let slub =
        0.05 * value(seed + 1, p[0] / 0.9, p[1] / 16.0) + 0.05 * value(seed + 2, p[0] / 16.0, p[1] / 0.9);
    let tau = std::f64::consts::TAU;
    let relief = match structure {
        Structure::Woven => (tau * x / 2.0).sin() * (tau * y / 2.0).sin(),
        Structure::Knit => 0.9 * (tau * x).cos() + 0.35 * (tau * (y + 0.4 * (2.0 * x).fract())).sin(),
    };
    1.0 + 0.10 * relief + slub + 0.05 * fractal(seed + 3, p[0] / 70.0, p[1] / 70.0, 3)
}

/// Height of the cloth over the ground, mm: soft billows, pressed folds and sharp small creases.
pub(crate) fn height(seed: u64, p: PlanePoint) -> f64 {
    let billow = 8.0 * fractal(seed + 10, p[0] / 150.0, p[1] / 170.0, 3);
    let pressed = 0.9 * groove(p[0] + 2.5 * value(seed + 11, 0.0, p[1] / 90.0), 2.2)
        + 0.8 * groove(p[1] - 312.0 + 2.5 * value(seed + 12, p[0] / 80.0, 0.0), 2.4);
    let creases: f64 = (0..34).map(|k| crease(seed + 100 + k, p)).sum();
    billow - pressed + creases
}

fn groove(x: f64, width: f64) -> f64 {
    (-(x / width).powi(2)).exp()
}

/// One crease: a curved ridge with a place, a direction, a length and a height of its own.
fn crease(seed: u64, p: PlanePoint) -> f64 {
    let r = |k: i64| hash(seed, k, 0);
    let centre = [(r(0) - 0.5) * 520.0, 30.0 + r(1) * 560.0];
    let angle = (r(2) - 0.5) * 2.2 + if centre[0] > 0.0 { 0.9 } else { -0.9 };
    let (s, c) = angle.sin_cos();
    let d = [p[0] - centre[0], p[1] - centre[1]];
    let length = 34.0 + 62.0 * r(3);
    let along = (d[0] * c + d[1] * s) / length;
    if along.abs() > 1.6 {
        return 0.0;
    }
    let bend = (r(4) - 0.5) * 26.0 * along * along;
    let width = 3.2 + 7.0 * r(5);
    let across = (d[1] * c - d[0] * s - bend) / width;
    (0.8 + 1.5 * r(6)) * (width / 6.0) * (-across * across - 2.0 * along * along).exp()
}

/// Light on the relief: a lamp from the upper left, Lambert's cosine with much light from all
/// round.
pub(crate) fn relief_light(seed: u64, p: PlanePoint) -> f64 {
    let e = 0.6;
    let dx = (height(seed, [p[0] + e, p[1]]) - height(seed, [p[0] - e, p[1]])) / (2.0 * e);
    let dy = (height(seed, [p[0], p[1] + e]) - height(seed, [p[0], p[1] - e])) / (2.0 * e);
    (1.0 + 0.75 * dx - 0.85 * dy).clamp(0.45, 1.5)
}

/// Binding and stitches over the cloth's colour.
pub(crate) fn finish(
    colour: LinearColour,
    rim: RimFinish,
    near: &NearestEdge,
    thread: LinearColour,
) -> LinearColour {
    let d = near.depth;
    // Cloth rolls at its rim and turns away from the light.
    let rolled = scale(colour, 1.0 - 0.16 * (1.0 - smoothstep(0.0, 2.4, d)));
    match rim {
        RimFinish::Seam => rolled,
        RimFinish::Bound(width, tape) => {
            let ribs = 1.0 + 0.06 * (near.along * std::f64::consts::TAU / 2.3).sin();
            let round = 1.0 - 0.22 * ((d - width / 2.0) / (width / 2.0)).powi(2);
            let bound = blend(scale(tape, ribs * round), rolled, smoothstep(width - 0.4, width + 0.4, d));
            // The binding lies on the cloth and shades it.
            let shade = 1.0
                - 0.28 * smoothstep(width, width + 0.3, d) * (1.0 - smoothstep(width + 0.6, width + 3.0, d));
            stitched(scale(bound, shade), d - (width - 2.0), near.along, thread)
        }
        RimFinish::Hemmed(depth) => {
            let fold = 1.0 - 0.10 * groove(d - depth - 2.5, 1.6) + 0.05 * groove(d - depth + 4.5, 2.5);
            let first = stitched(scale(rolled, fold), d - depth, near.along, thread);
            stitched(first, d - depth + 6.0, near.along + 1.4, thread)
        }
    }
}

/// A row of stitches, 3 mm long with gaps, at distance `off` from its line.
fn stitched(colour: LinearColour, off: f64, along: f64, thread: LinearColour) -> LinearColour {
    let place = (along / 3.2).fract();
    let dash = smoothstep(0.05, 0.2, place) * (1.0 - smoothstep(0.72, 0.87, place));
    let pull = 1.0 - 0.14 * groove(off, 1.3);
    blend(scale(colour, pull), thread, 0.75 * dash * groove(off, 0.42))
}
