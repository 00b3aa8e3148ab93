//! E3: square plates under a small uniform load; their centre does not depend on the Poisson's
//! ratio of bending.

use nalgebra::{DMatrix, DVector};

use super::reference;
use toile_cloth::energy::{Clamp, Cloth, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{Model, Solver, State, Static};

/// Centre deflection in plate sides: so small that the membrane stays idle.
const DEFLECTION: f64 = 1e-4;
/// Vertices in the fit that reads the centre.
const FITTED: usize = 12;

pub(super) fn errors(models: Models, layout: Layout, along: usize) -> Result<Vec<(String, f64)>, ClothError> {
    let mesh = Rectangle::new(layout, 1.0, 1.0, along);
    let clamped = deflection(models, &mesh, true, reference::clamped_plate()?)?;
    let supported = deflection(models, &mesh, false, reference::supported_plate())?;
    Ok(vec![("clamped".into(), clamped - 1.0), ("supported".into(), supported - 1.0)])
}

/// Centre deflection over the exact one, for side 1 and D = 1.
fn deflection(models: Models, mesh: &Rectangle, clamped: bool, coefficient: f64) -> Result<f64, ClothError> {
    let load = DEFLECTION / coefficient;
    let sheet = mesh.sheet(1.0)?;
    let fabric = Fabric::isotropic(1.0, 1e4, 0.0, 1.0);
    let mut model = Model::of(&sheet).pinned(|v| mesh.on_border(v)).under(Vec3::new(0.0, 0.0, -load));
    let held = Clamp { chosen: &|v| mesh.on_border(v as usize), outward: &|v| outward(mesh, v as usize) };
    let fixed = model.fixed.clone();
    model = model
        .made_of(models, &Cloth::of(&sheet, &[&fabric]).holding(&fixed).clamped(clamped.then_some(held)))?;
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    Static::to(1e-7 * load).advance(&model, &mut state)?;
    Ok(centre(mesh, &state.x) / DEFLECTION)
}

/// Any direction in the plane away from the plate, with a part across each border that the vertex
/// may belong to.
fn outward(mesh: &Rectangle, v: usize) -> Vec3 {
    let p = mesh.uv[v] - 0.5 * mesh.size;
    Vec3::new(p.x, p.y, 0.0).normalize()
}

/// Depth at the centre by a quadratic fit through the nearest vertices.
fn centre(mesh: &Rectangle, x: &[Vec3]) -> f64 {
    let from_centre = |v: usize| mesh.uv[v] - 0.5 * mesh.size;
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| from_centre(a).norm().total_cmp(&from_centre(b).norm()));
    let near = &order[..FITTED.min(order.len())];
    let a = DMatrix::from_fn(near.len(), 6, |r, c| {
        let p = from_centre(near[r]);
        [1.0, p.x, p.y, p.x * p.x, p.y * p.y, p.x * p.y][c]
    });
    let b = DVector::from_fn(near.len(), |r, _| -x[near[r]].z);
    a.svd(true, true).solve(&b, 1e-12).map_or(f64::NAN, |fit| fit[0])
}
