//! A piece that is sewn onto another by hand: a pocket, a label.
//!
//! All its edges but the highest are sewn to a line within the other piece, drawn where they lie on
//! it.

use super::held::{fault, refused};
use super::{names, sewn};
use toile_core::prelude::*;

/// Sews a piece onto another; `way` leads from the middle of that one's box to the middle of the
/// piece's.
pub(super) fn sew_on(pattern: &mut Pattern, name: &str, onto: &str, way: Vector2) -> Result<(), StageError> {
    let [p, base] = [names::piece(pattern, name)?, names::piece(pattern, onto)?];
    if p == base {
        return Err(StageError::invalid(format!("\"{name}\" cannot be sewn onto itself"))
            .hint("name another piece as `onto`"));
    }
    let edges = sewn_edges(&pattern.pieces[p]);
    let uses: Vec<EdgeUse> =
        edges.iter().map(|k| edge_use(name, &pattern.pieces[p].outer.edges[*k].name)).collect();
    for of in &uses {
        sewn::check_open(pattern, &of.edge)?;
    }
    let by = middle(&pattern.pieces[base]) + way - middle(&pattern.pieces[p]);
    let line = PieceLine {
        name: free_name(&pattern.pieces[base], &format!("{name}_place")),
        purpose: LinePurpose::Placement,
        points: along(&pattern.pieces[p], &edges).into_iter().map(|q| q + by).collect(),
    };
    let place = vec![edge_use(onto, &line.name)];
    let mut after = pattern.pieces[base].clone();
    after.lines.push(line);
    if let Some(what) = fault(&pattern.pieces[base], &after) {
        let hint = format!("\"{name}\" must lie within \"{onto}\": x: \"0 mm\", y: \"0 mm\" is its middle");
        return Err(refused(&pattern.pieces[base], &what).hint(hint));
    }
    pattern.pieces[base] = after;
    let name = sewn::free_name(pattern, &format!("{name} on {onto}"));
    pattern.seams.push(PatternSeam { name, kind: SeamKind::Patch, sides: vec![uses, place] });
    Ok(())
}

fn edge_use(panel: &str, edge: &str) -> EdgeUse {
    EdgeUse { edge: EdgeRef { panel: panel.to_owned(), edge: edge.to_owned() }, reversed: false }
}

/// The numbers of all edges but the highest, in their order from its end to its start.
fn sewn_edges(piece: &Piece) -> Vec<usize> {
    let n = piece.outer.edges.len();
    let height = |k: usize| {
        let path = piece.outer.path(k);
        path.at(0.5 * path.length()).y
    };
    let top = (0..n).max_by(|a, b| height(*a).total_cmp(&height(*b))).unwrap_or(0);
    (1..n).map(|k| (top + k) % n).collect()
}

/// The points along edges that follow each other.
fn along(piece: &Piece, edges: &[usize]) -> Vec<Point2> {
    let mut points: Vec<Point2> = edges.iter().flat_map(|k| piece.outer.path(*k).points()).collect();
    points.dedup();
    points
}

/// The middle of the box around a piece.
fn middle(piece: &Piece) -> Vector2 {
    let points = piece.outer.points().0;
    let first = points.first().copied().unwrap_or_else(Point2::origin);
    let (lo, hi) = points.iter().fold((first, first), |(lo, hi), q| (lo.inf(q), hi.sup(q)));
    nalgebra::center(&lo, &hi).coords
}

/// The name, numbered where the piece has an edge or line of it.
fn free_name(piece: &Piece, name: &str) -> String {
    let is_taken = |name: &str| piece.path(name).is_some();
    let numbered = (2..).map(|n| format!("{name}_{n}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|n| !is_taken(n)).unwrap_or_default()
}
