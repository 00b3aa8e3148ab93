//! The sheet of a map: what hangs, where it starts, and where it comes to rest.

use super::scheme::Scheme;
use crate::{Models, reference};
use toile_cloth::energy::{Cloth, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{CentralDifferences, Model, Solver, State, Static};

/// Side of the sheet, m.
pub const SIDE: f64 = 0.1;
/// Time that a cell runs, in times of one radian of the slowest swing; motion then has died to a
/// few millionths.
pub const DECAY: f64 = 12.0;
/// kg/m².
const DENSITY: f64 = 0.15;
/// Bending rigidity of a limp cloth, N m.
const BENDING: f64 = 1e-6;
/// m/s².
const GRAVITY: f64 = 9.81;
/// Angle from the vertical at which the sheet is released, rad.
const OUT: f64 = 0.5;
/// The start leaves its plane by this share of an edge, so that nothing is straight by chance.
const NUDGE: f64 = 1e-3;

/// A hung sheet of one edge length and one stiffness.
pub(super) struct Hung {
    pub along: usize,
    /// N/m.
    pub stiffness: f64,
    pub mesh: Rectangle,
    pub sheet: Sheet,
    pub fabric: Fabric,
    pub model: Model,
    /// Held out, not stretched.
    pub start: Vec<Vec3>,
    /// Where it comes to rest.
    pub answer: Vec<Vec3>,
    /// 2/omega_max at the start, s.
    pub limit: f64,
    /// How long it takes to come to rest, s.
    pub time: f64,
}

impl Hung {
    /// With so many edges along its side.
    pub(super) fn new(along: usize, stiffness: f64) -> Result<Self, ClothError> {
        let mesh = Rectangle::new(Layout::Equilateral, SIDE, SIDE, along);
        let sheet = mesh.sheet(DENSITY)?;
        let fabric = Fabric::isotropic(DENSITY, stiffness, 0.0, BENDING);
        let gravity = Vec3::new(0.0, -GRAVITY, 0.0);
        let mut model = Model::of(&sheet).pinned(|v| mesh.at_top(v)).under(gravity);
        let fixed = model.fixed.clone();
        model = model.made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]).holding(&fixed))?;
        let rate = reference::hanging_omega(1) * (GRAVITY / SIDE).sqrt();
        model.drag = 2.0 * rate;
        let mut hanging = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y - SIDE, 0.0)).collect());
        Static::to(1e-8 * weight(&model)).advance(&model, &mut hanging)?;
        let start = held_out(&mesh);
        let limit = CentralDifferences::limit(&model, &start);
        let (answer, time) = (hanging.x, DECAY / rate);
        Ok(Self { along, stiffness, mesh, sheet, fabric, model, start, answer, limit, time })
    }

    /// Mean edge length, m.
    pub(super) fn edge(&self) -> f64 {
        let edges = self.sheet.edges();
        edges.iter().map(|e| e.rest_length).sum::<f64>() / edges.len() as f64
    }

    /// N.
    pub(super) fn weight(&self) -> f64 {
        weight(&self.model)
    }

    /// Greatest distance of a vertex from where it comes to rest, in lengths of the sheet.
    pub(super) fn error(&self, x: &[Vec3]) -> f64 {
        farthest(x, &self.answer) / SIDE
    }

    /// For the bar.
    pub(super) fn name(&self, scheme: Scheme, dt: Option<f64>) -> String {
        let step = dt.map_or(String::new(), |dt| format!(", step {dt:.1e} s"));
        format!("{}, edge {:.1} mm, {:.3} N/m{step}", scheme.name(), 1e3 * self.edge(), self.stiffness)
    }
}

fn weight(model: &Model) -> f64 {
    GRAVITY * model.masses.iter().sum::<f64>()
}

/// Turned about the upper edge, and waved a little.
fn held_out(mesh: &Rectangle) -> Vec<Vec3> {
    let edge = mesh.size.y / (mesh.uv.len() as f64).sqrt();
    let wave = |v: usize| if mesh.at_top(v) { 0.0 } else { NUDGE * edge * (1.7 * v as f64).sin() };
    let out = |v: usize| {
        let (p, along) = (mesh.uv[v], mesh.uv[v].y - mesh.size.y);
        Vec3::new(p.x, along * OUT.cos(), wave(v) - along * OUT.sin())
    };
    (0..mesh.uv.len()).map(out).collect()
}

/// Greatest distance of a pair of places, m; infinite where it is no number.
pub(super) fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).norm());
    apart.fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
}
