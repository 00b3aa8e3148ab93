//! The open edges of a garment: hems, necklines and cuffs as thick as the cloth turned under.
//!
//! Along every edge that no seam closes runs a rounded strip: from the right side around the edge
//! to the wrong side. Its profile has five points: two on the cloth, one over, one beyond and one
//! under the edge. Cost: eight triangles a mesh edge. Limit: one look at the strip is one colour of
//! the edge beside it; no stitch is drawn.

use std::collections::BTreeMap;
use toile_core::artifact::{Garment, Material, Mesh, Model, Point3, Vector3};

/// What is added to a panel's name for the strip along its edges.
const EDGE: &str = " edge";

/// Whether a mesh is the strip along the open edges of another one.
pub(crate) fn is_edge(mesh: &Mesh, model: &Model) -> bool {
    mesh.name.strip_suffix(EDGE).is_some_and(|panel| model.meshes.iter().any(|m| m.name == panel))
}

/// Adds a strip of this thickness, metres, to every panel with open edges. The first meshes and
/// materials of the model are those of the panels; `normals` are the garment's.
pub(super) fn add_edges(model: &mut Model, garment: &Garment, normals: &[Vector3], thickness: f64) {
    if thickness <= 0.0 {
        return;
    }
    let open = OpenEdges::of(garment, normals);
    for panel in 0..garment.panels.len() {
        let uv = &model.meshes[panel].uv;
        let Some(strip) = open.strip(garment, panel, uv, thickness, model.materials.len()) else { continue };
        let cloth = &model.materials[model.meshes[panel].material];
        let material = Material {
            name: strip.name.clone(),
            wrong_side: None,
            double_sided: false,
            normal_texture: None,
            ..cloth.clone()
        };
        model.meshes.push(strip);
        model.materials.push(material);
    }
}

/// Points of the profile.
const PROFILE: usize = 5;

/// The places along the open edges of a garment.
pub(super) struct OpenEdges {
    /// By welded vertex: away from the cloth, in its plane, unit length.
    beyond: BTreeMap<u32, Vector3>,
    /// By panel: its edges, welded or not, in the order of its triangles.
    edges: Vec<Vec<[u32; 2]>>,
    /// Upright on the cloth, one per vertex.
    normals: Vec<Vector3>,
}

impl OpenEdges {
    /// Of a garment with these normals.
    pub(super) fn of(garment: &Garment, normals: &[Vector3]) -> OpenEdges {
        let welded = |i: u32| garment.weld[i as usize];
        let sorted = |[a, b]: [u32; 2]| [welded(a).min(welded(b)), welded(a).max(welded(b))];
        let sides = |t: &[u32; 3]| [0, 1, 2].map(|k| [t[k], t[(k + 1) % 3]]);
        let mut uses: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        garment.triangles.iter().flat_map(sides).for_each(|e| *uses.entry(sorted(e)).or_default() += 1);
        let open = |e: &[u32; 2]| welded(e[0]) != welded(e[1]) && uses[&sorted(*e)] == 1;
        let edges: Vec<Vec<[u32; 2]>> = garment
            .panels
            .iter()
            .map(|p| garment.triangles[p.triangles.clone()].iter().flat_map(sides).filter(open).collect())
            .collect();
        let mut sums: BTreeMap<u32, Vector3> = BTreeMap::new();
        for [a, b] in edges.iter().flatten() {
            let along = garment.positions[*b as usize] - garment.positions[*a as usize];
            for i in [a, b] {
                // A triangle runs against the clock around its normal, so the cloth lies to the
                // left of its edge.
                let away = along.cross(&normals[*i as usize]);
                *sums.entry(welded(*i)).or_insert_with(Vector3::zeros) += away;
            }
        }
        let unit = |v: Vector3| v.try_normalize(1e-12).unwrap_or_else(Vector3::zeros);
        let beyond = sums.into_iter().map(|(i, sum)| (i, unit(sum))).collect();
        OpenEdges { beyond, edges, normals: normals.to_vec() }
    }

    /// The strip along a panel's open edges, `thickness` metres thick, in the panel's texture
    /// coordinates `uv`; none where all its edges are sewn.
    pub(super) fn strip(
        &self,
        garment: &Garment,
        panel: usize,
        uv: &[[f32; 2]],
        thickness: f64,
        material: usize,
    ) -> Option<Mesh> {
        let edges = &self.edges[panel];
        if edges.is_empty() {
            return None;
        }
        let of = &garment.panels[panel];
        let name = format!("{}{EDGE}", of.name);
        let mut strip =
            Mesh { name, positions: vec![], normals: vec![], uv: vec![], triangles: vec![], material };
        let mut places: BTreeMap<u32, u32> = BTreeMap::new();
        for i in edges.iter().flatten() {
            places.entry(*i).or_insert_with(|| {
                let first = strip.positions.len() as u32;
                let (at, normal) = (garment.positions[*i as usize], self.normals[*i as usize]);
                let beyond = self.beyond[&garment.weld[*i as usize]];
                for (place, n) in profile(at, normal, beyond, thickness / 2.0) {
                    strip.positions.push(place);
                    strip.normals.push(n);
                }
                let own = uv.get(*i as usize - of.vertices.start);
                strip.uv.extend(own.into_iter().flat_map(|uv| [*uv; PROFILE]));
                first
            });
        }
        for [a, b] in edges {
            let (a, b) = (places[a], places[b]);
            for k in 0..PROFILE as u32 - 1 {
                strip.triangles.push([a + k, a + k + 1, b + k]);
                strip.triangles.push([b + k, a + k + 1, b + k + 1]);
            }
        }
        Some(strip)
    }
}

/// Places and normals around an edge, from the right side to the wrong one.
fn profile(at: Point3, n: Vector3, beyond: Vector3, radius: f64) -> [(Point3, Vector3); PROFILE] {
    let n = n.try_normalize(1e-12).unwrap_or_else(Vector3::z);
    let out = if beyond == Vector3::zeros() { n } else { beyond };
    [
        (at - out * (2.0 * radius), n),
        (at + n * radius, n),
        (at + out * radius, out),
        (at - n * radius, -n),
        (at - out * (2.0 * radius), -n),
    ]
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use toile_fixtures::photographed;

    #[test]
    fn hem_and_neck_have_a_strip_and_sewn_sides_none() {
        let garment = photographed::garment(8);
        let normals = garment.vertex_normals();
        let open = OpenEdges::of(&garment, &normals);
        // Eight edges above, eight below; the sides are sewn.
        assert_eq!(open.edges.iter().map(Vec::len).collect::<Vec<_>>(), [16, 16]);
        let strip = open.strip(&garment, 0, &[], 0.002, 7).unwrap();
        assert_eq!((strip.name.as_str(), strip.material), ("front edge", 7));
        assert_eq!((strip.positions.len(), strip.triangles.len()), (18 * 5, 16 * 8));
    }

    #[test]
    fn a_strip_lies_beyond_the_edge_by_half_its_thickness() {
        let garment = photographed::garment(8);
        let normals = garment.vertex_normals();
        let strip = OpenEdges::of(&garment, &normals).strip(&garment, 0, &[], 0.002, 0).unwrap();
        let (lowest, highest) =
            garment.positions.iter().fold((f64::MAX, f64::MIN), |(lo, hi), p| (lo.min(p.y), hi.max(p.y)));
        let below = strip.positions.iter().fold(f64::MAX, |lo, p| lo.min(p.y));
        let above = strip.positions.iter().fold(f64::MIN, |hi, p| hi.max(p.y));
        assert!((lowest - below - 0.001).abs() < 2e-4, "{}", lowest - below);
        assert!((above - highest - 0.001).abs() < 2e-4, "{}", above - highest);
    }

    #[test]
    fn its_triangles_face_as_its_normals_do() {
        let garment = photographed::garment(8);
        let normals = garment.vertex_normals();
        let strip = OpenEdges::of(&garment, &normals).strip(&garment, 0, &[], 0.002, 0).unwrap();
        for t in &strip.triangles {
            let [a, b, c] = t.map(|i| strip.positions[i as usize]);
            let shown: Vector3 = t.iter().map(|i| strip.normals[*i as usize]).sum();
            assert!((b - a).cross(&(c - a)).dot(&shown) > 0.0, "{t:?}");
        }
    }
}
