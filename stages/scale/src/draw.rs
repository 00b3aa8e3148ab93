//! The photo with the object outlined, for a report.

use crate::Found;
use crate::pose::through;
use image::{Rgb, RgbImage};
use imageproc::drawing::{draw_filled_circle_mut, draw_line_segment_mut};
use nalgebra::{Point2, Vector2};

const OUTLINE: Rgb<u8> = Rgb([255, 0, 170]);
const MARK: Rgb<u8> = Rgb([0, 220, 90]);

/// The photo with the outline, the corners and the marks of what was found, and an arrow of 10 cm
/// along the object's first side. Of the photo's own size; lines of a 600th of its longer side.
pub fn draw(photo: &RgbImage, found: &Found) -> RgbImage {
    let mut picture = photo.clone();
    let width = (f64::from(photo.width().max(photo.height())) / 600.0).max(1.0);
    for i in 0..4 {
        line(&mut picture, found.corners[i], found.corners[(i + 1) % 4], width, OUTLINE);
    }
    found.marks.iter().for_each(|p| spot(&mut picture, *p, width, MARK));
    found.corners.iter().for_each(|p| spot(&mut picture, *p, 2.0 * width, OUTLINE));
    tenth(&mut picture, found, width);
    picture
}

/// Ten centimetres on the ground from the object's middle along its first side.
fn tenth(picture: &mut RgbImage, found: &Found, width: f64) {
    let Some(to_pixels) = found.homography.try_inverse() else { return };
    let ends = [found.ground(found.corners[0]), found.ground(found.corners[1])];
    let [Some(a), Some(b)] = ends else { return };
    let Some(along) = (b - a).try_normalize(1e-9) else { return };
    let middle = found.corners.iter().map(|p| p.coords).sum::<Vector2<f64>>() / 4.0;
    let Some(from) = found.ground(Point2::from(middle)) else { return };
    let ends = [-0.05, 0.05].map(|t| through(&to_pixels, from + along * t));
    line(picture, ends[0], ends[1], width, MARK);
}

/// A line of a width, within the frame's reach.
fn line(picture: &mut RgbImage, a: Point2<f64>, b: Point2<f64>, width: f64, colour: Rgb<u8>) {
    let Some(d) = (b - a).try_normalize(1e-9) else { return };
    let reach = 3.0 * f64::from(picture.width().max(picture.height()));
    if ![a, b].iter().all(|p| p.x.abs() < reach && p.y.abs() < reach) {
        return;
    }
    let normal = Vector2::new(-d.y, d.x);
    let rows = (2.0 * width).ceil() as i32;
    for i in -rows..=rows {
        let shift = normal * (f64::from(i) * 0.25 * width);
        let ends = [a + shift, b + shift].map(|p| (p.x as f32, p.y as f32));
        draw_line_segment_mut(picture, ends[0], ends[1], colour);
    }
}

fn spot(picture: &mut RgbImage, p: Point2<f64>, radius: f64, colour: Rgb<u8>) {
    let (w, h) = (f64::from(picture.width()), f64::from(picture.height()));
    if (0.0..w).contains(&p.x) && (0.0..h).contains(&p.y) {
        draw_filled_circle_mut(
            picture,
            (p.x.round() as i32, p.y.round() as i32),
            radius.ceil() as i32,
            colour,
        );
    }
}
