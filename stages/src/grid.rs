//! Laplace and Poisson equations on the pixels of a picture.
//!
//! Neighbours `i`, `j` are joined by a weight `w` and a step `s` that is wanted between them. Found are the values `x` that make
//! the sum of `w (x_j - x_i - s)^2` least, where some of them are given. With steps of zero this is Laplace's equation.
//!
//! Method: conjugate gradients with the diagonal as preconditioner (Hestenes and Stiefel, 1952). Cost: ten operations a pixel and
//! round. Limits: one thread; the rounds grow with the picture's longer side.

use toile_core::prelude::*;

/// How neighbours are joined: to the right and down, one entry a pixel; zero past the frame.
pub(crate) struct Grid {
    pub(crate) width: usize,
    pub(crate) right: Vec<f64>,
    pub(crate) down: Vec<f64>,
}

/// The steps that are wanted to the right and down.
pub(crate) struct Steps<'a> {
    pub(crate) right: &'a [f64],
    pub(crate) down: &'a [f64],
}

/// When the rounds end.
pub(crate) struct End {
    /// The residual against that at the start.
    pub(crate) residual: f64,
    /// The most rounds.
    pub(crate) rounds: usize,
}

impl Grid {
    /// The values; where `fixed` gives one, it stays. Those of a part that is joined to no fixed value are
    /// known but for a constant.
    ///
    /// Errors: the run was stopped.
    pub(crate) fn solve(
        &self,
        steps: Option<&Steps<'_>>,
        fixed: &[Option<f64>],
        end: &End,
        cx: &Context,
    ) -> Result<Vec<f64>, StageError> {
        let diagonal = self.diagonal();
        let mut x: Vec<f64> = fixed.iter().map(|f| f.unwrap_or(0.0)).collect();
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

    /// Half the gradient of the sum; zero where values are fixed. Without steps: the product of the Laplacian with `x`.
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
            let left = if i % w > 0 { self.right[i - 1] } else { 0.0 };
            let up = if i >= w { self.down[i - w] } else { 0.0 };
            self.right[i] + self.down[i] + left + up
        };
        // A pixel without neighbours keeps its value, whatever it is divided by.
        (0..self.right.len()).map(sum).map(|d| if d > 0.0 { d } else { 1.0 }).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const END: End = End { residual: 1e-10, rounds: 200 };

    fn joined(width: usize, height: usize) -> Grid {
        let right = (0..width * height).map(|i| if i % width + 1 < width { 1.0 } else { 0.0 }).collect();
        let down = (0..width * height).map(|i| if i + width < width * height { 1.0 } else { 0.0 }).collect();
        Grid { width, right, down }
    }

    #[test]
    fn between_two_fixed_ends_values_rise_evenly() {
        let fixed = [Some(0.0), None, None, None, Some(4.0)];
        let x = joined(5, 1).solve(None, &fixed, &END, &Context::quiet()).unwrap();
        x.iter().enumerate().for_each(|(i, x)| assert!((x - i as f64).abs() < 1e-9, "{x}"));
    }

    #[test]
    fn steps_of_a_plane_give_the_plane() {
        let grid = joined(6, 4);
        let (right, down) = (vec![0.5; 24], vec![-0.25; 24]);
        let x = grid
            .solve(Some(&Steps { right: &right, down: &down }), &[None; 24], &END, &Context::quiet())
            .unwrap();
        let x0 = x[0];
        for (i, x) in x.iter().enumerate() {
            let plane = x0 + 0.5 * (i % 6) as f64 - 0.25 * (i / 6) as f64;
            assert!((x - plane).abs() < 1e-8, "{x} {plane}");
        }
    }
}
