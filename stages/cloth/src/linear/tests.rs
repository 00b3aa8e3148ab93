#![allow(clippy::unwrap_used)]
use nalgebra::Matrix3;

use super::*;
use crate::stopper::Stopper;
use toile_geometry::Vec3;

#[test]
fn a_block_counts_on_both_sides_of_the_diagonal() {
    let mut a = BlockMatrix::with_couplings(2, |visit| visit(&[1, 0]));
    let b = Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0);
    a.add(1, 0, &b);
    let x = [Vec3::x(), Vec3::y()];
    assert_eq!(a.times(&x), [b.transpose() * x[1], b * x[0]]);
}

/// A chain of masses on springs of random stiffness along random directions, with its diagonal
/// raised: positive definite.
fn chain(n: usize, shift: f64) -> BlockMatrix {
    let mut a = BlockMatrix::with_couplings(n, |visit| {
        (0..n as u32 - 1).for_each(|i| visit(&[i, i + 1]));
        (0..n as u32 - 7).for_each(|i| visit(&[i, i + 7]));
    });
    let mut spring = |i: u32, j: u32, k: f64| {
        let d = Vec3::new((k * 3.7).sin(), (k * 1.3).cos(), 0.3).normalize();
        let h = d * d.transpose() * (1.0 + k.sin().abs());
        a.add(i, i, &h);
        a.add(j, j, &h);
        a.add(i, j, &-h);
    };
    (0..n as u32 - 1).for_each(|i| spring(i, i + 1, f64::from(i)));
    (0..n as u32 - 7).for_each(|i| spring(i + 7, i, f64::from(i) * 0.7));
    a.add_diagonal(std::iter::repeat_n(shift, n));
    a
}

fn load(n: usize) -> Vec<Vec3> {
    (0..n).map(|i| Vec3::new((i as f64).sin(), (i as f64 * 0.3).cos(), 1.0)).collect()
}

#[test]
fn factor_and_iteration_solve_the_same_system() {
    let (a, b) = (chain(200, 0.1), load(200));
    let mut cholesky = Cholesky::analyse(&a).unwrap();
    cholesky.factor(&a).unwrap();
    let direct = cholesky.solve(&b);
    let mut iterated = vec![Vec3::zeros(); 200];
    let report = conjugate_gradients(&a, &b, &mut iterated, 1e-12, 1000, &Stopper::default()).unwrap();
    assert!(report.relative_residual <= 1e-12);
    for ((d, i), (ad, b)) in direct.iter().zip(&iterated).zip(a.times(&direct).iter().zip(&b)) {
        assert!((d - i).norm() < 1e-9 && (ad - b).norm() < 1e-11);
    }
}

#[test]
fn an_indefinite_matrix_is_refused() {
    let a = chain(20, -0.5);
    let error = Cholesky::analyse(&a).unwrap().factor(&a).unwrap_err().to_string();
    assert!(error.starts_with("the stiffness matrix could not be factored"), "{error}");
}

#[test]
fn fixed_rows_stay_put() {
    let (mut a, mut b) = (chain(20, 0.1), load(20));
    let fixed: Vec<bool> = (0..20).map(|i| i % 3 == 0).collect();
    a.fix(&fixed);
    fixed.iter().zip(&mut b).filter(|(f, _)| **f).for_each(|(_, b)| *b = Vec3::zeros());
    let mut cholesky = Cholesky::analyse(&a).unwrap();
    cholesky.factor(&a).unwrap();
    let x = cholesky.solve(&b);
    assert!(fixed.iter().zip(&x).all(|(f, x)| !f || *x == Vec3::zeros()));
}

#[test]
fn a_scalar_factor_solves_the_three_axes_apart() {
    let mut a = BlockMatrix::with_couplings(30, |visit| (0..29).for_each(|i| visit(&[i, i + 1])));
    a.add_diagonal((0..30).map(|i| 2.5 + f64::from(i)));
    (0..29).for_each(|i| a.add(i, i + 1, &-Matrix3::identity()));
    let mut factor = Cholesky::analyse_scalar(&a).unwrap();
    factor.factor(&a).unwrap();
    for (ax, b) in a.times(&factor.solve(&load(30))).iter().zip(&load(30)) {
        assert!((ax - b).norm() < 1e-13);
    }
}

#[test]
fn no_row_of_a_product_is_longer_than_the_sum_of_its_row() {
    let a = chain(30, 0.3);
    let sums = a.row_sums();
    for seed in 0..50 {
        let unit = |i: usize| Vec3::new((i as f64 + seed as f64).sin(), (2.0 * i as f64).cos(), seed as f64);
        let x: Vec<Vec3> = (0..30).map(|i| unit(i).normalize()).collect();
        let y = a.times(&x);
        assert!(y.iter().zip(&sums).all(|(y, sum)| y.norm() <= sum * (1.0 + 1e-12)));
    }
}
