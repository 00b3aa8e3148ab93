#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::*;

fn patch() -> (Sheet, Vec<Vec3>) {
    let uv =
        [[0.0, 0.0], [0.1, 0.01], [0.02, 0.12], [0.13, 0.11], [0.05, 0.22]].map(|[x, y]| Vector2::new(x, y));
    let sheet = Sheet::flat(&uv, &[[0, 1, 2], [1, 3, 2], [2, 3, 4]], 0.1).unwrap();
    let bend = |(k, p): (usize, &Vector2<f64>)| {
        Vec3::new(p.x * 1.03, 0.4 * p.y * p.y + 0.01 * (k as f64).sin(), p.y)
    };
    (sheet, uv.iter().enumerate().map(bend).collect())
}

const SOFT: Stiffness = Stiffness { weft: 300.0, warp: 500.0, shear: 40.0, bend: 1e-2 };

#[test]
fn the_gradient_is_the_slope_of_the_energy() {
    let (sheet, mut x) = patch();
    let elastic = Elastic::new(&sheet, SOFT);
    let mut gradient = vec![Vec3::zeros(); x.len()];
    elastic.add_gradient(&x, &mut gradient);
    for i in 0..x.len() {
        for c in 0..3 {
            let h = 1e-6;
            let at = x[i][c];
            x[i][c] = at + h;
            let up = elastic.value(&x);
            x[i][c] = at - h;
            let down = elastic.value(&x);
            x[i][c] = at;
            let slope = (up - down) / (2.0 * h);
            assert!(
                (slope - gradient[i][c]).abs() < 1e-6 * (1.0 + slope.abs()),
                "{i} {c}: {slope} {}",
                gradient[i][c]
            );
        }
    }
}

#[test]
fn under_tension_the_matrix_is_the_slope_of_the_gradient() {
    let (sheet, mut x) = patch();
    x.iter_mut().for_each(|p| *p *= 1.2);
    let mut elastic = Elastic::new(&sheet, SOFT);
    let pattern = Pattern::new(x.len(), elastic.couplings());
    elastic.bind(&pattern);
    let mut values = vec![Matrix3::zeros(); pattern.blocks()];
    elastic.add_matrix(&x, false, &mut values);
    let push: Vec<Vec3> =
        (0..x.len()).map(|i| Vec3::new(i as f64, 2.0 * i as f64, 1.0).map(f64::sin)).collect();
    let mut product = vec![Vec3::zeros(); x.len()];
    pattern.multiply_add(&values, &push, &mut product);
    let h = 1e-6;
    let at = |s: f64| {
        let moved: Vec<Vec3> = x.iter().zip(&push).map(|(p, d)| p + d * s).collect();
        let mut g = vec![Vec3::zeros(); x.len()];
        elastic.add_gradient(&moved, &mut g);
        g
    };
    for ((up, down), want) in at(h).iter().zip(&at(-h)).zip(&product) {
        assert!(((up - down) / (2.0 * h) - want).norm() < 1e-4 * (1.0 + want.norm()), "{want}");
    }
}
