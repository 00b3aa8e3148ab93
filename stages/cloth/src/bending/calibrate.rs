//! The factor that gives a hinge mesh the rigidity it is asked for.
//!
//! Bend the rest mesh to three unit curvatures (along x, along y, twist), hold a border, and let the inner vertices give way until the
//! bending energy is least; then average the energy over all directions of a cylinder and compare with the exact
//! `kappa² / 2` per area. Letting vertices give way matters: with the vertices on the cylinder itself an irregular mesh looks 6 %
//! too stiff, but half of that is gone in equilibrium. The give is local, so a few dozen conjugate-gradient steps suffice; cost
//! is that of a few dozen products with the matrix, once a mesh.

use nalgebra::{Matrix3, Vector2};

use super::Rigidity;
use super::flap::{Flap, flaps};
use crate::force::Vec3;
use crate::linear::{BlockMatrix, conjugate_gradients};
use crate::mesh::Sheet;

/// Steps of relaxation: by then the fourth digit of the factor stands still.
const RELAXATION_STEPS: usize = 60;

/// Triangles of different panels meet with different rest frames; only flaps inside one frame can be judged.
const SAME_FRAME: f64 = 1e-9;

/// What a hinge mesh is, against the sheet it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Calibration {
    /// What to multiply the hinge stiffness by. 1 for a mesh without inner edges.
    pub factor: f64,
    /// Poisson's ratio of its bending, about -1/3.
    pub poisson: f64,
}

impl Calibration {
    /// Judges the rest mesh.
    pub(super) fn of(sheet: &Sheet) -> Self {
        let flaps: Vec<Flap> =
            flaps(sheet, &Rigidity::uniform(1.0)).into_iter().filter(|f| one_frame(sheet, f)).collect();
        let free = inner(sheet, &flaps);
        let mut lifts = quadratics(&vertex_frame(sheet));
        relax(&flaps, &free, &mut lifts);
        let judged = |f: &&Flap| f.vertices.iter().all(|&v| free[v as usize]);
        let chosen: Vec<&Flap> = flaps.iter().filter(judged).collect();
        Self::from_folds(&if chosen.is_empty() { flaps.iter().collect() } else { chosen }, &lifts)
    }

    fn from_folds(flaps: &[&Flap], lifts: &[Vec3]) -> Self {
        let (mut cylinder, mut dome, mut saddle, mut area) = (0.0, 0.0, 0.0, 0.0);
        for f in flaps {
            let [a, b, c]: [f64; 3] = fold(f, lifts).into();
            let k = stiffness(f);
            // Mean over directions of (a cos² + b sin² + c sin cos)²; a dome; the mean of the two saddles.
            cylinder += k * (3.0 * (a * a + b * b) + 2.0 * a * b + c * c) / 8.0;
            dome += k * (a + b).powi(2);
            saddle += k * 0.5 * ((a - b).powi(2) + c * c);
            area += f.area / 3.0;
        }
        if cylinder > 0.0 && area > 0.0 {
            Self { factor: area / cylinder, poisson: (dome - saddle) / (dome + saddle) }
        } else {
            Self { factor: 1.0, poisson: -1.0 / 3.0 }
        }
    }
}

fn one_frame(sheet: &Sheet, f: &Flap) -> bool {
    let corner = |t: u32, v: u32| {
        let k = sheet.triangles()[t as usize].iter().position(|&w| w == v);
        k.map(|k| sheet.rest()[t as usize][k])
    };
    f.vertices[..2].iter().all(|&v| match (corner(f.triangles[0], v), corner(f.triangles[1], v)) {
        (Some(a), Some(b)) => (a - b).norm() < SAME_FRAME,
        _ => false,
    })
}

/// Any rest place of each vertex: unique inside a panel, and seam vertices are held anyway.
fn vertex_frame(sheet: &Sheet) -> Vec<Vector2<f64>> {
    let mut frame = vec![Vector2::zeros(); sheet.vertex_count()];
    for (t, corners) in sheet.triangles().iter().zip(sheet.rest()) {
        for (&v, c) in t.iter().zip(corners) {
            frame[v as usize] = *c;
        }
    }
    frame
}

/// Vertices whose every edge belongs to a judged flap, and whose neighbours' edges do as well: the border holds slope and place.
fn inner(sheet: &Sheet, flaps: &[Flap]) -> Vec<bool> {
    let mut degree = vec![0_i32; sheet.vertex_count()];
    for e in sheet.edges() {
        e.vertices.iter().for_each(|&v| degree[v as usize] += 1);
    }
    for f in flaps {
        f.vertices[..2].iter().for_each(|&v| degree[v as usize] -= 1);
    }
    let mut free: Vec<bool> = degree.iter().map(|&d| d == 0).collect();
    for e in sheet.edges() {
        let [a, b] = e.vertices.map(|v| v as usize);
        if degree[a] != 0 || degree[b] != 0 {
            (free[a], free[b]) = (false, false);
        }
    }
    free
}

/// Lifts of x²/2, y²/2 and xy at every vertex.
fn quadratics(frame: &[Vector2<f64>]) -> Vec<Vec3> {
    frame.iter().map(|p| Vec3::new(0.5 * p.x * p.x, 0.5 * p.y * p.y, p.x * p.y)).collect()
}

fn stiffness(f: &Flap) -> f64 {
    f.slenderness
}

/// Lowers the bending energy of all three lifts at once by moving the free vertices.
fn relax(flaps: &[Flap], free: &[bool], lifts: &mut [Vec3]) {
    let n = lifts.len();
    let mut a = BlockMatrix::with_couplings(n, |visit| flaps.iter().for_each(|f| visit(&f.vertices)));
    let mut residual = vec![Vec3::zeros(); n];
    for f in flaps {
        let fold = fold(f, lifts);
        for i in 0..4 {
            residual[f.vertices[i] as usize] -= fold * (stiffness(f) * f.weights[i]);
        }
        let blocks: [[Matrix3<f64>; 4]; 4] = std::array::from_fn(|i| {
            std::array::from_fn(|j| Matrix3::identity() * (stiffness(f) * f.weights[i] * f.weights[j]))
        });
        a.add_element(&f.vertices, &blocks);
    }
    let fixed: Vec<bool> = free.iter().map(|f| !f).collect();
    a.fix(&fixed);
    residual.iter_mut().zip(&fixed).filter(|(_, f)| **f).for_each(|(r, _)| *r = Vec3::zeros());
    let mut give = vec![Vec3::zeros(); n];
    conjugate_gradients(&a, &residual, &mut give, 1e-8, RELAXATION_STEPS);
    lifts.iter_mut().zip(&give).for_each(|(l, g)| *l += g);
}

fn fold(f: &Flap, lifts: &[Vec3]) -> Vec3 {
    (0..4).map(|i| lifts[f.vertices[i] as usize] * f.weights[i]).sum()
}
