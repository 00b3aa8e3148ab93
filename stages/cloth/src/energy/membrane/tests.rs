#![allow(clippy::unwrap_used)]
use nalgebra::{Matrix2, Vector2};
use proptest::prelude::*;

use super::*;
use crate::energy::{Cloth, Energy, Vec3, gradient_error, hessian_error};
use crate::fabric::{Curve, Fabric};
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
        Box::new(Springs::new(&Cloth::of(&s, &[&fabric()]))),
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
    // f = (1 + 1e-6, 2e-6; 1e-6, 1 - 3e-6).
    let metric = [(1.0_f64 + 1e-6).powi(2) + 1e-12, (1.0_f64 - 3e-6).powi(2) + 4e-12, 3e-6 - 5e-12];
    for (one, other) in woven.stress(metric).iter().zip(stvk.stress(metric)) {
        assert!((one - other).abs() < 1e-5 * k * 4e-6, "{one} {other}");
    }
}

/// A yarn pressed to 0.48 of its length: the law keeps its slopes from there on, and is the slope
/// of its own energy.
#[test]
fn beyond_the_limit_of_the_law_the_stress_is_still_the_slope_of_the_energy() {
    let law = Woven::new(&fabric()).unwrap();
    let metric = [0.48_f64.powi(2), 1.1, 0.1];
    let stress = law.stress(metric);
    let slope = |k: usize| {
        let at = |h: f64| law.density(std::array::from_fn(|i| metric[i] + if i == k { h } else { 0.0 }));
        (at(1e-7) - at(-1e-7)) / 2e-7
    };
    // E11 = (u.u - 1) / 2, and the third strain is u.v itself.
    for (k, wanted) in [2.0 * slope(0), 2.0 * slope(1), slope(2)].into_iter().enumerate() {
        assert!((stress[k] - wanted).abs() < 1e-5 * (1.0 + wanted.abs()), "{k}: {} {wanted}", stress[k]);
    }
}

/// Smallest eigenvalue of the 3 x 3 tangent relative to the largest.
fn lowest(law: &impl Law, f: &Matrix2<f64>) -> f64 {
    let c = f.tr_mul(f);
    let [t11, t22, t33, t12, t13, t23] = law.response([c[(0, 0)], c[(1, 1)], c[(0, 1)]], false).tangent;
    let m = nalgebra::Matrix3::new(t11, t12, t13, t12, t22, t23, t13, t23, t33);
    let e = nalgebra::SymmetricEigen::new(m).eigenvalues;
    e.min() / e.amax()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn projected_tangents_are_positive(a in prop::array::uniform4(-1.5..1.5f64)) {
        let f = Matrix2::from_row_slice(&a);
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
