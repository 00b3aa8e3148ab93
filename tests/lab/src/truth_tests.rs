//! What `StaticEquilibrium` reaches on problems with exact answers.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use crate::reference;
use nalgebra::Vector2;
use std::ops::ControlFlow;
use toile_cloth::energy::Vec3;
use toile_cloth::fabric::Fabric;
use toile_cloth::scene::Scene;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::statics::drive::solve::{Precision, StaticEquilibrium};

/// Two strips of length 1 that hang from a bar between them: by symmetry each is clamped level
/// there.
fn over_a_bar(layout: Layout, along: usize, gamma: f64) -> (Scene, Vec<usize>) {
    let half = Rectangle::new(layout, 0.3, 1.0, along);
    let stretch = 2e4_f64.max(2e3 * gamma);
    let mut scene = Scene::new("bar", Fabric::isotropic(1.0, stretch, 0.0, 1.0));
    let first: Vec<usize> = (0..half.uv.len()).filter(|&v| half.at_bottom(v)).collect();
    let mut rest = half.uv.clone();
    // The other half is the mirror image; both share the row on the bar.
    let mirrored: Vec<u32> = (0..half.uv.len())
        .map(|v| {
            if half.at_bottom(v) {
                return v as u32;
            }
            rest.push(Vector2::new(half.uv[v].x, -half.uv[v].y));
            rest.len() as u32 - 1
        })
        .collect();
    let mut triangles = half.triangles.clone();
    triangles.extend(half.triangles.iter().map(|t| [t[0], t[2], t[1]].map(|v| mirrored[v as usize])));
    let positions: Vec<Vec3> = rest.iter().map(|p| Vec3::new(p.y, 0.0, p.x)).collect();
    scene.add_panel("strip", &rest, &positions, &triangles);
    scene.pinned = first.iter().map(|&v| v as u32).collect();
    scene.phases.iter_mut().for_each(|p| p.gravity = Vec3::new(0.0, -gamma, 0.0));
    scene.self_collision = false;
    let tips = (0..half.uv.len()).filter(|&v| half.at_top(v)).collect();
    (scene, tips)
}

/// How far the tips hang below the bar.
fn tip_drop(layout: Layout, along: usize, gamma: f64, precision: Precision) -> f64 {
    let (scene, tips) = over_a_bar(layout, along, gamma);
    // A mesh coarser than the bend folds to a crease on the bar, which holds on finer ones: heavy
    // cloth starts on the finest.
    let coarsest = if gamma > 100.0 { usize::MAX } else { StaticEquilibrium::default().coarsest };
    let rest =
        StaticEquilibrium { speed: 1e-6 * gamma.sqrt(), coarsest, precision, ..StaticEquilibrium::default() };
    let state = rest.solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap();
    -tips.iter().map(|&v| state.positions[v].y).sum::<f64>() / tips.len() as f64
}

#[test]
fn single_precision_of_factors_leaves_the_answer_alone() {
    for gamma in [0.1, 10.0, 1000.0] {
        let [mixed, double] = [Precision::Mixed, Precision::Double]
            .map(|precision| tip_drop(Layout::Irregular(1), 40, gamma, precision));
        assert!((mixed - double).abs() < 1e-5, "{gamma} {mixed} {double}");
    }
}

#[test]
fn a_cantilever_hangs_where_the_elastica_does() {
    for layout in [Layout::Equilateral, Layout::Irregular(1)] {
        for gamma in [0.1, 1.0, 10.0, 100.0, 1000.0] {
            let error = tip_drop(layout, 40, gamma, Precision::Mixed) - reference::cantilever(gamma).drop;
            assert!(error.abs() < 0.005, "{layout:?} {gamma} {error:.5}");
        }
    }
}
