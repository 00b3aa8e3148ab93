//! As rigid as possible (Liu, Zhang, Xu, Gotsman, Gortler 2008): each triangle keeps its shape as
//! far as its neighbours let it.
//!
//! Local step: the rotation nearest to each triangle's map. Global step: the places whose maps are
//! nearest to those rotations, a linear system whose factor is made once. Each pair lowers the
//! energy `sum share |J - R|^2`, ever more slowly; so after a few, Newton's method goes the rest of
//! the way to the minimum, which also keeps triangles from flipping. Cost: one factor of n
//! unknowns, two solutions an iteration, then some Newton steps.

use super::{Flattening, Placement};
use crate::energy::ArapEnergy;
use crate::error::FlattenError;
use crate::frames::{TriangleFrames, corners, flipped};
use crate::linear::{CholeskyFactor, slot};
use crate::newton::{NewtonOutcome, NewtonProblem, StoppingLimits};
use crate::start::start;
use crate::surface::PieceSurface;
use crate::system::PieceSystem;
use nalgebra::{Point2, Vector2};

/// How long to iterate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ArapOptions {
    /// Pairs of local and global steps, 0 or more; by default 0: from a start without flips
    /// Newton's method alone is faster.
    pub pairs: usize,
    /// When Newton's method stops; 0 iterations leave the result of the pairs, if it has no flips.
    pub newton: StoppingLimits,
}

/// The least weight of an unknown by area, against the drift of the whole piece.
const DRIFT: f64 = 1e-6;

/// Flattens with the least `|J - R|^2`.
///
/// # Errors
/// Parameters of the placement or options, [`FlattenError::NoStart`],
/// [`FlattenError::Factorization`].
pub fn arap(
    surface: &PieceSurface,
    options: ArapOptions,
    placement: &Placement,
) -> Result<Flattening, FlattenError> {
    placement.check(surface)?;
    let (system, frames) = (PieceSystem::new(surface, &[]), TriangleFrames::new(surface));
    let (flat, start) = start(surface, &system, &frames)?;
    let mut better = flat.clone();
    pairs(&system, &frames, options.pairs, &mut better)?;
    // The pairs do not care about flips; Newton's method must start without.
    let mut flat = if flipped(system.triangles(), &better).is_empty() { better } else { flat };
    let problem =
        NewtonProblem { system: &system, frames: &frames, energy: &ArapEnergy, terms: &[], constraints: &[] };
    let report = problem.minimise(&mut flat, options.newton)?;
    let iterations = report.iterations + options.pairs;
    placement.finish(surface, &frames, flat, (start, NewtonOutcome { iterations, ..report }))
}

/// Makes `count` pairs of a local and a global step.
pub(crate) fn pairs(
    system: &PieceSystem,
    frames: &TriangleFrames,
    count: usize,
    q: &mut [Point2<f64>],
) -> Result<(), FlattenError> {
    if count == 0 {
        return Ok(());
    }
    let (values, masses) = laplacian(system, frames);
    let mut factor = CholeskyFactor::analyse(system.graph(), 1, system.order())?;
    factor.factor(&values)?;
    let n = q.len();
    for _ in 0..count {
        let mut right = vec![0.0; 2 * n];
        for v in 0..n {
            (right[v], right[n + v]) = (masses[v] * q[v].x, masses[v] * q[v].y);
        }
        for (t, &triangle) in system.triangles().iter().enumerate() {
            let j = frames.map(t, corners(q, triangle));
            // The nearest rotation of a 2 x 2 matrix needs no singular values.
            let r = Vector2::new(j.m11 + j.m22, j.m21 - j.m12).try_normalize(0.0).unwrap_or_else(Vector2::x);
            for (v, g) in triangle.into_iter().zip(frames.gradients(t)) {
                right[v as usize] += frames.share(t) * (r.x * g.x - r.y * g.y);
                right[n + v as usize] += frames.share(t) * (r.y * g.x + r.x * g.y);
            }
        }
        factor.solve(&mut right)?;
        q.iter_mut().enumerate().for_each(|(v, p)| *p = Point2::new(right[v], right[n + v]));
    }
    Ok(())
}

/// The matrix of `sum share |J|^2` plus the masses, and the masses.
fn laplacian(system: &PieceSystem, frames: &TriangleFrames) -> (Vec<f64>, Vec<f64>) {
    let graph = system.graph();
    let mut values = vec![0.0; graph.vertices() + graph.pairs()];
    let mut masses = vec![0.0; graph.vertices()];
    for (t, triangle) in system.triangles().iter().enumerate() {
        let g = frames.gradients(t);
        for k in 0..3 {
            let (i, j) = (triangle[k], triangle[(k + 1) % 3]);
            let mass = DRIFT * frames.share(t) / 3.0;
            masses[i as usize] += mass;
            values[slot(graph, i as usize)] += frames.share(t) * g[k].norm_squared() + mass;
            let low = i.min(j) as usize;
            let place = graph.pair(i, j).map_or(0, |p| p - graph.start(low));
            values[slot(graph, low) + 1 + place] += frames.share(t) * g[k].dot(&g[(k + 1) % 3]);
        }
    }
    (values, masses)
}
