#![allow(clippy::unwrap_used)]
use super::*;

#[test]
fn gravity_is_linear() {
    let gravity = Gravity { masses: vec![0.1, 0.2], acceleration: Vec3::new(0.0, -9.81, 0.0) };
    let x = [Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 2.0, 3.0)];
    assert!((gravity.value(&x) - 9.81 * 0.5).abs() < 1e-14);
    assert!(gradient_error(&gravity, &x, 1e-3) < 1e-10);
}

#[test]
fn the_seam_force_grows_with_the_gap() {
    let seam = SeamSprings::new(vec![[0, 1]], 40.0);
    let x = [Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.1, 1.0, 0.0)];
    assert!((seam.value(&x) - 0.5 * 40.0 * 0.01).abs() < 1e-12);
    let mut gradient = [Vec3::zeros(); 2];
    seam.add_gradient(&x, &mut gradient);
    assert!((gradient[0] + Vec3::x() * 4.0).norm() < 1e-12, "the first is pulled towards the second");
    assert!(gradient_error(&seam, &x, 1e-4) < 1e-8);
    assert!(hessian_error(&seam, &x, 1e-4) < 1e-8);
}
