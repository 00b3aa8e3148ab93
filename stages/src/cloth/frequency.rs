//! How fast the cloth can vibrate, which bounds the time step.
//!
//! Method: the highest frequency is the root of the greatest eigenvalue of `M^-1 K`, found by power
//! iteration on the springs as they lie flat, each at its steepest slope. Joining nodes only
//! constrains the motion and lowers it, so it is found once. Before that, the inertia of nodes
//! whose springs are much stiffer for their mass than is usual is raised (selective mass scaling, as
//! explicit finite elements do): one sliver would otherwise slow the whole garment.
//! Cost: [`ITERATIONS`] times one evaluation of forces.

use super::membrane::{Material, Membrane};
use super::model::Cloth;
use nalgebra::Vector2;

/// Power iterations: the estimate is then within about 3 % below the true value.
const ITERATIONS: usize = 60;

/// Covers what the iterations leave.
const MARGIN: f64 = 1.05;

/// Nodes may vibrate by the square root of this faster than the usual node; stiffer ones get inertia.
const SPREAD: f64 = 1.5;

/// Inertia of every node: its mass, or more where its springs are unusually stiff for it.
pub(super) fn inertia(mass: &[f64], membranes: &[Membrane], materials: &[Material]) -> Vec<f64> {
    let mut stiffness = vec![0.0; mass.len()];
    for m in membranes {
        let k = m.stiffness_bound(&materials[m.material as usize]);
        m.nodes.iter().for_each(|&n| stiffness[n as usize] += k);
    }
    let ratio = |i: usize| if mass[i] > 0.0 { stiffness[i] / mass[i] } else { 0.0 };
    let mut ratios: Vec<f64> = (0..mass.len()).map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let most = SPREAD * ratios.get(mass.len() / 2).copied().unwrap_or(0.0);
    (0..mass.len()).map(|i| if most > 0.0 { mass[i].max(stiffness[i] / most) } else { mass[i] }).collect()
}

/// The highest angular frequency of the cloth's springs, rad/s.
pub(super) fn highest(cloth: &Cloth) -> f64 {
    // A fixed start without symmetry: neighbours point opposite ways, no mode is orthogonal to it.
    let start = |i: usize| {
        let wave = |k: f64| (k * (i as f64 + 1.0)).sin();
        Vector2::new(wave(2.399), wave(1.618))
    };
    let mut x: Vec<Vector2<f64>> = (0..cloth.len()).map(start).collect();
    let mut square = 0.0;
    for _ in 0..ITERATIONS {
        let norm = x.iter().map(|v| v.norm_squared()).sum::<f64>().sqrt();
        if norm <= 0.0 {
            return 0.0;
        }
        x.iter_mut().for_each(|v| *v /= norm);
        let mut y = vec![Vector2::zeros(); x.len()];
        for m in &cloth.membranes {
            m.add_flat_stiffness(&cloth.materials[m.material as usize], &x, &mut y);
        }
        y.iter_mut().zip(&cloth.inverse_inertia).for_each(|(y, w)| *y *= *w);
        square = y.iter().map(|v| v.norm_squared()).sum::<f64>().sqrt();
        x = y;
    }
    MARGIN * (square + hinges(cloth)).sqrt()
}

/// A bound on what bending adds to the frequency squared.
fn hinges(cloth: &Cloth) -> f64 {
    let mut sum = vec![0.0; cloth.len()];
    for h in &cloth.hinges {
        let k = h.stiffness_bound();
        h.nodes.iter().for_each(|&n| sum[n as usize] += k);
    }
    sum.iter().zip(&cloth.inverse_inertia).map(|(k, w)| k * w).fold(0.0, f64::max)
}
