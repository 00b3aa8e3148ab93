#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::*;
use crate::energy::{Cloth, Models};
use crate::fabric::{Curve, Fabric};
use crate::mesh::Sheet;
use nalgebra::Vector2;
use proptest::prelude::*;

fn patch() -> (Sheet, Vec<Vec3>) {
    let uv =
        [[0.0, 0.0], [0.1, 0.01], [0.02, 0.12], [0.13, 0.11], [0.05, 0.22]].map(|[x, y]| Vector2::new(x, y));
    let sheet = Sheet::flat(&uv, &[[0, 1, 2], [1, 3, 2], [2, 3, 4]], 0.1).unwrap();
    let bend = |(k, p): (usize, &Vector2<f64>)| {
        Vec3::new(p.x * 1.03, 0.4 * p.y * p.y + 0.01 * (k as f64).sin(), p.y)
    };
    (sheet, uv.iter().enumerate().map(bend).collect())
}

/// Curves with breaks, warp and weft apart, Poisson's ratio, bending in both directions.
fn measured() -> Fabric {
    Fabric {
        warp: Curve::through(&[[0.02, 5.0], [0.05, 40.0]]).unwrap(),
        weft: Curve::through(&[[0.03, 4.0], [0.3, 90.0]]).unwrap(),
        shear: Curve::through(&[[0.1, 3.0], [0.4, 30.0]]).unwrap(),
        bending_warp: 2e-2,
        bending_weft: 1e-2,
        ..Fabric::isotropic(0.1, 1.0, 0.1, 0.0)
    }
}

/// The models of the static solver on a sheet of one fabric.
fn elastic(sheet: &Sheet, fabric: &Fabric) -> Elastic {
    Elastic::new(Models::STATIC, &Cloth::of(sheet, &[fabric]), vec![], &[]).unwrap()
}

fn gradient(elastic: &Elastic, x: &[Vec3]) -> Vec<Vec3> {
    let mut g = vec![Vec3::zeros(); x.len()];
    elastic.add_gradient(x, &mut g);
    g
}

/// Holds every component of the gradient against central differences of the energy.
fn assert_gradient_is_the_slope(elastic: &Elastic, x: &mut [Vec3]) {
    let gradient = gradient(elastic, x);
    for i in 0..x.len() {
        for c in 0..3 {
            let (h, at) = (1e-6, x[i][c]);
            x[i][c] = at + h;
            let up = elastic.value(x);
            x[i][c] = at - h;
            let down = elastic.value(x);
            x[i][c] = at;
            let (slope, found) = ((up - down) / (2.0 * h), gradient[i][c]);
            assert!((slope - found).abs() < 1e-6 * (1.0 + slope.abs()), "{i} {c}: {slope} {found}");
        }
    }
}

#[test]
fn the_gradient_is_the_slope_of_the_energy() {
    let (sheet, mut x) = patch();
    let elastic = elastic(&sheet, &measured());
    assert_gradient_is_the_slope(&elastic, &mut x);
}

#[test]
fn under_tension_the_matrix_is_the_slope_of_the_gradient() {
    // Little shear: its curvature is what the matrix leaves out.
    let (sheet, mut x) = patch();
    let fabric = Fabric { shear: Curve::linear(1e-12), ..measured() };
    x.iter_mut().for_each(|p| *p *= 1.2);
    let mut elastic = elastic(&sheet, &fabric);
    let pattern = Pattern::new(x.len(), |visit| elastic.couplings(visit));
    elastic.bind(&pattern);
    let mut values = vec![Matrix3::zeros(); pattern.blocks()];
    elastic.write_matrix(&x, 0.0, &mut values);
    let push: Vec<Vec3> =
        (0..x.len()).map(|i| Vec3::new(i as f64, 2.0 * i as f64, 1.0).map(f64::sin)).collect();
    let mut product = vec![Vec3::zeros(); x.len()];
    pattern.multiply_add(&values, &push, &mut product);
    let h = 1e-6;
    let at = |s: f64| {
        let moved: Vec<Vec3> = x.iter().zip(&push).map(|(p, d)| p + d * s).collect();
        gradient(&elastic, &moved)
    };
    for ((up, down), want) in at(h).iter().zip(&at(-h)).zip(&product) {
        assert!(((up - down) / (2.0 * h) - want).norm() < 1e-4 * (1.0 + want.norm()), "{want}");
    }
}

/// The sheet's own weights leave a flat sheet alone, wherever it lies.
#[test]
fn a_flat_sheet_bends_nowhere() {
    let (sheet, _) = patch();
    let stiff = Fabric {
        warp: Curve::linear(1e-12),
        weft: Curve::linear(1e-12),
        shear: Curve::linear(1e-12),
        ..measured()
    };
    let elastic = elastic(&sheet, &stiff);
    let mut flat = vec![Vec3::zeros(); 5];
    for (t, rest) in sheet.triangles().iter().zip(sheet.rest()) {
        for (&v, p) in t.iter().zip(rest) {
            flat[v as usize] =
                Vec3::new(1.0, 2.0, 3.0) + Vec3::new(0.6, 0.8, 0.0) * p.x + Vec3::z() * (1.1 * p.y);
        }
    }
    assert!(gradient(&elastic, &flat).iter().all(|g| g.norm() < 1e-12));
}

/// Prolonged folds lie along the edges of the coarser mesh; smoothing spreads them.
#[test]
fn facets_of_a_coarser_mesh_are_held_as_a_curve() {
    let (n, bend) = (16, 2);
    let uv: Vec<Vector2<f64>> =
        (0..=n).flat_map(|i| (0..3).map(move |j| Vector2::new(f64::from(i), f64::from(j)) * 0.01)).collect();
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
    let mut elastic = elastic(&sheet, &cloth);
    // A polygon of a few sides.
    let faceted: Vec<Vec3> = uv
        .iter()
        .map(|p| {
            let s = p.x / (f64::from(bend) * 0.01);
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the state, the matrix does not go downhill.
    #[test]
    fn the_matrix_is_positive(places in proptest::array::uniform9(-0.1..0.1f64), push in proptest::array::uniform9(-1.0..1.0f64)) {
        let uv = [[0.0, 0.0], [0.1, 0.01], [0.02, 0.12]].map(|[x, y]| Vector2::new(x, y));
        let sheet = Sheet::flat(&uv, &[[0, 1, 2]], 0.1).unwrap();
        let mut elastic = elastic(&sheet, &Fabric { bending_warp: 0.0, bending_weft: 0.0, ..measured() });
        let pattern = Pattern::new(3, |visit| elastic.couplings(visit));
        elastic.bind(&pattern);
        let mut values = vec![Matrix3::zeros(); pattern.blocks()];
        let x: Vec<Vec3> = uv.iter().zip(places.chunks(3)).map(|(p, d)| Vec3::new(p.x + d[0], p.y + d[1], d[2])).collect();
        elastic.write_matrix(&x, 0.0, &mut values);
        let push: Vec<Vec3> = push.chunks(3).map(Vec3::from_column_slice).collect();
        let mut product = vec![Vec3::zeros(); 3];
        pattern.multiply_add(&values, &push, &mut product);
        let work: f64 = product.iter().zip(&push).map(|(a, b)| a.dot(b)).sum();
        prop_assert!(work > -1e-9, "{}", work);
    }
}
