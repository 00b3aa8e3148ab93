//! Least squares with factors that are not negative, of relative errors, little swayed by outliers.
//!
//! Method: all subsets of the few terms are tried; on each, weighted least squares of prediction /
//! fact - 1 with weights that fall off for what lies far out (Huber 1964, iteratively reweighted).
//! How far is measured by the logarithm of prediction / fact: three times too much is as far out as
//! a third, and one odd run bends a law no more from above than from below. Of the subsets whose
//! factors are all positive, the one with the least generalised cross-validation counts (Golub,
//! Heath, Wahba 1979). Non-negative factors keep a law rising, so that it can be used beyond the
//! sizes that were measured. Cost: 2^terms small systems. Limit: five terms.

/// One observation: the terms' values, the fact (greater than 0) and its weight.
#[derive(Debug, Clone)]
pub(super) struct Observation {
    pub(super) terms: Vec<f64>,
    pub(super) fact: f64,
    pub(super) weight: f64,
}

/// Errors beyond this, as a logarithm, count less.
const FAR: f64 = 0.25;
/// The greatest error, as a logarithm; a row that is predicted to be nothing has it.
const FARTHEST: f64 = 10.0;
/// Later subsets must be better by this: terms stand in the order of what is likely, and runs of
/// one pipeline cannot tell some of them apart.
const BETTER: f64 = 0.97;
/// Rounds of reweighting.
const ROUNDS: usize = 6;
/// Keeps systems regular; relative to their diagonal.
const RIDGE: f64 = 1e-9;

/// The factors, one a term; none without a usable row.
pub(super) fn fit(rows: &[Observation], terms: usize) -> Option<Vec<f64>> {
    let usable =
        |r: &&Observation| r.fact > 0.0 && r.fact.is_finite() && r.weight > 0.0 && r.terms.len() == terms;
    let rows: Vec<&Observation> = rows.iter().filter(usable).collect();
    let subsets = (1..1_usize << terms).map(|mask| (0..terms).filter(|i| mask >> i & 1 == 1).collect());
    let tried = subsets.filter_map(|columns: Vec<usize>| {
        let factors = robust(&rows, &columns)?;
        let score = validation(&rows, &columns, &factors)?;
        Some((score, columns, factors))
    });
    let (_, columns, factors) =
        tried.reduce(|best, next| if next.0 < BETTER * best.0 { next } else { best })?;
    let mut all = vec![0.0; terms];
    columns.iter().zip(&factors).for_each(|(c, f)| all[*c] = *f);
    Some(all)
}

/// What a subset predicts of a row.
fn predicted(row: &Observation, columns: &[usize], factors: &[f64]) -> f64 {
    columns.iter().zip(factors).map(|(c, f)| row.terms[*c] * f).sum()
}

/// How far a prediction lies from the fact, as a logarithm.
fn error(row: &Observation, columns: &[usize], factors: &[f64]) -> f64 {
    (predicted(row, columns, factors) / row.fact).ln().abs().min(FARTHEST)
}

/// Reweighted least squares; none where a factor is not positive.
fn robust(rows: &[&Observation], columns: &[usize]) -> Option<Vec<f64>> {
    let mut weights: Vec<f64> = rows.iter().map(|r| r.weight).collect();
    let mut factors = Vec::new();
    for _ in 0..ROUNDS {
        factors = least_squares(rows, columns, &weights)?;
        for (w, row) in weights.iter_mut().zip(rows) {
            *w = row.weight * (FAR / error(row, columns, &factors).max(FAR));
        }
    }
    factors.iter().all(|f| f.is_finite() && *f > 0.0).then_some(factors)
}

/// Normal equations of the relative errors, columns brought to like size.
fn least_squares(rows: &[&Observation], columns: &[usize], weights: &[f64]) -> Option<Vec<f64>> {
    let k = columns.len();
    let total: f64 = weights.iter().sum();
    let scale: Vec<f64> = columns
        .iter()
        .map(|c| rows.iter().zip(weights).map(|(r, w)| w * r.terms[*c] / r.fact).sum::<f64>() / total)
        .collect();
    if !scale.iter().all(|s| s.is_finite() && *s > 0.0) {
        return None;
    }
    let mut system = vec![vec![0.0; k + 1]; k];
    for (row, w) in rows.iter().zip(weights) {
        let a: Vec<f64> = columns.iter().zip(&scale).map(|(c, s)| row.terms[*c] / row.fact / s).collect();
        for (line, own) in system.iter_mut().zip(&a) {
            let sides = a.iter().chain(std::iter::once(&1.0));
            line.iter_mut().zip(sides).for_each(|(cell, other)| *cell += w * own * other);
        }
    }
    let x = solve(system)?;
    Some(x.iter().zip(&scale).map(|(x, s)| x / s).collect())
}

/// Gaussian elimination of a positive definite system with its right side as the last column.
fn solve(mut m: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let k = m.len();
    for (i, row) in m.iter_mut().enumerate() {
        row[i] *= 1.0 + RIDGE;
    }
    for i in 0..k {
        let pivot = m[i].clone();
        if !pivot[i].is_finite() || pivot[i] <= 0.0 {
            return None;
        }
        for row in m.iter_mut().skip(i + 1) {
            let share = row[i] / pivot[i];
            row.iter_mut().zip(&pivot).for_each(|(a, p)| *a -= share * p);
        }
    }
    let mut x = vec![0.0; k];
    for i in (0..k).rev() {
        let rest: f64 = (i + 1..k).map(|j| m[i][j] * x[j]).sum();
        x[i] = (m[i][k] - rest) / m[i][i];
    }
    Some(x)
}

/// Generalised cross-validation of the capped errors; none where there are no more rows than
/// factors, save one of each.
fn validation(rows: &[&Observation], columns: &[usize], factors: &[f64]) -> Option<f64> {
    let total: f64 = rows.iter().map(|r| r.weight).sum();
    let loss = |r: &&Observation| {
        let e = error(r, columns, factors);
        // Huber's loss.
        r.weight * if e < FAR { e * e } else { FAR * (2.0 * e - FAR) }
    };
    let sum: f64 = rows.iter().map(loss).sum();
    let count = rows.len() as f64;
    let free = 1.0 - columns.len() as f64 / count;
    match (rows.len(), columns.len()) {
        (1, 1) => Some(sum),
        _ if free <= 0.0 => None,
        _ => Some((sum / total + 1e-12) / (free * free)),
    }
}
