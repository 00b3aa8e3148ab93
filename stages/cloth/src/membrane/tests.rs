#![allow(clippy::unwrap_used)]
use nalgebra::{Matrix3x2, Vector2};
use proptest::prelude::*;

use super::*;
use crate::fabric::{Curve, Fabric};
use crate::force::{Energy, Vec3, gradient_error, hessian_error};
use crate::mesh::Sheet;

fn sheet() -> (Sheet, Vec<Vec3>) {
    let uv = [[0.0, 0.0], [0.1, 0.01], [0.12, 0.09], [-0.01, 0.1]].map(|p| Vector2::new(p[0], p[1]));
    let bent = [[0.0, 0.0, 0.0], [0.11, 0.0, 0.01], [0.11, 0.1, 0.03], [0.0, 0.09, -0.02]].map(Vec3::from);
    (Sheet::flat(&uv, &[[0, 1, 2], [0, 2, 3]], 0.2).unwrap(), bent.to_vec())
}

fn fabric() -> Fabric {
    let mut f = Fabric::isotropic(0.2, 900.0, 0.2, 0.0);
    f.weft = Curve::through(&[[0.02, 10.0], [0.5, 900.0]]).unwrap();
    f.shear = Curve::linear(80.0);
    f
}

fn models() -> Vec<Box<dyn Energy>> {
    let (s, _) = sheet();
    vec![
        Box::new(Triangles::new(&s, StVenantKirchhoff::new(500.0, 0.3).unwrap())),
        Box::new(Triangles::new(&s, Woven::new(&fabric()).unwrap())),
        Box::new(Springs::new(&s, &fabric()).unwrap()),
    ]
}

#[test]
fn derivatives_agree_with_differences() {
    let (_, x) = sheet();
    for m in models() {
        assert!(gradient_error(&*m, &x, 1e-6) < 1e-6, "{} gradient", m.name());
        assert!(hessian_error(&*m, &x, 1e-6) < 1e-6, "{} Hessian", m.name());
    }
}

#[test]
fn rest_shape_has_no_force_and_no_energy() {
    let (s, _) = sheet();
    let flat: Vec<Vec3> = [[0.0, 0.0], [0.1, 0.01], [0.12, 0.09], [-0.01, 0.1]]
        .map(|p| Vec3::new(0.3 + p[0], 7.0, p[1]))
        .to_vec();
    assert_eq!(s.vertex_count(), 4);
    for m in models() {
        let mut g = vec![Vec3::zeros(); 4];
        m.add_gradient(&flat, &mut g);
        assert!(m.value(&flat) < 1e-25 && g.iter().all(|v| v.norm() < 1e-10), "{}", m.name());
    }
}

#[test]
fn woven_equals_linear_elasticity_in_small_strain() {
    let (k, nu) = (500.0, 0.3);
    let woven = Woven::orthotropic(k, k, nu, k / (2.0 * (1.0 + nu))).unwrap();
    let stvk = StVenantKirchhoff::new(k, nu).unwrap();
    let f = Matrix3x2::new(1.0 + 1e-6, 2e-6, 1e-6, 1.0 - 3e-6, 0.0, 0.0);
    assert!((woven.stress(&f) - stvk.stress(&f)).norm() < 1e-5 * stvk.stress(&f).norm());
}

/// Smallest eigenvalue of the 6 x 6 tangent relative to the largest.
fn lowest(law: &dyn Law, f: &Matrix3x2<f64>) -> f64 {
    let t = law.tangent(f, crate::force::Projection::PositiveSemiDefinite);
    let m = nalgebra::Matrix6::from_fn(|r, c| t[r / 3][c / 3][(r % 3, c % 3)]);
    let e = nalgebra::SymmetricEigen::new(m).eigenvalues;
    e.min() / e.amax()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn projected_tangents_are_positive(a in prop::array::uniform6(-1.5..1.5f64)) {
        let f = Matrix3x2::from_row_slice(&a);
        prop_assert!(lowest(&StVenantKirchhoff::new(500.0, 0.3).unwrap(), &f) > -1e-12);
        prop_assert!(lowest(&Woven::new(&fabric()).unwrap(), &f) > -1e-9);
    }

    #[test]
    fn energy_does_not_see_rigid_motion(r in prop::array::uniform3(-3.0..3.0f64), t in prop::array::uniform3(-9.0..9.0f64)) {
        let (_, x) = sheet();
        let turn = nalgebra::Rotation3::new(Vec3::from(r));
        let moved: Vec<Vec3> = x.iter().map(|p| turn * p + Vec3::from(t)).collect();
        for m in models() {
            prop_assert!((m.value(&moved) / m.value(&x) - 1.0).abs() < 1e-9);
        }
    }
}
