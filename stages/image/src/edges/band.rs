//! Pictures that exist only in a band around the boundary.
//!
//! An operator reads a few pixels around each point, and only points near the mask's boundary
//! matter: the picture is cut into tiles, and tiles out of reach are never computed. Cost: about
//! three tiles' worth of pixels for each tile's length of boundary, instead of the whole picture
//! (a twelfth of a 12-megapixel photo).

use image::RgbImage;
use rayon::prelude::*;
use toile_core::artifact::Point2;

/// Side of a tile, pixels: larger tiles compute more that is not needed, smaller ones repeat more
/// of their rims.
const TILE: usize = 48;
const NONE: u32 = u32::MAX;

/// A square piece of a grey picture, row by row.
#[derive(Debug, Clone)]
pub(crate) struct PicturePatch {
    pub(crate) side: usize,
    pub(crate) data: Vec<f32>,
}

impl PicturePatch {
    /// Correlates with `across` along rows and `down` along columns (odd lengths); the result is
    /// smaller by the kernels' radii on each side, so nothing is made up at the rim. Both kernels
    /// have one length.
    pub(crate) fn separable(&self, across: &[f32], down: &[f32]) -> PicturePatch {
        let (n, k) = (self.side, across.len());
        let side = n + 1 - k;
        let mut rows = vec![0.0; n * side];
        for (row, out) in self.data.chunks_exact(n).zip(rows.chunks_exact_mut(side)) {
            for (x, o) in out.iter_mut().enumerate() {
                *o = row[x..x + k].iter().zip(across).map(|(v, c)| v * c).sum();
            }
        }
        let mut data = vec![0.0; side * side];
        for (y, out) in data.chunks_exact_mut(side).enumerate() {
            for (i, c) in down.iter().enumerate() {
                let row = &rows[(y + i) * side..(y + i + 1) * side];
                out.iter_mut().zip(row).for_each(|(o, v)| *o += c * v);
            }
        }
        PicturePatch { side, data }
    }

    /// Point by point.
    pub(crate) fn zip(&self, other: &PicturePatch, f: impl Fn(f32, f32) -> f32) -> PicturePatch {
        let data = self.data.iter().zip(&other.data).map(|(&a, &b)| f(a, b)).collect();
        PicturePatch { side: self.side, data }
    }

    /// The inner part, `rim` pixels from each side.
    pub(crate) fn core(&self, rim: usize) -> PicturePatch {
        let side = self.side - 2 * rim;
        let row = |y: usize| &self.data[(y + rim) * self.side + rim..][..side];
        PicturePatch { side, data: (0..side).flat_map(row).copied().collect() }
    }
}

/// Which tiles of a picture are computed.
#[derive(Debug)]
pub(crate) struct TileBand {
    size: [usize; 2],
    columns: usize,
    index: Vec<u32>,
    tiles: Vec<[usize; 2]>,
}

impl TileBand {
    /// The tiles within `reach` pixels of any of the points (pixels, y up).
    pub(crate) fn around(size: [usize; 2], points: &[Point2], reach: f64) -> Self {
        let [columns, rows] = size.map(|n| n.div_ceil(TILE).max(1));
        let mut wanted = vec![false; columns * rows];
        let tile = |v: f64, count: usize| ((v.max(0.0) as usize) / TILE).min(count - 1);
        for p in points {
            for ty in tile(-p.y - reach, rows)..=tile(-p.y + reach, rows) {
                for tx in tile(p.x - reach, columns)..=tile(p.x + reach, columns) {
                    wanted[ty * columns + tx] = true;
                }
            }
        }
        let mut band = TileBand { size, columns, index: vec![NONE; wanted.len()], tiles: Vec::new() };
        for (i, _) in wanted.iter().enumerate().filter(|(_, w)| **w) {
            band.index[i] = band.tiles.len() as u32;
            band.tiles.push([i % columns * TILE, i / columns * TILE]);
        }
        band
    }

    /// Runs `f` on the grey patch of every tile, which reaches `halo` pixels beyond the tile.
    pub(crate) fn map<R: Send>(
        &self,
        photo: &RgbImage,
        halo: usize,
        f: impl Fn(PicturePatch) -> R + Sync,
    ) -> Vec<R> {
        self.tiles.par_iter().map(|&origin| f(grey_patch(photo, origin, halo))).collect()
    }

    /// Patches of tile size as one picture.
    pub(crate) fn plane(&self, tiles: Vec<PicturePatch>) -> BandPicture<'_> {
        BandPicture { band: self, tiles }
    }

    /// A picture that is zero everywhere.
    pub(crate) fn blank(&self) -> BandPicture<'_> {
        let tile = PicturePatch { side: TILE, data: vec![0.0; TILE * TILE] };
        self.plane(vec![tile; self.tiles.len()])
    }

    /// Width and height of the whole picture.
    pub(crate) fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Every pixel of the band that lies in the picture, tile by tile.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.tiles.iter().flat_map(|&[x0, y0]| {
            let columns = x0..(x0 + TILE).min(self.size[0]);
            (y0..(y0 + TILE).min(self.size[1])).flat_map(move |y| columns.clone().map(move |x| [x, y]))
        })
    }
}

/// Luminance (Rec. 601, sRGB levels) around a tile; the picture goes on beyond its frame.
fn grey_patch(photo: &RgbImage, [x0, y0]: [usize; 2], halo: usize) -> PicturePatch {
    let (w, h) = (photo.width() as i64, photo.height() as i64);
    let side = TILE + 2 * halo;
    let raw = photo.as_raw();
    let mut data = Vec::with_capacity(side * side);
    for j in 0..side {
        let y = (y0 as i64 + j as i64 - halo as i64).clamp(0, h - 1);
        for i in 0..side {
            let x = (x0 as i64 + i as i64 - halo as i64).clamp(0, w - 1);
            let at = 3 * (y * w + x) as usize;
            let [r, g, b] = [0, 1, 2].map(|k| f32::from(raw[at + k]));
            data.push(0.299 * r + 0.587 * g + 0.114 * b);
        }
    }
    PicturePatch { side, data }
}

/// A picture known in a band.
#[derive(Debug)]
pub(crate) struct BandPicture<'a> {
    band: &'a TileBand,
    tiles: Vec<PicturePatch>,
}

impl BandPicture<'_> {
    fn place(&self, x: usize, y: usize) -> Option<(usize, usize)> {
        let tile = self.band.index[(y / TILE) * self.band.columns + x / TILE];
        (tile != NONE).then_some((tile as usize, (y % TILE) * TILE + x % TILE))
    }

    /// The value at a pixel; zero outside the band. The picture goes on beyond its frame.
    pub(crate) fn at(&self, x: i64, y: i64) -> f32 {
        let clamp = |v: i64, n: usize| v.clamp(0, n as i64 - 1) as usize;
        let [w, h] = self.band.size;
        self.place(clamp(x, w), clamp(y, h)).map_or(0.0, |(t, i)| self.tiles[t].data[i])
    }

    /// Sets a pixel of the band.
    pub(crate) fn set(&mut self, x: usize, y: usize, value: f32) {
        if let Some((t, i)) = self.place(x, y) {
            self.tiles[t].data[i] = value;
        }
    }

    /// The value at a point (pixels, y up) by cubic convolution (R. Keys, 1981). Bilinear
    /// interpolation would draw the top of a ridge towards the nearest pixel, by up to a quarter of
    /// one.
    pub(crate) fn sample(&self, p: Point2) -> f64 {
        let (x, y) = (p.x.floor(), (-p.y).floor());
        let (across, down) = (cubic(p.x - x), cubic(-p.y - y));
        let row = |j: i64| -> f64 {
            let at = |i: i64| f64::from(self.at(x as i64 + i - 1, y as i64 + j - 1));
            (0..4).map(|i| across[i as usize] * at(i)).sum()
        };
        (0..4).map(|j| down[j as usize] * row(j)).sum()
    }

    /// The greatest value of the 3 x 3 pixels around a point (pixels, y up).
    pub(crate) fn greatest_near(&self, p: Point2) -> f32 {
        let (x, y) = (p.x.round() as i64, (-p.y).round() as i64);
        (0..9).map(|k| self.at(x + k % 3 - 1, y + k / 3 - 1)).fold(0.0, f32::max)
    }
}

/// Keys's weights of the pixels at -1, 0, 1 and 2 for a point at `t` between 0 and 1.
fn cubic(t: f64) -> [f64; 4] {
    [
        ((2.0 - t) * t - 1.0) * t / 2.0,
        ((3.0 * t - 5.0) * t * t + 2.0) / 2.0,
        ((4.0 - 3.0 * t) * t + 1.0) * t / 2.0,
        (t - 1.0) * t * t / 2.0,
    ]
}
