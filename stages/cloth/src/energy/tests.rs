#![allow(clippy::unwrap_used)]
use super::*;

#[test]
fn gravity_is_linear() {
    let gravity = Gravity { masses: vec![0.1, 0.2], acceleration: Vec3::new(0.0, -9.81, 0.0) };
    let x = [Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 2.0, 3.0)];
    assert!((gravity.value(&x) - 9.81 * 0.5).abs() < 1e-14);
    assert!(gradient_error(&gravity, &x, 1e-3) < 1e-10);
}
