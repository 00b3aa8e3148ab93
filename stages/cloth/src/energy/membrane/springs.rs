//! Springs along the mesh edges, by family: structural (near warp or weft) and shear (the
//! diagonals).
//!
//! A spring's stiffness is that of the cloth it stands for, `k A / l²` (van Gelder, 1998), A the
//! area of its triangles; a shear spring takes 4 G in place of k, which is exact for squares with
//! one diagonal. Piecewise-linear stiffness as in Fan et al., 1999. Cost: one square root an edge.
//! Limit: exact for stretch along mesh lines only; Poisson's ratio and the stiffness off the mesh
//! lines are what the mesh makes of them.

use nalgebra::{Matrix3, Vector2};

use crate::energy::{Assembled, Blocks, Cloth, Element, Projection, Subset, Vec3, add_block_of};
use crate::fabric::{Curve, Fabric};
use crate::mesh::Edge;

/// An edge within this angle of warp or weft (radians) is structural: half way between the axes and
/// the diagonal of a square.
const STRUCTURAL_ANGLE: f64 = std::f64::consts::FRAC_PI_8;

/// Which measured curve a spring follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    Warp,
    Weft,
    Shear,
}

#[derive(Debug, Clone, Copy)]
struct Spring {
    nodes: [u32; 2],
    rest: f64,
    family: Family,
    /// Index of its fabric.
    fabric: u32,
    /// Cloth width that the spring stands for, m: tension times width is its force.
    width: f64,
}

/// All springs of a sheet.
#[derive(Debug, Clone)]
pub struct Springs {
    springs: Vec<Spring>,
    /// The curves of each fabric, by family.
    curves: Vec<[Curve; 3]>,
}

impl Springs {
    /// Structural and shear springs on every edge; an edge between two fabrics is of its first
    /// triangle's.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Assembled<2, Self> {
        let springs = cloth.sheet.edges().iter().map(|e| spring(cloth, e)).collect();
        let curves = |f: &&Fabric| [f.warp.clone(), f.weft.clone(), f.shear.scaled(4.0)];
        Assembled(Self { springs, curves: cloth.fabrics.iter().map(curves).collect() })
    }

    fn curve(&self, s: &Spring) -> &Curve {
        &self.curves[s.fabric as usize][s.family as usize]
    }
}

fn spring(cloth: &Cloth<'_>, e: &Edge) -> Spring {
    let sheet = cloth.sheet;
    let mut area = sheet.areas()[e.sides.0.triangle as usize];
    if let Some(other) = e.sides.1 {
        area += sheet.areas()[other.triangle as usize];
    }
    let corners = &sheet.rest()[e.sides.0.triangle as usize];
    let k = e.sides.0.corner as usize;
    let family = family(&(corners[(k + 2) % 3] - corners[(k + 1) % 3]));
    let fabric = cloth.index(e.sides.0.triangle as usize) as u32;
    Spring { nodes: e.vertices, rest: e.rest_length, family, fabric, width: area / e.rest_length }
}

fn family(direction: &Vector2<f64>) -> Family {
    let from_warp = direction.x.abs().atan2(direction.y.abs());
    if from_warp < STRUCTURAL_ANGLE {
        Family::Warp
    } else if from_warp > std::f64::consts::FRAC_PI_2 - STRUCTURAL_ANGLE {
        Family::Weft
    } else {
        Family::Shear
    }
}

impl Element<2> for Springs {
    type State = Blocks<2>;

    fn name(&self) -> &'static str {
        "springs"
    }

    fn count(&self) -> usize {
        self.springs.len()
    }

    fn nodes(&self, e: usize) -> [u32; 2] {
        self.springs[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 2]) -> f64 {
        let s = &self.springs[e];
        let strain = (x[1] - x[0]).norm() / s.rest - 1.0;
        self.curve(s).energy(strain) * s.width * s.rest
    }

    fn gradient(&self, e: usize, x: &[Vec3; 2]) -> [Vec3; 2] {
        let s = &self.springs[e];
        let (length, unit) = direction(x);
        let pull = unit * (self.curve(s).force(length / s.rest - 1.0) * s.width);
        [-pull, pull]
    }

    fn state(&self, e: usize, x: &[Vec3; 2], form: Projection) -> Blocks<2> {
        let s = &self.springs[e];
        let (length, unit) = direction(x);
        let (curve, strain) = (self.curve(s), length / s.rest - 1.0);
        if form == Projection::Bound {
            // Force over length is below the steepest slope, too.
            let h = Matrix3::identity() * (curve.steepest() * s.width / s.rest);
            return [[h, -h], [-h, h]];
        }
        let mut across = if length > 0.0 { curve.force(strain) * s.width / length } else { 0.0 };
        if across < 0.0 {
            across *= form.compression();
        }
        let along = curve.slope(strain) * s.width / s.rest;
        let h = Matrix3::identity() * across + unit * unit.transpose() * (along - across);
        [[h, -h], [-h, h]]
    }

    fn add_block(&self, _: usize, state: &Blocks<2>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        add_block_of(state, row, column, sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let spring =
            |&e: &usize| Spring { nodes: subset.renumbered(self.springs[e].nodes), ..self.springs[e] };
        Self { springs: elements.iter().map(spring).collect(), curves: self.curves.clone() }
    }
}

/// Length and direction; the direction of a spring without length is zero, so that it pulls
/// nowhere.
fn direction(x: &[Vec3; 2]) -> (f64, Vec3) {
    let d = x[1] - x[0];
    let length = d.norm();
    (length, if length > 0.0 { d / length } else { Vec3::zeros() })
}
