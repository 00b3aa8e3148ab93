//! A view and its reductions, each half as wide and high, as block matching reads them.

use image::RgbaImage;

/// No reduction is made of a level this high, px.
const LOWEST: usize = 64;
/// Brightness where nothing is seen.
const GREY: i32 = 128;

/// One picture: brightness and coverage of each pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FlowLevel {
    pub(super) width: usize,
    pub(super) height: usize,
    pixels: Vec<[u8; 2]>,
}

impl FlowLevel {
    fn of(view: &RgbaImage) -> FlowLevel {
        let (width, height) = view.dimensions();
        FlowLevel {
            width: width as usize,
            height: height as usize,
            pixels: view.pixels().map(|p| read(p.0)).collect(),
        }
    }

    /// Means of two by two pixels; an odd last row or column counts twice.
    fn half(&self) -> FlowLevel {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mean = |x: usize, y: usize| {
            let corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| self.clamped(2 * x + i, 2 * y + j));
            [0, 1].map(|c| ((corners.iter().map(|p| u32::from(p[c])).sum::<u32>() + 2) / 4) as u8)
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y));
        FlowLevel { width, height, pixels: pixels.collect() }
    }

    fn clamped(&self, x: usize, y: usize) -> [u8; 2] {
        self.pixels[y.min(self.height - 1) * self.width + x.min(self.width - 1)]
    }

    /// Pixels of a row; beyond the picture's border its last pixels repeat.
    pub(super) fn row(&self, y: i32, x: i32, out: &mut [[u8; 2]]) {
        let start = y.clamp(0, self.height as i32 - 1) as usize * self.width;
        if x >= 0 && x as usize + out.len() <= self.width {
            let first = start + x as usize;
            return out.copy_from_slice(&self.pixels[first..first + out.len()]);
        }
        for (k, pixel) in out.iter_mut().enumerate() {
            *pixel = self.pixels[start + (x + k as i32).clamp(0, self.width as i32 - 1) as usize];
        }
    }

    /// Whether anything is seen in a part of the picture.
    pub(super) fn shows(&self, x: std::ops::Range<usize>, y: std::ops::Range<usize>) -> bool {
        let rows = y.start..y.end.min(self.height);
        let end = x.end.min(self.width);
        rows.into_iter().any(|y| (x.start..end).any(|x| self.pixels[y * self.width + x][1] > 0))
    }
}

/// Brightness (ITU-R BT.601), grey where nothing is seen, and coverage.
fn read([r, g, b, a]: [u8; 4]) -> [u8; 2] {
    let light = (299 * i32::from(r) + 587 * i32::from(g) + 114 * i32::from(b) + 500) / 1000;
    [(GREY + (light - GREY) * i32::from(a) / 255) as u8, a]
}

/// The view itself, then its reductions.
#[derive(Debug)]
pub struct Pyramid(pub(super) Vec<FlowLevel>);

impl Pyramid {
    /// Of a view whose transparent pixels show nothing.
    pub fn of(view: &RgbaImage) -> Pyramid {
        let mut levels = vec![FlowLevel::of(view)];
        while let Some(last) = levels.last().filter(|l| l.height > LOWEST) {
            levels.push(last.half());
        }
        Pyramid(levels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn what_is_not_seen_is_grey_and_a_level_is_the_mean_of_the_one_above() {
        let mut view = RgbaImage::from_pixel(3, 65, Rgba([0, 0, 0, 0]));
        view.put_pixel(0, 0, Rgba([255, 255, 255, 255]));
        view.put_pixel(2, 64, Rgba([10, 10, 10, 255]));
        let Pyramid(levels) = Pyramid::of(&view);
        assert_eq!(levels.iter().map(|l| (l.width, l.height)).collect::<Vec<_>>(), [(3, 65), (2, 33)]);
        assert_eq!((levels[0].pixels[0], levels[0].pixels[1]), ([255, 255], [128, 0]));
        assert_eq!(levels[1].pixels[0], [160, 64]);
        assert_eq!(levels[1].pixels[65], [10, 255], "the last row and column count twice");
    }

    #[test]
    fn rows_go_on_beyond_the_border() {
        let view = RgbaImage::from_fn(4, 2, |x, y| Rgba([x as u8 + 10 * y as u8; 4].map(|v| v.max(1))));
        let level = FlowLevel::of(&view);
        let mut out = [[0; 2]; 6];
        level.row(-3, -1, &mut out);
        assert_eq!(out.map(|p| p[1]), [1, 1, 1, 2, 3, 3]);
        level.row(7, 1, &mut out[..2]);
        assert_eq!(out[0][1], 11);
        assert!(level.shows(3..9, 1..9) && !level.shows(4..9, 0..2));
    }
}
