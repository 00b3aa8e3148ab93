//! Brings a figure to its measures.
//!
//! Aims are corrected on the smooth solid until its measures are those that are wanted; then it is
//! meshed once and measured by tape. Where the mesh misses by more than [`TOLERANCE`], what is
//! wanted of the solid is corrected and it is meshed again.

use crate::figure::BodyFigure;
use crate::form::BodyForm;
use crate::measures::landmarks::landmarks;
use crate::measures::measure::{Six, limbs, meshed, smooth, wanted};
use crate::shape::{Aims, FigureSize};
use crate::skin::isosurface::{CellGrid, mesh};
use crate::skin::topology::MeshTopology;
use crate::skin::topology::SkinMesh;
use toile_core::prelude::*;

/// The mesh's measures agree to this length, metres, and to this share.
const TOLERANCE: [f64; 2] = [0.002, 0.004];
/// The smooth figure's agree to this share before it is meshed.
const SMOOTH_TOLERANCE: f64 = 4e-4;
/// Corrections of the aims before giving up; six suffice for ordinary figures.
const MAX_FITS: usize = 30;
/// Meshings before giving up; one suffices for ordinary figures.
const MAX_MESHINGS: usize = 5;
/// A mesh that is not closed, or in which fingers have grown together, is made anew with edges
/// shorter by this factor.
const FINER: f64 = 0.92;
/// The finest mesh of the smallest body still has edges of this share of its height; it also keeps
/// wrists and thumbs several cells thick for children.
const LARGEST_EDGE: f64 = 1.0 / 95.0;
/// The names of [`Six`].
const NAMES: [&str; 6] = ["hip", "waist", "bust", "neck", "arm", "inseam"];

/// The body of that size and form, meshed at that edge length.
pub(crate) fn fit(size: &FigureSize, form: &BodyForm, edge: f64, cx: &Context) -> Result<Body, StageError> {
    let (want, mut cell) = (wanted(size), edge.min(size.height * LARGEST_EDGE));
    let (mut goal, mut aims) = (want, Aims::first(size));
    let mut missed = NAMES[0];
    for round in 0..MAX_MESHINGS {
        cx.check()?;
        cx.progress(round as f64 / MAX_MESHINGS as f64, "fitting the measures");
        let figure = fitted(size, form, &goal, &mut aims).map_err(unfit)?;
        let skin = skin(&figure, cell);
        if !is_sound(&skin) {
            missed = "skin";
            cell *= FINER;
            continue;
        }
        let marks = landmarks(&figure, &skin.0, &skin.1).ok_or_else(|| unfit("armpits"))?;
        let found = meshed(&figure, &skin, &marks).ok_or_else(|| unfit("trunk"))?;
        let close = |k: usize| (found[k] - want[k]).abs() < TOLERANCE[0].min(TOLERANCE[1] * want[k]);
        let Some(worst) = (0..6).find(|&k| !close(k)) else {
            return finish(&figure, skin, marks, found);
        };
        missed = NAMES[worst];
        (0..6).for_each(|k| goal[k] += want[k] - found[k]);
    }
    Err(unfit(missed))
}

/// The smooth figure that has the measures; `aims` is where the search begins and where it ends.
/// The name of what is missed where there is none.
fn fitted(
    size: &FigureSize,
    form: &BodyForm,
    goal: &Six,
    aims: &mut Aims,
) -> Result<BodyFigure, &'static str> {
    let mut missed = NAMES[0];
    for _ in 0..MAX_FITS {
        let figure = BodyFigure::new(size, form, aims);
        let found = smooth(&figure);
        let ratio: Six = std::array::from_fn(|k| goal[k] / found[k]);
        let Some(worst) = (0..6).find(|&k| ratio[k].is_nan() || (ratio[k] - 1.0).abs() >= SMOOTH_TOLERANCE)
        else {
            return Ok(figure);
        };
        missed = NAMES[worst];
        (0..3).for_each(|k| aims.trunk[k] *= ratio[k]);
        aims.neck *= ratio[3];
        aims.arm *= ratio[4];
        aims.crotch += goal[5] - found[5];
    }
    Err(missed)
}

fn unfit(what: &str) -> StageError {
    StageError::new(
        ErrorCode::InvalidParameter,
        format!("the mannequin's {what} cannot be brought to these measures"),
    )
    .hint("bring bust, waist, hip and shoulder width nearer to each other, or raise `arm_angle`")
}

/// The figure's mesh, brought to the exact height with its soles at zero.
fn skin(figure: &BodyFigure, cell: f64) -> SkinMesh {
    let (mut positions, triangles) = mesh(figure, &CellGrid { bounds: figure.bounds(), cell });
    let (lo, hi) = positions.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p.y), h.max(p.y)));
    let stretch = figure.size().height / (hi - lo);
    positions.iter_mut().for_each(|p| p.y = (p.y - lo) * stretch);
    (positions, triangles)
}

/// Whether the mesh is one closed skin without holes through it.
fn is_sound((positions, triangles): &SkinMesh) -> bool {
    let topology = MeshTopology::of(positions.len(), triangles);
    topology.is_closed() && topology.components == 1 && topology.euler() == 2
}

fn finish(
    figure: &BodyFigure,
    skin: SkinMesh,
    landmarks: crate::measures::landmarks::NamedLandmarks,
    found: Six,
) -> Result<Body, StageError> {
    let [biceps, thigh] = limbs(figure, &skin, &landmarks).ok_or_else(|| unfit("limbs"))?;
    let [hip, waist, bust, neck, arm, inseam] = found;
    let [left, right] = Hand::BOTH.map(|hand| landmarks.get(&hand.name("shoulder")));
    let measured = [
        ("height", figure.size().height),
        ("bust", bust),
        ("waist", waist),
        ("hip", hip),
        ("shoulder_width", left.zip(right).map_or(f64::NAN, |(a, b)| (a - b).norm())),
        ("neck", neck),
        ("arm_length", arm),
        ("inseam", inseam),
        ("biceps", biceps),
        ("thigh", thigh),
    ];
    let measurements = measured.into_iter().map(|(name, v)| (name.to_owned(), v)).collect();
    let (positions, triangles) = skin;
    Ok(Body { positions, triangles, landmarks, measurements })
}
