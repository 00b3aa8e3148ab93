//! Whether a garment stands, or lies as one whose file has another axis up.
//!
//! Hems, waists and necks lie level on a garment that stands. Where the openings of a mesh face
//! forwards instead, and it is less tall than it is deep, its file has the other axis up. Cost: one
//! pass over the open edges.

use super::raw::RawMesh;
use std::collections::BTreeMap;
use toile_core::prelude::*;
use toile_geometry::components::groups;

/// Less tall than this share of its depth: it may lie.
const FLAT: f64 = 0.8;
/// Openings face forwards where they do so this many times as much as up and down.
const FORWARDS: f64 = 2.0;

/// Whether the garment seems to lie on its back or front; `positions` have y up.
pub(in crate::flat) fn lies(mesh: &RawMesh) -> bool {
    let used = || mesh.triangles.iter().flatten().map(|&v| mesh.positions[v as usize]);
    let Some(first) = used().next() else { return false };
    let (lo, hi) = used().fold((first, first), |(lo, hi), p| (lo.inf(&p), hi.sup(&p)));
    let size = hi - lo;
    if size.y > FLAT * size.z {
        return false;
    }
    let facing = openings(mesh);
    facing.z > FORWARDS * facing.y
}

/// The areas of all openings as seen along the axes, summed.
fn openings(mesh: &RawMesh) -> Vector3 {
    let mut edges: BTreeMap<[u32; 2], (i32, [u32; 2])> = BTreeMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            edges.entry([a.min(b), a.max(b)]).or_insert((0, [a, b])).0 += 1;
        }
    }
    let open: Vec<[u32; 2]> = edges.into_values().filter(|(n, _)| *n == 1).map(|(_, e)| e).collect();
    let (of, _) = groups(mesh.positions.len(), open.iter().copied());
    let mut areas: BTreeMap<u32, Vector3> = BTreeMap::new();
    for [a, b] in &open {
        let [p, q] = [a, b].map(|v| mesh.positions[*v as usize].coords);
        *areas.entry(of[*a as usize]).or_insert_with(Vector3::zeros) += p.cross(&q) / 2.0;
    }
    areas.values().fold(Vector3::zeros(), |sum, area| sum + area.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flattened tube, 60 cm wide, 20 cm deep and 80 cm long, standing or lying.
    fn tube(is_lying: bool) -> RawMesh {
        let (around, mut mesh) = (24_u32, RawMesh::default());
        for y in [0.0, 0.8] {
            for k in 0..around {
                let angle = f64::from(k) / f64::from(around) * std::f64::consts::TAU;
                let (x, z) = (0.3 * angle.cos(), -0.1 * angle.sin());
                mesh.positions.push(if is_lying { Point3::new(x, -z, y) } else { Point3::new(x, y, z) });
            }
        }
        for k in 0..around {
            let (a, b) = (k, (k + 1) % around);
            mesh.triangles.extend([[a, b, b + around], [a, b + around, a + around]]);
        }
        mesh
    }

    #[test]
    fn a_garment_whose_openings_face_forwards_lies() {
        assert!(!lies(&tube(false)));
        assert!(lies(&tube(true)));
    }

    #[test]
    fn a_wide_flat_skirt_stands() {
        let mut skirt = tube(false);
        for p in &mut skirt.positions {
            *p = Point3::new(2.0 * p.x, 0.3 * p.y, 6.0 * p.z);
        }
        assert!(!lies(&skirt));
    }
}
