//! Textures at every scale (Williams, *Pyramidal parametrics*, 1983).
//!
//! Each level averages two by two texels of the level above in linear light; a lookup blends
//! bilinearly on the two nearest levels. Cost: a third more memory, eight texels a lookup.

use image::RgbImage;
use std::sync::LazyLock;

/// Linear light of every sRGB level.
pub(crate) static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| srgb_to_linear(i as f32 / 255.0)));

/// How finely linear light is divided on its way back to sRGB: fine enough that no level is skipped.
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
pub(crate) struct Mips(Vec<Level>);

#[derive(Debug)]
struct Level {
    width: usize,
    height: usize,
    texels: Vec<[u8; 3]>,
}

impl Mips {
    /// All levels of a picture; none for an empty one.
    pub(crate) fn new(picture: &RgbImage) -> Mips {
        let (w, h) = picture.dimensions();
        let texels = picture.pixels().map(|p| p.0).collect();
        let mut levels = vec![Level { width: w as usize, height: h as usize, texels }];
        while let Some(next) = levels.last().and_then(Level::halved) {
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

impl Level {
    fn halved(&self) -> Option<Level> {
        if self.width <= 1 && self.height <= 1 || self.texels.is_empty() {
            return None;
        }
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut texels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let at = |dx: usize, dy: usize| {
                    let (x, y) = ((2 * x + dx).min(self.width - 1), (2 * y + dy).min(self.height - 1));
                    self.texels[y * self.width + x].map(|v| LINEAR[v as usize])
                };
                let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                texels.push([0, 1, 2].map(|c| encode(four.iter().map(|t| t[c]).sum::<f32>() / 4.0)));
            }
        }
        Some(Level { width, height, texels })
    }

    fn texel(&self, x: i64, y: i64) -> [f32; 3] {
        let clamp = |v: i64, n: usize| v.clamp(0, n as i64 - 1) as usize;
        let at = clamp(y, self.height) * self.width + clamp(x, self.width);
        self.texels.get(at).map_or([1.0; 3], |t| t.map(|v| LINEAR[v as usize]))
    }

    fn bilinear(&self, uv: [f32; 2]) -> [f32; 3] {
        let (x, y) = (uv[0] * self.width as f32 - 0.5, uv[1] * self.height as f32 - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let (x, y) = (x.floor() as i64, y.floor() as i64);
        let top = mix(self.texel(x, y), self.texel(x + 1, y), fx);
        let bottom = mix(self.texel(x, y + 1), self.texel(x + 1, y + 1), fx);
        mix(top, bottom, fy)
    }
}

fn mix(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t)
}
