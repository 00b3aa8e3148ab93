//! A mesher whose triangles are near-equilateral everywhere but at the border.
//!
//! Right-angled triangles, as a square grid gives them, bend more easily along their diagonals than
//! across; equilateral ones bend alike in all directions. This crate lays a lattice of them over
//! the panel, rows along the weft, and joins it to the outline.
//!
//! - [`LatticeMesher`]: the stage.
//! - `check`: what an outline must be.
//! - `divide`: the outline and its inner lines as segments, seams divided by their gauges.
//! - `fill`: lattice points inside, clear of every segment.
//! - `triangulate`: constrained Delaunay, and vertices near the border moved to better places.

mod check;
mod divide;
mod fill;
mod triangulate;

use divide::MeshSegments;
use toile_core::prelude::*;
use triangulate::LatticeMesh;

/// Fills the panel with a lattice of equilateral triangles.
///
/// Rows run along the weft. Choose it where bending should be the same in all directions;
/// `GridMesher` keeps springs on the threads instead. Named edges are divided as their gauges say,
/// so that two edges that are sewn together get equal counts. Darts, pleats and folds lie on mesh
/// edges. Away from the border every triangle is equilateral; near it vertices are moved and added
/// until no angle is less than the outline's own corners force.
#[stage(
    role = Mesher,
    source = "Chew, 1989; Freitag and Ollivier-Gooch, 1997",
    example = "LatticeMesher(edge: \"12 mm\")",
    contracts(Deterministic, ThreadInvariant, BoundaryPreserving, RefusesEmpty, Cancellable)
)]
pub struct LatticeMesher {
    /// Length of the triangles' edges; a smaller one gives finer folds and takes longer.
    #[param(default = Length::mm(12.0), min = 0.0001, max = 1.0, trades, finer = "less")]
    pub edge: Length,
}

#[stage]
impl LatticeMesher {
    fn run(&self, outline: &Outline, cx: &Context) -> Result<Panel, StageError> {
        let h = self.edge.metres();
        check::outline(outline, h)?;
        cx.check()?;
        let division = divide::divide(outline, h)?;
        cx.progress(0.2, format!("{} segments on the outline", division.segments().len()));
        let seeds = fill::fill(outline, &division, h);
        cx.check()?;
        let meshed = triangulate::mesh(&division, seeds, h, cx)?;
        let panel = assemble(outline, division, meshed)?;
        cx.figure("triangles", panel.triangles.len() as f64, "");
        cx.figure("least_angle", panel.least_angle(), "deg");
        Ok(panel)
    }
}

/// Puts the panel together; inner lines must have become mesh edges.
fn assemble(outline: &Outline, division: MeshSegments, meshed: LatticeMesh) -> Result<Panel, StageError> {
    let mut sides: Vec<[u32; 2]> = meshed
        .triangles
        .iter()
        .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
        .map(sorted)
        .collect();
    sides.sort_unstable();
    let lies = |w: &[u32]| sides.binary_search(&sorted([w[0], w[1]])).is_ok();
    if let Some(line) = division.chains.iter().find(|c| !c.vertices.windows(2).all(lies)) {
        return Err(StageError::invalid(format!("inner line \"{}\" lies outside the cloth", line.name)));
    }
    let frame = outline.frame;
    let photo_px = frame.map_or_else(Vec::new, |f| meshed.points.iter().map(|p| f.to_px(*p)).collect());
    let mut loops = division.loops.into_iter();
    Ok(Panel {
        positions: meshed.points,
        triangles: meshed.triangles,
        boundary: loops.next().unwrap_or_default(),
        holes: loops.collect(),
        edges: division.edges,
        inner: division.chains,
        photo_px,
        outline_area: outline.area(),
        outline_length: outline.perimeter(),
    })
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

toile_core::plugin!(LatticeMesher);
