//! Buckling of flat cloth whose seams close within its plane.
//!
//! A curtain that is gathered to a row of pins has to fold. But a flat sheet never leaves its plane
//! if all forces lie in the plane: it is compressed, and the seams stay open. So panels that are
//! flat at the start and after the seams have been closed start again with a small imperfection out
//! of their plane. Cost: O(n). Limit: which folds form is chance, as it is for real cloth.

use crate::statics::levels::pieces::Pieces;
use nalgebra::SymmetricEigen;
use toile_geometry::Vec3;

/// Thickness, as a share of its size, below which cloth counts as flat.
const FLAT: f64 = 1e-6;

/// Size of the imperfection, as a share of an edge.
const OUT: f64 = 0.01;

/// The golden ratio minus 1: the fractional parts of its multiples are spread evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The positions `start` with a small imperfection of the panels that are flat both in `start` and
/// after sewing in `end`; `edge` is the length of their edges, m. `None` where no panel is.
pub(crate) fn out_of_plane(pieces: &Pieces, start: &[Vec3], end: &[Vec3], edge: f64) -> Option<Vec<Vec3>> {
    let mut has_cloth = vec![false; start.len()];
    pieces.triangles.iter().flatten().for_each(|&v| has_cloth[v as usize] = true);
    let count = pieces.panel.iter().max().map_or(0, |p| *p as usize + 1);
    let mut of_panel: Vec<Vec<usize>> = vec![Vec::new(); count];
    (0..start.len()).filter(|&v| has_cloth[v]).for_each(|v| of_panel[pieces.panel[v] as usize].push(v));
    let mut moved = start.to_vec();
    let mut is_any = false;
    for vertices in of_panel.iter().filter(|v| !v.is_empty()) {
        let (Some(normal), Some(_)) = (normal(vertices, start), normal(vertices, end)) else { continue };
        is_any = true;
        for &v in vertices.iter().filter(|v| !pieces.pinned[**v]) {
            moved[v] += normal * (OUT * edge * ((GOLDEN * (v + 1) as f64).fract() - 0.5));
        }
    }
    is_any.then_some(moved)
}

/// The normal of the plane in which vertices lie; `None` where they are not flat.
fn normal(vertices: &[usize], x: &[Vec3]) -> Option<Vec3> {
    let middle = vertices.iter().map(|&v| x[v]).sum::<Vec3>() / vertices.len() as f64;
    let spread = vertices
        .iter()
        .map(|&v| (x[v] - middle) * (x[v] - middle).transpose())
        .sum::<nalgebra::Matrix3<f64>>();
    let eigen = SymmetricEigen::new(spread);
    let least = eigen.eigenvalues.imin();
    let normal: Vec3 = eigen.eigenvectors.column(least).into();
    let size = spread.trace().sqrt() / (vertices.len() as f64).sqrt();
    let thick = vertices.iter().map(|&v| (x[v] - middle).dot(&normal).abs()).fold(0.0, f64::max);
    (thick < FLAT * size).then_some(normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::generate;

    #[test]
    fn what_stays_flat_begins_a_hair_out_of_its_plane_and_nothing_else_does() {
        let mut scene = generate::hang(6);
        let pieces = Pieces::new(&scene);
        let start = scene.positions.clone();
        let moved = out_of_plane(&pieces, &start, &start, 0.1).unwrap_or_default();
        let farthest = start.iter().zip(&moved).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(farthest > 2e-4 && farthest < 6e-4, "{farthest}");
        scene.pinned.iter().for_each(|&v| assert_eq!(start[v as usize], moved[v as usize]));
        scene.positions.iter_mut().for_each(|p| *p += Vec3::new(0.0, 0.1 * p.x * p.x, 0.1 * p.x * p.z));
        assert_eq!(out_of_plane(&pieces, &start, &scene.positions, 0.1), None);
    }
}
