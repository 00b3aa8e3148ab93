//! Chessboards: inner corners, their grid, and the plane they lie on.
//!
//! Corners are saddles of the smoothed grey levels that pass a test on a ring around them
//! (`saddles`). From a corner and its two nearest neighbours a grid is grown (`grid`), the largest
//! full rectangle of it is taken, its corners are placed to a fraction of a pixel in the photo
//! (`refine`), and the pose is fitted to them.
//!
//! Limits: any ground of two tones in squares is a chessboard; state the number of inner corners to
//! refuse others. Squares need about 7 pixels of the photo reduced to 1400 px.

mod grid;
mod refine;
mod saddles;

use crate::found::{Found, ScaleKind, density, inverse, middle};
use crate::options::ScaleOptions;
use crate::pixels::ReducedPhoto;
use crate::pose::{self, KnownCamera, Pin, through};
use crate::{KnownObject, ScaleError};
use grid::BoardCorners;
use image::RgbImage;
use nalgebra::{Matrix3, Point2, Vector2};

/// Longer sides of the reduced copies that are tried, pixels.
const SIZES: [usize; 3] = [1400, 600, 2800];
/// The largest root mean square distance of the corners from the fitted plane, pixels and share of
/// a square.
const OFF: f64 = 0.5;
const OFF_SHARE: f64 = 0.02;

/// Finds a chessboard of squares of a side, metres.
pub(crate) fn find(
    photo: &RgbImage,
    object: KnownObject,
    square: f64,
    counts: Option<(u32, u32)>,
    options: &ScaleOptions,
) -> Result<Found, ScaleError> {
    let camera = KnownCamera::of(photo.width(), photo.height(), options.focal_35mm);
    let longer = photo.width().max(photo.height()) as usize;
    let mut ks: Vec<usize> = SIZES.iter().map(|s| longer.div_ceil(*s)).collect();
    ks.dedup();
    let mut refused = ScaleError::NoneFound { object: object.name() };
    for k in ks {
        match at_size(photo, object, square, counts, k, &camera) {
            Ok(found) => return Ok(found),
            Err(ScaleError::NoneFound { .. }) => {}
            Err(other) => refused = other,
        }
    }
    Err(refused)
}

fn at_size(
    photo: &RgbImage,
    object: KnownObject,
    square: f64,
    counts: Option<(u32, u32)>,
    k: usize,
    camera: &KnownCamera,
) -> Result<Found, ScaleError> {
    let none = || ScaleError::NoneFound { object: object.name() };
    let small = ReducedPhoto::of(photo, k);
    let boards = grid::boards(&saddles::saddles(&small));
    let mut found: Vec<Found> = Vec::new();
    for board in boards {
        let fits = counts.is_none_or(|(m, n)| board.is(m as usize, n as usize));
        if fits {
            found.extend(measured(photo, object, square, &board, &small, camera));
        } else if near_frame(&board, &small) {
            let place = middle(&board.outer().map(|p| small.to_photo(p)));
            return Err(ScaleError::Cut { object: object.name(), place });
        }
    }
    match found.len() {
        0 => Err(none()),
        1 => checked(found.remove(0)),
        _ => {
            let places = found.iter().map(|f| middle(&f.corners)).collect();
            Err(ScaleError::Several { object: object.name(), places })
        }
    }
}

/// Refuses a board that is seen too flat.
fn checked(found: Found) -> Result<Found, ScaleError> {
    match found.tilt {
        Some(degrees) if degrees > 60.0 => {
            Err(ScaleError::Tilted { object: found.object.name(), place: middle(&found.corners), degrees })
        }
        _ => Ok(found),
    }
}

/// Whether a board comes within a square of the frame.
fn near_frame(board: &BoardCorners, small: &ReducedPhoto) -> bool {
    let reach = 1.2 * board.square();
    let (w, h) = (small.w as f64, small.h as f64);
    board.outer().iter().any(|p| p.x < reach || p.y < reach || p.x > w - reach || p.y > h - reach)
}

/// The board's plane, if its corners lie on one.
fn measured(
    photo: &RgbImage,
    object: KnownObject,
    square: f64,
    board: &BoardCorners,
    small: &ReducedPhoto,
    camera: &KnownCamera,
) -> Option<Found> {
    let reach = (0.35 * board.square() * small.k as f64).clamp(2.0, 9.0);
    let places: Vec<Point2<f64>> =
        board.places.iter().map(|p| refine::refine(photo, small.to_photo(*p), reach)).collect();
    let model: Vec<Point2<f64>> = (0..places.len()).map(|i| on_board(board, i, square)).collect();
    let start = pose::homography(&model, &places)?;
    let pins = pins(&model, &places);
    let pose = pose::fit(&start, &pins, camera)?;
    let h = pose.homography(camera);
    let residual = off(&h, &model, &places);
    if residual > OFF + OFF_SHARE * board.square() * small.k as f64 || pose.unusual(camera) > 20.0 {
        return None;
    }
    let (c, r) = (board.columns, board.rows);
    let corners = [0, c - 1, c * r - 1, c * (r - 1)].map(|i| places[i]);
    Some(Found {
        object,
        kind: ScaleKind::Plane,
        corners,
        marks: places,
        homography: inverse(&h)?,
        px_per_metre: density(&h, Point2::origin())?,
        residual,
        confidence: 1.0,
        tilt: Some(pose.slant()),
    })
}

/// The place of corner `i` on the board, metres from its middle.
fn on_board(board: &BoardCorners, i: usize, square: f64) -> Point2<f64> {
    let (x, y) = ((i % board.columns) as f64, (i / board.columns) as f64);
    Point2::new(x - (board.columns - 1) as f64 / 2.0, y - (board.rows - 1) as f64 / 2.0) * square
}

/// Two pins for each corner.
fn pins(model: &[Point2<f64>], places: &[Point2<f64>]) -> Vec<Pin> {
    let both = |(m, p): (&Point2<f64>, &Point2<f64>)| {
        [Vector2::x(), Vector2::y()].map(|normal| Pin { model: *m, at: *p, normal, error: ERROR })
    };
    model.iter().zip(places).flat_map(both).collect()
}

/// Standard error of a corner's place, pixels.
const ERROR: f64 = 0.1;

fn off(h: &Matrix3<f64>, model: &[Point2<f64>], places: &[Point2<f64>]) -> f64 {
    let squares: f64 = model.iter().zip(places).map(|(m, p)| (through(h, *m) - p).norm_squared()).sum();
    (squares / places.len().max(1) as f64).sqrt()
}
