//! What the cloth carries, and how hard it presses on the body.
//!
//! Strain of a yarn direction is `e = |f| - 1`, f the image of its flat unit vector; tension is
//! what the fabric's curve gives for it, N per metre of cut width. A garment at rest is in
//! equilibrium: what membrane, elastic bands and weight leave over at a vertex is what the body
//! holds. Its part along the body's normal, by the area around the vertex, is the pressure; on a
//! tube around a cylinder it is Laplace's `p = T / r`. Source: Woven law of the cloth engine (see
//! `docs/reference/solver.md`); Laplace 1806.
//!
//! Limits: bending is left out; weight is that on the Earth, whatever gravity the solver had; of
//! layers that lie on each other each has its own pressure; cloth that is not at rest, or whose
//! flat shape is not known, has no true figures.

use nalgebra::{Matrix2, Matrix3x2};
use toile_cloth::energy::membrane::{Law, Woven};
use toile_core::artifact::{BodyContact, Collider, Garment, Point2, SeamKind, Vector3};
use toile_core::{Context, StageError};
use toile_drape::engine::{cloth_error, engine_fabric};

/// Weight of a mass, m/s².
const GRAVITY: f64 = 9.81;
/// How far cloth on the body may be from it, in thicknesses of the collider: contact begins at one.
const ON: f64 = 3.0;

/// Warp and weft.
pub(super) type Yarns = [f64; 2];

/// What the cloth carries.
#[derive(Debug, Clone)]
pub(super) struct ClothLoad {
    /// Strain, one per triangle.
    pub strain: Vec<Yarns>,
    /// Tension, N per metre of cut width, one per triangle.
    pub tension: Vec<Yarns>,
    /// Pressure on the body, Pa, one per vertex; none where the cloth is not on it.
    pub pressure: Vec<Option<f64>>,
    /// Present area around each vertex, square metres; joined vertices have theirs together.
    pub area: Vec<f64>,
}

impl ClothLoad {
    /// Of a garment on its body.
    ///
    /// # Errors
    /// A fabric whose curves the engine does not take.
    pub(super) fn of(
        garment: &Garment,
        collider: Option<&Collider>,
        cx: &Context,
    ) -> Result<Self, StageError> {
        let corners = garment.gathered_corners();
        let (mut strain, mut tension) = (Vec::new(), Vec::new());
        let n = garment.positions.len();
        let (mut force, mut area) = (vec![Vector3::zeros(); n], vec![0.0; n]);
        for panel in &garment.panels {
            cx.check()?;
            let fabric = engine_fabric(&panel.fabric, panel.fabric.thickness).map_err(|e| cloth_error(&e))?;
            let law = Woven::new(&fabric).map_err(|e| cloth_error(&e))?;
            for t in panel.triangles.clone() {
                let nodes = garment.triangles[t];
                let flat = corners.as_ref().map_or_else(|| nodes.map(|i| garment.rest[i as usize]), |c| c[t]);
                let piece =
                    DeformedTriangle::new(flat, nodes.map(|i| garment.positions[i as usize].coords), &law);
                strain.push(piece.strain);
                tension.push(piece.tension);
                let weight = Vector3::y() * (-GRAVITY * fabric.density * piece.flat_area / 3.0);
                for (i, f) in nodes.into_iter().zip(piece.forces) {
                    force[i as usize] += f + weight;
                    area[i as usize] += piece.area / 3.0;
                }
            }
        }
        add_bands(garment, &mut force);
        let (force, area) = (together(garment, &force), together(garment, &area));
        let pressure = pressure(garment, collider, &force, &area);
        Ok(Self { strain, tension, pressure, area })
    }
}

/// Pressure of a garment at rest on its body, Pa, one per vertex; none where the cloth is not on
/// it.
///
/// # Errors
/// A fabric whose curves the engine does not take.
pub fn pressures(garment: &Garment, collider: &Collider) -> Result<Vec<Option<f64>>, StageError> {
    Ok(ClothLoad::of(garment, Some(collider), &Context::quiet())?.pressure)
}

/// A triangle of cloth, deformed.
struct DeformedTriangle {
    strain: Yarns,
    tension: Yarns,
    forces: [Vector3; 3],
    flat_area: f64,
    area: f64,
}

impl DeformedTriangle {
    fn new([a, b, c]: [Point2; 3], [p, q, r]: [Vector3; 3], law: &Woven) -> Self {
        let area = (q - p).cross(&(r - p)).norm() / 2.0;
        let flat = Matrix2::from_columns(&[b - a, c - a]);
        let (flat_area, none) = (flat.determinant().abs() / 2.0, [0.0; 2]);
        let Some(back) = flat.try_inverse() else {
            return Self { strain: none, tension: none, forces: [Vector3::zeros(); 3], flat_area, area };
        };
        let gradient = Matrix3x2::from_columns(&[q - p, r - p]) * back;
        let (u, v) = (gradient.column(0).into_owned(), gradient.column(1).into_owned());
        let [weft, warp, shear] = law.stress([u.norm_squared(), v.norm_squared(), u.dot(&v)]);
        let along = [v * warp + u * shear, u * weft + v * shear];
        let pull = |by: [f64; 2]| -(along[1] * by[0] + along[0] * by[1]) * flat_area;
        let (one, other) = ([back[(0, 0)], back[(0, 1)]], [back[(1, 0)], back[(1, 1)]]);
        let first = [-one[0] - other[0], -one[1] - other[1]];
        Self {
            strain: [v.norm() - 1.0, u.norm() - 1.0],
            tension: [along[0].norm().copysign(warp), along[1].norm().copysign(weft)],
            forces: [pull(first), pull(one), pull(other)],
            flat_area,
            area,
        }
    }
}

/// What elastic bands pull with: a tension beyond their length at rest, never a push.
fn add_bands(garment: &Garment, force: &mut [Vector3]) {
    for seam in &garment.seams {
        let SeamKind::Elastic { ratio, stiffness } = seam.kind else { continue };
        for pieces in seam.pairs.windows(2) {
            let [a, b] = [pieces[0][0] as usize, pieces[1][0] as usize];
            let length = ratio * (garment.rest[b] - garment.rest[a]).norm();
            let d = garment.positions[b] - garment.positions[a];
            let strain = d.norm() / length - 1.0;
            if strain > 0.0 && strain.is_finite() {
                let pull = d.normalize() * (stiffness * strain);
                force[a] += pull;
                force[b] -= pull;
            }
        }
    }
}

/// The sum over the vertices that are joined, at each of them.
fn together<T: Copy + std::ops::AddAssign>(garment: &Garment, values: &[T]) -> Vec<T> {
    let mut sums = values.to_vec();
    for (i, &w) in garment.weld.iter().enumerate().filter(|&(i, w)| i != *w as usize) {
        let own = values[i];
        sums[w as usize] += own;
    }
    garment.weld.iter().map(|&w| sums[w as usize]).collect()
}

/// Rounds in which forces and areas are shared with neighbours: after five, the meshes of the tests
/// give Laplace's pressure within 1 %.
const ROUNDS: usize = 5;

/// Pressure at each vertex on the body. A mesh gives one vertex more than its share and the next
/// one less, so forces and areas are first shared out among neighbours on the body, which keeps
/// their sums.
fn pressure(
    garment: &Garment,
    collider: Option<&Collider>,
    force: &[Vector3],
    area: &[f64],
) -> Vec<Option<f64>> {
    let Some(collider) = collider else { return vec![None; force.len()] };
    let mut contacts: Vec<BodyContact> = Vec::new();
    collider.scheme.body_contacts(&garment.positions, ON * collider.scheme.card().thickness, &mut contacts);
    let mut held: Vec<Option<[f64; 2]>> = vec![None; force.len()];
    for c in contacts.iter().filter(|c| garment.weld[c.vertex as usize] == c.vertex) {
        let i = c.vertex as usize;
        held[i] = Some([-force[i].dot(&c.normal), area[i]]);
    }
    let edges = joined_edges(garment);
    (0..ROUNDS).for_each(|_| share(&edges, &mut held));
    let at =
        |w: &u32| held[*w as usize].map(|[push, area]| if area > 0.0 { (push / area).max(0.0) } else { 0.0 });
    garment.weld.iter().map(at).collect()
}

/// Every edge once, by joined vertices.
fn joined_edges(garment: &Garment) -> Vec<[usize; 2]> {
    let joined = |[a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|v| garment.weld[v as usize] as usize);
        [a.min(b), a.max(b)]
    };
    let mut edges: Vec<[usize; 2]> =
        garment.edges().into_iter().map(joined).filter(|[a, b]| a != b).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Each vertex keeps an equal part of what it holds, and gives one to each neighbour that holds
/// something.
fn share(edges: &[[usize; 2]], held: &mut [Option<[f64; 2]>]) {
    let both = |held: &[Option<[f64; 2]>], [a, b]: [usize; 2]| held[a].is_some() && held[b].is_some();
    let mut parts = vec![1.0; held.len()];
    for &[a, b] in edges.iter().filter(|e| both(held, **e)) {
        parts[a] += 1.0;
        parts[b] += 1.0;
    }
    held.iter_mut().zip(&parts).for_each(|(h, n)| *h = h.map(|h| h.map(|v| v / n)));
    let given: Vec<[f64; 2]> = held.iter().map(|h| h.unwrap_or_default()).collect();
    for &[a, b] in edges.iter().filter(|e| both(held, **e)).collect::<Vec<_>>() {
        for (to, from) in [(a, b), (b, a)] {
            held[to] = held[to].map(|h| [h[0] + given[from][0], h[1] + given[from][1]]);
        }
    }
}
