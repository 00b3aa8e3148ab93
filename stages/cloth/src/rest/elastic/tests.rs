#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::*;
use crate::fabric::Curve;
use crate::force::Energy;
use crate::membrane::{Triangles, Woven};
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
    let elastic = Elastic::new(&sheet, &[&measured()], None, |_| 0);
    assert_gradient_is_the_slope(&elastic, &mut x);
}

#[test]
fn under_tension_the_matrix_is_the_slope_of_the_gradient() {
    // Little shear: its curvature is what the matrix leaves out.
    let (sheet, mut x) = patch();
    let fabric = Fabric { shear: Curve::linear(0.0), ..measured() };
    x.iter_mut().for_each(|p| *p *= 1.2);
    let mut elastic = Elastic::new(&sheet, &[&fabric], None, |_| 0);
    let pattern = Pattern::new(x.len(), elastic.couplings());
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
        warp: Curve::linear(0.0),
        weft: Curve::linear(0.0),
        shear: Curve::linear(0.0),
        ..measured()
    };
    let elastic = Elastic::new(&sheet, &[&stiff], None, |_| 0);
    let mut flat = vec![Vec3::zeros(); 5];
    for (t, rest) in sheet.triangles().iter().zip(sheet.rest()) {
        for (&v, p) in t.iter().zip(rest) {
            flat[v as usize] =
                Vec3::new(1.0, 2.0, 3.0) + Vec3::new(0.6, 0.8, 0.0) * p.x + Vec3::z() * (1.1 * p.y);
        }
    }
    assert!(gradient(&elastic, &flat).iter().all(|g| g.norm() < 1e-12));
}

const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [0.1, 0.01], [0.02, 0.12]];

/// One element, by the law of the rest solver and by the woven membrane.
fn one_element() -> (Elastic, impl Energy) {
    let uv = CORNERS.map(|[x, y]| Vector2::new(x, y));
    let sheet = Sheet::flat(&uv, &[[0, 1, 2]], 0.1).unwrap();
    let fabric = Fabric { bending_warp: 0.0, bending_weft: 0.0, ..measured() };
    let elastic = Elastic::new(&sheet, &[&fabric], None, |_| 0);
    (elastic, Triangles::new(&sheet, Woven::new(&fabric).unwrap()))
}

/// The element's corners, each moved from its place on the plane.
fn moved(places: &[f64; 9]) -> Vec<Vec3> {
    let at = |([x, y], d): (&[f64; 2], &[f64])| Vec3::new(x + d[0], y + d[1], d[2]);
    CORNERS.iter().zip(places.chunks(3)).map(at).collect()
}

/// Lengths of the element's weft and warp by those at rest, and the sine of the shear between them.
fn yarns(x: &[Vec3]) -> ([f64; 2], f64) {
    let [_, [a, b], [c, d]] = CORNERS;
    let (p, q, area) = (x[1] - x[0], x[2] - x[0], a * d - b * c);
    let (weft, warp) = ((p * d - q * b) / area, (q * a - p * c) / area);
    ([weft.norm(), warp.norm()], weft.dot(&warp) / (weft.norm() * warp.norm()))
}

/// True where the rest solver's law claims to be the woven one: see the limits at the head of `law`.
fn is_claimed(x: &[Vec3]) -> bool {
    let (length, sine) = yarns(x);
    length.iter().all(|l| *l > 0.5) && sine.abs() < 0.95
}

/// Found by the property below: a weft yarn at 0.48 of its length, where the shear follows it no longer. The
/// law is another there than the woven one, and must still be the slope of its own energy.
#[test]
fn beyond_the_laws_limit_the_gradient_is_still_the_slope_of_the_energy() {
    let (elastic, woven) = one_element();
    let mut x =
        moved(&[0.029_024_490_109_794_51, 0.0, 0.0, -0.024_775_725_924_386_774, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert!((yarns(&x).0[0] - 0.477_476).abs() < 1e-6 && !is_claimed(&x));
    assert!((elastic.value(&x) - woven.value(&x)).abs() > 1e-4, "the two laws part here");
    assert_gradient_is_the_slope(&elastic, &mut x);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// One element answers as the woven membrane does, on any piece of its curves.
    #[test]
    fn the_membrane_is_the_woven_one(places in proptest::array::uniform9(-0.03..0.03f64)) {
        let (elastic, woven) = one_element();
        let x = moved(&places);
        prop_assume!(is_claimed(&x));
        let (own, other) = (elastic.value(&x), woven.value(&x));
        prop_assert!((own - other).abs() < 1e-12 * (1.0 + other), "{} {}", own, other);
        let mut want = vec![Vec3::zeros(); 3];
        woven.add_gradient(&x, &mut want);
        for (g, w) in gradient(&elastic, &x).iter().zip(&want) {
            prop_assert!((g - w).norm() < 1e-10 * (1.0 + w.norm()), "{} {}", g, w);
        }
    }

    /// Whatever the state, the matrix does not go downhill.
    #[test]
    fn the_matrix_is_positive(places in proptest::array::uniform9(-0.1..0.1f64), push in proptest::array::uniform9(-1.0..1.0f64)) {
        let uv = [[0.0, 0.0], [0.1, 0.01], [0.02, 0.12]].map(|[x, y]| Vector2::new(x, y));
        let sheet = Sheet::flat(&uv, &[[0, 1, 2]], 0.1).unwrap();
        let mut elastic = Elastic::new(&sheet, &[&Fabric { bending_warp: 0.0, bending_weft: 0.0, ..measured() }], None, |_| 0);
        let pattern = Pattern::new(3, elastic.couplings());
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
