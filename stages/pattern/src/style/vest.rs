//! The sleeveless vest.

use super::naming::{Half, IN, OUT, check_armpit, name_edges};
use super::sewing::{pairs, place_and_sew};
use super::shape::{Path, Shape};
use toile_core::prelude::*;

/// Names the edges of a sleeveless vest and sews its shoulders and sides.
///
/// Edges, counter-clockwise on each panel: `side`, `armhole`, `shoulder` with `_left` or `_right`
/// (the wearer's), `neck` and `hem`. Panels: `front` and `back`. A vest may lie up to 15 degrees
/// askew; corners that the edge detector missed are found from the shape.
#[stage(
    role = Style,
    source = "3D garment modelling based on image-based rendering, about 2012",
    example = "Vest()",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, ScaleEquivariant, RefusesEmpty)
)]
pub struct Vest;

#[stage]
impl Vest {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        cx: &Context,
    ) -> Result<(Set<Outline>, SewingPlan), StageError> {
        let named = outlines
            .iter()
            .map(|(name, o)| Ok((name.to_owned(), name_edges(name, "a vest", o, find_half, cx)?)))
            .collect::<Result<Set<Outline>, StageError>>()?;
        let seams = pairs(&named, &["shoulder_left", "shoulder_right", "side_left", "side_right"], cx);
        place_and_sew(&named, seams, cx)
    }
}

/// The edges of one half, from the hem upwards.
pub(super) const HALF: [&str; 3] = ["side", "armhole", "shoulder"];

/// Shortest shoulder seam, as a share of the garment's size.
const LEAST_SHOULDER: f64 = 0.03;
/// Least height of an armhole, as a share of the garment's height.
const LEAST_ARMHOLE: f64 = 0.1;
/// Least depth of an armhole below the line from shoulder to armpit, as a share of the size.
const LEAST_SCOOP: f64 = 0.012;
/// How far the armpit stands out from the line hem to armhole at least, as a share of the size.
const LEAST_ARMPIT: f64 = 0.015;

/// The vest's landmarks between hem and neck.
fn find_half(shape: &Shape, path: Path) -> Result<Half, String> {
    let shoulder = shape.extreme(path, Vector2::new(0.8, 1.0), OUT).ok_or("it has no shoulder")?;
    let seam = (shape.at(path.to) - shape.at(shoulder)).norm();
    if seam < LEAST_SHOULDER * shape.size {
        return Err("it has no shoulder beside the neck".into());
    }
    let side = Path { from: path.from, to: shoulder };
    // The armhole is where the border comes in most on its way from hem to shoulder.
    let (scoop, _) = shape.farthest(side, -1.0, IN).ok_or("it has no armhole")?;
    let below = Path { from: path.from, to: scoop };
    let (armpit, out) = shape.farthest(below, 1.0, OUT).ok_or("it has no armpit")?;
    if out < LEAST_ARMPIT * shape.size {
        return Err(
            "its sides run up to the shoulders without an armhole; it seems to have sleeves or none at all"
                .into(),
        );
    }
    check_armpit(shape, armpit)?;
    let (_, depth) =
        shape.farthest(Path { from: armpit, to: shoulder }, -1.0, IN).ok_or("it has no armhole")?;
    let rise = shape.at(shoulder).y - shape.at(armpit).y;
    if depth < LEAST_SCOOP * shape.size || rise < LEAST_ARMHOLE * shape.height() {
        return Err("its border does not curve in between shoulder and armpit".into());
    }
    Ok(HALF.into_iter().zip([path.from, armpit, shoulder]).collect())
}
