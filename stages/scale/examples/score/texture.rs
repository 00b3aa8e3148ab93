//! Grounds on which garments are laid. Places in metres, colours in grey levels.

use crate::random::{Random, noise, rough};
use std::f64::consts::PI;

type Colour = [f64; 3];

/// A ground's pattern.
#[derive(Debug, Clone)]
pub struct Ground {
    pub kind: usize,
    pub base: Colour,
    pub other: Colour,
    pub size: f64,
    pub turn: f64,
    pub seed: u64,
}

pub const KINDS: [&str; 6] = ["plain", "wood", "planks", "cloth", "checks", "noise"];

impl Ground {
    pub fn draw(r: &mut Random) -> Self {
        let kind = r.below(KINDS.len());
        let base = match kind {
            1 | 2 => {
                let v = r.from(70.0, 190.0);
                [v * 1.1, v * 0.9, v * 0.7]
            }
            _ => {
                let v = r.from(60.0, 210.0);
                let c = r.colour(-25.0, 25.0);
                c.map(|d| v + d)
            }
        };
        let shift = r.from(18.0, 45.0) * if r.chance(0.5) { 1.0 } else { -1.0 };
        let other = base.map(|v| v + shift);
        let size = match kind {
            4 => r.from(0.01, 0.05),
            3 => r.from(0.0015, 0.004),
            _ => r.from(0.06, 0.14),
        };
        Ground { kind, base, other, size, turn: r.from(0.0, PI), seed: r.below(1 << 30) as u64 }
    }

    pub fn at(&self, x: f64, y: f64) -> Colour {
        let (s, c) = self.turn.sin_cos();
        let (u, v) = (c * x + s * y, c * y - s * x);
        let part = match self.kind {
            0 => 0.15 * rough(u * 40.0, v * 40.0, self.seed),
            1 => self.grain(u, v),
            2 => self.planks(u, v),
            3 => self.weave(u, v),
            4 => self.checks(u, v),
            _ => 0.5 * rough(u * 150.0, v * 150.0, self.seed),
        };
        std::array::from_fn(|i| self.base[i] + (self.other[i] - self.base[i]) * part)
    }

    fn grain(&self, u: f64, v: f64) -> f64 {
        let bend = 0.01 * noise(u * 4.0, v * 6.0, self.seed + 9);
        0.6 * rough(u * 12.0, (v + bend) * 220.0, self.seed)
            + 0.3 * noise(u * 3.0, (v + bend) * 40.0, self.seed + 5)
    }

    fn planks(&self, u: f64, v: f64) -> f64 {
        let row = (v / self.size).floor();
        let long = self.size * 6.0;
        let shift = long * (noise(row * 7.3 + 0.5, 0.5, self.seed) + 1.0);
        let column = ((u + shift) / long).floor();
        let tone = 0.5 * noise(row * 3.1 + 0.37, column * 5.7 + 0.2, self.seed + 3);
        let (dv, du) = ((v / self.size - row) * self.size, ((u + shift) / long - column) * long);
        let joint = |d: f64| (1.0 - (d / 0.0012)).clamp(0.0, 1.0);
        let dark = joint(dv).max(joint(self.size - dv)).max(joint(du)).max(joint(long - du));
        let sign = if self.other[0] > self.base[0] { -1.5 } else { 1.5 };
        0.6 * self.grain(u + 3.0 * row, v + column) + tone + sign * dark
    }

    fn weave(&self, u: f64, v: f64) -> f64 {
        let turn = std::f64::consts::TAU / self.size;
        let wave = (u * turn).sin() * (v * turn).sin();
        0.35 * wave
            + 0.2 * noise(u / self.size, v * 30.0, self.seed)
            + 0.2 * noise(u * 30.0, v / self.size, self.seed + 1)
    }

    fn checks(&self, u: f64, v: f64) -> f64 {
        let half = |t: f64| {
            let d = (t / self.size).rem_euclid(2.0);
            let edge = (d - 1.0).abs().min(d.min(2.0 - d)) * self.size / 0.0006;
            let side = if d < 1.0 { 1.0 } else { -1.0 };
            side * edge.clamp(0.0, 1.0)
        };
        0.5 * (half(u) + half(v)) + 0.08 * rough(u * 300.0, v * 300.0, self.seed)
    }
}
