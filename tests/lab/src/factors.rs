//! The own sparse factorization of the static solver beside faer's supernodal one, on matrices of
//! cloth.

use crate::Progress;
use serde::Serialize;
use std::fmt;
use std::time::Instant;
use toile_cloth::energy::{Cloth, Models, Projection, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::linear::{BlockMatrix, Cholesky};
use toile_cloth::solver::Model;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::statics::factor::multifrontal::{Factor, Symbolic};
use toile_cloth::statics::factor::scalar::Real;

/// Edges along the side of a square sheet: about 2,000, 20,000 and 100,000 nodes.
const SIDES: [usize; 3] = [42, 133, 297];

/// Step of implicit Euler whose inertia the matrices carry, s.
const DT: f64 = 1.0 / 60.0;

/// One matrix.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Row {
    /// Nodes of the sheet.
    pub nodes: usize,
    /// Order and symbolic factor, own and faer's, s.
    pub analyse_s: [f64; 2],
    /// Numbers and one solution: own with double, own with single precision, faer's, s.
    pub factor_s: [f64; 3],
    /// Numbers in the factor, own and faer's.
    pub fill: [usize; 2],
    /// Greatest residual over the right side's: own with double, own with single precision, faer's.
    pub residual: [f64; 3],
}

/// All matrices.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// A row a size.
    pub rows: Vec<Row>,
    /// Threads that the own factorization had; faer's has one.
    pub threads: usize,
}

/// Measures all sizes, or those up to the one at which `progress` stops.
///
/// # Errors
/// A matrix that is not positive definite.
pub fn factors(progress: &mut Progress<'_>) -> Result<Report, ClothError> {
    let mut rows = Vec::new();
    for (k, side) in SIDES.into_iter().enumerate() {
        if progress(k as f64 / SIDES.len() as f64, &format!("{side} edges along the side")).is_break() {
            break;
        }
        rows.push(row(side)?);
    }
    Ok(Report { rows, threads: rayon::current_num_threads() })
}

fn row(side: usize) -> Result<Row, ClothError> {
    let mesh = Rectangle::new(Layout::Irregular(1), 1.0, 1.0, side);
    let sheet = mesh.sheet(0.15)?;
    let fabric = Fabric::isotropic(0.15, 500.0, 0.0, 1e-5);
    let model = Model::of(&sheet).made_of(Models::STATIC, &Cloth::of(&sheet, &[&fabric]))?;
    let x: Vec<Vec3> = mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.01 * (9.0 * p.x).sin())).collect();
    let mut matrix = model.stiffness(&x, Projection::PositiveSemiDefinite);
    matrix.add_diagonal(model.masses.iter().map(|m| m / (DT * DT)));
    let right: Vec<Vec3> =
        (0..x.len()).map(|i| Vec3::new((i as f64).sin(), 1.0, (2.0 * i as f64).cos())).collect();

    let ((symbolic, own_analyse), flat) = (timed(|| Symbolic::new(matrix.pattern(), &x)), &matrix);
    let (double, double_s) = own::<f64>(&symbolic, flat, &right)?;
    let (single, single_s) = own::<f32>(&symbolic, flat, &right)?;
    let (cholesky, faer_analyse) = timed(|| Cholesky::analyse(flat));
    let mut cholesky = cholesky?;
    let (faer, faer_s) = timed(|| cholesky.factor(flat).map(|()| cholesky.solve(&right)));
    let residual = |x: &[Vec3]| {
        let greatest = |v: &mut dyn Iterator<Item = Vec3>| v.map(|r| r.amax()).fold(0.0, f64::max);
        let left = flat.times(x);
        greatest(&mut left.iter().zip(&right).map(|(l, r)| l - r)) / greatest(&mut right.iter().copied())
    };
    Ok(Row {
        nodes: x.len(),
        analyse_s: [own_analyse, faer_analyse],
        factor_s: [double_s, single_s, faer_s],
        fill: [symbolic.factor_len(), cholesky.fill()],
        residual: [residual(&double), residual(&single), residual(&faer?)],
    })
}

/// The solution by the own factor in the precision `T`, and the time of the second of two
/// factorizations, whose memory is there.
fn own<T: Real + Default>(
    symbolic: &Symbolic,
    matrix: &BlockMatrix,
    right: &[Vec3],
) -> Result<(Vec<Vec3>, f64), ClothError> {
    let mut factor = Factor::<T>::default();
    let mut once = || {
        let mut x = right.to_vec();
        let done = symbolic.factor_and_solve(matrix.values(), &mut factor, &mut x, &|| false);
        done.map(|()| x).map_err(|e| ClothError::Factorization { why: e.to_string() })
    };
    once()?;
    let (x, seconds) = timed(once);
    Ok((x?, seconds))
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let done = work();
    (done, start.elapsed().as_secs_f64())
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "own: {} threads; faer: 1 thread. Times in ms, residuals as shares.\n", self.threads)?;
        writeln!(
            f,
            "| nodes | analyse own | faer | factor and solve own | own, single | faer | numbers own | faer | residual own | single | faer |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|---|---|---|---|---|")?;
        for r in &self.rows {
            let [a, b] = r.analyse_s.map(|s| 1e3 * s);
            let [d, s, l] = r.factor_s.map(|s| 1e3 * s);
            let [p, q] = r.fill.map(|n| n as f64 / 1e6);
            let [x, y, z] = r.residual;
            writeln!(
                f,
                "| {} | {a:.1} | {b:.1} | {d:.1} | {s:.1} | {l:.1} | {p:.2} M | {q:.2} M | {x:.0e} | {y:.0e} | {z:.0e} |",
                r.nodes
            )?;
        }
        Ok(())
    }
}

impl Report {
    /// As one JSON object.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}
