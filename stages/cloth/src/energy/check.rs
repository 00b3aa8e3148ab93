//! Derivatives against central differences: the first test of every model, also of models from
//! other crates.

use super::potential::{Energy, Projection, matrix_of, write_matrix};
use toile_geometry::Vec3;

/// Largest difference between the gradient and central differences of the value, relative to the
/// largest entry.
#[must_use]
pub fn gradient_error(energy: &dyn Energy, x: &[Vec3], step: f64) -> f64 {
    let mut gradient = vec![Vec3::zeros(); x.len()];
    energy.add_gradient(x, &mut gradient);
    let (mut worst, mut scale) = (0.0_f64, f64::MIN_POSITIVE);
    for (v, g) in gradient.iter().enumerate() {
        for k in 0..3 {
            let slope =
                (energy.value(&moved(x, v, k, step)) - energy.value(&moved(x, v, k, -step))) / (2.0 * step);
            worst = worst.max((slope - g[k]).abs());
            scale = scale.max(slope.abs());
        }
    }
    worst / scale
}

/// The same for the exact Hessian against central differences of the gradient.
#[must_use]
pub fn hessian_error(energy: &dyn Energy, x: &[Vec3], step: f64) -> f64 {
    let (mut hessian, places) = matrix_of(x.len(), &[energy]);
    write_matrix(&[energy], &places, x, Projection::Exact, &mut hessian);
    let (mut worst, mut scale) = (0.0_f64, f64::MIN_POSITIVE);
    for v in 0..x.len() {
        for k in 0..3 {
            let (mut up, mut down) = (vec![Vec3::zeros(); x.len()], vec![Vec3::zeros(); x.len()]);
            energy.add_gradient(&moved(x, v, k, step), &mut up);
            energy.add_gradient(&moved(x, v, k, -step), &mut down);
            let mut unit = vec![Vec3::zeros(); x.len()];
            unit[v][k] = 1.0;
            let column = hessian.times(&unit);
            for (w, c) in column.iter().enumerate() {
                let slope = (up[w] - down[w]) / (2.0 * step);
                worst = worst.max((slope - c).amax());
                scale = scale.max(slope.amax());
            }
        }
    }
    worst / scale
}

fn moved(x: &[Vec3], v: usize, k: usize, by: f64) -> Vec<Vec3> {
    let mut x = x.to_vec();
    x[v][k] += by;
    x
}
