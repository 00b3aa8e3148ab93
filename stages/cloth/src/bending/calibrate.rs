//! The factor that gives a hinge mesh the rigidity it is asked for, and the Poisson's ratio that it has.
//!
//! Load the free rest mesh of each panel with constant moments along its border (along x, along y, twist): the exact sheet answers
//! with constant curvature. The quadratic that fits the mesh's answer best has a curvature as well, and so gives a stiffness tensor, whose mean over all directions
//! of a cylinder is compared with D. Letting the vertices give way matters: held on a cylinder an irregular mesh looks 6 %
//! too stiff, but half of that is gone in equilibrium; and a narrow strip misses the hinges that its border does not have. Cost: one
//! sparse factor of a number a vertex pair, some 3 % of a Newton step, once a mesh.

use nalgebra::{Matrix3, Vector2};

use super::Rigidity;
use super::flap::{Flap, flaps};
use crate::force::Vec3;
use crate::linear::{BlockMatrix, Cholesky};
use crate::mesh::Sheet;

/// Triangles of different panels meet with different rest frames, m.
const SAME_FRAME: f64 = 1e-9;
/// A mesh that asks for more correction than this (either way) is too small to judge.
const LARGEST_FACTOR: f64 = 2.0;

/// Hinges that lean with the square of their direction's cosine change the two stiffnesses by two thirds of it (mean over directions).
const LEAN_PER_DIFFERENCE: f64 = 1.5;
/// More grain than this is the mesh's layout, not chance, and stays.
const LARGEST_LEAN: f64 = 0.3;

/// What a hinge mesh is, against the sheet it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Calibration {
    /// What to multiply the hinge stiffness by. 1 for a mesh too small to judge.
    pub factor: f64,
    /// Poisson's ratio of its bending, about -1/3.
    pub poisson: f64,
    /// How much more the hinges across x need than those across y, as a share of the mean: an irregular mesh has a grain of some per cent.
    pub lean: f64,
}

/// The rest mesh cut apart into panels: seam vertices count once a panel.
struct Panels {
    corners: Vec<[u32; 3]>,
    /// Rest place of each vertex.
    places: Vec<Vector2<f64>>,
    /// Panel of each vertex: ascending.
    panel: Vec<usize>,
    held: Vec<bool>,
}

impl Calibration {
    const NONE: Self = Self { factor: 1.0, poisson: -1.0 / 3.0, lean: 0.0 };

    /// Judges the rest mesh.
    pub(crate) fn of(sheet: &Sheet) -> Self {
        let flaps: Vec<Flap> =
            flaps(sheet, &Rigidity::uniform(1.0)).into_iter().filter(|f| one_frame(sheet, f)).collect();
        let panels = Panels::cut(sheet, &flaps);
        let Some(compliance) = compliance(sheet, &flaps, &panels) else { return Self::NONE };
        compliance.try_inverse().map_or(Self::NONE, |q| Self::from_stiffness(&q))
    }

    /// The rigidity to build hinges with.
    pub(crate) fn corrected(&self, d: &Rigidity) -> Rigidity {
        Rigidity { weft: d.weft * (1.0 + self.lean), warp: d.warp * (1.0 - self.lean) }
    }

    /// From the stiffness by (curvature along x, along y, twist).
    fn from_stiffness(q: &Matrix3<f64>) -> Self {
        let cylinder = (3.0 * (q[(0, 0)] + q[(1, 1)]) + 2.0 * q[(0, 1)] + q[(2, 2)]) / 8.0;
        let dome = q[(0, 0)] + q[(1, 1)] + 2.0 * q[(0, 1)];
        let saddle = 0.5 * (q[(0, 0)] + q[(1, 1)] - 2.0 * q[(0, 1)] + q[(2, 2)]);
        let (factor, poisson) = (1.0 / cylinder, (dome - saddle) / (dome + saddle));
        let difference = (q[(1, 1)] - q[(0, 0)]) / (q[(1, 1)] + q[(0, 0)]);
        let lean = (LEAN_PER_DIFFERENCE * difference).clamp(-LARGEST_LEAN, LARGEST_LEAN);
        let fair = factor.is_finite() && (1.0 / LARGEST_FACTOR..=LARGEST_FACTOR).contains(&factor);
        if fair && poisson.abs() < 1.0 { Self { factor, poisson, lean } } else { Self::NONE }
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

impl Panels {
    fn cut(sheet: &Sheet, flaps: &[Flap]) -> Self {
        let mut parent: Vec<usize> = (0..sheet.triangles().len()).collect();
        for f in flaps {
            let [a, b] = f.triangles.map(|t| find(&mut parent, t as usize));
            parent[a.max(b)] = a.min(b);
        }
        let panel: Vec<usize> = (0..parent.len()).map(|t| find(&mut parent, t)).collect();
        let mut places: Vec<(usize, u32)> =
            sheet.triangles().iter().zip(&panel).flat_map(|(t, &p)| t.map(|v| (p, v))).collect();
        places.sort_unstable();
        places.dedup();
        let place = |p: usize, v: u32| places.binary_search(&(p, v)).unwrap_or(0) as u32;
        let corners: Vec<[u32; 3]> =
            sheet.triangles().iter().zip(&panel).map(|(t, &p)| t.map(|v| place(p, v))).collect();
        // One triangle a panel takes its rigid motion.
        let mut held = vec![false; places.len()];
        for (t, _) in panel.iter().enumerate().filter(|(t, p)| *t == **p) {
            corners[t].iter().for_each(|&v| held[v as usize] = true);
        }
        let mut at = vec![Vector2::zeros(); places.len()];
        for (t, rest) in corners.iter().zip(sheet.rest()) {
            t.iter().zip(rest).for_each(|(&v, p)| at[v as usize] = *p);
        }
        let panel = places.into_iter().map(|p| p.0).collect();
        Self { corners, places: at, panel, held }
    }

    /// The vertices of each panel.
    fn members(&self) -> Vec<Vec<u32>> {
        let all: Vec<u32> = (0..self.panel.len() as u32).collect();
        all.chunk_by(|&a, &b| self.panel[a as usize] == self.panel[b as usize]).map(<[u32]>::to_vec).collect()
    }

    /// The vertices of a flap, cut apart.
    fn vertices(&self, sheet: &Sheet, f: &Flap) -> [u32; 4] {
        std::array::from_fn(|k| {
            let t = f.triangles[usize::from(k == 3)] as usize;
            let corner = sheet.triangles()[t].iter().position(|&w| w == f.vertices[k]).unwrap_or(0);
            self.corners[t][corner]
        })
    }
}

fn find(parent: &mut [usize], mut t: usize) -> usize {
    while parent[t] != t {
        parent[t] = parent[parent[t]];
        t = parent[t];
    }
    t
}

/// Mean curvature (along x, along y, twist) of all panels under each unit moment, for rigidity 1.
fn compliance(sheet: &Sheet, flaps: &[Flap], panels: &Panels) -> Option<Matrix3<f64>> {
    let vertices: Vec<[u32; 4]> = flaps.iter().map(|f| panels.vertices(sheet, f)).collect();
    let mut a =
        BlockMatrix::with_couplings(panels.places.len(), |visit| vertices.iter().for_each(|v| visit(v)));
    for (f, v) in flaps.iter().zip(&vertices) {
        let block = |i: usize, j: usize| Matrix3::identity() * (f.slenderness * f.weights[i] * f.weights[j]);
        a.add_element(v, &std::array::from_fn::<_, 4, _>(|i| std::array::from_fn(|j| block(i, j))));
    }
    a.fix(&panels.held);
    let load = border_moments(sheet, flaps, panels);
    let mut b = load.clone();
    b.iter_mut().zip(&panels.held).filter(|(_, h)| **h).for_each(|(b, _)| *b = Vec3::zeros());
    let mut factor = Cholesky::analyse_scalar(&a).ok()?;
    factor.factor(&a).ok()?;
    let lifts = factor.solve(&b);
    let mut sum = Matrix3::zeros();
    for panel in panels.members() {
        let (places, lifts): (Vec<_>, Vec<_>) =
            panel.iter().map(|&v| (panels.places[v as usize], lifts[v as usize])).unzip();
        sum += curvatures(&places, &lifts)? * panel.len() as f64;
    }
    let mean = sum / panels.places.len() as f64;
    Some(0.5 * (mean + mean.transpose()))
}

/// Column j: the curvatures (along x, along y, twist) of the quadratic that fits component j of the lifts best.
fn curvatures(places: &[Vector2<f64>], lifts: &[Vec3]) -> Option<Matrix3<f64>> {
    let centre = places.iter().sum::<Vector2<f64>>() / places.len() as f64;
    let size = places.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max);
    let row = |p: &Vector2<f64>| {
        let q = (p - centre) / size;
        nalgebra::Vector6::new(1.0, q.x, q.y, 0.5 * q.x * q.x, 0.5 * q.y * q.y, q.x * q.y)
    };
    let mut normal = nalgebra::Matrix6::zeros();
    let mut right = nalgebra::Matrix6x3::zeros();
    for (p, w) in places.iter().zip(lifts) {
        let r = row(p);
        normal += r * r.transpose();
        right += r * w.transpose();
    }
    let fit = normal.cholesky()?.solve(&right);
    Some(fit.fixed_rows::<3>(3) / (size * size))
}

/// The work of unit moments (xx, yy, xy) on the slopes along every panel's border, by vertex.
fn border_moments(sheet: &Sheet, flaps: &[Flap], panels: &Panels) -> Vec<Vec3> {
    let mut inner = vec![[false; 3]; sheet.triangles().len()];
    for f in flaps {
        for t in f.triangles.map(|t| t as usize) {
            let on_edge = |k: usize| f.vertices[..2].contains(&sheet.triangles()[t][k]);
            if let Some(k) = (0..3).find(|&k| !on_edge(k)) {
                inner[t][k] = true;
            }
        }
    }
    let mut load = vec![Vec3::zeros(); panels.places.len()];
    for (t, corners) in sheet.rest().iter().enumerate() {
        let m = sheet.inverse_rest()[t];
        let (g1, g2) = (m.row(0).transpose(), m.row(1).transpose());
        let shape = [-g1 - g2, g1, g2];
        for k in (0..3).filter(|&k| !inner[t][k]) {
            let e = corners[(k + 2) % 3] - corners[(k + 1) % 3];
            let n = Vector2::new(e.y, -e.x);
            for (c, g) in shape.iter().enumerate() {
                let twist = 0.5 * (n.x * g.y + n.y * g.x);
                load[panels.corners[t][c] as usize] += Vec3::new(n.x * g.x, n.y * g.y, twist);
            }
        }
    }
    load
}
