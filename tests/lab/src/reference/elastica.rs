//! Bent strips held at both ends: the heart loop under its weight, and the column whose foot stands
//! on the ground.

use super::root;

/// Runge-Kutta steps along a strip.
const STEPS: usize = 2000;

/// A bent strip as a curve: places at equal arc lengths, and the number that is looked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Height of the loop in strip lengths, or horizontal over vertical force at the foot.
    pub value: f64,
    /// Places (x, y) from the first end to the last, in strip lengths.
    pub places: Vec<[f64; 2]>,
}

/// Integrates (angle, curvature, x, y) over `length` from `start`; the rate of curvature is
/// `bend(s, angle)`.
fn integrate(start: [f64; 4], length: f64, bend: impl Fn(f64, f64) -> f64) -> Vec<[f64; 4]> {
    let h = length / STEPS as f64;
    let rate = |s: f64, y: &[f64; 4]| [y[1], bend(s, y[0]), y[0].cos(), y[0].sin()];
    let moved = |y: &[f64; 4], k: &[f64; 4], t: f64| -> [f64; 4] { std::array::from_fn(|i| y[i] + t * k[i]) };
    let mut all = vec![start];
    let mut y = start;
    for n in 0..STEPS {
        let s = h * n as f64;
        let k1 = rate(s, &y);
        let k2 = rate(s + 0.5 * h, &moved(&y, &k1, 0.5 * h));
        let k3 = rate(s + 0.5 * h, &moved(&y, &k2, 0.5 * h));
        let k4 = rate(s + h, &moved(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        all.push(y);
    }
    all
}

/// Peirce's heart loop (1930): both ends clamped together pointing down, the strip rises, turns out
/// and hangs; `gamma = rho g L³ / D`. The value is the height from the lowest point to the clamp:
/// 0.13386 without weight.
#[must_use]
pub fn heart_loop(gamma: f64) -> Curve {
    // Half of it, from the lowest point: curvature there and level force are looked for, from the
    // weightless ones on.
    let half = |p: [f64; 2], g: f64| {
        integrate([0.0, p[0], 0.0, 0.0], 0.5, move |s, a| p[1] * a.sin() - g * s * a.cos())
    };
    let miss = |p: [f64; 2], g: f64| {
        let end = half(p, g)[STEPS];
        [end[0] - 1.5 * std::f64::consts::PI, end[2]]
    };
    let mut p = [5.11170975, 35.24211043];
    let stages = (gamma / 5.0).ceil().max(1.0) as usize;
    for k in 1..=stages {
        let g = gamma * k as f64 / stages as f64;
        for _ in 0..20 {
            p = newton(p, |p| miss(p, g));
        }
    }
    let right = half(p, gamma);
    let mirrored = right.iter().rev().map(|y| [-y[2], y[3]]);
    let places = mirrored.chain(right.iter().skip(1).map(|y| [y[2], y[3]])).collect();
    Curve { value: right[STEPS][3], places }
}

/// One step of Newton's method in two unknowns.
fn newton(p: [f64; 2], f: impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let e = 1e-6;
    let (o, a, b) = (f(p), f([p[0] + e, p[1]]), f([p[0], p[1] + e]));
    let j = nalgebra::Matrix2::new(a[0] - o[0], b[0] - o[0], a[1] - o[1], b[1] - o[1]) / e;
    match j.try_inverse() {
        Some(inverse) => {
            let d = inverse * nalgebra::Vector2::new(o[0], o[1]);
            [p[0] - d.x, p[1] - d.y]
        }
        None => p,
    }
}

/// A weightless strip clamped upright above its own foot, which is pressed nearer by the share
/// `shortening` of its length. The value is the horizontal over the vertical force at the foot:
/// with less friction than that it slips. Places run from the clamp at the origin, where the strip
/// points along +x.
#[must_use]
pub fn pressed_column(shortening: f64) -> Curve {
    // With the axes along the force: angle'' = -force sin(angle), from the foot, where the strip
    // ends without moment.
    let curve = |start: f64, force: f64| integrate([start, 0.0, 0.0, 0.0], 1.0, move |_, a| -force * a.sin());
    let chord = |end: &[f64; 4]| end[3].atan2(end[2]);
    // The clamp points along the line from foot to clamp: the first buckle of a clamped and pinned
    // column (20.19) or beyond.
    let force = |start: f64| {
        root(12.0, 32.0, |f| {
            let end = curve(start, f)[STEPS];
            end[0] - chord(&end)
        })
    };
    let start = root(1e-3, 2.2, |a| {
        let end = curve(a, force(a))[STEPS];
        1.0 - end[2].hypot(end[3]) - shortening
    });
    let shape = curve(start, force(start));
    let (end, turn) = (shape[STEPS], chord(&shape[STEPS]));
    let place = |y: &[f64; 4]| {
        let (x, z) = (end[2] - y[2], end[3] - y[3]);
        [x * turn.cos() + z * turn.sin(), -x * turn.sin() + z * turn.cos()]
    };
    Curve { value: turn.tan().abs(), places: shape.iter().rev().map(place).collect() }
}

impl Curve {
    /// The place at this share of the length.
    #[must_use]
    pub fn at(&self, share: f64) -> [f64; 2] {
        let last = self.places.len() - 1;
        let s = share.clamp(0.0, 1.0) * last as f64;
        let k = (s as usize).min(last - 1);
        let t = s - k as f64;
        std::array::from_fn(|c| self.places[k][c] * (1.0 - t) + self.places[k + 1][c] * t)
    }
}

/// Period of a plate of length L that swings as a whole from its edge, over sqrt(L/g), from this
/// greatest angle.
#[must_use]
pub fn plate_pendulum(amplitude: f64) -> f64 {
    // Complete elliptic integral by the arithmetic-geometric mean.
    let (mut a, mut b) = (1.0_f64, (0.5 * amplitude).cos());
    for _ in 0..30 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    2.0 * std::f64::consts::PI * (2.0_f64 / 3.0).sqrt() / a
}

/// `rho g L³ / D` at which a narrow strip on edge, clamped at one end, buckles sideways (Prandtl,
/// 1899): 12.85 times the mean of bending and twisting stiffness, `sqrt(2 (1 - nu))` of D.
#[must_use]
pub fn lateral_buckling(poisson: f64) -> f64 {
    12.85 * (2.0 * (1.0 - poisson)).sqrt()
}
