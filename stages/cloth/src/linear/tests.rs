#![allow(clippy::unwrap_used)]
use nalgebra::Matrix3;

use super::*;
use crate::force::Vec3;

#[test]
fn a_block_counts_on_both_sides_of_the_diagonal() {
    let mut a = BlockMatrix::with_couplings(2, |visit| visit(&[1, 0]));
    let b = Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0);
    a.add(1, 0, &b);
    let x = [Vec3::x(), Vec3::y()];
    assert_eq!(a.times(&x), [b.transpose() * x[1], b * x[0]]);
}
