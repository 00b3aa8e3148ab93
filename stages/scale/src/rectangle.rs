//! Cards and sheets: candidates from segments, each judged in the photo.
//!
//! Candidates come from the photo reduced to two sizes, so that the texture of the ground is gone
//! at one of them. Each is measured in the photo (`side`), its pose fitted (`pose`), and refused
//! where a side is not distinct along its length, where the aspect is not that of the object under
//! any plausible camera, where the sides run on beyond the corners (boards, tiles, checks), or
//! where the corners are round or sharp against the object's kind (`judge`).

use crate::found::{Found, ScaleKind, density, inverse, middle};
use crate::judge::{self, Judged};
use crate::object::RoundedRectangle;
use crate::options::ScaleOptions;
use crate::pixels::ReducedPhoto;
use crate::pose::{KnownCamera, MOST_TILT};
use crate::quads::{Quad, quads};
use crate::ridges::SlopeRidges;
use crate::segments::segments;
use crate::{KnownObject, ScaleError};
use image::RgbImage;
use nalgebra::Point2;

/// The longer side of the finer reduced copy is at most this, pixels.
const FINE: usize = 1400;
/// And of the coarser one.
const COARSE: usize = 600;
/// Candidates that are measured, of each copy.
const MEASURED: usize = 110;
/// The shorter side that is needed, pixels.
pub(crate) const LEAST_SIDE: f64 = 25.0;
/// A second place whose merit is this near to the best is as good.
const EQUAL: f64 = 0.12;

/// Finds a card or sheet.
pub(crate) fn find(
    photo: &RgbImage,
    object: KnownObject,
    shape: &RoundedRectangle,
    options: &ScaleOptions,
) -> Result<Found, ScaleError> {
    let camera = KnownCamera::of(photo.width(), photo.height(), options.focal_35mm);
    let mut judged: Vec<Judged> = Vec::new();
    for k in reductions(photo) {
        for candidate in candidates(photo, k, shape, &camera) {
            judged.extend(judge::judge(photo, &candidate, k, shape, &camera));
        }
    }
    let tilted = |j: &Judged| j.pose.tilt() > camera.most_tilt;
    judged.sort_by(|a, b| tilted(a).cmp(&tilted(b)).then(b.merit.total_cmp(&a.merit)));
    let best = judged.first().ok_or(ScaleError::NoneFound { object: object.name() })?;
    checked(photo, best, object, &camera)?;
    alone(best, judged.iter().filter(|j| !tilted(j)), object)?;
    found(best, object, &camera)
}

/// By how much the photo is reduced: to two sizes, or to one if they are the same.
fn reductions(photo: &RgbImage) -> Vec<usize> {
    let longer = photo.width().max(photo.height()) as usize;
    let mut ks = [FINE, COARSE].map(|most| longer.div_ceil(most)).to_vec();
    ks.dedup();
    ks
}

/// A quadrilateral in photo pixels whose aspect may be the object's; its first side is a long one.
fn candidates(photo: &RgbImage, k: usize, shape: &RoundedRectangle, camera: &KnownCamera) -> Vec<Quad> {
    let small = ReducedPhoto::of(photo, k);
    let ridges = SlopeRidges::of(&small, LEAST_SLOPE);
    let least = (0.5 * LEAST_SIDE / k as f64).max(6.0);
    let mut kept: Vec<Quad> = Vec::new();
    let segments = segments(&ridges, least);
    for quad in quads(&segments, &ridges, least, shape.long / shape.short) {
        let corners = quad.corners.map(|p| small.to_photo(p));
        for turn in 0..2 {
            let turned = Quad { corners: std::array::from_fn(|i| corners[(i + turn) % 4]), ..quad };
            let fits = judge::may_be(&turned.corners, shape, camera, k as f64);
            if fits && !kept.iter().any(|q| same(q, &turned, 1.5 * k as f64)) {
                kept.push(turned);
            }
        }
        if kept.len() >= MEASURED {
            break;
        }
    }
    kept
}

/// Ridges below this many grey levels a pixel are left out.
const LEAST_SLOPE: f32 = 2.0;

fn same(a: &Quad, b: &Quad, reach: f64) -> bool {
    a.corners.iter().zip(&b.corners).all(|(p, q)| (p - q).norm() < reach)
}

/// Refuses where another place is as good.
fn alone<'a>(
    best: &Judged,
    judged: impl Iterator<Item = &'a Judged>,
    object: KnownObject,
) -> Result<(), ScaleError> {
    let mut places = vec![middle(&best.corners)];
    for other in judged.filter(|j| j.merit > best.merit - EQUAL) {
        let at = middle(&other.corners);
        let apart = |p: &[f64; 2]| (p[0] - at[0]).hypot(p[1] - at[1]) > 0.5 * best.short;
        if places.iter().all(apart) {
            places.push(at);
        }
    }
    match places.len() {
        1 => Ok(()),
        _ => Err(ScaleError::Several { object: object.name(), places }),
    }
}

/// Refuses what is cut, small or seen too flat.
fn checked(
    photo: &RgbImage,
    best: &Judged,
    object: KnownObject,
    camera: &KnownCamera,
) -> Result<(), ScaleError> {
    let (object, place) = (object.name(), middle(&best.corners));
    if !best.corners.iter().all(|p| in_frame(photo, p)) {
        return Err(ScaleError::Cut { object, place });
    }
    if best.short < LEAST_SIDE {
        return Err(ScaleError::TooSmall { object, place, short: best.short, least: LEAST_SIDE });
    }
    let degrees = best.pose.slant();
    if degrees > MOST_TILT || best.pose.tilt() > camera.most_tilt {
        return Err(ScaleError::Tilted { object, place, degrees });
    }
    Ok(())
}

fn in_frame(photo: &RgbImage, p: &Point2<f64>) -> bool {
    let (w, h) = (f64::from(photo.width()), f64::from(photo.height()));
    p.x >= -0.5 && p.y >= -0.5 && p.x <= w - 0.5 && p.y <= h - 0.5
}

fn found(best: &Judged, object: KnownObject, camera: &KnownCamera) -> Result<Found, ScaleError> {
    let to_pixels = best.pose.homography(camera);
    let homography = inverse(&to_pixels).ok_or(ScaleError::NotFinite)?;
    let px_per_metre = density(&to_pixels, Point2::origin()).ok_or(ScaleError::NotFinite)?;
    Ok(Found {
        object,
        kind: ScaleKind::Plane,
        corners: best.corners,
        marks: Vec::new(),
        homography,
        px_per_metre,
        residual: best.residual,
        confidence: best.coverage,
        tilt: Some(best.pose.slant()),
    })
}
