//! Light from a panorama: a picture of everything around, as wide as 360 and as high as 180
//! degrees.
//!
//! The picture is reduced to [`WIDTH`] by half as many cells; every cell is a light at that
//! direction (image-based lighting: Debevec, 1998). Soft light from all of them falls on every
//! place that they reach; the brightest region is the key light as well, whose shadows have an
//! edge. The middle of the picture is seen behind the wearer, from the front. Limit: the picture's
//! own levels count, so lamps brighter than its white are taken as white.

use super::mips::LINEAR;
use image::RgbImage;
use toile_core::artifact::{Digester, Vector3};

/// Cells around.
const WIDTH: usize = 48;
const HEIGHT: usize = WIDTH / 2;
/// The mean of the light over all directions, as strong as that of the studio without a panorama.
const MEAN: f64 = 0.725;
/// The key light's region, as the sine of its half angle.
const REGION: f64 = 0.35;

/// A panorama's light.
#[derive(Debug, Clone)]
pub struct Surroundings {
    /// Luminance by cells, mean [`MEAN`], top row first.
    light: Vec<f64>,
    /// Colour of the light from all sides, of luminance one.
    pub(super) tint: [f32; 3],
    /// The brightest region above the horizon.
    pub(super) key: Vector3,
    /// How much of the studio's key light it gives, 0 to 1: none where all sides are alike.
    pub(super) strength: f64,
    /// Its colour, of luminance one.
    pub(super) key_tint: [f32; 3],
}

impl Surroundings {
    /// From a picture; a black one is taken as an even grey one.
    pub fn new(panorama: &RgbImage) -> Surroundings {
        let colours = cells(panorama);
        let solid = |row: usize| (std::f64::consts::PI * (row as f64 + 0.5) / HEIGHT as f64).sin();
        let all: f64 = (0..HEIGHT).map(|r| solid(r) * WIDTH as f64).sum();
        let mean = (0..WIDTH * HEIGHT).fold([0.0; 3], |sum: [f64; 3], i| {
            [0, 1, 2].map(|c| sum[c] + colours[i][c] * solid(i / WIDTH) / all)
        });
        if luminance(&mean) < 1e-4 {
            let light = vec![MEAN; WIDTH * HEIGHT];
            return Surroundings {
                light,
                tint: [1.0; 3],
                key: Vector3::y(),
                strength: 0.0,
                key_tint: [1.0; 3],
            };
        }
        let region = |towards: &Vector3| {
            let (mut sum, mut weight) = ([0.0; 3], 0.0);
            for (i, colour) in colours.iter().enumerate() {
                let share = solid(i / WIDTH) * (towards.dot(&direction(i)) - (1.0 - REGION)).max(0.0);
                (0..3).for_each(|c| sum[c] += colour[c] * share);
                weight += share;
            }
            sum.map(|s: f64| s / f64::max(weight, 1e-12))
        };
        let above = (0..WIDTH * HEIGHT).map(direction).filter(|d| d.y > 0.1 && d.y < 0.95);
        let (key, colour) = above.fold((Vector3::y(), [0.0; 3]), |best, d| {
            let colour = region(&d);
            if luminance(&colour) > luminance(&best.1) { (d, colour) } else { best }
        });
        let unit = |c: &[f64; 3]| c.map(|v| (v / luminance(c).max(1e-9)) as f32);
        let strength = 1.0 - (luminance(&mean) / luminance(&colour).max(1e-9)).min(1.0);
        let light = colours.iter().map(|c| MEAN * luminance(c) / luminance(&mean)).collect();
        Surroundings { light, tint: unit(&mean), key, strength, key_tint: unit(&colour) }
    }

    /// How bright it is in a direction.
    pub(super) fn towards(&self, d: &Vector3) -> f64 {
        let around = 0.5 + d.x.atan2(-d.z) / std::f64::consts::TAU;
        let down = d.y.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
        let cell = |v: f64, count: usize| ((v * count as f64) as usize).min(count - 1);
        self.light[cell(down, HEIGHT) * WIDTH + cell(around, WIDTH)]
    }

    /// Everything by which it changes light.
    pub(super) fn digest(&self, d: &mut Digester) {
        d.text("panorama").floats(self.light.iter().copied());
    }
}

/// The direction of a cell.
fn direction(cell: usize) -> Vector3 {
    let around = std::f64::consts::TAU * ((cell % WIDTH) as f64 + 0.5) / WIDTH as f64 - std::f64::consts::PI;
    let down = std::f64::consts::PI * ((cell / WIDTH) as f64 + 0.5) / HEIGHT as f64;
    Vector3::new(down.sin() * around.sin(), down.cos(), -down.sin() * around.cos())
}

/// The means of a picture's cells, linear light.
fn cells(picture: &RgbImage) -> Vec<[f64; 3]> {
    let (w, h) = (picture.width() as usize, picture.height() as usize);
    let span = |i: usize, count: usize, size: usize| {
        let from = (i * size / count).min(size - 1);
        from..((i + 1) * size / count).max(from + 1)
    };
    let mean = |i: usize| {
        let (columns, rows) = (span(i % WIDTH, WIDTH, w), span(i / WIDTH, HEIGHT, h));
        let count = (columns.len() * rows.len()) as f64;
        let mut sum = [0.0; 3];
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let p = picture.get_pixel(x as u32, y as u32).0;
            (0..3).for_each(|c| sum[c] += f64::from(LINEAR[p[c] as usize]));
        }
        sum.map(|s| s / count)
    };
    if w == 0 || h == 0 { vec![[0.0; 3]; WIDTH * HEIGHT] } else { (0..WIDTH * HEIGHT).map(mean).collect() }
}

/// Luminance of linear light.
fn luminance(c: &[f64; 3]) -> f64 {
    0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn a_lamp_is_found_where_it_stands_and_in_its_colour() {
        // A quarter right of the middle: to the wearer's left, which is +x; above the horizon.
        let lamp = |x: u32, y: u32| (280..320).contains(&x) && (50..80).contains(&y);
        let room =
            RgbImage::from_fn(400, 200, |x, y| Rgb(if lamp(x, y) { [255, 220, 160] } else { [60; 3] }));
        let light = Surroundings::new(&room);
        assert!(light.key.x > 0.7 && light.key.y > 0.3 && light.key.z.abs() < 0.3, "{:?}", light.key);
        assert!(light.strength > 0.5 && light.key_tint[0] > 1.05 && light.key_tint[2] < 0.9);
        assert!(light.towards(&light.key) > 5.0 * light.towards(&-light.key));
    }

    #[test]
    fn an_even_panorama_is_the_same_light_from_all_sides() {
        for level in [0, 128, 255] {
            let light = Surroundings::new(&RgbImage::from_pixel(64, 32, Rgb([level; 3])));
            assert!(light.strength < 1e-9);
            for d in [Vector3::x(), -Vector3::y(), Vector3::z()] {
                assert!((light.towards(&d) - MEAN).abs() < 1e-9, "{level}");
            }
        }
    }
}
