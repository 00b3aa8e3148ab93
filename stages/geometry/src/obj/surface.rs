//! What of a mended mesh can be touched from outside.

use super::pieces::MeshPieces;
use super::repair::without_unused;
use super::{Mesh, Repairs};
use crate::signed_distance::SignedDistance;
use nalgebra::Vector3;

/// Volume below which a piece encloses nothing, as a share of the cube of its size.
const THIN: f64 = 1e-12;

/// A piece of the mesh.
struct MeshPiece {
    triangles: usize,
    closed: bool,
    volume: f64,
    /// One of its vertices.
    first: Vector3<f64>,
}

/// Beside a largest piece that is closed, leaves out open pieces (hair, eyelashes, a ground) and
/// the inner side of walls, and turns pieces that face inwards. Where the largest is not closed,
/// nothing is changed: what is missing there cannot be guessed.
#[must_use]
pub fn outer_surface(mut mesh: Mesh, repairs: &mut Repairs) -> Mesh {
    let pieces = MeshPieces::new(&mesh);
    let all = list(&mesh, &pieces);
    let Some(main) = (0..all.len()).reduce(|a, b| if all[b].triangles > all[a].triangles { b } else { a })
    else {
        return mesh;
    };
    let least = THIN * mesh.size().powi(3);
    if !all[main].closed || all[main].volume.abs() <= least {
        return mesh;
    }
    let is_open = |p: &MeshPiece| p.triangles > 0 && (!p.closed || p.volume.abs() <= least);
    let is_inward = |p: &MeshPiece| p.triangles > 0 && !is_open(p) && p.volume < 0.0;
    if !all.iter().any(|p| is_open(p) || is_inward(p)) {
        return mesh;
    }
    let is_within = within(&mesh, &pieces, main, all[main].volume < 0.0);
    let leave_out: Vec<bool> = (0..all.len())
        .map(|k| is_open(&all[k]) || (k != main && is_inward(&all[k]) && is_within(&all[k].first)))
        .collect();
    repairs.open_pieces += all.iter().filter(|p| is_open(p)).count();
    repairs.inner += (0..all.len()).filter(|&k| leave_out[k] && !is_open(&all[k])).count();
    let turn: Vec<bool> = (0..all.len()).map(|k| is_inward(&all[k]) && !leave_out[k]).collect();
    repairs.turned += turn.iter().filter(|t| **t).count();
    mesh.triangles.retain(|t| !leave_out[pieces.at(t)]);
    mesh.triangles.iter_mut().filter(|t| turn[pieces.at(t)]).for_each(|t| t.swap(1, 2));
    without_unused(mesh)
}

fn list(mesh: &Mesh, pieces: &MeshPieces) -> Vec<MeshPiece> {
    let mut all: Vec<MeshPiece> = (0..pieces.closed.len())
        .map(|k| MeshPiece {
            triangles: pieces.triangles[k],
            closed: pieces.closed[k],
            volume: 0.0,
            first: Vector3::zeros(),
        })
        .collect();
    // Seen from a vertex of its own, a piece far from the origin keeps its digits.
    for (v, &k) in pieces.of.iter().enumerate().rev() {
        all[k as usize].first = mesh.vertices[v];
    }
    for t in &mesh.triangles {
        let piece = &mut all[pieces.at(t)];
        let [a, b, c] = t.map(|v| mesh.vertices[v as usize] - piece.first);
        piece.volume += a.dot(&b.cross(&c)) / 6.0;
    }
    all
}

/// Whether a point lies in the main piece.
fn within(
    mesh: &Mesh,
    pieces: &MeshPieces,
    main: usize,
    inward: bool,
) -> impl Fn(&Vector3<f64>) -> bool + use<> {
    let outwards = |t: &[u32; 3]| if inward { [t[0], t[2], t[1]] } else { *t };
    let own: Vec<[u32; 3]> = mesh.triangles.iter().filter(|t| pieces.at(t) == main).map(outwards).collect();
    let body: SignedDistance = SignedDistance::new(mesh.vertices.clone(), own);
    let reach = 2.0 * mesh.size();
    move |p| body.nearest(p, reach).is_some_and(|n| n.distance < 0.0)
}
