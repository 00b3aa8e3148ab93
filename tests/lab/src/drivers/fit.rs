//! Powers: time and error against what drives them, as straight lines in the logarithms.

use super::{Driver, Row, Scene, Way, named};
use serde::Serialize;

/// Fewer points have no power.
const LEAST_POINTS: usize = 3;

/// A power law through measured points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Power {
    /// Of the driver.
    pub exponent: f64,
    /// Root mean square distance of the points from the law, as a factor: 1 where all lie on it.
    pub scatter: f64,
}

/// The powers of one solver; none where fewer than three runs gave an answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fit {
    /// What was simulated.
    pub scene: Scene,
    /// What was turned.
    pub driver: Driver,
    /// The solver and its membrane.
    #[serde(serialize_with = "named")]
    pub way: Way,
    /// Time against the driver.
    pub time: Option<Power>,
    /// Error against the driver.
    pub error: Option<Power>,
}

/// For every solver, scene and driver among the rows.
pub(super) fn fits(rows: &[Row]) -> Vec<Fit> {
    let same = |a: &Row, b: &Row| (a.scene, a.driver, a.way) == (b.scene, b.driver, b.way);
    rows.chunk_by(same).map(of).collect()
}

fn of(rows: &[Row]) -> Fit {
    let Row { scene, driver, way, .. } = rows[0];
    let driven = |r: &Row| match driver {
        Driver::Particles => r.particles as f64,
        Driver::Step => r.dt.unwrap_or(0.0),
    };
    let answers: Vec<(f64, f64, f64)> =
        rows.iter().filter_map(|r| Some((driven(r), r.seconds, r.error?))).collect();
    let time = power(&answers.iter().map(|a| [a.0, a.1]).collect::<Vec<_>>());
    let error = power(&answers.iter().map(|a| [a.0, a.2]).collect::<Vec<_>>());
    Fit { scene, driver, way, time, error }
}

/// Least squares of `ln y = a ln x + c` over the points where both are above zero.
fn power(points: &[[f64; 2]]) -> Option<Power> {
    let logs: Vec<[f64; 2]> =
        points.iter().filter(|p| p[0] > 0.0 && p[1] > 0.0).map(|p| p.map(f64::ln)).collect();
    let n = logs.len() as f64;
    let mean = |k: usize| logs.iter().map(|p| p[k]).sum::<f64>() / n;
    let [mx, my] = [mean(0), mean(1)];
    let spread: f64 = logs.iter().map(|p| (p[0] - mx).powi(2)).sum();
    if logs.len() < LEAST_POINTS || spread <= 0.0 {
        return None;
    }
    let exponent = logs.iter().map(|p| (p[0] - mx) * (p[1] - my)).sum::<f64>() / spread;
    let off: f64 = logs.iter().map(|p| (p[1] - my - exponent * (p[0] - mx)).powi(2)).sum();
    Some(Power { exponent, scatter: (off / n).sqrt().exp() })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn powers_are_found_and_their_scatter() {
        let exact: Vec<[f64; 2]> = [1.0, 2.0, 5.0, 9.0_f64].map(|x| [x, 3.0 * x.powf(-1.5)]).to_vec();
        let found = power(&exact).unwrap();
        assert!((found.exponent + 1.5).abs() < 1e-12 && (found.scatter - 1.0).abs() < 1e-12);
        // Points off by a factor of two up and down about a level.
        let level = power(&[[1.0, 2.0], [2.0, 0.5], [4.0, 0.5], [8.0, 2.0]]).unwrap();
        assert!(level.exponent.abs() < 1e-12 && (level.scatter - 2.0).abs() < 1e-12);
        assert_eq!(power(&exact[..2]), None);
        assert_eq!(power(&[[1.0, 1.0], [1.0, 2.0], [1.0, 3.0]]), None);
    }
}
