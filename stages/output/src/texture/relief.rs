//! Normal maps of a relief (Blinn, *Simulation of wrinkled surfaces*, 1978).
//!
//! Heights in metres over a grid of texels become unit normals in the tangent frame: x along
//! growing u, y up the picture, z out of the surface, each stored as 0 to 255 for -1 to 1. Slopes
//! are taken with the operator of Sobel (1968), which smooths across its direction. Cost: nine
//! looks at every height.

use image::RgbImage;
use rayon::prelude::*;

/// Heights over a grid, top row first.
pub(super) struct Relief {
    /// Metres.
    pub(super) heights: Vec<f32>,
    /// Texels, at least one to a side.
    pub(super) width: usize,
    pub(super) height: usize,
    /// Side of a texel, metres.
    pub(super) texel: f64,
    /// Whether the relief repeats beyond its edges; else its border goes on.
    pub(super) repeats: bool,
}

impl Relief {
    /// The normal map; `strength` multiplies the heights.
    pub(super) fn normal_map(&self, strength: f64) -> RgbImage {
        let mut map = RgbImage::new(self.width as u32, self.height as u32);
        // Sobel's weights sum to eight texels.
        let steep = if self.texel > 0.0 { (strength / (8.0 * self.texel)) as f32 } else { 0.0 };
        map.par_chunks_mut(3 * self.width.max(1)).enumerate().for_each(|(y, row)| {
            let rows = [self.row(y, -1), self.row(y, 0), self.row(y, 1)];
            for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
                let (left, right) = (self.place(x, -1, self.width), self.place(x, 1, self.width));
                let down = |x: usize| rows[0][x] + 2.0 * rows[1][x] + rows[2][x];
                let along = |row: &[f32]| row[left] + 2.0 * row[x] + row[right];
                let (to_right, up) = (down(right) - down(left), along(rows[0]) - along(rows[2]));
                pixel.copy_from_slice(&encoded([-steep * to_right, -steep * up, 1.0]));
            }
        });
        map
    }

    fn row(&self, y: usize, step: i64) -> &[f32] {
        let first = self.place(y, step, self.height) * self.width;
        &self.heights[first..first + self.width]
    }

    fn place(&self, at: usize, step: i64, count: usize) -> usize {
        let (at, count) = (at as i64 + step, count as i64);
        (if self.repeats { at.rem_euclid(count) } else { at.clamp(0, count - 1) }) as usize
    }
}

/// A direction as a texel of a normal map.
fn encoded(n: [f32; 3]) -> [u8; 3] {
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    n.map(|c| ((c / length * 0.5 + 0.5) * 255.0).round() as u8)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn relief(height: impl Fn(f32, f32) -> f32) -> RgbImage {
        let at = |k: usize| height((k % 8) as f32, (k / 8) as f32);
        let heights = (0..64).map(at).collect();
        Relief { heights, width: 8, height: 8, texel: 1e-3, repeats: false }.normal_map(1.0)
    }

    #[test]
    fn a_flat_relief_has_normals_that_stand_upright() {
        assert!(relief(|_, _| 0.5).pixels().all(|p| p.0 == [128, 128, 255]));
    }

    #[test]
    fn a_slope_of_one_leans_by_half_a_right_angle() {
        // Rising to the right: the normal leans to the left, x = -sqrt(1/2).
        assert_eq!(relief(|x, _| x * 1e-3).get_pixel(4, 4).0, [37, 128, 218]);
        // Rising down the picture: the normal leans up the picture, y = sqrt(1/2).
        assert_eq!(relief(|_, y| y * 1e-3).get_pixel(4, 4).0, [128, 218, 218]);
    }

    #[test]
    fn what_repeats_is_as_steep_over_its_edge_as_within() {
        let wave = |k: usize| (k as f32 * std::f32::consts::TAU / 16.0).sin() * 1e-3;
        let heights = (0..16 * 4).map(|k| wave(k % 16)).collect();
        let map = Relief { heights, width: 16, height: 4, texel: 1e-3, repeats: true }.normal_map(1.0);
        assert_eq!(map.get_pixel(0, 0).0, map.get_pixel(0, 3).0);
        assert!(map.get_pixel(0, 0).0[0] < 128 && map.get_pixel(8, 0).0[0] > 128);
        assert_eq!(map.get_pixel(1, 1).0, map.get_pixel(15, 1).0, "alike on both sides of the crossing");
    }
}
