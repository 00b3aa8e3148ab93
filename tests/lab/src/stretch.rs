//! E2: strips that hang under their own weight, and strips cut at an angle to the warp.

use nalgebra::{Rotation2, Vector2};

use super::reference::{self, Orthotropic};
use toile_cloth::energy::bending::Hinge;
use toile_cloth::energy::{Cloth, DeadLoad, Membrane, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::{Curve, Fabric};
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{Model, Solver, State, Static};

const ALPHAS: [f64; 3] = [1e-3, 1e-2, 1e-1];
const WIDTH: f64 = 0.3;
const ANGLES: [f64; 7] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0];
/// Strain of the off-axis strips: so small that the law is linear to four digits.
const STRAIN: f64 = 1e-5;

pub(super) fn errors(models: Models, layout: Layout, along: usize) -> Result<Vec<(String, f64)>, ClothError> {
    let mut parts = Vec::new();
    for alpha in ALPHAS {
        let exact = match models.membrane {
            Membrane::StVenantKirchhoff => reference::hanging_stvk(alpha),
            _ => reference::hanging_linear(alpha),
        };
        parts.push((format!("hanging {alpha}"), hanging_tip(models, layout, along, alpha)? / exact - 1.0));
    }
    // An isotropic law cannot be asked for the grain.
    let samples: &[Orthotropic] = match models.membrane {
        Membrane::StVenantKirchhoff => &Orthotropic::SAMPLES[3..],
        _ => &Orthotropic::SAMPLES,
    };
    for o in samples {
        for degrees in ANGLES {
            let e = off_axis(models, layout, along, o, degrees.to_radians())?
                / o.stiffness_at(degrees.to_radians());
            parts.push((format!("E1 {} at {degrees}", o.e1), e - 1.0));
        }
    }
    Ok(parts)
}

/// Tip displacement over length, for L = 1, k = 1, density 1, gravity alpha.
fn hanging_tip(models: Models, layout: Layout, along: usize, alpha: f64) -> Result<f64, ClothError> {
    let mesh = Rectangle::new(layout, WIDTH, 1.0, along);
    let sheet = mesh.sheet(1.0)?;
    let fabric = Fabric::isotropic(1.0, 1.0, 0.0, 0.0);
    let mut model = Model::of(&sheet).pinned(|v| mesh.at_top(v)).under(Vec3::new(0.0, -alpha, 0.0));
    model = steadied(model.with_membrane(models, &Cloth::of(&sheet, &[&fabric]))?, &sheet);
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    Static::to(1e-9 * alpha).advance(&model, &mut state)?;
    let tip: Vec<f64> = (0..mesh.uv.len()).filter(|&v| mesh.at_bottom(v)).map(|v| -state.x[v].y).collect();
    Ok(tip.iter().sum::<f64>() / tip.len() as f64)
}

/// The same with a trace of bending, so that the plane is not left where nothing pulls.
fn steadied(model: Model, sheet: &Sheet) -> Model {
    let trace = Fabric::isotropic(1.0, 1.0, 0.0, 1e-8);
    model.with(Hinge::new(&Cloth::of(sheet, &[&trace])))
}

/// Force per width over mean strain of a strip whose length runs at `angle` to the warp, its ends
/// free to shear.
fn off_axis(
    models: Models,
    layout: Layout,
    along: usize,
    o: &Orthotropic,
    angle: f64,
) -> Result<f64, ClothError> {
    let mesh = Rectangle::new(layout, WIDTH, 1.0, along);
    // Direction 1 is the weft (rest x). The strip's length (mesh y) lies at `angle` to it.
    let turn = Rotation2::new(angle - std::f64::consts::FRAC_PI_2);
    let rest: Vec<Vector2<f64>> = mesh.uv.iter().map(|p| turn * p).collect();
    let sheet = Sheet::flat(&rest, &mesh.triangles, 1.0)?;
    let mut fabric = Fabric::isotropic(1.0, o.e2, 0.0, 0.0);
    (fabric.weft, fabric.shear) = (Curve::linear(o.e1), Curve::linear(o.g));
    fabric.poisson = o.nu12 * o.e2 / o.e1;
    if models.membrane == Membrane::StVenantKirchhoff {
        fabric.poisson = o.nu12;
    }
    let force = o.stiffness_at(angle) * STRAIN;
    let mut model = Model::of(&sheet).pinned(|v| v == 0).under(Vec3::zeros());
    model = steadied(model.with_membrane(models, &Cloth::of(&sheet, &[&fabric]))?, &sheet);
    model = model.with(pull(&mesh, &sheet, force));
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    Static::to(1e-8 * force * WIDTH).advance(&model, &mut state)?;
    Ok(force / mean_strain(&mesh, &sheet, &state.x))
}

/// Equal traction (N/m) on both ends.
fn pull(mesh: &Rectangle, sheet: &Sheet, force: f64) -> DeadLoad {
    let mut forces = vec![Vec3::zeros(); mesh.uv.len()];
    for e in sheet.edges().iter().filter(|e| e.is_boundary()) {
        let [a, b] = e.vertices.map(|v| v as usize);
        let sign = f64::from(u8::from(mesh.at_top(a) && mesh.at_top(b)))
            - f64::from(u8::from(mesh.at_bottom(a) && mesh.at_bottom(b)));
        for v in [a, b] {
            forces[v].y += 0.5 * sign * force * e.rest_length;
        }
    }
    DeadLoad { forces }
}

/// Area-weighted mean of the Green strain along the strip.
fn mean_strain(mesh: &Rectangle, sheet: &Sheet, x: &[Vec3]) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for (t, corners) in sheet.triangles().iter().enumerate() {
        let [a, b, c] = corners.map(|v| mesh.uv[v as usize]);
        // Rest direction of the strip's length in the sheet's own frame.
        let local = nalgebra::Matrix2::from_columns(&[b - a, c - a]).try_inverse();
        let [ra, rb, rc] = sheet.rest()[t];
        let Some(local) = local else { continue };
        let axis = nalgebra::Matrix2::from_columns(&[rb - ra, rc - ra]) * local * Vector2::y();
        let stretched = sheet.deformation(t, x) * axis;
        sum += sheet.areas()[t] * 0.5 * (stretched.norm_squared() - 1.0);
        area += sheet.areas()[t];
    }
    sum / area
}
