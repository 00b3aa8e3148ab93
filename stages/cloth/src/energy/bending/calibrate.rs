//! The bending stiffness that a mesh has, against that of the sheet that it represents.
//!
//! The free rest mesh of each panel is loaded with constant moments along its border (along x,
//! along y, twist): the exact sheet takes a constant curvature. The curvature of the quadratic that
//! fits the mesh's displacement best gives a compliance tensor C. Coupled hinges of rigidity D are
//! built with `D C D` in place of D: right to second order in the error. Lone hinges are multiplied
//! by one factor, the mean over all directions of a cylinder. The vertices must be free to move:
//! held on a quadratic surface, an irregular mesh of coupled hinges has exactly the right energy,
//! but in equilibrium 3 % less. Cost: one sparse factor with one number per vertex pair, some 3 %
//! of a Newton step, once per mesh.

use nalgebra::{Matrix3, Vector2};

use super::flap::{Flap, flaps};
use super::patch::{Beyond, Patch, patches};
use crate::fabric::Rigidity;
use crate::linear::{BlockMatrix, Cholesky};
use crate::mesh::Sheet;
use toile_geometry::Vec3;

/// Triangles of different panels meet with different rest frames, m.
const SAME_FRAME: f64 = 1e-9;
/// A mesh that needs more correction than this (either way) is too small to judge.
const LARGEST_FACTOR: f64 = 2.0;

/// Hinges that lean with the square of their direction's cosine change the two stiffnesses by two
/// thirds of it (mean over directions).
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
    /// How much more the hinges across x need than those across y, as a share of the mean: an
    /// irregular mesh has a grain of some per cent.
    pub lean: f64,
}

/// The rest mesh cut apart into panels: seam vertices count once per panel.
struct Panels {
    corners: Vec<[u32; 3]>,
    /// Rest place of each vertex.
    places: Vec<Vector2<f64>>,
    /// Panel of each vertex, by its first triangle: ascending.
    panel: Vec<usize>,
    /// Which panel that is, counted from 0.
    rank: Vec<usize>,
    held: Vec<bool>,
}

impl Calibration {
    const NONE: Self = Self { factor: 1.0, poisson: -1.0 / 3.0, lean: 0.0 };

    /// Judges the rest mesh.
    pub(crate) fn of(sheet: &Sheet) -> Self {
        let flaps: Vec<Flap> = flaps(sheet).into_iter().filter(|f| one_frame(sheet, f)).collect();
        let panels = Panels::cut(sheet, &flaps);
        let answers = panels.answers(sheet, &flaps, &lone_matrix(sheet, &flaps, &panels));
        let Some(answers) = answers.and_then(|a| a.into_iter().collect::<Option<Vec<_>>>()) else {
            return Self::NONE;
        };
        let sum: Matrix3<f64> = answers.iter().zip(panels.members()).map(|(c, m)| c * m.len() as f64).sum();
        (sum / panels.places.len() as f64).try_inverse().map_or(Self::NONE, |q| Self::from_stiffness(&q))
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
        let mut rank = vec![0; panel.len()];
        let first: Vec<usize> = (0..panel.len()).filter(|&t| panel[t] == t).collect();
        first.iter().enumerate().for_each(|(k, &t)| rank[t] = k);
        let panel = places.into_iter().map(|p| p.0).collect();
        Self { corners, places: at, panel, rank, held }
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

/// Rigidity by (kxx, kyy, kxy) to build the coupled hinges of each triangle with, so that its panel
/// has the requested rigidity.
pub(super) fn calibrated(sheet: &Sheet, rigidities: &[Rigidity]) -> Vec<Matrix3<f64>> {
    let size = rigidities.iter().map(|r| r.warp.max(r.weft)).fold(0.0, f64::max);
    let mut wanted: Vec<Matrix3<f64>> = rigidities.iter().map(Rigidity::tensor).collect();
    if size <= 0.0 {
        return wanted;
    }
    let flaps: Vec<Flap> = flaps(sheet).into_iter().filter(|f| one_frame(sheet, f)).collect();
    let panels = Panels::cut(sheet, &flaps);
    let unit: Vec<Matrix3<f64>> = wanted.iter().map(|d| d / size).collect();
    let answers = panels.answers(sheet, &flaps, &coupled_matrix(sheet, &flaps, &panels, &unit));
    let answers = answers.unwrap_or_default();
    for (t, corners) in panels.corners.iter().enumerate() {
        let panel = panels.rank[panels.panel[corners[0] as usize]];
        let answer = answers.get(panel).copied().flatten();
        if let Some(c) = answer.and_then(|c| correct(&wanted[t], &(c / size))) {
            wanted[t] = c;
        }
    }
    wanted
}

/// `D C D`, unless the correction is too large to be plausible.
fn correct(d: &Matrix3<f64>, compliance: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let root = d.diagonal().map(f64::sqrt);
    let excess = Matrix3::from_fn(|i, j| root[i] * compliance[(i, j)] * root[j]);
    let sizes = nalgebra::SymmetricEigen::new(excess).eigenvalues;
    let fair = sizes.iter().all(|s| (1.0 / LARGEST_FACTOR..=LARGEST_FACTOR).contains(s));
    fair.then(|| d * compliance * d)
}

/// Stiffness against lifts of lone hinges of rigidity 1, one number per vertex pair.
fn lone_matrix(sheet: &Sheet, flaps: &[Flap], panels: &Panels) -> BlockMatrix {
    let vertices: Vec<[u32; 4]> = flaps.iter().map(|f| panels.vertices(sheet, f)).collect();
    let mut a =
        BlockMatrix::with_couplings(panels.places.len(), |visit| vertices.iter().for_each(|v| visit(v)));
    for (f, v) in flaps.iter().zip(&vertices) {
        let block = |i: usize, j: usize| Matrix3::identity() * (f.slenderness * f.weights[i] * f.weights[j]);
        a.add_element(v, &std::array::from_fn::<_, 4, _>(|i| std::array::from_fn(|j| block(i, j))));
    }
    a
}

/// The same of coupled hinges of the rigidity of each triangle, cut apart at seams.
fn coupled_matrix(sheet: &Sheet, flaps: &[Flap], panels: &Panels, d: &[Matrix3<f64>]) -> BlockMatrix {
    let mut joined = vec![[false; 3]; sheet.triangles().len()];
    for f in flaps {
        for (t, k) in f.sides(sheet) {
            joined[t][k] = true;
        }
    }
    let cut = |(t, p): (usize, Patch)| {
        let beyond = std::array::from_fn(|k| if joined[t][k] { p.beyond[k] } else { Beyond::Free });
        let mut p = Patch::new(sheet, t, beyond);
        for k in 0..3 {
            p.vertices[k] = panels.corners[t][k];
            p.vertices[3 + k] = match p.beyond[k] {
                Beyond::Triangle { index, corner } => panels.corners[index as usize][corner as usize],
                _ => p.vertices[k],
            };
        }
        p
    };
    let patches: Vec<Patch> = patches(sheet, |_| None).into_iter().enumerate().map(cut).collect();
    let mut a = BlockMatrix::with_couplings(panels.places.len(), |visit| {
        patches.iter().for_each(|p| visit(&p.vertices));
    });
    for (p, d) in patches.iter().zip(d) {
        let k = p.stiffness(d);
        let column = |v: usize| nalgebra::Vector3::from_fn(|k, _| p.weights[k][v]);
        let block = |i: usize, j: usize| Matrix3::identity() * column(i).dot(&(k * column(j)));
        a.add_element(&p.vertices, &std::array::from_fn::<_, 6, _>(|i| std::array::from_fn(|j| block(i, j))));
    }
    a
}

impl Panels {
    /// Mean curvature (along x, along y, twist) of each panel under each unit moment; none for a
    /// panel too small to measure.
    fn answers(
        &self,
        sheet: &Sheet,
        flaps: &[Flap],
        matrix: &BlockMatrix,
    ) -> Option<Vec<Option<Matrix3<f64>>>> {
        let mut a = matrix.clone();
        a.fix(&self.held);
        let mut b = border_moments(sheet, flaps, self);
        b.iter_mut().zip(&self.held).filter(|(_, h)| **h).for_each(|(b, _)| *b = Vec3::zeros());
        let mut factor = Cholesky::analyse_scalar(&a).ok()?;
        factor.factor(&a).ok()?;
        let lifts = factor.solve(&b);
        let answer = |members: Vec<u32>| {
            let (places, lifts): (Vec<_>, Vec<_>) =
                members.iter().map(|&v| (self.places[v as usize], lifts[v as usize])).unzip();
            curvatures(&places, &lifts).map(|c| 0.5 * (c + c.transpose()))
        };
        Some(self.members().into_iter().map(answer).collect())
    }
}

/// Column j: the curvatures (along x, along y, twist) of the quadratic that fits component j of the
/// lifts best.
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
    for (t, k) in flaps.iter().flat_map(|f| f.sides(sheet)) {
        inner[t][k] = true;
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
