//! What all flatteners have in common: pieces from the garment, each laid flat, cared for, cut at
//! darts; pattern and garment of them.

use super::dart::{Darts, dart_paths};
use super::drawn::{CORNER, PatternDrawing};
use super::fault::flatten_fault;
use super::file::list;
use super::sheet::{GarmentPieces, Labelled};
use nalgebra::{Matrix2, Matrix3x2};
use toile_core::prelude::*;
use toile_flatten::FlattenError;
use toile_flatten::care::{CareOptions, CareReport, Objective, SeamLengths, mirror_distance, refine};
use toile_flatten::distortion::distortion;
use toile_flatten::flatteners::{Flattening, Placement, Tension};
use toile_flatten::grain::Grain;
use toile_flatten::surface::PieceSurface;

/// A flattener of one piece of a garment, whose panel has this number.
pub(super) type PieceFlattener<'a> =
    dyn Fn(&PieceSurface, &Placement, usize) -> Result<Flattening, FlattenError> + Sync + 'a;

/// What is asked of a flattener.
pub(super) struct Request<'a> {
    /// Lays one piece flat.
    pub(super) method: &'a PieceFlattener<'a>,
    /// The energy that pattern care minimises, and what it cares for; none for a map that none
    /// belongs to.
    pub(super) care: Option<(Objective, CareOptions)>,
    /// Darts.
    pub(super) darts: Darts,
    /// The garment's stretch along warp and weft that the pattern must not have.
    pub(super) tension: (f64, f64),
}

/// What flatteners care for beyond the shape of triangles.
#[params]
#[derive(Copy)]
pub struct Care {
    /// Make the two sides of each seam equally long.
    #[param(default = true)]
    pub seams: bool,
    /// Make left and right pieces mirror images, and pieces that are their own mirror image so.
    #[param(default = true)]
    pub mirror: bool,
    /// An edge that leaves its line by at most this share of its length becomes straight; 0 for
    /// none.
    #[param(default = 0.005, min = 0.0, max = 0.19)]
    pub straight: f64,
    /// Stretch of the garment along warp and weft that the pattern must not have: (0.1, 0.2) of a
    /// knit that is worn 10 % longer and 20 % wider.
    #[param(default = (0.0, 0.0), min = -0.8, max = 9.0)]
    pub tension: (f64, f64),
    /// What becomes of cloth that cannot lie flat.
    #[param(default = Darts::None)]
    pub darts: Darts,
}

/// Where the mean direction of the warp is shorter, it has none: the y of space is taken.
const LEAST_GRAIN: f64 = 0.2;

impl Request<'_> {
    /// The pattern of a garment, and the garment with the flat places of that pattern.
    pub(super) fn run(
        &self,
        garment: &Garment,
        sewn: Option<&Pattern>,
        cx: &Context,
    ) -> Result<(Pattern, Garment), StageError> {
        let mut sheet = GarmentPieces::of(garment)?;
        let mut proposed = Vec::new();
        if let Some((objective, _)) = &self.care {
            let placements = self.placements(&sheet, garment);
            let paths = dart_paths(&sheet, objective, &placements, self.darts, cx)?;
            match self.darts {
                Darts::Auto { .. } => sheet = cut(garment, &sheet, &paths)?,
                Darts::None | Darts::Propose => proposed = paths,
            }
        }
        let placements = self.placements(&sheet, garment);
        let mut flats = self.flat(&sheet, &placements, cx)?;
        if let Some((objective, options)) = &self.care {
            cx.progress(0.8, "pattern care");
            let even = sheet.without_gathers(garment);
            let report = refine(&even, &mut flats, objective, &placements, *options)
                .map_err(|e| flatten_fault(&e, ""))?;
            tell(&report, &flats, cx);
        }
        unsettled(&sheet, &flats, cx);
        crossed(&sheet, &flats, cx);
        let flat: Vec<Vec<Point2>> = flats.into_iter().map(|f| centred(f.points)).collect();
        let name = sewn.map_or_else(|| "flat".to_owned(), |p| p.name.clone());
        let drawing = PatternDrawing { sheet: &sheet, flat: &flat, garment, sewn, proposed: &proposed, name };
        let (pattern, notes) = drawing.pattern();
        notes.into_iter().for_each(|what| cx.warn(what));
        if let Err(what) = pattern.check() {
            return Err(StageError::invalid(format!("the flat pieces make no pattern: {what}"))
                .hint("look at the garment's mesh: slivers and folds along its edges"));
        }
        Ok((pattern, sheet.garment(garment, &flat)))
    }

    /// Each piece laid flat, the pieces in parallel.
    fn flat(
        &self,
        sheet: &GarmentPieces,
        placements: &[Placement],
        cx: &Context,
    ) -> Result<Vec<Flattening>, StageError> {
        let one = |i: usize| {
            cx.check()?;
            cx.progress(0.7 * i as f64 / placements.len() as f64, format!("piece {}", sheet.names[i]));
            let surface = &sheet.pieces.pieces[i].surface;
            (self.method)(surface, &placements[i], sheet.panels[i])
                .map_err(|e| flatten_fault(&e, &sheet.names[i]))
        };
        cx.parallel_map(placements.len(), one).into_iter().collect()
    }

    fn placements(&self, sheet: &GarmentPieces, garment: &Garment) -> Vec<Placement> {
        let tension = Tension { warp: self.tension.0, weft: self.tension.1 };
        let rest = sheet.rest(garment);
        let pieces = sheet.pieces.pieces.iter().zip(&rest);
        pieces.map(|(p, rest)| Placement { grain: grain(&p.surface, rest), tension }).collect()
    }
}

/// The sheet cut along darts.
fn cut(
    garment: &Garment,
    sheet: &GarmentPieces,
    paths: &[Vec<Vec<u32>>],
) -> Result<GarmentPieces, StageError> {
    if paths.iter().all(Vec::is_empty) {
        return Ok(sheet.clone());
    }
    let mut labelled = Labelled::of(garment)?;
    for (piece, paths) in sheet.pieces.pieces.iter().zip(paths) {
        let node = |v: u32| piece.vertices[v as usize];
        let edges: Vec<[u32; 2]> =
            paths.iter().flat_map(|p| p.windows(2).map(|w| [node(w[0]), node(w[1])])).collect();
        labelled.cut_along(&piece.triangles, &edges);
    }
    labelled.sheet(garment)
}

/// The direction in space of the cloth's warp where the flat shape is known, else the y of space.
fn grain(surface: &PieceSurface, rest: &[Point2]) -> Grain {
    let mut mean = Vector3::zeros();
    for t in surface.triangles() {
        let [a, b, c] = t.map(|v| rest[v as usize]);
        let [p, q, r] = t.map(|v| surface.positions()[v as usize]);
        let Some(back) = Matrix2::from_columns(&[b - a, c - a]).try_inverse() else { continue };
        let warp = Matrix3x2::from_columns(&[q - p, r - p]) * back * Vector2::y();
        mean += warp * (q - p).cross(&(r - p)).norm() / 2.0;
    }
    mean /= surface.area();
    if !(mean.norm() > LEAST_GRAIN && mean.iter().all(|x| x.is_finite())) {
        return Grain::up();
    }
    // A grain has no arrow: pieces that were drawn upside down stand upright.
    Grain::Direction(if mean.y < 0.0 { -mean } else { mean })
}

/// The middle of the piece's box in the origin.
fn centred(mut flat: Vec<Point2>) -> Vec<Point2> {
    let first = flat.first().copied().unwrap_or_else(Point2::origin);
    let (lo, hi) = flat.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    let middle = nalgebra::center(&lo, &hi).coords;
    flat.iter_mut().for_each(|p| *p -= middle);
    flat
}

/// What pattern care did, in figures.
fn tell(report: &CareReport, flats: &[Flattening], cx: &Context) {
    let worst = |of: fn(&SeamLengths) -> [f64; 2]| {
        report.seams.iter().map(|s| SeamLengths::mismatch(of(s))).fold(0.0, f64::max)
    };
    cx.figure("seam_mismatch_before", worst(|s| s.before) * 1e2, "%");
    cx.figure("seam_mismatch", worst(|s| s.after) * 1e2, "%");
    cx.figure("straight_edges", report.straight.iter().sum::<usize>() as f64, "");
    let exact =
        report.mirrors.iter().map(|(p, _)| mirror_distance(p, &flats[p.a].points, &flats[p.b].points));
    let apart = exact.chain(report.outlines.iter().map(|p| p.after)).fold(0.0, f64::max);
    cx.figure("left_and_right_apart", apart * 1e3, "mm");
    cx.figure("mirror_images", (report.mirrors.len() + report.outlines.len()) as f64, "");
}

/// Pieces that still changed when the steps ran out.
fn unsettled(sheet: &GarmentPieces, flats: &[Flattening], cx: &Context) {
    let of: Vec<(&str, usize)> = sheet
        .names
        .iter()
        .zip(flats)
        .filter(|(_, f)| !f.report.converged)
        .map(|(n, f)| (n.as_str(), f.report.iterations))
        .collect();
    if let Some(n) = of.iter().map(|p| p.1).max() {
        let names = list(of.iter().map(|p| p.0));
        cx.warn(format!("the flat shape of {names} had not settled after {n} steps: give more `iterations`"));
    }
}

/// Pieces whose outline crosses itself in the plane.
fn crossed(sheet: &GarmentPieces, flats: &[Flattening], cx: &Context) {
    let crosses = |(i, flat): &(usize, &Flattening)| {
        distortion(&sheet.pieces.pieces[*i].surface, &flat.points).is_ok_and(|t| t.crossings > 0)
    };
    let of: Vec<&str> =
        flats.iter().enumerate().filter(crosses).map(|(i, _)| sheet.names[i].as_str()).collect();
    if !of.is_empty() {
        cx.warn(format!(
            "the flat outline of {} crosses itself, so that it cannot be cut as one piece: mark a seam or a dart there",
            list(of.into_iter())
        ));
    }
}

impl Care {
    /// The options of pattern care; a corner is what the drawing takes for one.
    pub(super) fn options(&self, newton: toile_flatten::newton::StoppingLimits) -> CareOptions {
        let defaults = CareOptions::default();
        let on = |share: f64| if self.mirror { share } else { 0.0 };
        CareOptions {
            seams: self.seams,
            straight: self.straight,
            corner: CORNER,
            mirror: on(defaults.mirror),
            mirror_outline: on(defaults.mirror_outline),
            newton,
        }
    }
}
