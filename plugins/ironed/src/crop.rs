//! The panel's part of its photo, scaled down by whole numbers.
//!
//! A pixel is inside where its centre lies in a triangle of the panel. Scaling down takes the mean
//! of the inside pixels of a block, in linear light, so that no background is mixed in. Linear in
//! the pixels.

use image::RgbImage;
use toile_core::artifact::{Photo, Point2};

/// Pixels around the panel.
const MARGIN: f64 = 8.0;

/// A crop with the pixels that the panel covers.
pub(crate) struct PanelCrop {
    pub(crate) pixels: RgbImage,
    /// Row by row.
    pub(crate) inside: Vec<bool>,
    /// Photo pixels a pixel.
    pub(crate) step: f64,
    origin: Point2,
}

impl PanelCrop {
    /// Around a panel, its longer side at most `size`; `None` where the panel covers no pixel of
    /// the photo.
    pub(crate) fn of(photo: &Photo, places: &[Point2], triangles: &[[u32; 3]], size: u32) -> Option<Self> {
        let (w, h) = photo.pixels.dimensions();
        let first = *places.first()?;
        let (low, high) = places.iter().fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
        let range = |low: f64, high: f64, size: u32| {
            let from = (low - MARGIN).floor().max(0.0) as u32;
            let to = (high + MARGIN).ceil().min(f64::from(size) - 1.0);
            (to >= f64::from(from)).then(|| (from, to as u32 - from + 1))
        };
        let ((left, width), (top, height)) = (range(low.x, high.x, w)?, range(low.y, high.y, h)?);
        let step = width.max(height).div_ceil(size.max(1));
        let mut covered = vec![false; (width * height) as usize];
        let at = |v: u32| places[v as usize] - corner(left, top);
        for t in triangles {
            scan(t.map(|v| Point2::from(at(v))), width, height, &mut covered);
        }
        let (cw, ch) = (width.div_ceil(step), height.div_ceil(step));
        let mut pixels = RgbImage::new(cw, ch);
        let mut inside = vec![false; (cw * ch) as usize];
        for (k, (pixel, inside)) in pixels.pixels_mut().zip(&mut inside).enumerate() {
            let (x0, y0) = (k as u32 % cw * step, k as u32 / cw * step);
            let block =
                (y0..(y0 + step).min(height)).flat_map(|y| (x0..(x0 + step).min(width)).map(move |x| (x, y)));
            let own = block.filter(|(x, y)| covered[(y * width + x) as usize]);
            let (mut sum, mut count) = ([0.0; 3], 0u32);
            for (x, y) in own {
                let levels = photo.pixels.get_pixel(left + x, top + y).0;
                sum.iter_mut().zip(levels).for_each(|(s, v)| *s += crate::iron::linear(v));
                count += 1;
            }
            if count > 0 {
                pixel.0 = sum.map(|s| crate::iron::encoded(s / f64::from(count)));
                *inside = true;
            }
        }
        let origin = Point2::new(f64::from(left), f64::from(top));
        inside.contains(&true).then(|| PanelCrop { pixels, inside, step: f64::from(step), origin })
    }

    /// Texture coordinates of a photo pixel: (0, 0) and (1, 1) are the outer corners of the first
    /// and last pixel.
    pub(crate) fn uv(&self, px: &Point2) -> [f32; 2] {
        let (w, h) = self.pixels.dimensions();
        let share = |v: f64, from: f64, size: u32| ((v - from + 0.5) / (f64::from(size) * self.step)) as f32;
        [share(px.x, self.origin.x, w), share(px.y, self.origin.y, h)]
    }

    /// Inside pixels with nothing but inside pixels within `depth` along rows and columns.
    pub(crate) fn eroded(&self, depth: usize) -> Vec<bool> {
        let (w, h) = (self.pixels.width() as usize, self.pixels.height() as usize);
        let rows: Vec<bool> = self.inside.chunks_exact(w).flat_map(|row| eroded_line(row, depth)).collect();
        let mut out = vec![false; w * h];
        for x in 0..w {
            let column: Vec<bool> = (0..h).map(|y| rows[y * w + x]).collect();
            eroded_line(&column, depth).into_iter().enumerate().for_each(|(y, v)| out[y * w + x] = v);
        }
        out
    }
}

fn corner(x: u32, y: u32) -> Point2 {
    Point2::new(f64::from(x), f64::from(y))
}

fn eroded_line(line: &[bool], depth: usize) -> Vec<bool> {
    let mut outside = vec![0usize; line.len() + 1];
    line.iter().enumerate().for_each(|(i, v)| outside[i + 1] = outside[i] + usize::from(!v));
    let clear = |i: usize| {
        let whole = i >= depth && i + depth < line.len();
        whole && outside[i + depth + 1] == outside[i - depth]
    };
    (0..line.len()).map(clear).collect()
}

/// Marks the pixels whose centres lie in a triangle of either winding.
fn scan(t: [Point2; 3], width: u32, height: u32, covered: &mut [bool]) {
    let (low, high) = (t[0].inf(&t[1]).inf(&t[2]), t[0].sup(&t[1]).sup(&t[2]));
    let last = |size: u32| f64::from(size) - 1.0;
    for y in low.y.ceil().max(0.0) as u32..=high.y.floor().clamp(0.0, last(height)) as u32 {
        let row = f64::from(y);
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if row < a.y.min(b.y) || row > a.y.max(b.y) {
                continue;
            }
            let s = if a.y == b.y { 0.0 } else { (row - a.y) / (b.y - a.y) };
            let xs = if a.y == b.y { [a.x, b.x] } else { [a.x + s * (b.x - a.x); 2] };
            (from, to) = (from.min(xs[0]).min(xs[1]), to.max(xs[0]).max(xs[1]));
        }
        let (from, to) = (from.ceil().max(0.0), to.floor().min(last(width)));
        if from <= to {
            let start = (y * width) as usize;
            covered[start + from as usize..=start + to as usize].fill(true);
        }
    }
}
