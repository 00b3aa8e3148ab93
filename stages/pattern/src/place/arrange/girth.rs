//! Whether the garment is large enough for the body.

use super::boards::Board;
use toile_core::prelude::*;

/// Line force at which cloth counts as stretched to its limit, N/m: a tight but wearable garment.
const TIGHT: f64 = 150.0;
/// Bounds of the stretch that is granted whatever the fabric's curve says.
const STRETCH: (f64, f64) = (0.02, 0.6);

/// An armhole that ends below a level opens the garment there: its girth is then taken this much
/// lower at most, in steps, metres.
const LOWER: (u32, f64) = (20, 0.005);

/// Compares the girth of a garment that is a front and a back with the body's at bust, waist and
/// hip, where it reaches them. Of one with more pieces a row tells no girth: its parts are worn at
/// other heights than they start at.
pub(super) fn check(boards: &[Board<'_>], body: &Body, fabric: &Fabric) -> Result<(), StageError> {
    if boards.len() != 2 {
        return Ok(());
    }
    for level in ["bust", "waist", "hip"] {
        let Some(mark) = body.landmarks.get(&format!("{level}_front")) else { continue };
        let Some(&around) = body.measurements.get(level) else { continue };
        // What begins near the waist has no bust, however short the body is.
        let waist = body.landmarks.get("waist_front").filter(|_| level == "bust");
        let least = waist.map_or(f64::NEG_INFINITY, |waist| f64::midpoint(mark.y, waist.y));
        let lower = (0..LOWER.0).map(|k| mark.y - f64::from(k) * LOWER.1).filter(|y| *y > least);
        let Some(girth) = lower.filter_map(|y| garment_girth(boards, y)).next() else { continue };
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

/// Front and back chords together at height `y`; `None` where the garment does not close there.
fn garment_girth(boards: &[Board<'_>], y: f64) -> Option<f64> {
    let side = |before: bool| {
        let chords = boards.iter().filter(|b| b.is_before() == before).filter_map(|b| chord(b, y));
        chords.reduce(|a, b| Some(a? + b?))?
    };
    Some(side(true)? + side(false)?)
}

/// The width of a piece at height `y`, if it reaches there: of the stretch of its row nearest to
/// its middle, so that hanging sleeves do not count; of none where its ends are not sewn.
fn chord(board: &Board<'_>, y: f64) -> Option<Option<f64>> {
    let Board { panel, points, sewn, .. } = board;
    let boundary = &panel.boundary;
    let sides = (0..boundary.len()).map(|i| (boundary[i], boundary[(i + 1) % boundary.len()]));
    let crossing = |(v, w): (u32, u32)| {
        let (a, b) = (points[v as usize], points[w as usize]);
        let x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
        ((a.y >= y) != (b.y >= y)).then_some((x, sewn.contains(&v) && sewn.contains(&w)))
    };
    let mut crossings: Vec<(f64, bool)> = sides.filter_map(crossing).collect();
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let xs = || points.iter().map(|p| p.x);
    let middle = (xs().fold(f64::INFINITY, f64::min) + xs().fold(f64::NEG_INFINITY, f64::max)) / 2.0;
    let away = |c: &[(f64, bool)]| (c[0].0 - middle).max(middle - c[1].0).max(0.0);
    let trunk = crossings.chunks_exact(2).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    Some((trunk[0].1 && trunk[1].1).then_some(trunk[1].0 - trunk[0].0))
}
