//! The T-shirt whose sleeves belong to its front and back.

use super::naming::{Half, IN, OUT, check_armpit, name_edges};
use super::sewing::{pairs, place_and_sew};
use super::shape::{Path, Shape};
use toile_core::prelude::*;

/// Names the edges of a T-shirt and sews its shoulders, underarms and sides.
///
/// The sleeves are part of the front and the back, as the photos show them. Edges,
/// counter-clockwise on each panel: `side`, `underarm` (armpit to cuff), `cuff`, `shoulder` (neck
/// to cuff, along the top of the sleeve) with `_left` or `_right` (the wearer's), `neck` and `hem`.
/// Panels: `front` and `back`. A shirt may lie up to 15 degrees askew; corners that the edge
/// detector missed are found from the shape.
#[stage(
    role = Style,
    source = "3D garment modelling based on image-based rendering, about 2012",
    example = "TShirt()",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, ScaleEquivariant, RefusesEmpty)
)]
pub struct TShirt;

/// The edges of one half, from the hem upwards.
pub(super) const HALF: [&str; 4] = ["side", "underarm", "cuff", "shoulder"];

/// What is sewn, in the order of the report.
const SEWN: [&str; 6] =
    ["shoulder_left", "shoulder_right", "underarm_left", "underarm_right", "side_left", "side_right"];

#[stage]
impl TShirt {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        cx: &Context,
    ) -> Result<(Set<Outline>, SewingPlan), StageError> {
        let named = outlines
            .iter()
            .map(|(name, o)| Ok((name.to_owned(), name_edges(name, "a T-shirt", o, find_half, cx)?)))
            .collect::<Result<Set<Outline>, StageError>>()?;
        let seams = pairs(&named, &SEWN, cx);
        place_and_sew(&named, seams, cx)
    }
}

/// How far the armpit lies inside the line from hem to cuff at least, as a share of the size.
const LEAST_ARMPIT: f64 = 0.04;
/// Turn of a corner that is an armpit wherever it lies, degrees.
const SHARP: f64 = 40.0;
/// Shortest underarm seam, as a share of the size: cap sleeves have next to none.
const LEAST_UNDERARM: f64 = 0.015;
/// Shortest cuff, as a share of the size.
const LEAST_CUFF: f64 = 0.05;

/// The shirt's landmarks between hem and neck.
fn find_half(shape: &Shape, path: Path) -> Result<Half, String> {
    let top = shape.extreme(path, Vector2::new(1.0, 0.25), OUT).ok_or("it has no sleeve")?;
    let below = Path { from: path.from, to: top };
    let (farthest, depth) = shape.farthest(below, -1.0, IN).ok_or("it has no armpit")?;
    if depth < LEAST_ARMPIT * shape.size {
        return Err("its sides run up without an armpit; it seems to have no sleeves".into());
    }
    // A sleeve that hangs down leaves the side with little depth but with a sharp corner.
    let armpit = match shape.sharpest(below, IN) {
        Some((corner, turn)) if turn > SHARP && check_armpit(shape, corner).is_ok() => corner,
        _ => farthest,
    };
    check_armpit(shape, armpit)?;
    let (low, _) = shape.farthest(Path { from: armpit, to: top }, 1.0, OUT).ok_or("it has no cuff")?;
    let long = |from: usize, to: usize, least: f64| shape.length(Path { from, to }) > least * shape.size;
    if !long(armpit, low, LEAST_UNDERARM) || !long(low, top, LEAST_CUFF) {
        return Err("its arms end without a cuff; it seems to have no sleeves".into());
    }
    Ok(HALF.into_iter().zip([path.from, armpit, low, top]).collect())
}
