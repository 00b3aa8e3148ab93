//! E4: strips held at two level edges, sagging under their own weight.

use super::reference;
use toile_cloth::energy::{Cloth, Membrane, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{Model, Solver, State, Static};

const SPANS: [f64; 4] = [0.5, 0.8, 0.95, 0.99];
const BETAS: [f64; 2] = [1e-4, 1e-2];
const WIDTH: f64 = 0.2;
/// Rigidity over weight: a bending layer of a few per mille of the length.
const RIGIDITY: f64 = 1e-6;

pub(super) fn errors(models: Models, layout: Layout, along: usize) -> Result<Vec<(String, f64)>, ClothError> {
    let mesh = Rectangle::new(layout, WIDTH, 1.0, along);
    let mut parts = Vec::new();
    // The quadratic law of St Venant-Kirchhoff equals the linear one of the reference only for
    // small beta.
    let betas = if models.membrane == Membrane::StVenantKirchhoff { &BETAS[..1] } else { &BETAS[..] };
    for &beta in betas {
        for span in SPANS {
            let exact = reference::catenary(span, beta);
            let (sag, tension) = hang(models, &mesh, span, beta)?;
            parts.push((format!("sag {span} {beta}"), sag - exact.sag));
            parts.push((format!("tension {span} {beta}"), tension / exact.support - 1.0));
        }
    }
    Ok(parts)
}

/// Sag of the middle and tension at the supports, for L = 1 and weight 1 per area.
fn hang(models: Models, mesh: &Rectangle, span: f64, beta: f64) -> Result<(f64, f64), ClothError> {
    let sheet = mesh.sheet(1.0)?;
    let fabric = Fabric::isotropic(1.0, 1.0 / beta, 0.0, RIGIDITY);
    let held = |v: usize| mesh.at_bottom(v) || mesh.at_top(v);
    let mut model = Model::of(&sheet).pinned(held).under(Vec3::new(0.0, -1.0, 0.0));
    let fixed = model.fixed.clone();
    model = model.made_of(models, &Cloth::of(&sheet, &[&fabric]).holding(&fixed))?;
    let depth = reference::catenary(span, 0.0).sag;
    let start = |p: &nalgebra::Vector2<f64>| Vec3::new(span * p.y, -4.0 * depth * p.y * (1.0 - p.y), p.x);
    let mut state = State::at_rest(mesh.uv.iter().map(start).collect());
    Static::to(1e-8).advance(&model, &mut state)?;
    let forces = model.forces(&state.x);
    let pull: Vec3 = (0..mesh.uv.len()).filter(|&v| mesh.at_bottom(v)).map(|v| forces[v]).sum();
    Ok((middle(mesh, &state.x), pull.norm() / WIDTH))
}

/// Mean depth at half the length: over the vertices there, or a fit through those near.
fn middle(mesh: &Rectangle, x: &[Vec3]) -> f64 {
    let near: Vec<usize> = (0..x.len()).filter(|&v| (mesh.uv[v].y - 0.5).abs() < 0.12).collect();
    // Least squares of depth = a + b s + c s² + d s³ + e s⁴, s from the middle.
    let a =
        nalgebra::DMatrix::from_fn(near.len(), 5, |r, c| (10.0 * (mesh.uv[near[r]].y - 0.5)).powi(c as i32));
    let b = nalgebra::DVector::from_fn(near.len(), |r, _| -x[near[r]].y);
    a.svd(true, true).solve(&b, 1e-12).map_or(f64::NAN, |fit| fit[0])
}
