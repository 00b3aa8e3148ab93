//! Things that lie on the ground. Places in metres in the thing's own frame.

use crate::random::{Random, noise};

type Colour = [f64; 3];

/// What a thing looks like.
#[derive(Debug, Clone)]
pub enum Look {
    /// A card or phone: base colour, second colour, seed of the print.
    Print(Colour, Colour, u64),
    /// Paper, with lines of text in tone `1` if its seed is odd.
    Paper(Colour, u64),
    /// Squares of a side, rows and columns of them, dark and light.
    Chess { square: f64, columns: usize, rows: usize, dark: Colour, light: Colour },
    /// A ruler with marks each millimetre (`true`) or centimetre.
    Ruler { base: Colour, ink: Colour, fine: bool },
    /// Cloth: base colour, second colour, stripes of a width or 0.
    Cloth(Colour, Colour, f64),
}

/// A thing and its place on the ground.
#[derive(Debug, Clone)]
pub struct Thing {
    pub outline: Outline,
    pub look: Look,
    pub x: f64,
    pub y: f64,
    pub turn: f64,
    /// Height above the ground, which gives the shadow's width, metres.
    pub thick: f64,
}

#[derive(Debug, Clone)]
pub enum Outline {
    /// Half sides and radius.
    Box(f64, f64, f64),
    Polygon(Vec<[f64; 2]>),
}

impl Outline {
    /// Signed distance, negative inside.
    pub fn distance(&self, x: f64, y: f64) -> f64 {
        match self {
            Outline::Box(a, b, r) => {
                let (dx, dy) = (x.abs() - a + r, y.abs() - b + r);
                dx.max(0.0).hypot(dy.max(0.0)) + dx.max(dy).min(0.0) - r
            }
            Outline::Polygon(p) => polygon(p, x, y),
        }
    }

    pub fn reach(&self) -> f64 {
        match self {
            Outline::Box(a, b, _) => a.hypot(*b),
            Outline::Polygon(p) => p.iter().map(|q| q[0].hypot(q[1])).fold(0.0, f64::max),
        }
    }
}

fn polygon(p: &[[f64; 2]], x: f64, y: f64) -> f64 {
    let (mut near, mut within) = (f64::INFINITY, false);
    for i in 0..p.len() {
        let ([ax, ay], [bx, by]) = (p[i], p[(i + 1) % p.len()]);
        let (ex, ey, wx, wy) = (bx - ax, by - ay, x - ax, y - ay);
        let t = ((wx * ex + wy * ey) / (ex * ex + ey * ey)).clamp(0.0, 1.0);
        near = near.min((wx - ex * t).hypot(wy - ey * t));
        if (ay > y) != (by > y) && x < ax + (y - ay) * ex / ey {
            within = !within;
        }
    }
    if within { -near } else { near }
}

impl Thing {
    pub fn own(&self, x: f64, y: f64) -> (f64, f64) {
        let (s, c) = self.turn.sin_cos();
        let (x, y) = (x - self.x, y - self.y);
        (c * x + s * y, c * y - s * x)
    }

    /// The colour at a place of the thing's frame; `pixel` is the size of a pixel there, metres.
    pub fn colour(&self, u: f64, v: f64, pixel: f64) -> Colour {
        match &self.look {
            Look::Print(base, other, seed) => self.print(*base, *other, *seed, u, v, pixel),
            Look::Paper(base, seed) => paper(*base, *seed, u, v, pixel, &self.outline),
            Look::Chess { square, columns, rows, dark, light } => {
                let (w, h) = (*columns as f64, *rows as f64);
                let (a, b) = (u / square + w / 2.0, v / square + h / 2.0);
                let p = pixel / square;
                let inside = band(a, 0.0, w, p) * band(b, 0.0, h, p);
                let odd = wave(a, p) * wave(b, p);
                blend(*light, *dark, inside * (0.5 + 0.5 * odd))
            }
            Look::Ruler { base, ink, fine } => ruler(*base, *ink, *fine, u, v, pixel, &self.outline),
            Look::Cloth(base, other, width) if *width > 0.0 => {
                blend(*base, *other, 0.5 + 0.5 * wave(u / width, pixel / width))
            }
            Look::Cloth(base, other, _) => blend(*base, *other, 0.3 * noise(u * 8.0, v * 8.0, 5).abs()),
        }
    }

    fn print(&self, base: Colour, other: Colour, seed: u64, u: f64, v: f64, pixel: f64) -> Colour {
        let Outline::Box(a, b, _) = self.outline else { return base };
        let (s, t) = (u / a, v / b);
        let mut c = blend(base, other, 0.15 * (s + t).clamp(-1.0, 1.0) + 0.15);
        if seed & 1 == 1 {
            // A stripe along, off the edge.
            c = blend(c, [25.0, 25.0, 30.0], band(v, -0.75 * b, -0.35 * b, pixel));
        }
        if seed & 2 == 2 {
            let chip = band(u, -0.7 * a, -0.42 * a, pixel) * band(v, -0.2 * b, 0.2 * b, pixel);
            c = blend(c, [205.0, 175.0, 90.0], chip);
        }
        if seed & 4 == 4 {
            let text = band(v, 0.35 * b, 0.5 * b, pixel) * band(u, -0.7 * a, 0.7 * a, pixel);
            let letters = if noise(u * 600.0, 0.3, seed) > 0.0 { 1.0 } else { 0.0 };
            c = blend(c, other, text * letters);
        }
        if seed & 8 == 8 {
            let ring = 1.0 - (((s - 0.6).hypot(t * b / a - 0.2) * a - 0.2 * a).abs() / 0.002).min(1.0);
            c = blend(c, other, ring);
        }
        c
    }
}

fn paper(base: Colour, seed: u64, u: f64, v: f64, pixel: f64, outline: &Outline) -> Colour {
    let Outline::Box(a, b, _) = *outline else { return base };
    let mut c = base;
    if seed % 2 == 1 {
        let row = (u / 0.007).floor();
        let on = band(u - row * 0.007, 0.001, 0.004, pixel)
            * band(u, -a + 0.025, a - 0.025, pixel)
            * band(v, -b + 0.02, b - 0.02, pixel);
        let letters = (noise(v * 500.0, row * 1.37 + 0.5, seed) * 3.0).clamp(0.0, 1.0);
        c = blend(c, [50.0; 3], on * letters * 0.9);
    }
    if seed % 4 >= 2 {
        let d = (u.abs() - a + 0.015).max(v.abs() - b + 0.015).abs();
        c = blend(c, [60.0, 60.0, 80.0], 1.0 - (d / 0.0006).min(1.0));
    }
    c
}

fn ruler(base: Colour, ink: Colour, fine: bool, u: f64, v: f64, pixel: f64, outline: &Outline) -> Colour {
    let Outline::Box(a, b, _) = *outline else { return base };
    let along = u + a - 0.006;
    let deep = v + b;
    let mut c = base;
    let end = 2.0 * a - 0.012;
    let mut mark = |pitch: f64, depth: f64| {
        let n = (along / pitch).round();
        if n * pitch < -1e-6 || n * pitch > end + 1e-6 {
            return;
        }
        let d = (along - n * pitch).abs();
        let width = 0.00018;
        let covered =
            ((d + pixel / 2.0).min(width / 2.0) - (d - pixel / 2.0).max(-width / 2.0)).max(0.0) / pixel;
        c = blend(c, ink, covered.min(1.0) * band(deep, -0.001, depth, pixel));
    };
    if fine {
        mark(0.001, 0.0035);
        mark(0.005, 0.005);
        mark(0.01, 0.007);
    } else {
        mark(0.01, 0.006);
    }
    // Numbers, as blots beside each centimetre.
    let n = (along / 0.01).round();
    let blot = band(along - n * 0.01, -0.0012, 0.0012, pixel) * band(deep, 0.0085, 0.0115, pixel);
    let holes = if noise(along * 1500.0, deep * 1500.0, n as u64) > -0.3 { 1.0 } else { 0.0 };
    blend(c, ink, blot * holes)
}

/// 1 between two places, 0 outside, with a pixel's ramp.
pub fn band(t: f64, a: f64, b: f64, pixel: f64) -> f64 {
    (((t - a).min(b - t)) / pixel + 0.5).clamp(0.0, 1.0)
}

/// A square wave of period 2 with a pixel's ramp: 1 in even cells, -1 in odd ones.
fn wave(t: f64, pixel: f64) -> f64 {
    let d = t.rem_euclid(2.0);
    let edge = (d.min((d - 1.0).abs()).min(2.0 - d) / (pixel / 2.0)).min(1.0);
    if d < 1.0 { edge } else { -edge }
}

pub fn blend(a: Colour, b: Colour, t: f64) -> Colour {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// A shirt laid flat about its middle.
pub fn shirt(r: &mut Random, scale: f64) -> Outline {
    let (w, h) = (r.from(0.22, 0.27) * scale, r.from(0.3, 0.36) * scale);
    let s = r.from(0.12, 0.2) * scale;
    let right = [
        [0.09 * scale, -h],
        [w, -0.88 * h],
        [w + s, -0.45 * h],
        [w + 0.6 * s, -0.3 * h],
        [w * 0.95, -0.5 * h],
        [w, h],
    ];
    let mut p: Vec<[f64; 2]> = right.to_vec();
    p.extend(right.iter().rev().map(|q| [-q[0], q[1]]));
    p.push([0.0, -0.85 * h]);
    Outline::Polygon(p)
}
