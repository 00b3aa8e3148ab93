//! Maps of the network's cells, read at places of the photo.
//!
//! Between centres of cells a value is interpolated (bilinear). Cells that lie on the black beside
//! the photo are never read, so that a garment that the frame cuts is not thinned at the frame:
//! there the value is that of the nearest cell on the photo.
//!
//! Cost: a mask of 12 megapixels takes 0.12 s on one thread, a map of parts 0.14 s. Limits: a cell
//! is 1/48 of the photo's longer side, and nothing that is narrower has a sharp border.

use crate::letterbox::{CellSpan, Letterbox};
use crate::network::GRID;
use rayon::prelude::*;

/// The cells around a place along one side: the one before, the one after, and the share of the
/// latter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Between {
    before: usize,
    after: usize,
    share: f32,
}

impl Between {
    /// The cells around a place in the photo; the nearest place on the photo where it is outside,
    /// its start where it is no number.
    pub(crate) fn at(span: CellSpan, place: f64) -> Between {
        let (first, last) = span.cells();
        let cell = span.cell(place).max(first as f64).min(last as f64);
        let before = cell as usize;
        Between { before, after: (before + 1).min(last), share: (cell - before as f64) as f32 }
    }

    /// Those of the centres of `count` pixels that cover a side of the photo.
    fn all(span: CellSpan, count: usize) -> Vec<Between> {
        let step = f64::from(span.photo()) / count as f64;
        (0..count).map(|i| Between::at(span, (i as f64 + 0.5) * step - 0.5)).collect()
    }

    /// The value between those of two cells.
    fn mix(&self, before: f32, after: f32) -> f32 {
        before + (after - before) * self.share
    }
}

/// The values of a map at a place: `N` of each cell, cells row by row.
pub(crate) fn at<const N: usize>(cells: &[[f32; N]], box_: &Letterbox, (x, y): (f64, f64)) -> [f32; N] {
    let (column, row) = (Between::at(box_.x(), x), Between::at(box_.y(), y));
    let along = |row: usize| {
        let (a, b) = (&cells[row * GRID + column.before], &cells[row * GRID + column.after]);
        std::array::from_fn::<f32, N, _>(|k| column.mix(a[k], b[k]))
    };
    let (above, below) = (along(row.before), along(row.after));
    std::array::from_fn(|k| row.mix(above[k], below[k]))
}

/// A picture of `width` x `height` pixels over the whole photo, row by row, each pixel made of the
/// map's values at its centre.
pub(crate) fn picture<const N: usize, T: Send>(
    cells: &[[f32; N]],
    box_: &Letterbox,
    (width, height): (usize, usize),
    pixel: impl Fn(&[f32; N]) -> T + Sync,
) -> Vec<T> {
    let columns = Between::all(box_.x(), width);
    let row = |row: Between| {
        let of = |row: usize| &cells[row * GRID..(row + 1) * GRID];
        let mixed = of(row.before).iter().zip(of(row.after));
        let mixed: Vec<[f32; N]> = mixed.map(|(a, b)| std::array::from_fn(|k| row.mix(a[k], b[k]))).collect();
        let at = |c: &Between| {
            let (a, b) = (&mixed[c.before], &mixed[c.after]);
            pixel(&std::array::from_fn(|k| c.mix(a[k], b[k])))
        };
        columns.iter().map(at).collect::<Vec<T>>()
    };
    let rows: Vec<Vec<T>> = Between::all(box_.y(), height).into_par_iter().map(row).collect();
    rows.into_iter().flatten().collect()
}
