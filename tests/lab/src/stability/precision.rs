//! Extremes of arithmetic: what single precision changes.

use super::strip::judged;
use super::{Check, Must, Verdict};
use std::ops::ControlFlow;
use toile_cloth::energy::{Cloth, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::scene::Scene;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{Model, Solver, State, Static};
use toile_cloth::statics::drive::solve::{Precision, StaticEquilibrium, StaticsError};

const DENSITY: f64 = 0.15;
/// Length of the strip, m.
const LENGTH: f64 = 0.4;
/// What single precision may change, in lengths: 6e-8 times the condition of a hanging strip.
const ROUNDED: f64 = 1e-5;

pub(super) fn checks() -> Vec<Check> {
    let check = |value: &str, run: fn() -> Verdict| Check::new("f32_vs_f64", value, Must::Converge, run);
    vec![
        check("input rounded to f32", || judged(rounded())),
        check("factors of Rest", || match factors() {
            Ok(verdict) => judged(Ok(verdict)),
            Err(e) => Verdict::Failed(e.to_string()),
        }),
    ]
}

fn fabric() -> Fabric {
    Fabric::isotropic(DENSITY, 500.0, 0.0, 1e-5)
}

fn strip() -> Rectangle {
    Rectangle::new(Layout::Irregular(3), 0.1, LENGTH, 16)
}

fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / LENGTH
}

/// What single precision of all input changes in the answer.
fn rounded() -> Result<(bool, String), ClothError> {
    let rest = |narrow: bool| {
        let mut mesh = strip();
        if narrow {
            mesh.uv.iter_mut().for_each(|p| *p = p.map(|c| f64::from(c as f32)));
        }
        let sheet = mesh.sheet(if narrow { f64::from(DENSITY as f32) } else { DENSITY })?;
        let top: Vec<bool> = mesh.uv.iter().map(|p| p.y > LENGTH - 1e-6).collect();
        let model =
            Model::of(&sheet).made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric()]))?.pinned(|v| top[v]);
        let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
        Static::to(1e-10).advance(&model, &mut state)?;
        Ok(state.x)
    };
    let apart = apart(&rest(false)?, &rest(true)?);
    Ok((apart < ROUNDED, format!("rounding the input to f32 moves the answer by {apart:.0e} lengths")))
}

/// What single precision of factors changes in the answer of `StaticEquilibrium`: a strip held
/// level that falls and hangs.
fn factors() -> Result<(bool, String), StaticsError> {
    let mesh = strip();
    let level: Vec<Vec3> = mesh.uv.iter().map(|p| Vec3::new(p.x, 0.0, p.y)).collect();
    let mut scene = Scene::new("strip", fabric());
    scene.add_panel("strip", &mesh.uv, &level, &mesh.triangles);
    scene.pinned = (0..mesh.uv.len() as u32).filter(|&v| mesh.uv[v as usize].y > LENGTH - 1e-6).collect();
    scene.self_collision = false;
    let rest = |precision| {
        let rest = StaticEquilibrium { speed: 1e-6, precision, ..StaticEquilibrium::default() };
        rest.solve(&scene, &mut |_, _| ControlFlow::Continue(())).map(|state| state.positions)
    };
    let apart = apart(&rest(Precision::Double)?, &rest(Precision::Mixed)?);
    Ok((apart < ROUNDED, format!("factors of single precision move the answer by {apart:.0e} lengths")))
}
