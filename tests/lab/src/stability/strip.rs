//! Extremes of one sheet against exact answers: hanging strips, cantilevers, thin triangles,
//! weightless and lone pieces.

use nalgebra::Vector2;

use super::{Case, Check, Must, Verdict};
use crate::reference;
use toile_cloth::solver::layout::{Layout, Rectangle};

use toile_cloth::energy::{Clamp, Cloth, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::{Fabric, Rigidity};
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::{
    CentralDifferences, ImplicitEuler, Model, Projective, Solver, State, Static, Xpbd,
};

/// kg/m².
const DENSITY: f64 = 0.15;
const G: f64 = 9.81;
/// A strip stretched beyond this is named, not shown.
const MOST_STRAIN: f64 = 1.0;
/// Steps of cloth that must stay where it is.
const STILL_STEPS: usize = 10_000;

pub(super) fn checks() -> Vec<Check> {
    let must = Must::Converge;
    let mut checks = Vec::new();
    for k in [1e-2, 1.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7] {
        checks.push(Check::new("stiffness", format!("{k:e} N/m, hanging strip"), must, move || tip(k, 1.0)));
    }
    for d in [0.0, 1e-9, 1e-6, 1e-5, 1e-3, 1.0] {
        checks.push(Check::new("bending", format!("{d:e} N m, cantilever"), must, move || {
            judged(cantilever(d))
        }));
    }
    checks.push(Check::new("time step", "above 2/omega, explicit", Must::Refuse, refused_step));
    checks.push(Check::new("edge", "100 to 2 mm: error falls", must, || judged(refined())));
    checks.push(Check::new("edge", "mm read as m", must, || judged(suspected())));
    for aspect in [1.0, 10.0, 100.0, 1000.0] {
        checks
            .push(Check::new("aspect", format!("{aspect}, rest shape"), must, move || judged(thin(aspect))));
    }
    checks.push(Check::new("aspect", "1e7", Must::Refuse, || match sliver() {
        Err(e @ ClothError::DegenerateTriangle { .. }) => Verdict::Refused(e.to_string()),
        other => Verdict::Failed(format!("{other:?}")),
    }));
    checks.push(Check::new("mass ratio", "1e4, iterations", must, || judged(iterations())));
    checks.push(Check::new("gravity", "0, ten thousand steps", must, || judged(still())));
    checks.push(Check::new("gravity", "100, hanging strip", must, || tip(500.0, 100.0)));
    for loose in [false, true] {
        let name = if loose { "one vertex free" } else { "falling" };
        checks.push(Check::new("one_triangle_panel", name, must, move || judged(one_triangle(loose))));
    }
    checks
}

/// Converged if what `good` says holds.
pub(super) fn judged(result: Result<(bool, String), ClothError>) -> Verdict {
    match result {
        Ok((true, detail)) => Verdict::Converged(detail),
        Ok((false, detail)) => Verdict::Failed(detail),
        Err(e) => Verdict::Failed(e.to_string()),
    }
}

fn fabric(k: f64, d: f64) -> Fabric {
    Fabric::isotropic(DENSITY, k, 0.0, d)
}

fn flat_start(mesh: &Rectangle) -> State {
    State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect())
}

fn cloth(sheet: &Sheet, fabric: &Fabric) -> Result<Model, ClothError> {
    Model::of(sheet).made_of(Models::DEFAULT, &Cloth::of(sheet, &[fabric]))
}

/// Tip displacement over length of a strip of 0.2 m under its own weight, with the sheet and the
/// state.
fn hang(k: f64, edge: f64, gravity: f64) -> Result<(f64, Sheet, State), ClothError> {
    let mesh = Rectangle::new(Layout::Alternating, 4.0 * edge, 0.2, (0.2 / edge).round() as usize);
    let sheet = mesh.sheet(DENSITY)?;
    let mut model = cloth(&sheet, &fabric(k, 1e-9))?.pinned(|v| mesh.at_top(v));
    model.gravity *= gravity;
    let mut state = flat_start(&mesh);
    let weight = DENSITY * G * gravity * 0.2 * 4.0 * edge;
    Static::to(1e-6 * weight).advance(&model, &mut state)?;
    let tip = -state.x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    Ok((tip / 0.2, sheet, state))
}

/// The exact tip displacement over length.
fn exact_tip(k: f64, gravity: f64) -> f64 {
    reference::hanging_linear(DENSITY * G * gravity * 0.2 / k)
}

fn tip(k: f64, gravity: f64) -> Verdict {
    let (tip, sheet, state) = match hang(k, 0.02, gravity) {
        Ok(hung) => hung,
        Err(e) => return Verdict::Failed(e.to_string()),
    };
    let off = tip / exact_tip(k, gravity) - 1.0;
    match sheet.check_strain(&state.x, MOST_STRAIN) {
        Err(e) => Verdict::Refused(e.to_string()),
        Ok(()) if off.abs() < 0.01 => Verdict::Converged(format!("tip off by {off:+.0e}")),
        Ok(()) => Verdict::Failed(format!("tip off by {off:+.2e}")),
    }
}

fn cantilever(d: f64) -> Result<(bool, String), ClothError> {
    let mesh = Rectangle::new(Layout::Equilateral, 0.02, 0.1, 20);
    let sheet = mesh.sheet(DENSITY)?;
    let fabric = fabric(2e3_f64.max(1e7 * d), d);
    let clamp = Clamp { chosen: &|v| mesh.at_bottom(v as usize), outward: &|_| -Vec3::x() };
    let model = Model::of(&sheet)
        .made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]).clamped(clamp))?
        .pinned(|v| mesh.at_bottom(v));
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.y, 0.0, p.x)).collect());
    Static::to(1e-9).advance(&model, &mut state)?;
    let drop = -state.x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min) / 0.1;
    // Softer than the grid can bend it hangs straight down.
    let exact = if d > 1e-8 { reference::cantilever(DENSITY * G * 1e-3 / d).drop } else { 1.0 };
    Ok(((drop - exact).abs() < 0.02, format!("tip {drop:.4} L below, exact {exact:.4}")))
}

fn refused_step() -> Verdict {
    let run = || {
        let mesh = Rectangle::new(Layout::OneDiagonal, 0.2, 0.2, 8);
        let sheet = mesh.sheet(DENSITY)?;
        let (model, mut state) = (cloth(&sheet, &fabric(500.0, 1e-5))?, flat_start(&mesh));
        let limit = CentralDifferences::limit(&model, &state.x);
        CentralDifferences::fixed(1.01 * limit).advance(&model, &mut state)
    };
    match run() {
        Err(e @ ClothError::TimeStepUnstable { .. }) => Verdict::Refused(e.to_string()),
        other => Verdict::Failed(format!("{other:?}")),
    }
}

fn refined() -> Result<(bool, String), ClothError> {
    let mut errors = Vec::new();
    for edge in [0.1, 0.05, 0.02, 0.01, 0.005, 0.002] {
        errors.push((hang(100.0, edge, 1.0)?.0 / exact_tip(100.0, 1.0) - 1.0).abs());
    }
    let falls = errors.windows(2).all(|w| w[1] <= w[0] + 1e-4);
    Ok((falls, errors.iter().map(|e| format!("{e:.0e}")).collect::<Vec<_>>().join(", ")))
}

fn suspected() -> Result<(bool, String), ClothError> {
    let edge =
        |size: f64| Ok(Rectangle::new(Layout::OneDiagonal, size, size, 20).sheet(0.1)?.suspicious_size());
    let (right, wrong) = (edge(0.6)?, edge(600.0)?);
    Ok((
        right.is_none() && wrong.is_some(),
        format!("600 x 600: longest edge {:.0} m is warned of", wrong.unwrap_or(0.0)),
    ))
}

fn thin(aspect: f64) -> Result<(bool, String), ClothError> {
    let square = Rectangle::new(Layout::Alternating, 0.1, 0.1, 6);
    let uv: Vec<Vector2<f64>> = square.uv.iter().map(|p| Vector2::new(p.x, p.y * aspect)).collect();
    let sheet = Sheet::flat(&uv, &square.triangles, DENSITY)?;
    let model = cloth(&sheet, &fabric(500.0, 1e-5))?;
    let mut state = State::at_rest(uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    let mut solver = ImplicitEuler::new(0.01, 1e-6);
    for _ in 0..20 {
        solver.advance(&model, &mut state)?;
    }
    let strain = sheet.greatest_strain(&state.x).1.abs();
    Ok((strain < 1e-9, format!("strain {strain:.0e}")))
}

fn sliver() -> Result<Sheet, ClothError> {
    let corners = [Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Vector2::new(0.5, 1e-7)];
    Sheet::flat(&corners, &[[0, 1, 2]], 0.1)
}

fn iterations() -> Result<(bool, String), ClothError> {
    let of = |ratio: f64| Ok(Case { mass_ratio: ratio, ..Case::default() }.run(10, 10)?.iterations);
    let (even, light): (usize, usize) = (of(1.0)?, of(1e4)?);
    Ok((light <= 10 * even, format!("{light} iterations, {even} with equal masses")))
}

fn still() -> Result<(bool, String), ClothError> {
    let mesh = Rectangle::new(Layout::Irregular(4), 0.2, 0.2, 4);
    let sheet = mesh.sheet(DENSITY)?;
    let model = cloth(&sheet, &fabric(500.0, 1e-5))?.under(Vec3::zeros());
    let solvers: [Box<dyn Solver>; 2] =
        [Box::new(ImplicitEuler::new(0.01, 1e-9)), Box::new(CentralDifferences::adaptive(0.01))];
    let mut farthest: f64 = 0.0;
    for mut solver in solvers {
        let (start, mut state) = (flat_start(&mesh), flat_start(&mesh));
        for _ in 0..STILL_STEPS {
            solver.advance(&model, &mut state)?;
        }
        farthest = state.x.iter().zip(&start.x).map(|(a, b)| (a - b).norm()).fold(farthest, f64::max);
    }
    Ok((farthest < 1e-9, format!("moved {farthest:.0e} m")))
}

/// Free fall of one triangle with every solver that steps; or its free corner falls while two are
/// held.
fn one_triangle(held: bool) -> Result<(bool, String), ClothError> {
    let mesh = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|p| Vector2::new(p[0], p[1]));
    let sheet = Sheet::flat(&mesh, &[[0, 1, 2]], DENSITY)?;
    let fabric = fabric(500.0, 1e-5);
    let model = cloth(&sheet, &fabric)?.pinned(|v| held && v < 2);
    let solvers: [Box<dyn Solver>; 4] = [
        Box::new(ImplicitEuler::new(0.01, 1e-12)),
        Box::new(CentralDifferences::adaptive(0.01)),
        Box::new(Xpbd::new(&sheet, &fabric, 0.01, 10)?),
        Box::new(Projective::new(&sheet, &model, 500.0, &Rigidity::of(&fabric), 0.01, 10)?),
    ];
    let mut worst: f64 = 0.0;
    for mut solver in solvers {
        let mut s = State::at_rest(mesh.iter().map(|p| Vec3::new(p.x, 0.0, p.y)).collect());
        while s.time < 0.1 {
            solver.advance(&model, &mut s)?;
        }
        let off = if held {
            sheet.greatest_strain(&s.x).1.abs()
        } else {
            (s.x[2].y + 0.5 * G * s.time * s.time).abs()
        };
        worst = worst.max(if off.is_nan() { f64::INFINITY } else { off });
    }
    Ok((
        worst < if held { 0.05 } else { 1e-9 },
        format!("{} {worst:.0e}", if held { "strain" } else { "off by m" }),
    ))
}
