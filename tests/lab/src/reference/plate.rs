//! Square plates under uniform load: `w_centre = C q a^4 / D`, for any Poisson's ratio.

use nalgebra::Matrix3;

use toile_cloth::energy::Vec3;
use toile_cloth::error::ClothError;
use toile_cloth::linear::{BlockMatrix, Cholesky};

/// C of a plate simply supported on all sides, by Navier's series.
#[must_use]
pub fn supported_plate() -> f64 {
    let pi = std::f64::consts::PI;
    let term = |m: usize, n: usize| {
        let sign = if (m + n).is_multiple_of(4) { -1.0 } else { 1.0 };
        let (m, n) = (m as f64, n as f64);
        sign / (m * n * (m * m + n * n).powi(2))
    };
    let odd = || (0..200).map(|k| 2 * k + 1);
    16.0 / pi.powi(6) * odd().flat_map(|m| odd().map(move |n| (m, n))).map(|(m, n)| term(m, n)).sum::<f64>()
}

/// C of a plate clamped on all sides: finite differences of the biharmonic equation on two grids,
/// extrapolated.
///
/// # Errors
/// Does not fail; the type is that of the linear solver.
pub fn clamped_plate() -> Result<f64, ClothError> {
    let (coarse, fine) = (clamped_on(19)?, clamped_on(39)?);
    Ok(fine + (fine - coarse) / 3.0)
}

/// The 13-point stencil on n x n inner points; the clamp mirrors the first row outside.
fn clamped_on(n: usize) -> Result<f64, ClothError> {
    let id = |i: usize, j: usize| (j * n + i) as u32;
    let stencil = [(0, 1, -8.0), (1, 0, -8.0), (1, 1, 2.0), (1, -1, 2.0), (0, 2, 1.0), (2, 0, 1.0)];
    let inside = |i: usize, d: i32| usize::try_from(i as i32 + d).ok().filter(|&k| k < n);
    let mut pairs = Vec::new();
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        for (di, dj, w) in stencil {
            if let (Some(k), Some(l)) = (inside(i, di), inside(j, dj)) {
                pairs.push((id(i, j), id(k, l), w));
            }
        }
    }
    let mut a =
        BlockMatrix::with_couplings(n * n, |visit| pairs.iter().for_each(|&(p, q, _)| visit(&[p, q])));
    pairs.iter().for_each(|&(p, q, w)| a.add(p, q, &(Matrix3::identity() * w)));
    let border = |k: usize| f64::from(u8::from(k == 0)) + f64::from(u8::from(k == n - 1));
    a.add_diagonal((0..n * n).map(|v| 20.0 + border(v % n) + border(v / n)));
    let mut factor = Cholesky::analyse(&a)?;
    factor.factor(&a)?;
    let h = 1.0 / (n + 1) as f64;
    Ok(factor.solve(&vec![Vec3::x(); n * n])[n * n / 2].x * h.powi(4))
}
