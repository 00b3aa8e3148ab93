//! Whether the garment is large enough for the body.

use super::lift::Board;
use toile_core::prelude::*;

/// Line force at which cloth counts as stretched to its limit, N/m: a tight but wearable garment.
const TIGHT: f64 = 150.0;
/// Bounds of the stretch that is granted whatever the fabric's curve says.
const STRETCH: (f64, f64) = (0.02, 0.6);

/// Compares the garment's girth with the body's at bust, waist and hip, where it reaches them.
pub(crate) fn check_girths(
    panels: &[(Board, &Panel)],
    body: &Body,
    fabric: &Fabric,
) -> Result<(), StageError> {
    for level in ["bust", "waist", "hip"] {
        let Some(mark) = body.landmarks.get(&format!("{level}_front")) else { continue };
        let Some(&around) = body.measurements.get(level) else { continue };
        let Some(girth) = garment_girth(panels, mark.y) else { continue };
        if girth * (1.0 + stretch(fabric)) < around {
            return Err(too_small(level, girth, around));
        }
    }
    Ok(())
}

fn too_small(level: &str, girth: f64, around: f64) -> StageError {
    let cm = |m: f64| (m * 100.0).round();
    let message = format!(
        "the garment is too small: at the {level} it measures {} cm around, the body {} cm",
        cm(girth),
        cm(around)
    );
    StageError::invalid(message).hint("check the photos' scale (`width`), or take a smaller body")
}

/// The strain at which the fabric is tight across.
fn stretch(fabric: &Fabric) -> f64 {
    let (mut lo, mut hi) = STRETCH;
    for _ in 0..30 {
        let middle = (lo + hi) / 2.0;
        if fabric.weft.at(middle).0 < TIGHT { lo = middle } else { hi = middle }
    }
    lo
}

/// Front and back chord together at height `y`; `None` where a side does not reach it.
fn garment_girth(panels: &[(Board, &Panel)], y: f64) -> Option<f64> {
    let side = |sign: f64| {
        let chords = panels.iter().filter(|(b, _)| b.side == sign).filter_map(|(b, p)| chord(b, p, y));
        chords.reduce(|a, b| a + b)
    };
    Some(side(1.0)? + side(-1.0)?)
}

/// The width of the panel's trunk at height `y`: the stretch of its row nearest to its middle, so
/// that hanging sleeves do not count.
fn chord(board: &Board, panel: &Panel, y: f64) -> Option<f64> {
    let outline: Vec<Point2> =
        panel.boundary.iter().map(|&v| board.lay(panel.positions[v as usize])).collect();
    let n = outline.len();
    let mut crossings: Vec<f64> = (0..n)
        .filter_map(|i| {
            let (a, b) = (outline[i], outline[(i + 1) % n]);
            ((a.y >= y) != (b.y >= y)).then(|| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
        })
        .collect();
    crossings.sort_by(f64::total_cmp);
    let (lo, hi) =
        outline.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.x), h.max(p.x)));
    let middle = (lo + hi) / 2.0;
    let away = |c: &[f64]| (c[0] - middle).max(middle - c[1]).max(0.0);
    crossings.chunks_exact(2).min_by(|a, b| away(a).total_cmp(&away(b))).map(|c| c[1] - c[0])
}
