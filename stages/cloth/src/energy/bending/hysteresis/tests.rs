#![allow(clippy::unwrap_used)]
use super::*;
use crate::energy::{Energy, matrix_of, write_matrix};
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use nalgebra::Vector2;

/// The couple over the rigidity, 1/m.
const RATIO: f64 = 40.0;

/// Edge of the square, m.
const EDGE: f64 = 0.01;

/// A square of two triangles with one hinge, of a cloth with friction between its yarns.
fn square() -> (Assembled<4, Hysteresis>, Vec<Vector2<f64>>) {
    let cloth = Fabric {
        bending_friction_warp: RATIO * 1e-5,
        bending_friction_weft: RATIO * 1e-5,
        ..Fabric::isotropic(0.1, 1000.0, 0.0, 1e-5)
    };
    let uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vector2::new(x, y) * EDGE);
    let sheet = Sheet::flat(&uv, &[[0, 1, 2], [1, 3, 2]], 0.1).unwrap();
    (Hysteresis::new(&Cloth::of(&sheet, &[&cloth])).unwrap(), uv.to_vec())
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
fn moment(held: &Assembled<4, Hysteresis>, uv: &[Vector2<f64>], angle: f64) -> f64 {
    let x = folded(uv, angle);
    let mut g = vec![Vec3::zeros(); 4];
    held.add_gradient(&x, &mut g);
    let turn = (folded(uv, angle + 1e-6)[3] - folded(uv, angle - 1e-6)[3]) / 2e-6;
    g[3].dot(&turn)
}

#[test]
fn a_cloth_without_friction_between_its_yarns_holds_nothing() {
    let uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vector2::new(x, y));
    let sheet = Sheet::flat(&uv, &[[0, 1, 2], [1, 3, 2]], 0.1).unwrap();
    assert!(Hysteresis::new(&Cloth::of(&sheet, &[&Fabric::isotropic(0.1, 1000.0, 0.0, 1e-5)])).is_none());
    let (held, uv) = square();
    assert_eq!(held.value(&folded(&uv, 0.5)), 0.0, "nothing is held before somebody says where");
}

#[test]
fn a_fold_is_held_where_it_was_and_its_moment_nears_the_couple() {
    let (mut elastic, uv) = square();
    elastic.0.hold(&folded(&uv, 0.2));
    let couple = elastic.0.holds[0].couple;
    assert!(moment(&elastic, &uv, 0.2).abs() < 1e-6 * couple);
    let [small, more, most] = [0.25, 0.35, 0.6].map(|a| moment(&elastic, &uv, a) / couple);
    assert!(0.0 < small && small < more && more < most && most < 1.0, "{small} {more} {most}");
    assert!(moment(&elastic, &uv, 0.0) < -0.5 * couple);
}

/// The couple of a hinge against its stiffness is that of the cloth: at the angle of a curvature of
/// `RATIO` both are alike.
#[test]
fn the_couple_is_what_stiffness_makes_of_its_curvature() {
    let (elastic, _) = square();
    let hold = &elastic.0.holds[0];
    // A diagonal of a square bends over half of the diagonal.
    let span = EDGE / 2.0_f64.sqrt();
    assert!((hold.couple / hold.fold.stiffness / (RATIO * span) - 1.0).abs() < 1e-9);
    assert!((hold.tolerance / (SLIP_TOLERANCE * RATIO * span) - 1.0).abs() < 1e-9);
}

#[test]
fn a_fold_that_turned_and_was_dragged_along_stays_open_when_it_is_released() {
    let (mut elastic, uv) = square();
    elastic.0.hold(&folded(&uv, 0.0));
    elastic.0.drag(&folded(&uv, 1.0));
    let tolerance = elastic.0.holds[0].tolerance;
    assert!(
        elastic.0.held[0] > 0.5 && (moment(&elastic, &uv, 1.0) / elastic.0.holds[0].couple - 0.5).abs() < 0.1
    );
    // What has hardly turned is not dragged.
    let held = elastic.0.held.clone();
    elastic.0.drag(&folded(&uv, 1.0 - 0.5 * tolerance));
    assert_eq!(elastic.0.held, held);
}

#[test]
fn forces_are_the_slope_of_the_potential_where_the_sheet_does_not_stretch() {
    let (mut elastic, uv) = square();
    elastic.0.hold(&folded(&uv, 0.1));
    for angle in [-0.4, 0.05, 0.12, 0.3, 0.9] {
        let value = |a: f64| elastic.value(&folded(&uv, a));
        let slope = (value(angle + 1e-5) - value(angle - 1e-5)) / 2e-5;
        let found = moment(&elastic, &uv, angle);
        assert!((slope - found).abs() < 2e-2 * found.abs(), "{angle} {slope} {found}");
    }
}

#[test]
fn the_matrix_is_the_slope_of_the_forces_across_the_sheet() {
    let (mut elastic, uv) = square();
    elastic.0.hold(&folded(&uv, 0.1));
    let x = folded(&uv, 0.0);
    let (mut matrix, places) = matrix_of(4, &[&elastic]);
    write_matrix(&[&elastic], &places, &x, Projection::PositiveSemiDefinite, &mut matrix);
    for node in 0..4 {
        let mut way = vec![Vec3::zeros(); 4];
        way[node].z = 1.0;
        let product = matrix.times(&way);
        let at = |h: f64| {
            let moved: Vec<Vec3> = x.iter().zip(&way).map(|(p, w)| p + w * h).collect();
            let mut g = vec![Vec3::zeros(); 4];
            elastic.add_gradient(&moved, &mut g);
            g
        };
        for ((up, down), p) in at(1e-8).iter().zip(&at(-1e-8)).zip(&product) {
            let slope = (up.z - down.z) / 2e-8;
            assert!((slope - p.z).abs() < 1e-5 * (1.0 + p.z.abs()), "{node} {slope} {}", p.z);
        }
    }
}
