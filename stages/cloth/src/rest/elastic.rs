//! The sheet's own resistance, in the form the rest solver wants: one pass for the gradient and a positive semi-definite
//! matrix. Every triangle has the law of its panel's fabric.
//!
//! Membrane: woven triangles with measured curves (see `law`); the part of the second derivative that the stress makes is
//! projected by clamping the two principal stresses at zero, which costs two square roots a triangle (the tension field of
//! Choi and Ko 2002 put into Newton's matrix). Bending: the quadratic isometric model (Bergou et al. 2006) with the hinge's
//! calibrated weights and the free edges' correction (see `border`), whose matrix never changes. Cost O(triangles), and once a
//! mesh the calibration's sparse factor of one number a pair of nodes.

mod assembly;
mod border;
mod crease;
mod hold;
mod law;
mod part;
mod spring;

pub use spring::Spring;

use super::pattern::Pattern;
use crate::bending::{Calibration, Rigidity, flaps};
use crate::fabric::Fabric;
use crate::mesh::{Edge, Sheet, Side};
use crate::scene::StrainLimit;
use assembly::{Assembly, Local};
use border::Border;
use crease::Crease;
use hold::Hold;
use law::{Law, Response};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use rayon::prelude::*;

type Vec3 = Vector3<f64>;

#[derive(Debug, Clone)]
struct Triangle {
    nodes: [u32; 3],
    /// Which law.
    cloth: u32,
    /// Derivative of the deformation gradient's two columns by each corner.
    shape: [Vector2<f64>; 3],
    area: f64,
}

#[derive(Debug, Clone)]
struct Hinge {
    nodes: [u32; 4],
    /// The small fold angle by the nodes' lifts; their sum is zero.
    weights: [f64; 4],
    stiffness: f64,
}

/// The elastic energy of a sheet.
#[derive(Debug, Clone)]
pub struct Elastic {
    laws: Vec<Law>,
    triangles: Vec<Triangle>,
    hinges: Vec<Hinge>,
    borders: Vec<Border>,
    springs: Vec<Spring>,
    creases: Vec<Crease>,
    assembly: Assembly,
    /// What friction between yarns may hold, hinge by hinge; empty where no cloth has any.
    frictions: Vec<Hold>,
    /// The angles at which it holds, as many; empty until it does.
    held: Vec<f64>,
    /// Stress of each triangle as the last step foretold it: weft, warp, shear, N/m.
    foretold: Vec<[f64; 3]>,
}

/// Elements that one sum adds up.
const CHUNK: usize = 512;

/// Elements of one task: to wake a thread takes as long as some thousand.
const TASK: usize = 2048;

/// The pairs of corners of a triangle, row before column.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

impl Elastic {
    /// Prepares the sheet's elements; triangle `t` is of `cloths[cloth(t)]`.
    #[must_use]
    pub fn new(
        sheet: &Sheet,
        cloths: &[&Fabric],
        limit: Option<StrainLimit>,
        cloth: impl Fn(usize) -> usize,
    ) -> Self {
        Self::calibrated_on(sheet, sheet, cloths, limit, cloth)
    }

    /// The same for a sheet whose rest shapes do not fit together everywhere, with the bending of the `cut` pieces.
    #[must_use]
    pub fn calibrated_on(
        cut: &Sheet,
        sheet: &Sheet,
        cloths: &[&Fabric],
        limit: Option<StrainLimit>,
        cloth: impl Fn(usize) -> usize,
    ) -> Self {
        let of = |t: usize| cloth(t).min(cloths.len().saturating_sub(1));
        let laws = cloths.iter().map(|c| Law::of(c, limit)).collect();
        let triangles = (0..sheet.triangles().len()).map(|t| triangle(sheet, t, of(t) as u32)).collect();
        let bends: Vec<Rigidity> = cloths.iter().map(|c| Rigidity::of(c)).collect();
        let (hinges, borders) = match bends.iter().all(|b| b.warp == 0.0 && b.weft == 0.0) {
            true => (Vec::new(), Vec::new()),
            false => bending(&Calibration::of(cut), sheet, |t| &bends[of(t)]),
        };
        let frictions = frictions(&hinges, sheet, |t| cloths[of(t)]);
        let held = Vec::new();
        let (springs, creases) = (Vec::new(), Vec::new());
        let (assembly, foretold) = (Assembly::default(), Vec::new());
        Self { laws, triangles, hinges, borders, springs, creases, assembly, frictions, held, foretold }
    }

    /// The same with elastic bands.
    #[must_use]
    pub fn with(self, springs: Vec<Spring>) -> Self {
        Self { springs, ..self }
    }

    /// Makes bending so many times stiffer; it counts from the next [`Self::bind`] on.
    pub fn stiffen(&mut self, by: f64) {
        self.hinges.iter_mut().for_each(|h| h.stiffness *= by);
        self.borders.iter_mut().for_each(|b| b.stiffen(by));
    }

    /// The groups of nodes that it couples.
    pub fn couplings(&self) -> impl Iterator<Item = &[u32]> {
        let sheet =
            self.triangles.iter().map(|t| &t.nodes[..]).chain(self.hinges.iter().map(|h| &h.nodes[..]));
        sheet.chain(self.springs.iter().map(|s| &s.nodes[..]))
    }

    /// Looks up where its blocks go. The pattern must hold its couplings, but those of held nodes.
    pub fn bind(&mut self, pattern: &Pattern) {
        self.springs.iter_mut().for_each(|s| s.slot = pattern.slot(s.nodes[0], s.nodes[1]));
        self.assembly =
            Assembly::new(pattern, &self.triangles, &self.hinges, &self.borders, !self.frictions.is_empty());
    }

    /// Follows into a wider pattern, in which the slots of that of the last [`Self::bind`] are at `slots`.
    pub fn follow(&mut self, pattern: &Pattern, slots: &[u32]) {
        self.springs.iter_mut().for_each(|s| s.slot = pattern.slot(s.nodes[0], s.nodes[1]));
        self.assembly.place(slots, pattern.blocks());
    }

    /// Remembers the stress that the linear model foretells for `moves` from `x`.
    pub fn foretell(&mut self, x: &[Vec3], moves: &[Vec3]) {
        let Self { triangles, laws, foretold, .. } = self;
        foretold.resize(triangles.len(), [0.0; 3]);
        let foretell =
            |(f, t): (&mut [f64; 3], &Triangle)| *f = t.foretell(&laws[t.cloth as usize], x, moves);
        foretold.par_iter_mut().zip(&*triangles).with_min_len(TASK).for_each(foretell);
    }

    /// Energy, J.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        let membrane = |t: &Triangle| {
            let (u, v) = t.columns(x);
            t.area * self.laws[t.cloth as usize].density(metric(&u, &v))
        };
        let bending = |h: &Hinge| 0.5 * h.stiffness * h.curvature(x).norm_squared();
        sum(&self.triangles, membrane)
            + sum(&self.hinges, bending)
            + sum(&self.borders, |b| b.value(x))
            + sum(&self.springs, |s| s.value(x))
            + self.value_of_creases(x)
    }

    /// Adds the derivative of the energy, N.
    pub fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        let forces = |t: &Triangle| {
            let (u, v) = t.columns(x);
            let [su, sv, ss] = self.laws[t.cloth as usize].stress(metric(&u, &v)).map(|s| s * t.area);
            let (pu, pv) = (u * su + v * ss, v * sv + u * ss);
            t.shape.map(|b| pu * b.x + pv * b.y)
        };
        let membrane: Vec<[Vec3; 3]> = self.triangles.par_iter().with_min_len(TASK).map(forces).collect();
        for (t, f) in self.triangles.iter().zip(&membrane) {
            t.nodes.iter().zip(f).for_each(|(&i, f)| gradient[i as usize] += f);
        }
        let moments: Vec<Vec3> =
            self.hinges.par_iter().with_min_len(2 * TASK).map(|h| h.curvature(x) * h.stiffness).collect();
        for (h, moment) in self.hinges.iter().zip(&moments) {
            h.nodes.iter().zip(&h.weights).for_each(|(&i, w)| gradient[i as usize] += moment * *w);
        }
        self.add_gradient_of_holds(x, gradient);
        self.borders.iter().for_each(|b| b.add_gradient(x, gradient));
        self.springs.iter().for_each(|s| s.add_gradient(x, gradient));
        self.add_gradient_of_creases(x, gradient);
    }

    /// Writes the second derivative with the foretold stress and a share of its `compression`, N/m; positive semi-definite
    /// without any.
    pub fn write_matrix(&self, x: &[Vec3], compression: f64, values: &mut [Matrix3<f64>]) {
        let local = |(k, t): (usize, &Triangle)| t.local(self, self.foretold.get(k), x, compression);
        let locals: Vec<Local> =
            self.triangles.par_iter().enumerate().with_min_len(TASK / 2).map(local).collect();
        self.assembly.write(&self.triangles, &locals, &self.stiffness_of_holds(x), values);
        self.springs.iter().for_each(|s| s.add_matrix(x, values));
    }

    /// Greatest excess of a triangle over the strain limit: the triangle, its strain along that yarn and the limit.
    #[must_use]
    pub fn over(&self, x: &[Vec3], limit: &StrainLimit) -> Option<(usize, f64, f64)> {
        let mut worst: Option<(usize, f64, f64)> = None;
        for (k, t) in self.triangles.iter().enumerate() {
            let (u, v) = t.columns(x);
            for (strain, limit) in [(u.norm() - 1.0, limit.weft), (v.norm() - 1.0, limit.warp)] {
                if strain > limit && worst.is_none_or(|(_, s, l)| strain / limit > s / l) {
                    worst = Some((k, strain, limit));
                }
            }
        }
        worst
    }
}

/// A sum in chunks of fixed size: the same bits for any number of threads.
fn sum<T: Sync>(of: &[T], f: impl Fn(&T) -> f64 + Sync) -> f64 {
    let parts: Vec<f64> =
        of.par_chunks(CHUNK).with_min_len(2 * TASK / CHUNK).map(|c| c.iter().map(&f).sum()).collect();
    parts.iter().sum()
}

impl Triangle {
    /// The images of the rest x and y axes.
    fn columns(&self, x: &[Vec3]) -> (Vec3, Vec3) {
        let [a, b, c] = self.nodes.map(|i| x[i as usize]);
        let [sa, sb, sc] = &self.shape;
        (a * sa.x + b * sb.x + c * sc.x, a * sa.y + b * sb.y + c * sc.y)
    }

    /// The stress after `moves` if strain were linear in them.
    fn foretell(&self, law: &Law, x: &[Vec3], moves: &[Vec3]) -> [f64; 3] {
        let (u, v) = self.columns(x);
        let (du, dv) = self.columns(moves);
        let Response { stress: [su, sv, ss], tangent: [c11, c22, c33, c12, c13, c23] } =
            law.response(metric(&u, &v));
        let (eu, ev, es) = (u.dot(&du), v.dot(&dv), u.dot(&dv) + v.dot(&du));
        [
            su + c11 * eu + c12 * ev + c13 * es,
            sv + c12 * eu + c22 * ev + c23 * es,
            ss + c13 * eu + c23 * ev + c33 * es,
        ]
    }

    /// Its state at `x`, with the foretold stress if there is any.
    fn local(&self, of: &Elastic, foretold: Option<&[f64; 3]>, x: &[Vec3], compression: f64) -> Local {
        let (u, v) = self.columns(x);
        let response = of.laws[self.cloth as usize].response(metric(&u, &v));
        let stress = foretold.copied().unwrap_or(response.stress);
        let mixed = tension(stress) * (1.0 - compression) + square(stress) * compression;
        Local { u, v, tangent: response.tangent.map(|c| c * self.area), stress: mixed * self.area }
    }
}

impl Hinge {
    fn curvature(&self, x: &[Vec3]) -> Vec3 {
        self.nodes.iter().zip(&self.weights).map(|(&i, w)| x[i as usize] * *w).sum()
    }
}

/// The squares and the product of the images of the rest x and y axes.
fn metric(u: &Vec3, v: &Vec3) -> [f64; 3] {
    [u.norm_squared(), v.norm_squared(), u.dot(v)]
}

/// The stress as a matrix.
fn square([u, v, s]: [f64; 3]) -> Matrix2<f64> {
    Matrix2::new(u, s, s, v)
}

/// The stress with its compressive part taken away.
fn tension([u, v, s]: [f64; 3]) -> Matrix2<f64> {
    let (mean, half) = (0.5 * (u + v), (0.5 * (u - v)).hypot(s));
    let (low, high) = (mean - half, mean + half);
    if low >= 0.0 {
        return Matrix2::new(u, s, s, v);
    }
    if high <= 0.0 || half == 0.0 {
        return Matrix2::zeros();
    }
    // The projector on the direction of the greater principal stress.
    Matrix2::new(u - low, s, s, v - low) * (high / (high - low))
}

fn triangle(sheet: &Sheet, t: usize, cloth: u32) -> Triangle {
    let inverse = sheet.inverse_rest()[t];
    let (b, c) = (inverse.row(0).transpose(), inverse.row(1).transpose());
    Triangle { nodes: sheet.triangles()[t], cloth, shape: [-b - c, b, c], area: sheet.areas()[t] }
}

/// Calibrated hinges, and what takes their false Poisson's ratio out of the border.
fn bending<'r>(
    calibration: &Calibration,
    sheet: &Sheet,
    bend: impl Fn(usize) -> &'r Rigidity,
) -> (Vec<Hinge>, Vec<Border>) {
    let across = |side: &Side| {
        let (r, k) = (&sheet.rest()[side.triangle as usize], side.corner as usize);
        let e = (r[(k + 2) % 3] - r[(k + 1) % 3]).normalize();
        calibration.corrected(bend(side.triangle as usize)).along(&Vector2::new(e.y, -e.x))
    };
    let rigidity = |e: &Edge| Some(0.5 * (across(&e.sides.0) + across(&e.sides.1?)));
    let flaps = flaps(sheet, &Rigidity::uniform(1.0));
    let hinges = flaps.iter().zip(sheet.edges().iter().filter_map(rigidity)).map(|(f, bend)| Hinge {
        nodes: f.vertices,
        weights: f.weights,
        stiffness: calibration.factor * bend * f.slenderness,
    });
    let moment = |t: usize| -calibration.poisson * calibration.factor * 0.5 * (bend(t).warp + bend(t).weft);
    (hinges.collect(), border::borders(sheet, moment))
}

/// What friction between yarns may hold at each hinge; nothing where no cloth has any.
fn frictions<'f>(hinges: &[Hinge], sheet: &Sheet, cloth: impl Fn(usize) -> &'f Fabric) -> Vec<Hold> {
    if hinges.is_empty() || (0..sheet.triangles().len()).all(|t| !cloth(t).has_bending_friction()) {
        return Vec::new();
    }
    // The couple over the rigidity of the side's cloth, across the edge.
    let ratio = |side: &Side| {
        let (r, k) = (&sheet.rest()[side.triangle as usize], side.corner as usize);
        let e = (r[(k + 2) % 3] - r[(k + 1) % 3]).normalize();
        let cloth = cloth(side.triangle as usize);
        let along = |r: Rigidity| r.along(&Vector2::new(e.y, -e.x));
        let rigidity = along(Rigidity::of(cloth));
        if rigidity > 0.0 { along(cloth.bending_friction()) / rigidity } else { 0.0 }
    };
    let both = |e: &Edge| Some(0.5 * (ratio(&e.sides.0) + ratio(&e.sides.1?)));
    let flaps = flaps(sheet, &Rigidity::uniform(1.0));
    let inner = flaps.iter().zip(sheet.edges().iter().filter_map(both));
    inner
        .zip(hinges)
        .map(|((f, ratio), h)| Hold::new(h.stiffness, (f.area / f.slenderness).sqrt(), ratio))
        .collect()
}

#[cfg(test)]
mod tests;
