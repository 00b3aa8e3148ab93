//! E1: a strip clamped level at one end, over four decades of weight against stiffness.

use super::reference;
use toile_cloth::energy::{Clamp, Cloth, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{Model, Solver, State, Static};

const GAMMAS: [f64; 5] = [0.1, 1.0, 10.0, 100.0, 1000.0];
/// Strip width in lengths.
const WIDTH: f64 = 0.3;
/// Stretch stiffness over weight: elongation well below the error looked for.
const STIFFNESS_OVER_WEIGHT: f64 = 2000.0;
/// Stretch over bending stiffness in the light cases.
const LEAST_STIFFNESS: f64 = 2e4;

pub(super) fn errors(models: Models, layout: Layout, along: usize) -> Result<Vec<(String, f64)>, ClothError> {
    let mesh = Rectangle::new(layout, WIDTH, 1.0, along);
    GAMMAS
        .iter()
        .map(|&gamma| {
            let drop = tip_drop(models, &mesh, gamma)?;
            Ok((format!("Gamma {gamma}"), drop - reference::cantilever(gamma).drop))
        })
        .collect()
}

/// Mean drop of the tip edge, for L = 1, D = 1, density 1 and gravity Gamma.
fn tip_drop(models: Models, mesh: &Rectangle, gamma: f64) -> Result<f64, ClothError> {
    let sheet = mesh.sheet(1.0)?;
    let fabric = Fabric::isotropic(1.0, LEAST_STIFFNESS.max(STIFFNESS_OVER_WEIGHT * gamma), 0.0, 1.0);
    let mut model = Model::of(&sheet).pinned(|v| mesh.at_bottom(v)).under(Vec3::new(0.0, -gamma, 0.0));
    let held = Clamp { chosen: &|v| mesh.at_bottom(v as usize), outward: &|_| -Vec3::x() };
    let fixed = model.fixed.clone();
    model = model.made_of(models, &Cloth::of(&sheet, &[&fabric]).holding(&fixed).clamped(held))?;
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.y, 0.0, p.x)).collect());
    Static::to(1e-7 * gamma).advance(&model, &mut state)?;
    let tip: Vec<f64> = (0..mesh.uv.len()).filter(|&v| mesh.at_top(v)).map(|v| -state.x[v].y).collect();
    Ok(tip.iter().sum::<f64>() / tip.len() as f64)
}
