//! Laplace and Poisson equations on the pixels of a picture.
//!
//! Neighbours `i`, `j` are joined by a weight `w` and a step `s` that is wanted between them. Found
//! are the values `x` that make the sum of `w (x_j - x_i - s)^2` least, where some of them are
//! given. With steps of zero this is Laplace's equation.
//!
//! Method: conjugate gradients with the diagonal as preconditioner (Hestenes and Stiefel, 1952).
//! Cost: ten operations a pixel and round. Limits: one thread; the rounds grow with the picture's
//! longer side.

use toile_core::prelude::*;

/// How neighbours are joined: to the right and down, one entry a pixel; zero past the frame.
pub struct Grid {
    /// Pixels across.
    pub width: usize,
    /// How strongly each is joined to the one on its right.
    pub right: Vec<f64>,
    /// How strongly each is joined to the one below it.
    pub down: Vec<f64>,
}

/// The steps that are wanted to the right and down.
pub struct Steps<'a> {
    /// From each pixel to the one on its right.
    pub right: &'a [f64],
    /// From each pixel to the one below it.
    pub down: &'a [f64],
}

/// When the rounds end.
pub struct StoppingRule {
    /// The residual against that at the start.
    pub residual: f64,
    /// The most rounds.
    pub rounds: usize,
}

impl Grid {
    /// The values between those that `fixed` gives, with steps of zero. Those of a part that is
    /// joined to no fixed value stay zero.
    ///
    /// Errors: the run was stopped.
    pub fn between_fixed(
        &self,
        fixed: &[Option<f64>],
        end: &StoppingRule,
        cx: &Context,
    ) -> Result<Vec<f64>, StageError> {
        let x: Vec<f64> = fixed.iter().map(|f| f.unwrap_or(0.0)).collect();
        self.improved(x, None, fixed, end, cx)
    }

    /// The values that have these steps, known but for a constant: first on grids of half, a
    /// quarter and so on of the cells, each a start for the next (nested iteration: Brandt, 1977),
    /// so that slow changes are right after few rounds.
    ///
    /// Errors: the run was stopped.
    pub fn sum_of(
        &self,
        steps: &Steps<'_>,
        end: &StoppingRule,
        cx: &Context,
    ) -> Result<Vec<f64>, StageError> {
        let n = self.right.len();
        let start = match self.coarser(steps) {
            None => vec![0.0; n],
            Some((grid, right, down)) => {
                let coarse = grid.sum_of(&Steps { right: &right, down: &down }, end, cx)?;
                (0..n).map(|i| between(&coarse, grid.width, [i % self.width, i / self.width])).collect()
            }
        };
        self.improved(start, Some(steps), &vec![None; n], end, cx)
    }

    /// The grid of pairs of pixels and its steps; none for a small one.
    fn coarser(&self, steps: &Steps<'_>) -> Option<(Grid, Vec<f64>, Vec<f64>)> {
        let (w, h) = (self.width, self.right.len() / self.width.max(1));
        if w.min(h) < SMALL {
            return None;
        }
        let (cw, ch) = (w.div_ceil(2), h.div_ceil(2));
        // Three steps lead from the middle of one pair to that of the next: half of the first, the
        // second, half of the last.
        let path = |list: &[f64], from: usize, next: usize, both: [usize; 2]| {
            let at = |k: usize, row: usize| list.get(from + k * next + row).copied().unwrap_or(0.0);
            both.map(|row| [at(0, row), at(1, row), at(2, row)])
        };
        let mut coarse = Grid { width: cw, right: vec![0.0; cw * ch], down: vec![0.0; cw * ch] };
        let (mut right, mut down) = (vec![0.0; cw * ch], vec![0.0; cw * ch]);
        for (x, y) in (0..ch).flat_map(|y| (0..cw).map(move |x| (x, y))) {
            let (i, from) = (y * cw + x, 2 * y * w + 2 * x);
            let (beside, below) = (if 2 * x + 1 < w { 1 } else { 0 }, if 2 * y + 1 < h { w } else { 0 });
            let mean = |p: [[f64; 3]; 2]| p.iter().map(|s| s[0] / 2.0 + s[1] + s[2] / 2.0).sum::<f64>() / 2.0;
            let weight = |p: [[f64; 3]; 2]| (p[0][1] + p[1][1]) / 2.0;
            if x + 1 < cw {
                coarse.right[i] = weight(path(&self.right, from, 1, [0, below]));
                right[i] = mean(path(steps.right, from, 1, [0, below]));
            }
            if y + 1 < ch {
                coarse.down[i] = weight(path(&self.down, from, w, [0, beside]));
                down[i] = mean(path(steps.down, from, w, [0, beside]));
            }
        }
        Some((coarse, right, down))
    }

    /// Values made better by rounds of conjugate gradients.
    fn improved(
        &self,
        mut x: Vec<f64>,
        steps: Option<&Steps<'_>>,
        fixed: &[Option<f64>],
        end: &StoppingRule,
        cx: &Context,
    ) -> Result<Vec<f64>, StageError> {
        let diagonal = self.diagonal();
        let mut q = vec![0.0; x.len()];
        self.gradient(&x, steps, fixed, &mut q);
        let mut r: Vec<f64> = q.iter().map(|q| -q).collect();
        let mut z: Vec<f64> = r.iter().zip(&diagonal).map(|(r, d)| r / d).collect();
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let least = rz * end.residual * end.residual;
        for round in 0..end.rounds {
            if rz <= least || rz <= f64::MIN_POSITIVE {
                break;
            }
            if round % 16 == 0 {
                cx.check()?;
            }
            self.gradient(&p, None, fixed, &mut q);
            let pq = dot(&p, &q);
            if pq <= 0.0 {
                break;
            }
            let a = rz / pq;
            x.iter_mut().zip(&p).for_each(|(x, p)| *x += a * p);
            r.iter_mut().zip(&q).for_each(|(r, q)| *r -= a * q);
            z.iter_mut().zip(r.iter().zip(&diagonal)).for_each(|(z, (r, d))| *z = r / d);
            let next = dot(&r, &z);
            let b = next / rz;
            rz = next;
            p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + b * *p);
        }
        Ok(x)
    }

    /// Half the gradient of the sum; zero where values are fixed. Without steps: the product of the
    /// Laplacian with `x`.
    fn gradient(&self, x: &[f64], steps: Option<&Steps<'_>>, fixed: &[Option<f64>], out: &mut [f64]) {
        out.fill(0.0);
        let (w, n) = (self.width, x.len());
        for i in 0..n {
            if i % w + 1 < w {
                let flow = self.right[i] * (x[i] - x[i + 1] + steps.map_or(0.0, |s| s.right[i]));
                out[i] += flow;
                out[i + 1] -= flow;
            }
            if i + w < n {
                let flow = self.down[i] * (x[i] - x[i + w] + steps.map_or(0.0, |s| s.down[i]));
                out[i] += flow;
                out[i + w] -= flow;
            }
        }
        out.iter_mut().zip(fixed).filter(|(_, f)| f.is_some()).for_each(|(o, _)| *o = 0.0);
    }

    fn diagonal(&self) -> Vec<f64> {
        let w = self.width;
        let sum = |i: usize| {
            let left = if !i.is_multiple_of(w) { self.right[i - 1] } else { 0.0 };
            let up = if i >= w { self.down[i - w] } else { 0.0 };
            self.right[i] + self.down[i] + left + up
        };
        // A pixel without neighbours keeps its value, whatever it is divided by.
        (0..self.right.len()).map(sum).map(|d| if d > 0.0 { d } else { 1.0 }).collect()
    }
}

/// Fewer pixels than this to a side are not made coarser.
const SMALL: usize = 8;

/// The value of a pixel between the middles of pairs of pixels.
fn between(coarse: &[f64], width: usize, [x, y]: [usize; 2]) -> f64 {
    let height = coarse.len() / width;
    let along = |v: usize, count: usize| {
        let v = ((v as f64 - 0.5) / 2.0).clamp(0.0, (count - 1) as f64);
        let first = (v as usize).min(count.saturating_sub(2));
        (first, v - first as f64)
    };
    let ((i, fx), (j, fy)) = (along(x, width), along(y, height));
    let at = |i: usize, j: usize| coarse[j.min(height - 1) * width + i.min(width - 1)];
    let row = |j: usize| at(i, j) * (1.0 - fx) + at(i + 1, j) * fx;
    row(j) * (1.0 - fy) + row(j + 1) * fy
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const END: StoppingRule = StoppingRule { residual: 1e-10, rounds: 200 };

    fn joined(width: usize, height: usize) -> Grid {
        let right = (0..width * height).map(|i| if i % width + 1 < width { 1.0 } else { 0.0 }).collect();
        let down = (0..width * height).map(|i| if i + width < width * height { 1.0 } else { 0.0 }).collect();
        Grid { width, right, down }
    }

    #[test]
    fn between_two_fixed_ends_values_rise_evenly() {
        let fixed = [Some(0.0), None, None, None, Some(4.0)];
        let x = joined(5, 1).between_fixed(&fixed, &END, &Context::quiet()).unwrap();
        x.iter().enumerate().for_each(|(i, x)| assert!((x - i as f64).abs() < 1e-9, "{x}"));
    }

    #[test]
    fn nested_grids_give_slow_changes_in_few_rounds() {
        let (w, h) = (97, 130);
        let wave = |i: usize| ((i % w) as f64 / 30.0).sin() + (i / w) as f64 * 0.02;
        let step = |i: usize, next: usize, last: bool| if last { 0.0 } else { wave(i + next) - wave(i) };
        let right: Vec<f64> = (0..w * h).map(|i| step(i, 1, i % w + 1 == w)).collect();
        let down: Vec<f64> = (0..w * h).map(|i| step(i, w, i + w >= w * h)).collect();
        let few = StoppingRule { residual: 1e-6, rounds: 40 };
        let x = joined(w, h).sum_of(&Steps { right: &right, down: &down }, &few, &Context::quiet()).unwrap();
        let off = x[0] - wave(0);
        let worst = x.iter().enumerate().map(|(i, x)| (x - wave(i) - off).abs()).fold(0.0, f64::max);
        assert!(worst < 0.02, "{worst}");
    }

    #[test]
    fn steps_of_a_plane_give_the_plane() {
        let grid = joined(6, 4);
        let (right, down) = (vec![0.5; 24], vec![-0.25; 24]);
        let x = grid.sum_of(&Steps { right: &right, down: &down }, &END, &Context::quiet()).unwrap();
        let x0 = x[0];
        for (i, x) in x.iter().enumerate() {
            let plane = x0 + 0.5 * (i % 6) as f64 - 0.25 * (i / 6) as f64;
            assert!((x - plane).abs() < 1e-8, "{x} {plane}");
        }
    }
}
