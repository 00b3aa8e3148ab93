//! Block matching: where each block of a picture is in another one.
//!
//! Method: the displacement of a block is that of the least sum of absolute differences (Jain, Jain
//! 1981), sought on halved pictures first, around whose vectors the next level searches
//! (hierarchical block matching: Bierling 1988). Vectors that leave the coarser one cost more, and
//! a median over the blocks around follows each level. Between pixels: the equiangular fit to three
//! sums. Limit: motion of an eighth of the picture's height. Integers alone: the same bits on every
//! machine.

use super::field::{FlowField, Vector};
use super::level::{FlowLevel, Pyramid};
use std::ops::Range;
use toile_core::{Context, StageError};

/// Side of a block of the picture itself, px.
pub const BLOCK: usize = 16;
/// Side of a block of a reduction, px: so blocks of the picture and of its half are the same ones.
const SMALL: usize = BLOCK / 2;
/// Parts of a pixel in what is found.
pub const PARTS: i32 = 4;
/// The longest motion is the picture's height divided by this.
const REACH: usize = 8;
/// Blocks are compared with a margin around them: their side divided by this.
const AROUND: usize = 4;
/// Longest side of what is compared, px.
const WINDOW: usize = BLOCK + 2 * BLOCK / AROUND;
/// Cost of a difference of one pixel to the expected vector: one grey level for so many pixels of
/// the window.
const STIFFNESS: u32 = 8;
/// All vectors within this of the coarser level's vector are tried on a reduced picture, px.
const WIDE: i32 = 8;
/// Steps of the descent from the best of these vectors.
const STEPS: usize = 3;

/// The motion of each block from one view to another, in quarters of a pixel.
///
/// # Errors
/// When the run has been stopped.
pub fn motion(from: &Pyramid, to: &Pyramid, cx: &Context) -> Result<FlowField, StageError> {
    let mut coarser: Option<FlowField> = None;
    for (k, pair) in from.0.iter().zip(&to.0).enumerate().rev() {
        let search = BlockSearch { from: pair.0, to: pair.1, side: if k == 0 { BLOCK } else { SMALL } };
        coarser = Some(search.level(coarser.as_ref(), k == 0, cx)?.calmed());
    }
    Ok(coarser.unwrap_or(FlowField { columns: 0, rows: 0, vectors: Vec::new() }))
}

/// Blocks of one level.
struct BlockSearch<'a> {
    from: &'a FlowLevel,
    to: &'a FlowLevel,
    side: usize,
}

/// A block with what is around it, and the vector it is expected to have.
struct PictureBlock {
    x: Range<usize>,
    y: Range<usize>,
    expected: Vector,
    pixels: Vec<[u8; 2]>,
}

impl BlockSearch<'_> {
    fn level(&self, coarser: Option<&FlowField>, last: bool, cx: &Context) -> Result<FlowField, StageError> {
        let (columns, rows) = (self.from.width.div_ceil(self.side), self.from.height.div_ceil(self.side));
        let mut vectors = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            cx.check()?;
            vectors.extend((0..columns).map(|column| self.one(column, row, coarser, last)));
        }
        Ok(FlowField { columns, rows, vectors })
    }

    /// One block's vector, in parts of a pixel on the last level.
    fn one(&self, column: usize, row: usize, coarser: Option<&FlowField>, last: bool) -> Option<Vector> {
        let (x, y) = (column * self.side, row * self.side);
        if !self.from.shows(x..x + self.side, y..y + self.side) {
            return None;
        }
        let best = match coarser {
            None => self.everywhere(&self.block(x, y, [0, 0])),
            Some(field) => self.near(x, y, field),
        };
        Some(if last { self.between(&self.block(x, y, best), best) } else { best })
    }

    fn block(&self, x: usize, y: usize, expected: Vector) -> PictureBlock {
        let around = self.side / AROUND;
        let (x, end) = (x.saturating_sub(around), (x + self.side + around).min(self.from.width));
        let (y, bottom) = (y.saturating_sub(around), (y + self.side + around).min(self.from.height));
        let mut pixels = vec![[0; 2]; (end - x) * (bottom - y)];
        for (line, y) in pixels.chunks_exact_mut(end - x).zip(y as i32..) {
            self.from.row(y, x as i32, line);
        }
        PictureBlock { x: x..end, y: y..bottom, expected, pixels }
    }

    /// The best of all vectors within reach.
    fn everywhere(&self, block: &PictureBlock) -> Vector {
        let reach = (self.from.height / REACH).max(1) as i32;
        self.best(block, [0, 0], within([0, 0], reach))
    }

    /// The best of the coarser level's vectors near a block and of those around its own, then of
    /// what is a few pixels from that.
    fn near(&self, x: usize, y: usize, coarser: &FlowField) -> Vector {
        // The picture and its half have the same blocks; on a further reduction a block is twice as
        // wide, which is as many px.
        let (column, row) = (x / BLOCK, y / BLOCK);
        let twice = |v: Vector| v.map(|c| 2 * c);
        let expected = coarser.vectors[row * coarser.columns + column].map_or([0, 0], twice);
        let block = self.block(x, y, expected);
        let reach = if self.side == SMALL { WIDE } else { 1 };
        let others = coarser.near(column, row).map(twice).chain(within(expected, reach));
        let mut best = self.best(&block, expected, others);
        for _ in 0..STEPS {
            let next = self.best(&block, best, within(best, 1));
            if next == best {
                break;
            }
            best = next;
        }
        best
    }

    /// The first of the cheapest vectors, the given one before all others.
    fn best(&self, block: &PictureBlock, first: Vector, others: impl Iterator<Item = Vector>) -> Vector {
        let mut least = (self.cost(block, first, u32::MAX), first);
        for v in others {
            let cost = self.cost(block, v, least.0);
            if cost < least.0 {
                least = (cost, v);
            }
        }
        least.1
    }

    /// The sum of absolute differences of brightness and coverage, and what leaving the expected
    /// vector costs. Summed only while it is below `most`.
    fn cost(&self, block: &PictureBlock, v: Vector, most: u32) -> u32 {
        let off = v[0].abs_diff(block.expected[0]) + v[1].abs_diff(block.expected[1]);
        let mut sum = off * block.pixels.len() as u32 / STIFFNESS;
        let mut buffer = [[0; 2]; WINDOW];
        let other = &mut buffer[..block.x.len()];
        for (line, y) in block.pixels.chunks_exact(block.x.len()).zip(block.y.start as i32..) {
            if sum >= most {
                break;
            }
            self.to.row(y + v[1], block.x.start as i32 + v[0], other);
            sum += differences(line.as_flattened(), other.as_flattened());
        }
        sum
    }

    /// A vector in parts of a pixel, where the differences do not vanish already.
    fn between(&self, block: &PictureBlock, [x, y]: Vector) -> Vector {
        let cost = |v| self.cost(block, v, u32::MAX);
        let middle = cost([x, y]);
        let part = |before, after| if middle == 0 { 0 } else { fit(before, middle, after) };
        [
            PARTS * x + part(cost([x - 1, y]), cost([x + 1, y])),
            PARTS * y + part(cost([x, y - 1]), cost([x, y + 1])),
        ]
    }
}

/// Vectors that differ by so many pixels at most in each direction.
fn within([x, y]: Vector, reach: i32) -> impl Iterator<Item = Vector> {
    (y - reach..=y + reach).flat_map(move |y| (x - reach..=x + reach).map(move |x| [x, y]))
}

fn differences(a: &[u8], b: &[u8]) -> u32 {
    a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(*b))).sum()
}

/// Where two lines of opposite slope through three sums meet, at most half a pixel from the middle
/// one, in parts of a pixel.
fn fit(before: u32, middle: u32, after: u32) -> i32 {
    let (before, middle, after) = (i64::from(before), i64::from(middle), i64::from(after));
    let rise = before.max(after) - middle;
    if rise <= 0 {
        return 0;
    }
    let parts = i64::from(PARTS);
    (parts * (before - after) + rise).div_euclid(2 * rise).clamp(-parts / 2, parts / 2) as i32
}

#[cfg(test)]
mod tests;
