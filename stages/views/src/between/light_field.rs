//! `LightField`: a new view from many photos on a grid, by rays.
//!
//! The plenoptic function says what light comes to each place from each direction (Adelson, Bergen
//! 1991). Outside of what is photographed it has four dimensions: a ray is where it crosses the
//! plane of the cameras (s, t) and the plane of the pictures (u, v). Photos on a grid sample
//! L(u, v, s, t); a ray between them is the quadrilinear mean of the sixteen around it (Levoy,
//! Hanrahan 1996), with the plane of the pictures moved to the depth that is to be sharp (Gortler
//! and others 1996; Isaksen and others 2000). Cost: sixteen pixels a pixel. Limit: what lies far
//! from the sharp plane is double, the more the farther the cameras stand apart.

use super::photos::{one_size, view};
use crate::picture::{flipped, in_order};
use image::RgbImage;
use rayon::prelude::*;
use std::borrow::Cow;
use toile_core::prelude::*;

/// Makes the view from a place between photos that were taken on a grid, without any geometry.
///
/// The photos lie on a grid of equal steps, all with the same direction, and are named by row and
/// column, from above and from the left: `r1c1`, `r1c2`, `r2c1`; names without two numbers are one
/// row in their order. Each pixel of the view is the
/// quadrilinear mean of the rays around it. `focus` says how far what shall be sharp moves from
/// each photo to the next. The result is a photo named `view`.
#[stage(
    role = ViewInterpolator,
    source = "garment modelling thesis, 2012: light field; Levoy, Hanrahan 1996; Gortler and others 1996; plenoptic function: Adelson, Bergen 1991",
    example = "LightField(across: 0.4, down: 0.5, focus: 3.5)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct LightField {
    /// The place across the grid: 0 is its left side, 1 its right side.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    across: f64,
    /// The place down the grid: 0 is its upper side, 1 its lower side.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    down: f64,
    /// How far what shall be sharp moves to the left from a photo to the next on its right, and up
    /// from one to the next below. 0 for photos that are turned or cut so that it stays in place.
    #[param(default = 0.0, min = -2000.0, max = 2000.0, unit = "px")]
    focus: f64,
    /// Rows and columns of the grid that are used: all (1), every second (2), every third (3), to
    /// see what fewer photos give.
    #[param(default = 1, min = 1, max = 64)]
    every: usize,
}

/// Photos by row and column.
struct CameraGrid<'a> {
    columns: usize,
    rows: usize,
    photos: Vec<Cow<'a, RgbImage>>,
    /// Steps of the whole grid in a step of this one.
    step: f64,
}

#[stage]
impl LightField {
    pub(super) fn run(&self, photos: Set<Photo>, cx: &Context) -> Result<Set<Photo>, StageError> {
        let names = in_order(photos.iter().map(|(name, _)| name));
        let [w, h] = one_size(&photos, &names)?;
        let grid = CameraGrid::of(&photos, &names, self.every)?;
        cx.figure("photos_used", grid.photos.len() as f64, "");
        let s = self.across * (grid.columns - 1) as f64;
        let t = self.down * (grid.rows - 1) as f64;
        let shift = self.focus * grid.step;
        let row = |y: u32| {
            cx.check()?;
            Ok((0..w).map(|x| grid.ray(f64::from(x), f64::from(y), s, t, shift)).collect())
        };
        let rows: Vec<Result<Vec<[f32; 3]>, StageError>> = (0..h).into_par_iter().map(row).collect();
        let colours = rows.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
        Ok(view(&colours, [w, h]))
    }
}

impl<'a> CameraGrid<'a> {
    /// The photos of every so manieth row and column.
    fn of(photos: &'a Set<Photo>, names: &[&str], every: usize) -> Result<Self, StageError> {
        let mut places = places(names)?;
        places.sort();
        let mut rows: Vec<u64> = places.iter().map(|p| p.0[0]).collect();
        let mut columns: Vec<u64> = places.iter().map(|p| p.0[1]).collect();
        rows.dedup();
        columns.sort_unstable();
        columns.dedup();
        let of_step = |all: Vec<u64>| -> Vec<u64> { all.into_iter().step_by(every).collect() };
        let whole = [rows.len(), columns.len()];
        let (rows, columns) = (of_step(rows), of_step(columns));
        let mut kept = Vec::new();
        for row in &rows {
            for column in &columns {
                let found = places.iter().filter(|p| p.0 == [*row, *column]);
                let mut found = found.filter_map(|p| photos.get(p.1));
                let (Some(photo), None) = (found.next(), found.next()) else {
                    return Err(incomplete(*row, *column, whole));
                };
                kept.push(flipped(photo));
            }
        }
        if kept.len() < 2 {
            let text = "a light field needs two photos or more, and there is 1".to_owned();
            return Err(StageError::invalid(text).hint("photograph from more places, or lower `every`"));
        }
        Ok(CameraGrid { columns: columns.len(), rows: rows.len(), photos: kept, step: every as f64 })
    }

    /// The colour of a ray through a pixel of the view at (s, t).
    fn ray(&self, x: f64, y: f64, s: f64, t: f64, shift: f64) -> [f32; 3] {
        let (mut sum, mut total) = ([0f32; 3], 0f32);
        let (left, above) = (s.floor(), t.floor());
        for (i, j) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let (column, row) = (left + i, above + j);
            let weight = ((1.0 - (s - column).abs()) * (1.0 - (t - row).abs())) as f32;
            if weight <= 0.0 || column >= self.columns as f64 || row >= self.rows as f64 {
                continue;
            }
            let Some(photo) = self.photos.get(row as usize * self.columns + column as usize) else {
                continue;
            };
            // What is sharp is farther to the left in a photo farther to the right.
            let colour = linear(photo, x + shift * (s - column), y + shift * (t - row));
            (0..3).for_each(|c| sum[c] += weight * colour[c]);
            total += weight;
        }
        sum.map(|c| c / total.max(1e-6))
    }
}

/// The colour at a place, bilinear; beyond the border its pixels go on.
fn linear(photo: &RgbImage, x: f64, y: f64) -> [f32; 3] {
    let limit = |v: f64, n: u32| v.clamp(0.0, f64::from(n - 1));
    let (x, y) = (limit(x, photo.width()), limit(y, photo.height()));
    let (fx, fy) = (x.floor(), y.floor());
    let (u, v) = ((x - fx) as f32, (y - fy) as f32);
    let at = |i: u32, j: u32| {
        let (x, y) = ((fx as u32 + i).min(photo.width() - 1), (fy as u32 + j).min(photo.height() - 1));
        photo.get_pixel(x, y).0.map(f32::from)
    };
    let [a, b, c, d] = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
    [0, 1, 2].map(|k| {
        let (top, bottom) = (a[k] + (b[k] - a[k]) * u, c[k] + (d[k] - c[k]) * u);
        top + (bottom - top) * v
    })
}

/// The names with their rows and columns; one row in the order of the names where none has two
/// numbers.
fn places<'a>(names: &[&'a str]) -> Result<Vec<([u64; 2], &'a str)>, StageError> {
    if names.iter().all(|name| place(name).is_none()) {
        return Ok((1..).zip(names).map(|(column, name)| ([1, column], *name)).collect());
    }
    let placed = |name: &&'a str| Ok((place(name).ok_or_else(|| nameless(name))?, *name));
    names.iter().map(placed).collect()
}

/// Row and column of a name with two numbers.
fn place(name: &str) -> Option<[u64; 2]> {
    let mut numbers = name.split(|c: char| !c.is_ascii_digit()).filter(|n| !n.is_empty());
    let place = [numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?];
    numbers.next().is_none().then_some(place)
}

fn nameless(name: &str) -> StageError {
    StageError::invalid(format!("photo \"{name}\" does not tell its row and column"))
        .hint("name the photos of a light field by row and column, like \"r1c1\", \"r1c2\", \"r2c1\"")
}

fn incomplete(row: u64, column: u64, [rows, columns]: [usize; 2]) -> StageError {
    let text = format!(
        "the grid of {rows} x {columns} photos has none, or more than one, in row {row} and column {column}"
    );
    StageError::invalid(text).hint("give one photo for each row and column of the grid")
}
