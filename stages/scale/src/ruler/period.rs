//! Periods of a profile, and the phase of one along it.

use super::strip::Strip;
use image::RgbImage;
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;

/// A period and how clear it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Period {
    /// Pixels.
    pub(crate) lag: f64,
    /// Autocorrelation there, up to 1.
    pub(crate) clear: f64,
}

/// Profiles of less than this standard deviation, grey levels, are noise.
const NOISE: f64 = 1.5;

/// Autocorrelation at lags of 0 to `lags` pixels, 1 at 0; zeros of a profile without contrast.
pub(crate) fn autocorrelation(s: &[f64], lags: usize) -> Vec<f64> {
    let square: f64 = s.iter().map(|v| v * v).sum();
    if s.len() < 3 * lags.max(8) / 2 || square < NOISE * NOISE * s.len() as f64 {
        return vec![0.0; lags + 1];
    }
    let at = |l: usize| {
        let n = s.len() - l;
        let product: f64 = s[..n].iter().zip(&s[l..]).map(|(a, b)| a * b).sum();
        product / square * s.len() as f64 / n as f64
    };
    (0..=lags).map(at).collect()
}

/// The smallest lag whose peak is nearly as high as the highest.
pub(crate) fn first_period(r: &[f64]) -> Option<Period> {
    let peaks: Vec<usize> = (2..r.len().saturating_sub(1))
        .filter(|l| r[*l] > r[l - 1] && r[*l] >= r[l + 1] && r[*l] > 0.15)
        .collect();
    let highest = peaks.iter().map(|l| r[*l]).fold(0.0, f64::max);
    let first = *peaks.iter().find(|l| r[**l] >= 0.62 * highest)?;
    Some(Period { lag: refined(r, top(r, first)), clear: r[first] })
}

/// A lag made finer by its multiples.
fn refined(r: &[f64], lag: f64) -> f64 {
    let mut fine = lag;
    for n in 2..40 {
        let near = (fine * f64::from(n)).round() as usize;
        if near + 2 >= r.len() {
            break;
        }
        let best = (near - 1..=near + 1).fold(near, |b, l| if r[l] > r[b] { l } else { b });
        if r[best] > 0.3 && r[best] >= r[best - 1] && r[best] >= r[best + 1] {
            fine = top(r, best) / f64::from(n);
        }
    }
    fine
}

fn top(r: &[f64], l: usize) -> f64 {
    let bend = r[l - 1] - 2.0 * r[l] + r[l + 1];
    l as f64 + if bend < 0.0 { (0.5 * (r[l - 1] - r[l + 1]) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// The autocorrelation about a lag: the largest within a pixel.
fn near(r: &[f64], lag: f64) -> f64 {
    let l = lag.round() as usize;
    (l.saturating_sub(1)..=l + 1).filter_map(|i| r.get(i)).copied().fold(0.0, f64::max)
}

/// How far the autocorrelation at a lag stands above that half a lag before and after; broad shapes
/// have a high one at every small lag.
pub(crate) fn at(r: &[f64], lag: f64) -> f64 {
    let between = |t: f64| {
        let i = t as usize;
        let value = |n: usize| r.get(n).copied().unwrap_or(0.0);
        value(i) + (value(i + 1) - value(i)) * (t - i as f64)
    };
    (near(r, lag) - 0.5 * (between(0.5 * lag) + between(1.5 * lag))).max(0.0)
}

/// The autocorrelation about a lag if it is a peak there: higher than half a fifth before and
/// after.
pub(crate) fn peak_at(r: &[f64], lag: f64) -> f64 {
    let near = near(r, lag);
    let highest = |from: f64, to: f64| {
        (from as usize..=to as usize).filter_map(|i| r.get(i)).copied().fold(0.0, f64::max)
    };
    let most = highest((0.25 * lag).max(3.0), 0.93 * lag);
    if near >= most { near } else { 0.0 }
}

/// Marks followed along an edge.
#[derive(Debug, Clone)]
pub(crate) struct MarkPhase {
    /// Pixels from a mark to the next at the middle of the marks.
    pub(crate) spacing: f64,
    /// Growth of the spacing from one end to the other, as a share.
    pub(crate) change: f64,
    /// Marks that were followed.
    pub(crate) periods: f64,
    /// Root mean square distance of the marks from the fit, pixels.
    pub(crate) residual: f64,
    /// Share of the windows between the ends in which the marks were seen.
    pub(crate) seen: f64,
    /// Places of the marks along the edge, pixels.
    pub(crate) marks: Vec<f64>,
}

/// A window's place, phase and strength.
#[derive(Debug, Clone, Copy)]
struct Window {
    x: f64,
    phase: f64,
    strength: f64,
}

impl MarkPhase {
    /// Follows marks of about `lag` pixels at the given depths.
    pub(crate) fn follow(strip: &Strip, photo: &RgbImage, depths: &[f64], lag: f64) -> Option<MarkPhase> {
        let windows = windows(&mean_profile(strip, photo, depths), lag);
        let windows = unwrapped(strongest_run(&windows)?);
        let curve = PhaseParabola::through(&windows, lag)?;
        let spacing = 1.0 / curve.rate(0.0);
        let good = spacing.is_finite() && spacing > 0.8 * lag && spacing < 1.25 * lag;
        let (low, high) = (curve.middle - curve.half - 2.5 * lag, curve.middle + curve.half + 2.5 * lag);
        let marks = curve.marks(low.max(0.0), high.min(strip.length as f64));
        let seen = windows.len() as f64 / (curve.half / lag + 1.0);
        (good && marks.len() > 3).then(|| MarkPhase {
            spacing,
            change: (curve.rate(-1.0) - curve.rate(1.0)) / curve.rate(0.0),
            periods: marks.len() as f64,
            residual: curve.residual(&windows) / TAU * spacing,
            seen: seen.min(1.0),
            marks,
        })
    }
}

/// The mean of the profiles at some depths.
fn mean_profile(strip: &Strip, photo: &RgbImage, depths: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; strip.length];
    for d in depths {
        strip.profile(photo, *d).iter().zip(&mut sum).for_each(|(v, s)| *s += v / depths.len() as f64);
    }
    sum
}

/// Phases of the period in windows of ten periods, two apart.
fn windows(s: &[f64], lag: f64) -> Vec<Window> {
    let half = 5.0 * lag;
    let mut list = Vec::new();
    let mut x = half;
    while x + half < s.len() as f64 {
        let (from, to) = ((x - half).ceil() as usize, (x + half) as usize);
        let (mut sum, mut energy) = (Complex::new(0.0, 0.0), 1e-9);
        for (i, v) in s.iter().enumerate().take(to + 1).skip(from) {
            let weight = 0.5 + 0.5 * (std::f64::consts::PI * (i as f64 - x) / half).cos();
            let turn = TAU * i as f64 / lag;
            sum += Complex::new(turn.cos(), -turn.sin()) * (weight * v);
            energy += weight * v * v;
        }
        let strength = sum.norm() / (energy * half).sqrt();
        list.push(Window { x, phase: sum.arg(), strength });
        x += 2.0 * lag;
    }
    list
}

/// The longest run of windows in which the period is strong; single weak ones are bridged.
fn strongest_run(windows: &[Window]) -> Option<&[Window]> {
    let mut strengths: Vec<f64> = windows.iter().map(|w| w.strength).collect();
    strengths.sort_by(f64::total_cmp);
    let strong = strengths.get(strengths.len().checked_sub(1)? * 3 / 4)?;
    let on = |n: usize| windows.get(n).is_some_and(|w| w.strength > 0.45 * strong);
    let (mut best, mut start) = (0..0, None);
    for n in 0..=windows.len() {
        if on(n) || (on(n + 1) && start.is_some() && n < windows.len()) {
            start = start.or(Some(n));
        } else if let Some(s) = start.take().filter(|s| n - s > best.len()) {
            best = s..n;
        }
    }
    (best.len() >= 3).then(|| &windows[best])
}

/// Phases without jumps.
fn unwrapped(run: &[Window]) -> Vec<Window> {
    let mut list = run.to_vec();
    for n in 1..list.len() {
        let jump = list[n].phase - list[n - 1].phase;
        list[n].phase -= TAU * (jump / TAU).round();
    }
    list
}

/// Phases as a parabola over the place from the middle, in halves of the length.
#[derive(Debug, Clone, Copy)]
struct PhaseParabola {
    fit: Vector3<f64>,
    middle: f64,
    half: f64,
    lag: f64,
}

impl PhaseParabola {
    /// The parabola through the phases, with weights of Tukey in a few rounds.
    fn through(windows: &[Window], lag: f64) -> Option<PhaseParabola> {
        let (first, last) = (windows.first()?.x, windows.last()?.x);
        let (middle, half) = ((first + last) / 2.0, ((last - first) / 2.0).max(1e-6));
        let mut curve = PhaseParabola { fit: Vector3::zeros(), middle, half, lag };
        let mut scale = f64::INFINITY;
        for _ in 0..5 {
            let (mut a, mut b) = (Matrix3::zeros(), Vector3::zeros());
            for w in windows {
                let (row, off) = (curve.row(w.x), curve.off(w) / scale);
                let weight = if scale.is_infinite() { 1.0 } else { (1.0 - off * off).max(0.0).powi(2) };
                a += row * row.transpose() * weight;
                b += row * (weight * w.phase);
            }
            curve.fit = a.try_inverse()? * b;
            let offs = windows.iter().map(|w| curve.off(w).abs()).collect();
            scale = (4.5 * crate::side::median(offs)?).max(0.3);
        }
        curve.fit.iter().all(|v| v.is_finite()).then_some(curve)
    }

    fn row(&self, x: f64) -> Vector3<f64> {
        let t = (x - self.middle) / self.half;
        Vector3::new(1.0, t, t * t)
    }

    fn off(&self, w: &Window) -> f64 {
        self.row(w.x).dot(&self.fit) - w.phase
    }

    /// Root mean square of the phases' distances, radians.
    fn residual(&self, windows: &[Window]) -> f64 {
        (windows.iter().map(|w| self.off(w).powi(2)).sum::<f64>() / windows.len() as f64).sqrt()
    }

    /// Marks a pixel, `t` halves of the length from the middle.
    fn rate(&self, t: f64) -> f64 {
        1.0 / self.lag + (self.fit[1] + 2.0 * self.fit[2] * t) / (TAU * self.half)
    }

    /// Marks up to a place.
    fn cycle(&self, x: f64) -> f64 {
        x / self.lag + self.row(x).dot(&self.fit) / TAU
    }

    /// Places between two ends where the cycle is whole: middles of the marks, or of the gaps if
    /// marks are light.
    fn marks(&self, low: f64, high: f64) -> Vec<f64> {
        let spacing = 1.0 / self.rate(0.0);
        let (mut list, mut n, mut x) = (Vec::new(), self.cycle(low).ceil(), low);
        while list.len() < 5000 {
            // A few steps of Newton from the last mark.
            (0..4).for_each(|_| x += (n - self.cycle(x)) * spacing);
            if x > high || x.is_nan() {
                break;
            }
            list.push(x);
            n += 1.0;
            x += spacing;
        }
        list
    }
}
