#![allow(clippy::unwrap_used)]
use super::*;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use crate::rest::pattern::Pattern;
use nalgebra::Vector2;

/// The couple over the rigidity, 1/m.
const RATIO: f64 = 40.0;

/// Edge of the square, m.
const EDGE: f64 = 0.01;

/// A square of two triangles with one hinge, of a cloth with friction between its yarns.
fn square() -> (Elastic, Vec<Vector2<f64>>) {
    let cloth = Fabric {
        bending_friction_warp: RATIO * 1e-5,
        bending_friction_weft: RATIO * 1e-5,
        ..Fabric::isotropic(0.1, 1000.0, 0.0, 1e-5)
    };
    let uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vector2::new(x, y) * EDGE);
    let sheet = Sheet::flat(&uv, &[[0, 1, 2], [1, 3, 2]], 0.1).unwrap();
    (Elastic::new(&sheet, &[&cloth], None, |_| 0), uv.to_vec())
}

/// The square folded along its diagonal: the far corner is turned about it.
fn folded(uv: &[Vector2<f64>], angle: f64) -> Vec<Vec3> {
    let mut x: Vec<Vec3> = uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect();
    let middle = (x[1] + x[2]) / 2.0;
    let arm = x[3] - middle;
    x[3] = middle + arm * angle.cos() + Vec3::z() * (arm.norm() * angle.sin());
    x
}

/// The moment of friction at the hinge, N m: what its force does while the far corner turns.
fn moment(elastic: &Elastic, uv: &[Vector2<f64>], angle: f64) -> f64 {
    let x = folded(uv, angle);
    let mut g = vec![Vec3::zeros(); 4];
    elastic.add_gradient_of_holds(&x, &mut g);
    let turn = (folded(uv, angle + 1e-6)[3] - folded(uv, angle - 1e-6)[3]) / 2e-6;
    g[3].dot(&turn)
}

#[test]
fn a_cloth_without_friction_between_its_yarns_holds_nothing() {
    let uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vector2::new(x, y));
    let sheet = Sheet::flat(&uv, &[[0, 1, 2], [1, 3, 2]], 0.1).unwrap();
    let mut elastic = Elastic::new(&sheet, &[&Fabric::isotropic(0.1, 1000.0, 0.0, 1e-5)], None, |_| 0);
    elastic.hold(&folded(&uv, 0.3), false);
    assert!(!elastic.holds());
    assert_eq!(elastic.value_of_holds(&folded(&uv, 0.5)), 0.0);
}

#[test]
fn a_fold_is_held_where_it_was_and_its_moment_nears_the_couple() {
    let (mut elastic, uv) = square();
    elastic.hold(&folded(&uv, 0.2), false);
    let couple = elastic.frictions[0].couple;
    assert!(moment(&elastic, &uv, 0.2).abs() < 1e-6 * couple);
    let [small, more, most] = [0.25, 0.35, 0.6].map(|a| moment(&elastic, &uv, a) / couple);
    assert!(0.0 < small && small < more && more < most && most < 1.0, "{small} {more} {most}");
    assert!(moment(&elastic, &uv, 0.0) < -0.5 * couple);
}

/// The couple of a hinge against its stiffness is that of the cloth: at the angle of a curvature of `RATIO` both are alike.
#[test]
fn the_couple_is_what_stiffness_makes_of_its_curvature() {
    let (elastic, _) = square();
    let (hinge, hold) = (&elastic.hinges[0], &elastic.frictions[0]);
    // A diagonal of a square bends over half of the diagonal.
    let span = EDGE / 2.0_f64.sqrt();
    assert!((hold.couple / hinge.stiffness / (RATIO * span) - 1.0).abs() < 1e-9);
    assert!((hold.soft / (SOFT * RATIO * span) - 1.0).abs() < 1e-9);
}

#[test]
fn a_fold_that_turned_and_was_dragged_along_stays_open_when_it_is_let_go() {
    let (mut elastic, uv) = square();
    elastic.hold(&folded(&uv, 0.0), false);
    elastic.drag(&folded(&uv, 1.0));
    let soft = elastic.frictions[0].soft;
    assert!(
        elastic.held[0] > 0.5 && (moment(&elastic, &uv, 1.0) / elastic.frictions[0].couple - 0.5).abs() < 0.1
    );
    // What has hardly turned is not dragged.
    let held = elastic.held.clone();
    elastic.drag(&folded(&uv, 1.0 - 0.5 * soft));
    assert_eq!(elastic.held, held);
}

#[test]
fn forces_are_the_slope_of_the_potential_where_the_sheet_does_not_stretch() {
    let (mut elastic, uv) = square();
    elastic.hold(&folded(&uv, 0.1), false);
    for angle in [-0.4, 0.05, 0.12, 0.3, 0.9] {
        let value = |a: f64| elastic.value_of_holds(&folded(&uv, a));
        let slope = (value(angle + 1e-5) - value(angle - 1e-5)) / 2e-5;
        let found = moment(&elastic, &uv, angle);
        assert!((slope - found).abs() < 2e-2 * found.abs(), "{angle} {slope} {found}");
    }
}

#[test]
fn the_matrix_is_the_slope_of_the_forces_across_the_sheet() {
    let (mut elastic, uv) = square();
    elastic.hold(&folded(&uv, 0.1), false);
    let pattern = Pattern::new(4, elastic.couplings());
    let x = folded(&uv, 0.0);
    let write = |elastic: &mut Elastic| {
        elastic.bind(&pattern);
        let mut values = vec![Matrix3::zeros(); pattern.blocks()];
        elastic.write_matrix(&x, 0.0, &mut values);
        values
    };
    let with = write(&mut elastic);
    elastic.held.clear();
    let without = write(&mut elastic);
    elastic.hold(&folded(&uv, 0.1), false);
    for node in 0..4 {
        let mut way = vec![Vec3::zeros(); 4];
        way[node].z = 1.0;
        let values: Vec<Matrix3<f64>> = with.iter().zip(&without).map(|(a, b)| a - b).collect();
        let mut product = vec![Vec3::zeros(); 4];
        pattern.multiply_add(&values, &way, &mut product);
        let at = |h: f64| {
            let moved: Vec<Vec3> = x.iter().zip(&way).map(|(p, w)| p + w * h).collect();
            let mut g = vec![Vec3::zeros(); 4];
            elastic.add_gradient_of_holds(&moved, &mut g);
            g
        };
        for ((up, down), p) in at(1e-8).iter().zip(&at(-1e-8)).zip(&product) {
            let slope = (up.z - down.z) / 2e-8;
            assert!((slope - p.z).abs() < 1e-5 * (1.0 + p.z.abs()), "{node} {slope} {}", p.z);
        }
    }
}

/// Folds that a coarser mesh hands on lie along its edges; smoothing spreads them.
#[test]
fn facets_of_a_coarser_mesh_are_held_as_a_curve() {
    let (n, bend) = (16, 2);
    let uv: Vec<Vector2<f64>> =
        (0..=n).flat_map(|i| (0..3).map(move |j| Vector2::new(f64::from(i), f64::from(j)) * EDGE)).collect();
    let at = |i: u32, j: u32| 3 * i + j;
    let triangles: Vec<[u32; 3]> = (0..n as u32)
        .flat_map(|i| {
            (0..2).flat_map(move |j| {
                [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]]
            })
        })
        .collect();
    let sheet = Sheet::flat(&uv, &triangles, 0.1).unwrap();
    let cloth = Fabric { bending_friction_weft: 4e-4, ..Fabric::isotropic(0.1, 1000.0, 0.0, 1e-5) };
    let mut elastic = Elastic::new(&sheet, &[&cloth], None, |_| 0);
    // A polygon of a few sides.
    let faceted: Vec<Vec3> = uv
        .iter()
        .map(|p| {
            let s = p.x / (f64::from(bend) * EDGE);
            let on_circle = |k: f64| Vec3::new(0.1 * (0.4 * k).sin(), p.y, 0.1 * (0.4 * k).cos());
            on_circle(s.floor()) * (1.0 - s.fract()) + on_circle(s.floor() + 1.0) * s.fract()
        })
        .collect();
    let sharpest = |e: &Elastic| e.held().iter().map(|a| a.abs()).fold(0.0, f64::max);
    elastic.hold(&faceted, false);
    let sharp = sharpest(&elastic);
    elastic.hold(&faceted, true);
    assert!(sharpest(&elastic) < 0.8 * sharp, "{} {sharp}", sharpest(&elastic));
}
