//! Triangles that are small where the outline or the cloth curves, and large elsewhere.
//!
//! - [`field`]: how long edges should be at each place.
//! - [`curves`], [`folds`]: what asks for short ones.
//! - [`cuts`]: how edges are cut, the two sides of a seam alike.
//! - [`quadtree`], [`fill`]: the triangles.

mod curves;
mod cuts;
mod field;
mod fill;
mod folds;
mod quadtree;
#[cfg(test)]
mod tests;

use super::assemble::mesh_cut;
use super::check::{MAX_TRIANGLES, check_outline, show};
use super::divide::Cuts;
use super::lattice::Lattice;
use super::layout::Layout;
use cuts::{Sized, agree};
use field::{Range, SizeField};
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// The shortest edge, as a share of the longest, where the file does not say.
const FINE_SHARE: f64 = 1.0 / 3.0;

/// Fills panels with triangles that are small where it matters.
///
/// Edges are as short as `fine` where the outline curves (neck, armhole), where the cloth is narrow
/// (a strap) and, behind a first, coarse drape of the same pattern in the pipeline, where that is
/// bent (folds); from there they grow by `grading` of the way up to `edge`. The two sides of a seam
/// are cut alike: all panels are meshed at once, and each asks no more of a seam than both can
/// have. Darts, pleats and folds lie on mesh edges.
#[stage(
    role = Mesher,
    source = "sizes: Persson 2006; Narain, Samii, O'Brien 2012; triangles: Yerry, Shephard 1983",
    example = "GradedMesher(edge: \"24 mm\", fine: \"8 mm\")",
    contracts(Deterministic, ThreadInvariant, BoundaryPreserving, RefusesEmpty, Cancellable)
)]
pub struct GradedMesher {
    /// Length of the triangles' edges where nothing curves.
    #[param(default = Length::mm(24.0), min = 0.0001, max = 1.0, trades, finer = "less")]
    pub(crate) edge: Length,
    /// Shortest length, where outline or cloth curve most; a third of `edge` where it is not given.
    /// An outline that asks for less is still followed.
    #[param(default = None, min = 0.0001, max = 1.0, trades, finer = "less")]
    pub(crate) fine: Option<Length>,
    /// How fast edges grow away from where they are short, length by length.
    #[param(default = 0.3, min = 0.05, max = 1.0, trades)]
    pub(crate) grading: f64,
    /// Edges at folds of a first drape are so short that they leave its surface by no more than
    /// this.
    #[param(default = Length::mm(1.0), min = 1e-6, max = 1.0, trades, finer = "less")]
    pub(crate) tolerance: Length,
}

#[stage]
impl GradedMesher {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        plan: Option<&SewingPlan>,
        drape: Option<&Garment>,
        cx: &Context,
    ) -> Result<Set<Panel>, StageError> {
        let range = self.range()?;
        if outlines.0.is_empty() {
            return Err(StageError::invalid("there are no outlines to mesh"));
        }
        let named: Vec<(&str, &Outline)> = outlines.iter().collect();
        let curvatures = drape.map(folds::curvatures);
        let bent = drape.zip(curvatures.as_deref());
        let mut panels = each(cx, &named, |(name, outline), cx| {
            let fault = |e| within(name, e);
            check_outline(outline, range.edge, cx).map_err(fault)?;
            let sized = self.sized(name, outline, range, bent, cx)?;
            check_count(outline, &sized.field).map_err(fault)?;
            Ok(sized)
        })?;
        let cuts = agree(&mut panels, plan, cx)?;
        let jobs: Vec<_> = named.iter().zip(panels.iter().zip(cuts)).collect();
        let meshed = each(cx, &jobs, |((name, outline), (panel, cuts)), cx| {
            let own = cx.for_entry(name);
            let panel = mesh(outline, panel, cuts.clone(), &own).map_err(|e| within(name, e))?;
            Ok(((*name).to_owned(), panel, own.take_figures(), own.take_remarks()))
        })?;
        let entry = |(name, panel, figures, remarks): (String, Panel, _, _)| {
            cx.absorb(&name, figures, remarks);
            (name, panel)
        };
        Ok(meshed.into_iter().map(entry).collect())
    }

    fn range(&self) -> Result<Range, StageError> {
        let edge = self.edge.metres();
        let fine = self.fine.map_or(FINE_SHARE * edge, Length::metres);
        if fine > edge {
            return Err(StageError::new(
                ErrorCode::InvalidParameter,
                format!("the shortest edge of {} is longer than the longest of {}", show(fine), show(edge)),
            )
            .hint("`fine` is what edges shrink to where something curves; make it smaller, or `edge` larger")
            .at("fine"));
        }
        Ok(Range { fine, edge, grading: self.grading })
    }

    /// A panel with the sizes that it asks for by itself.
    fn sized<'a>(
        &self,
        name: &'a str,
        outline: &'a Outline,
        range: Range,
        bent: Option<(&Garment, &[f64])>,
        cx: &Context,
    ) -> Result<Sized<'a>, StageError> {
        let layout = Layout::of(outline, range.fine);
        let mut field = SizeField::new(outline.bounds(), range);
        curves::lower_along(&mut field, &layout, cx)?;
        if let Some((garment, curvatures)) = bent {
            for panel in garment.panels.iter().filter(|p| p.name == name) {
                folds::lower_at_folds(&mut field, garment, panel, curvatures, self.tolerance.metres());
            }
        }
        cx.check()?;
        field.spread();
        Ok(Sized { name, layout, field })
    }
}

/// Works on all panels at once; of several faults the first panel's is reported.
fn each<T: Sync, R: Send>(
    cx: &Context,
    all: &[T],
    work: impl Fn(&T, &Context) -> Result<R, StageError> + Sync,
) -> Result<Vec<R>, StageError> {
    cx.parallel_map(all.len(), |i| work(&all[i], cx)).into_iter().collect()
}

fn mesh(outline: &Outline, panel: &Sized<'_>, cuts: Cuts, cx: &Context) -> Result<Panel, StageError> {
    let edge = panel.field.range().edge;
    mesh_cut(outline, &panel.layout, cuts, edge, cx, |division| {
        fill::fill(outline, division, &panel.field, cx)
    })
}

/// Refuses sizes that would make more triangles than a mesh may have.
fn check_count(outline: &Outline, field: &SizeField) -> Result<(), StageError> {
    let (low, cell, columns, rows) = field.raster();
    let lattice = Lattice { low, dx: cell, dy: cell, columns, rows, shift: 0.0 };
    let points = &outline.outer.points;
    let n = points.len() as u32;
    let inside = lattice.inside(points, &(0..n).map(|k| [k, (k + 1) % n]).collect::<Vec<_>>());
    let triangles = field.triangles(&inside);
    if triangles <= MAX_TRIANGLES {
        return Ok(());
    }
    Err(StageError::invalid(format!(
        "edges of {} to {} would make {:.0} million triangles, the limit is 5 million",
        show(field.range().fine),
        show(field.range().edge),
        triangles / 1e6
    ))
    .hint("use longer edges, or let them grow faster (`grading`)")
    .at("fine"))
}

/// Says which panel is at fault.
fn within(panel: &str, error: StageError) -> StageError {
    match error.code {
        ErrorCode::Cancelled => error,
        _ => StageError { message: format!("panel \"{panel}\": {}", error.message), ..error },
    }
}
