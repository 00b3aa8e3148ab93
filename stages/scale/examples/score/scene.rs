//! Scenes: a ground, a garment and things on it, seen by a pin-hole camera.

use crate::random::Random;
use crate::texture::Ground;
use crate::thing::{Look, Outline, Thing, blend, shirt};
use image::{ImageBuffer, RgbImage};
use nalgebra::{Matrix3, Point2, Rotation3, Vector3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// A scene with its camera.
#[derive(Debug, Clone)]
pub struct Scene {
    pub width: u32,
    pub height: u32,
    /// From metres on the ground to pixels.
    pub to_pixels: Matrix3<f64>,
    pub ground: Ground,
    /// The later lies above.
    pub things: Vec<Thing>,
    pub light: [f64; 3],
    pub shadow: Option<[f64; 5]>,
    pub blur: f64,
    pub noise: f64,
    pub quality: u8,
    pub seed: u64,
    pub tilt: f64,
}

/// A camera above the ground: pixels a metre at the middle, tilt, and the direction of tilt and
/// roll, radians.
pub fn camera(
    w: u32,
    h: u32,
    density: f64,
    tilt: f64,
    toward: f64,
    roll: f64,
    focal_35mm: f64,
) -> Matrix3<f64> {
    let (wf, hf) = (f64::from(w), f64::from(h));
    let f = focal_35mm / 43.267 * wf.hypot(hf);
    let axis = Vector3::new(toward.cos(), toward.sin(), 0.0);
    let r = Rotation3::new(axis * tilt) * Rotation3::new(Vector3::new(0.0, 0.0, roll));
    let place = Vector3::new(0.0, 0.0, f / density);
    let k = Matrix3::new(f, 0.0, (wf - 1.0) / 2.0, 0.0, f, (hf - 1.0) / 2.0, 0.0, 0.0, 1.0);
    let m = r.matrix();
    k * Matrix3::from_columns(&[m.column(0).into(), m.column(1).into(), place])
}

pub fn through(h: &Matrix3<f64>, x: f64, y: f64) -> Point2<f64> {
    let q = h * Vector3::new(x, y, 1.0);
    Point2::new(q.x / q.z, q.y / q.z)
}

impl Scene {
    /// A scene without things but a garment, of a size and density at the middle.
    pub fn draw(r: &mut Random, w: u32, h: u32, density: f64, tilt: f64) -> Scene {
        let focal = r.from(23.0, 29.0);
        let to_pixels = camera(w, h, density, tilt, r.from(-PI, PI), r.from(-0.15, 0.15), focal);
        let ground = Ground::draw(r);
        let away = |r: &mut Random, base: [f64; 3], least: f64| loop {
            let c = r.colour(20.0, 235.0);
            if (0..3).map(|i| (c[i] - base[i]).powi(2)).sum::<f64>().sqrt() > least {
                return c;
            }
        };
        let cloth = away(r, ground.base, 50.0);
        let stripes = if r.chance(0.3) { r.from(0.006, 0.03) } else { 0.0 };
        let shade = r.from(0.6, 1.3);
        let size = f64::from(w.min(h)) / density;
        let garment = Thing {
            outline: shirt(r, size),
            look: Look::Cloth(cloth, cloth.map(|c| (c * shade).min(250.0)), stripes),
            x: r.from(-0.1, 0.1) * size,
            y: r.from(-0.08, 0.08) * size,
            turn: r.from(-0.3, 0.3),
            thick: 0.002,
        };
        let shadow = r.chance(0.5).then(|| {
            let a = r.from(0.0, TAU);
            [a.cos(), a.sin(), r.from(-0.3, 0.3) * size, r.from(0.004, 0.05), r.from(0.45, 0.8)]
        });
        Scene {
            width: w,
            height: h,
            to_pixels,
            ground,
            things: vec![garment],
            light: [r.from(-0.25, 0.25) / size, r.from(-0.25, 0.25) / size, r.from(0.85, 1.1)],
            shadow,
            blur: r.from(0.5, 1.2),
            noise: r.from(1.0, 4.0),
            quality: r.from(72.0, 95.0) as u8,
            seed: r.below(1 << 30) as u64,
            tilt,
        }
    }

    /// Lays a thing where it is in the frame and beside the garment and the others; false if there
    /// is no room.
    pub fn lay(&mut self, r: &mut Random, mut thing: Thing) -> bool {
        let Some(back) = self.to_pixels.try_inverse() else { return false };
        for _ in 0..4000 {
            let (x, y) = (r.from(0.0, f64::from(self.width)), r.from(0.0, f64::from(self.height)));
            let p = through(&back, x, y);
            (thing.x, thing.y, thing.turn) = (p.x, p.y, r.from(-PI, PI));
            if self.in_frame(&thing, 6.0) && self.free(&thing) {
                self.things.push(thing);
                return true;
            }
        }
        false
    }

    pub fn outline(&self, thing: &Thing) -> Vec<Point2<f64>> {
        let Outline::Box(a, b, _) = thing.outline else { return Vec::new() };
        let (s, c) = thing.turn.sin_cos();
        [[-a, -b], [a, -b], [a, b], [-a, b]]
            .iter()
            .map(|[u, v]| through(&self.to_pixels, thing.x + c * u - s * v, thing.y + s * u + c * v))
            .collect()
    }

    fn in_frame(&self, thing: &Thing, rim: f64) -> bool {
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        self.outline(thing).iter().all(|p| p.x > rim && p.y > rim && p.x < w - rim && p.y < h - rim)
    }

    fn free(&self, thing: &Thing) -> bool {
        let Outline::Box(a, b, _) = thing.outline else { return false };
        let (s, c) = thing.turn.sin_cos();
        let steps = (0..=24).map(|i| f64::from(i) / 12.0 - 1.0).collect::<Vec<_>>();
        steps.iter().all(|i| {
            steps.iter().all(|j| {
                let (u, v) = ((a + 0.012) * i, (b + 0.012) * j);
                let (x, y) = (thing.x + c * u - s * v, thing.y + s * u + c * v);
                self.things.iter().all(|t| {
                    let (p, q) = t.own(x, y);
                    t.outline.distance(p, q) > 0.0
                })
            })
        })
    }

    /// The colour of a place on the ground; `pixel` is a pixel's size there, metres.
    fn at(&self, x: f64, y: f64, pixel: f64) -> [f64; 3] {
        let mut c = self.ground.at(x, y);
        for t in &self.things {
            let (u, v) = t.own(x, y);
            if u.hypot(v) > t.outline.reach() + 0.03 {
                continue;
            }
            // A soft shadow to one side.
            let cast = t.outline.distance(u - 1.2 * t.thick, v - 0.8 * t.thick);
            let dark = 0.3 * (0.5 - cast / (2.0 * t.thick + 1e-6)).clamp(0.0, 1.0);
            c = c.map(|k| k * (1.0 - dark));
            let share = (0.5 - t.outline.distance(u, v) / pixel).clamp(0.0, 1.0);
            if share > 0.0 {
                c = blend(c, t.colour(u, v, pixel), share);
            }
        }
        let light = self.light[2] * (1.0 + self.light[0] * x + self.light[1] * y);
        let shade = self.shadow.map_or(1.0, |[a, b, off, soft, deep]| {
            let t = ((a * x + b * y - off) / soft).clamp(-0.5, 0.5) + 0.5;
            deep + (1.0 - deep) * t * t * (3.0 - 2.0 * t)
        });
        c.map(|k| k * light * shade)
    }

    /// The photo.
    pub fn photo(&self) -> RgbImage {
        let Some(back) = self.to_pixels.try_inverse() else { return RgbImage::new(1, 1) };
        let (w, h) = (self.width as usize, self.height as usize);
        let mut sharp = vec![[0f32; 3]; w * h];
        sharp.par_chunks_mut(w).enumerate().for_each(|(j, row)| {
            for (i, out) in row.iter_mut().enumerate() {
                let centre = through(&back, i as f64, j as f64);
                let pixel = (through(&back, i as f64 + 1.0, j as f64) - centre).norm();
                let mut sum = [0.0; 3];
                for (dx, dy) in [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)] {
                    let p = through(&back, i as f64 + dx, j as f64 + dy);
                    let c = self.at(p.x, p.y, 0.5 * pixel);
                    (0..3).for_each(|n| sum[n] += 0.25 * c[n]);
                }
                *out = sum.map(|v| v as f32);
            }
        });
        let soft = blurred(&sharp, w, h, self.blur);
        let mut image: RgbImage = ImageBuffer::new(self.width, self.height);
        let noise = self.noise;
        let seed = self.seed;
        image.par_chunks_mut(3 * w).enumerate().for_each(|(j, row)| {
            let mut r = Random::new(seed ^ ((j as u64) << 32));
            for i in 0..w {
                let grey = 0.6 * noise * r.normal();
                for c in 0..3 {
                    let v = f64::from(soft[j * w + i][c]) + grey + 0.6 * noise * r.normal();
                    row[3 * i + c] = v.round().clamp(0.0, 255.0) as u8;
                }
            }
        });
        jpeg(&image, self.quality)
    }
}

fn blurred(from: &[[f32; 3]], w: usize, h: usize, sigma: f64) -> Vec<[f32; 3]> {
    let half = (3.0 * sigma).ceil() as isize;
    let mut kernel: Vec<f32> =
        (-half..=half).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp() as f32).collect();
    let total: f32 = kernel.iter().sum();
    kernel.iter_mut().for_each(|k| *k /= total);
    let pass = |from: &[[f32; 3]], dx: isize, dy: isize| {
        let mut to = vec![[0f32; 3]; w * h];
        to.par_chunks_mut(w).enumerate().for_each(|(j, row)| {
            for (i, out) in row.iter_mut().enumerate() {
                for (n, k) in kernel.iter().enumerate() {
                    let d = n as isize - half;
                    let x = (i as isize + d * dx).clamp(0, w as isize - 1) as usize;
                    let y = (j as isize + d * dy).clamp(0, h as isize - 1) as usize;
                    (0..3).for_each(|c| out[c] += k * from[y * w + x][c]);
                }
            }
        });
        to
    };
    pass(&pass(from, 1, 0), 0, 1)
}

/// Through a JPEG file in memory.
pub fn jpeg(image: &RgbImage, quality: u8) -> RgbImage {
    let mut bytes = Vec::new();
    let coder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, quality);
    if image.write_with_encoder(coder).is_err() {
        return image.clone();
    }
    image::load_from_memory(&bytes).map_or_else(|_| image.clone(), |i| i.to_rgb8())
}
