//! Marks as a PNG: lines and dots at three times the size, brought down, then the glyphs.

use super::mark::{Anchor, PlotMark, SIZE};
use image::imageops::{FilterType, resize};
use image::{ImageFormat, Rgb, RgbImage};
use imageproc::drawing::{draw_filled_circle_mut, draw_filled_rect_mut, draw_polygon_mut};
use imageproc::point::Point;
use imageproc::rect::Rect;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use std::io::Cursor;

/// Samples along a side of a pixel.
const SHARP: f64 = 3.0;
/// Dash and gap, px.
const DASH: [f64; 2] = [6.0, 5.0];

/// The file; empty where it cannot be encoded.
pub fn png(marks: &[PlotMark]) -> Vec<u8> {
    let large = SIZE.map(|s| (f64::from(s) * SHARP) as u32);
    let mut picture = RgbImage::from_pixel(large[0], large[1], Rgb([255; 3]));
    marks.iter().for_each(|m| shape(&mut picture, m));
    let mut picture = resize(&picture, SIZE[0], SIZE[1], FilterType::Triangle);
    marks.iter().for_each(|m| letters(&mut picture, m));
    let mut bytes = Cursor::new(Vec::new());
    match picture.write_to(&mut bytes, ImageFormat::Png) {
        Ok(()) => bytes.into_inner(),
        Err(_) => Vec::new(),
    }
}

fn shape(picture: &mut RgbImage, mark: &PlotMark) {
    match mark {
        PlotMark::Line { ends: [a, b], width, colour, dashed: false } => {
            stroke(picture, *a, *b, *width, *colour)
        }
        PlotMark::Line { ends: [a, b], width, colour, dashed: true } => {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let at = |d: f64| [0, 1].map(|k| a[k] + (b[k] - a[k]) * (d / length).min(1.0));
            let dashes = (length / (DASH[0] + DASH[1])).ceil() as usize;
            for i in 0..dashes {
                let from = i as f64 * (DASH[0] + DASH[1]);
                stroke(picture, at(from), at(from + DASH[0]), *width, *colour);
            }
        }
        PlotMark::Rect { corners: [a, b], colour } => fill(picture, *a, *b, *colour),
        PlotMark::Dot { at, radius, colour, hollow } => {
            let centre = at.map(|c| (c * SHARP).round() as i32).into();
            let white = Rgb([255; 3]);
            let (rim, fill) = if *hollow { (Rgb(*colour), white) } else { (white, Rgb(*colour)) };
            draw_filled_circle_mut(picture, centre, ((radius + 0.75) * SHARP) as i32, rim);
            draw_filled_circle_mut(picture, centre, ((radius - 0.75) * SHARP) as i32, fill);
        }
        PlotMark::Text { .. } => {}
    }
}

fn fill(picture: &mut RgbImage, a: [f64; 2], b: [f64; 2], colour: [u8; 3]) {
    let at = |k: usize| [a[k].min(b[k]), a[k].max(b[k])].map(|c| (c * SHARP).round() as i32);
    let ([left, right], [top, foot]) = (at(0), at(1));
    if right > left && foot > top {
        let rect = Rect::at(left, top).of_size((right - left) as u32, (foot - top) as u32);
        draw_filled_rect_mut(picture, rect, Rgb(colour));
    }
}

/// A thick line as a thin rectangle.
fn stroke(picture: &mut RgbImage, a: [f64; 2], b: [f64; 2], width: f64, colour: [u8; 3]) {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy);
    if length < 1e-6 {
        return;
    }
    let side = [-dy / length * width / 2.0, dx / length * width / 2.0];
    let corner = |p: [f64; 2], s: f64| {
        let at = [0, 1].map(|k| ((p[k] + side[k] * s) * SHARP).round() as i32);
        Point::new(at[0], at[1])
    };
    let corners = [corner(a, 1.0), corner(b, 1.0), corner(b, -1.0), corner(a, -1.0)];
    if corners[0] != corners[3] {
        draw_polygon_mut(picture, &corners, Rgb(colour));
    }
}

fn letters(picture: &mut RgbImage, mark: &PlotMark) {
    let PlotMark::Text { at, anchor, text, colour, large } = mark else { return };
    let size = if *large { RasterHeight::Size20 } else { RasterHeight::Size16 };
    let step = get_raster_width(FontWeight::Regular, size);
    let wide = (step * text.chars().count()) as f64;
    let left = match anchor {
        Anchor::Start => at[0],
        Anchor::Middle => at[0] - wide / 2.0,
        Anchor::End => at[0] - wide,
    };
    // The line that letters stand on is a fifth above the foot of the glyph's box.
    let top = at[1] - size.val() as f64 * 0.8;
    for (i, c) in text.chars().enumerate() {
        let Some(glyph) =
            get_raster(c, FontWeight::Regular, size).or_else(|| get_raster('?', FontWeight::Regular, size))
        else {
            continue;
        };
        for y in 0..glyph.height() {
            for x in 0..glyph.width() {
                let ink = glyph.pixel(x, y).unwrap_or(0);
                blend(picture, left + (i * step + x) as f64, top + y as f64, *colour, ink);
            }
        }
    }
}

fn blend(picture: &mut RgbImage, x: f64, y: f64, colour: [u8; 3], ink: u8) {
    if x < 0.0 || y < 0.0 || ink == 0 {
        return;
    }
    if let Some(pixel) = picture.get_pixel_mut_checked(x as u32, y as u32) {
        let share = u32::from(ink);
        for (old, new) in pixel.0.iter_mut().zip(colour) {
            *old = ((u32::from(*old) * (255 - share) + u32::from(new) * share) / 255) as u8;
        }
    }
}
