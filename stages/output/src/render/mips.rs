//! Textures at every scale (Williams, *Pyramidal parametrics*, 1983).
//!
//! Each level averages two by two texels of the level above in linear light; a lookup blends
//! bilinearly on the two nearest levels. Where a surface is seen at a slant, several lookups along
//! the slant on a finer level keep the print sharp ([`Footprint`]; Barkans, *High-quality rendering
//! using the Talisman architecture*, 1997).
//! Cost: a third more memory, eight texels a lookup.

use std::sync::LazyLock;
use toile_core::artifact::Texture;

/// Linear light of every sRGB level.
pub(crate) static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| srgb_to_linear(i as f32 / 255.0)));

/// How finely linear light is divided on its way back to sRGB: fine enough that no level is
/// skipped.
const ENCODE_STEPS: usize = 4096;
static ENCODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let level = |i: usize| (linear_to_srgb(i as f32 / ENCODE_STEPS as f32) * 255.0).round() as u8;
    (0..=ENCODE_STEPS).map(level).collect()
});

/// IEC 61966-2-1, decoded.
fn srgb_to_linear(v: f32) -> f32 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// IEC 61966-2-1, encoded.
fn linear_to_srgb(v: f32) -> f32 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// Linear light to an sRGB level; clamped.
pub(crate) fn encode(linear: f32) -> u8 {
    ENCODED[(linear.clamp(0.0, 1.0) * ENCODE_STEPS as f32 + 0.5) as usize]
}

/// A texture and its reductions.
#[derive(Debug)]
pub(crate) struct Mips(Vec<MipLevel>);

/// A share of 255 as it stands, which is how a normal map is read.
static SHARES: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| i as f32 / 255.0));

/// What the numbers of a picture mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Coding {
    /// sRGB colours.
    Colours,
    /// Shares, such as those of a normal map.
    Shares,
}

impl Coding {
    /// The value of every level.
    pub(crate) fn table(self) -> &'static [f32; 256] {
        match self {
            Coding::Colours => &LINEAR,
            Coding::Shares => &SHARES,
        }
    }

    /// The level of a value; clamped.
    pub(crate) fn encode(self, value: f32) -> u8 {
        match self {
            Coding::Colours => encode(value),
            Coding::Shares => (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8,
        }
    }
}

/// Lookups along a slant at most: beyond, the print blurs rather than costs.
const MOST_STEPS: f64 = 8.0;

/// What part of a texture one pixel sees: a row of lookups.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Footprint {
    lod: f32,
    steps: usize,
    /// From the first lookup to the last, texture coordinates.
    along: [f32; 2],
}

impl Default for Footprint {
    fn default() -> Self {
        Footprint { lod: 0.0, steps: 1, along: [0.0; 2] }
    }
}

impl Footprint {
    /// From the map that takes pixels to texels, on a texture of `size` texels.
    ///
    /// A pixel becomes an ellipse whose half axes are the map's singular values.
    pub(crate) fn new(map: &nalgebra::Matrix2<f64>, size: [f64; 2]) -> Footprint {
        if !map.iter().all(|c| c.is_finite()) {
            return Footprint::default();
        }
        // Singular values of a 2x2 matrix in closed form.
        let (square, d) = (map.norm_squared(), map.determinant());
        let spread = (square * square - 4.0 * d * d).max(0.0).sqrt();
        let [major, minor] = [square + spread, square - spread].map(|s| (s.max(0.0) / 2.0).sqrt());
        let steps = (major / minor.max(1.0)).ceil().clamp(1.0, MOST_STEPS);
        let lod = (major / steps).max(minor).max(1.0).log2() as f32;
        // The major axis turns from the texture's first axis by half the angle of this pair.
        let m = map * map.transpose();
        let (sin, cos) = ((2.0 * m[(0, 1)]).atan2(m[(0, 0)] - m[(1, 1)]) / 2.0).sin_cos();
        let span = major * (steps - 1.0) / steps;
        let along = [cos * span / size[0].max(1.0), sin * span / size[1].max(1.0)].map(|c| c as f32);
        Footprint { lod, steps: steps as usize, along }
    }

    /// Mean colour of the row of lookups around (u, v), linear light.
    pub(crate) fn sample(&self, mips: &Mips, uv: [f32; 2]) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for i in 0..self.steps {
            let t = if self.steps > 1 { i as f32 / (self.steps - 1) as f32 - 0.5 } else { 0.0 };
            let at = [uv[0] + t * self.along[0], uv[1] + t * self.along[1]];
            let colour = mips.sample(at, self.lod);
            (0..3).for_each(|c| sum[c] += colour[c]);
        }
        sum.map(|s| s / self.steps as f32)
    }
}

#[derive(Debug)]
struct MipLevel {
    width: usize,
    height: usize,
    texels: Vec<[u8; 3]>,
    /// Whether it repeats beyond its edges; else its border goes on.
    repeats: bool,
    coding: Coding,
}

impl Mips {
    /// All levels of a texture of colours; none for an empty one.
    pub(crate) fn new(texture: &Texture) -> Mips {
        Mips::coded(texture, Coding::Colours)
    }

    /// All levels of a normal map, whose numbers are averaged as they are.
    pub(crate) fn of_normals(texture: &Texture) -> Mips {
        Mips::coded(texture, Coding::Shares)
    }

    fn coded(texture: &Texture, coding: Coding) -> Mips {
        let (w, h) = texture.pixels.dimensions();
        let texels = texture.pixels.pixels().map(|p| p.0).collect();
        let mut levels = vec![MipLevel {
            width: w as usize,
            height: h as usize,
            texels,
            repeats: texture.repeats,
            coding,
        }];
        while let Some(next) = levels.last().and_then(MipLevel::halved) {
            levels.push(next);
        }
        Mips(levels)
    }

    /// Colour at (u, v), linear light; `lod` counts halvings.
    pub(crate) fn sample(&self, uv: [f32; 2], lod: f32) -> [f32; 3] {
        let lod = lod.clamp(0.0, (self.0.len() - 1) as f32);
        let (fine, share) = (lod as usize, lod.fract());
        let a = self.0[fine].bilinear(uv);
        match self.0.get(fine + 1) {
            Some(level) if share > 0.0 => mix(a, level.bilinear(uv), share),
            _ => a,
        }
    }
}

impl MipLevel {
    fn halved(&self) -> Option<MipLevel> {
        if self.width <= 1 && self.height <= 1 || self.texels.is_empty() {
            return None;
        }
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut texels = Vec::with_capacity(width * height);
        let table = self.coding.table();
        for y in 0..height {
            for x in 0..width {
                let at = |dx: usize, dy: usize| {
                    let (x, y) = ((2 * x + dx).min(self.width - 1), (2 * y + dy).min(self.height - 1));
                    self.texels[y * self.width + x].map(|v| table[v as usize])
                };
                let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                texels.push(
                    [0, 1, 2].map(|c| self.coding.encode(four.iter().map(|t| t[c]).sum::<f32>() / 4.0)),
                );
            }
        }
        Some(MipLevel { width, height, texels, repeats: self.repeats, coding: self.coding })
    }

    /// The four texels around a lookup.
    fn around(&self, x: i64, y: i64) -> Option<[[u8; 3]; 4]> {
        let clamp = |v: i64, n: usize| match self.repeats {
            true => v.rem_euclid((n as i64).max(1)) as usize,
            false => v.min(n as i64 - 1).max(0) as usize,
        };
        let (x0, x1) = (clamp(x, self.width), clamp(x.saturating_add(1), self.width));
        let row = |y: i64| {
            let from = clamp(y, self.height) * self.width;
            self.texels.get(from..from + self.width).filter(|row| !row.is_empty())
        };
        let (top, bottom) = (row(y)?, row(y.saturating_add(1))?);
        Some([top[x0], top[x1], bottom[x0], bottom[x1]])
    }

    fn bilinear(&self, uv: [f32; 2]) -> [f32; 3] {
        let (x, y) = (uv[0] * self.width as f32 - 0.5, uv[1] * self.height as f32 - 0.5);
        let ((x, fx), (y, fy)) = (split(x), split(y));
        let Some(four) = self.around(x, y) else { return [1.0; 3] };
        let linear = self.coding.table();
        let [a, b, c, d] = four.map(|t| t.map(|v| linear[v as usize]));
        mix(mix(a, b, fx), mix(c, d, fx), fy)
    }
}

/// The whole number below, and the rest. (`floor` is a call into the mathematics library on
/// processors that a plain build serves.)
fn split(v: f32) -> (i64, f32) {
    let towards_zero = v as i64;
    let whole = if (towards_zero as f32) > v { towards_zero - 1 } else { towards_zero };
    (whole, v - whole as f32)
}

fn mix(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t)
}
