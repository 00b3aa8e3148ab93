//! The static solver with each model of membrane and bending.
#![allow(clippy::unwrap_used, clippy::panic)]
use super::tests::deepest;
use super::*;
use crate::energy::Models;
use crate::energy::{Bending, Membrane};
use crate::scene::{StrainLimit, generate};
use std::ops::ControlFlow;
use toile_geometry::Vec3;

const MEMBRANES: [Membrane; 3] = [Membrane::Woven, Membrane::StVenantKirchhoff, Membrane::Springs];
const BENDINGS: [Bending; 4] = [Bending::Quadratic, Bending::Hinge, Bending::DiscreteShell, Bending::SkipOne];

fn with(models: Models, scene: &Scene) -> Result<Equilibrium, StaticsError> {
    StaticEquilibrium { models, ..StaticEquilibrium::default() }
        .solve(scene, &mut |_, _| ControlFlow::Continue(()))
}

#[test]
fn any_membrane_and_any_bending_come_to_rest_on_a_ball_and_each_in_its_own_way() {
    let scene = generate::drape(12);
    let mut seen: Vec<(String, Vec<Vec3>)> = Vec::new();
    for models in MEMBRANES.iter().flat_map(|&m| BENDINGS.map(|bending| Models { membrane: m, bending })) {
        let state = with(models, &scene).unwrap_or_else(|e| panic!("{}: {e}", models.name()));
        assert!(deepest(&scene, &state.positions) < 1e-4, "{}", models.name());
        for (name, other) in &seen {
            assert!(*other != state.positions, "{} is {name}", models.name());
        }
        seen.push((models.name(), state.positions));
    }
}

/// Three models of bending that mean the same rigidity hang a strip alike.
#[test]
fn models_of_the_same_rigidity_agree_where_the_mesh_carries_the_folds() {
    let scene = generate::hang(12);
    let lowest = |bending| {
        let state = with(Models { bending, ..Models::STATIC }, &scene).unwrap();
        state.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min)
    };
    let [one, two, three] = [Bending::Quadratic, Bending::Hinge, Bending::DiscreteShell].map(lowest);
    let size = scene.rest.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    assert!((one - two).abs() < 0.01 * size && (one - three).abs() < 0.01 * size, "{one} {two} {three}");
}

#[test]
fn a_strain_limit_is_refused_by_a_membrane_that_knows_none() {
    let limit = Some(StrainLimit { warp: 0.1, weft: 0.1 });
    let scene = Scene { strain_limit: limit, ..generate::hang(4) };
    let models = Models { membrane: Membrane::Springs, ..Models::STATIC };
    let error = with(models, &scene).unwrap_err().to_string();
    assert_eq!(error, "strain limit = 0.1 is out of range: only the membrane Woven keeps one");
}
