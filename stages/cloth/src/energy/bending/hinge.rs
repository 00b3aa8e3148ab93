//! The hinge: the sheet resists the fold angles over the three edges of each triangle together,
//! `E = (theta - rest) . K (theta - rest) / 2`.
//!
//! K converts the three angles into the curvature that they measure (see `patch`), and that into
//! energy by the tensor of the plate, here with Poisson's ratio 0. So every quadratic surface has
//! its exact energy on every mesh, in every direction, and free edges need no special treatment.
//! The angles are those of the folded sheet, at any fold (Grinspun, Hirani, Desbrun, Schroeder,
//! 2003, coupled after Grinspun, Gingold, Reisman, Zorin, 2006). In equilibrium the vertices of an
//! irregular mesh move a little, which makes it 3 % softer in all directions alike; `calibrate`
//! corrects that. Cost: three angles per triangle, and a matrix with half as many entries again as
//! lone hinges have. Limit: squares with alternating diagonals, whose vertices are of two kinds,
//! lose a quarter of their stiffness in equilibrium and stay 20 % too soft.

use super::angle::{Leaf, angle};
use super::calibrate::calibrated;
use super::patch::{Beyond, Patch, patches};
use crate::energy::{Assembled, Blocks, Cloth, Element, Projection, Subset, Vec3, add_block_of};
use crate::fabric::Rigidity;
use nalgebra::Matrix3;

#[derive(Debug, Clone, Copy)]
struct Bend {
    nodes: [u32; 6],
    beyond: [Beyond; 3],
    stiffness: Matrix3<f64>,
    rest: [f64; 3],
}

/// Coupled hinges of all triangles of a sheet.
#[derive(Debug, Clone)]
pub struct Hinge {
    triangles: Vec<Bend>,
}

impl Hinge {
    /// Flat at rest, calibrated for the mesh; the cloth's clamp holds the slope over its edges.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Assembled<6, Self> {
        let rigidities: Vec<Rigidity> =
            (0..cloth.sheet.triangles().len()).map(|t| cloth.rigidity(t)).collect();
        let d = calibrated(cloth.sheet, &rigidities);
        let bend = |(p, d): (Patch, &Matrix3<f64>)| Bend {
            nodes: p.vertices,
            beyond: p.beyond,
            stiffness: p.stiffness(d),
            rest: [0.0; 3],
        };
        let patches = patches(cloth.sheet, |e| cloth.beyond(e));
        Assembled(Self { triangles: patches.into_iter().zip(&d).map(bend).collect() })
    }

    /// Takes the fold angles at `x` as the unstressed ones: a pressed crease, a cuff rolled on its
    /// form.
    pub fn rest_at(&mut self, x: &[Vec3]) {
        for b in &mut self.triangles {
            let x = b.nodes.map(|v| x[v as usize]);
            b.rest = b.folds(&x).map(|f| f.map_or(0.0, |f| f.angle));
        }
    }
}

/// One fold of a patch: its angle, the two triangles, and where their (start, end, tip) stand in
/// the patch.
struct PatchFold {
    angle: f64,
    leaves: [(Leaf, [usize; 3]); 2],
}

impl Bend {
    fn folds(&self, x: &[Vec3; 6]) -> [Option<PatchFold>; 3] {
        std::array::from_fn(|k| self.fold(k, x))
    }

    fn fold(&self, k: usize, x: &[Vec3; 6]) -> Option<PatchFold> {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        // The far end of a held plane moves with the edge's start.
        let (tip, at) = match self.beyond[k] {
            Beyond::Free => return None,
            Beyond::Triangle { .. } => (x[3 + k], 3 + k),
            Beyond::Held(outward) => (x[i] + outward, i),
        };
        Some(PatchFold {
            angle: angle(&x[i], &x[j], &x[k], &tip),
            leaves: [
                (Leaf::new(&x[i], &x[j], &x[k], false), [i, j, k]),
                (Leaf::new(&x[i], &x[j], &tip, true), [i, j, at]),
            ],
        })
    }

    fn bent(&self, folds: &[Option<PatchFold>; 3]) -> nalgebra::Vector3<f64> {
        nalgebra::Vector3::from_fn(|k, _| folds[k].as_ref().map_or(0.0, |f| f.angle - self.rest[k]))
    }
}

impl PatchFold {
    /// Derivative of the angle by the six vertices.
    fn gradient(&self) -> [Vec3; 6] {
        let mut g = [Vec3::zeros(); 6];
        for (leaf, at) in &self.leaves {
            leaf.gradient().iter().zip(at).for_each(|(d, &v)| g[v] += d);
        }
        g
    }

    fn add_hessian(&self, h: &mut [[Matrix3<f64>; 6]; 6], moment: f64) {
        for (leaf, at) in &self.leaves {
            for (row, &i) in leaf.hessian().iter().zip(at) {
                row.iter().zip(at).for_each(|(block, &j)| h[i][j] += block * moment);
            }
        }
    }
}

impl Element<6> for Hinge {
    type State = Blocks<6>;

    fn name(&self) -> &'static str {
        "hinge bending"
    }

    fn count(&self) -> usize {
        self.triangles.len()
    }

    fn nodes(&self, e: usize) -> [u32; 6] {
        self.triangles[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 6]) -> f64 {
        let b = &self.triangles[e];
        let bent = b.bent(&b.folds(x));
        0.5 * bent.dot(&(b.stiffness * bent))
    }

    fn gradient(&self, e: usize, x: &[Vec3; 6]) -> [Vec3; 6] {
        let b = &self.triangles[e];
        let folds = b.folds(x);
        let moments = b.stiffness * b.bent(&folds);
        let mut sum = [Vec3::zeros(); 6];
        for (fold, moment) in folds.iter().zip(&moments) {
            let Some(fold) = fold else { continue };
            sum.iter_mut().zip(fold.gradient()).for_each(|(s, g)| *s += g * *moment);
        }
        sum
    }

    fn state(&self, e: usize, x: &[Vec3; 6], form: Projection) -> Blocks<6> {
        let b = &self.triangles[e];
        let folds = b.folds(x);
        let g = folds.each_ref().map(|f| f.as_ref().map_or([Vec3::zeros(); 6], PatchFold::gradient));
        // Row i of the products: moments of the three folds when vertex i moves.
        let pull: [[Vec3; 6]; 3] = std::array::from_fn(|k| {
            std::array::from_fn(|v| (0..3).map(|l| g[l][v] * b.stiffness[(k, l)]).sum())
        });
        let mut h: [[Matrix3<f64>; 6]; 6] = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| pull[k][i] * g[k][j].transpose()).sum())
        });
        if form == Projection::Exact {
            let moments = b.stiffness * b.bent(&folds);
            for (fold, moment) in folds.iter().zip(&moments) {
                fold.iter().for_each(|f| f.add_hessian(&mut h, *moment));
            }
        }
        h
    }
    fn add_block(&self, _: usize, state: &Blocks<6>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        add_block_of(state, row, column, sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let bend =
            |&e: &usize| Bend { nodes: subset.renumbered(self.triangles[e].nodes), ..self.triangles[e] };
        Self { triangles: elements.iter().map(bend).collect() }
    }

    fn scale_bending(&mut self, by: f64) {
        self.triangles.iter_mut().for_each(|b| b.stiffness *= by);
    }
}
