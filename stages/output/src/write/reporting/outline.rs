//! The outlines over their photos: whether the garment was found where it is.

use crate::render::{ArtifactPicture, PictureForm, jpeg, thumbnail};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;
use toile_core::artifact::{Outline, Photo, Point2};

/// The outline's colour.
const COLOUR: &str = "#e0218a";

/// A photo with its outline, so high; none where the outline is of no photo.
pub(crate) fn outlined(name: &str, photo: &Photo, outline: &Outline, height: u32) -> Option<ArtifactPicture> {
    let frame = outline.frame?;
    // The outline may have been found on a smaller copy of the photo.
    let larger = photo.px_per_metre.map_or(1.0, |s| s / frame.px_per_metre);
    let small = thumbnail(&photo.pixels, height);
    let shown = f64::from(small.width()) / f64::from(photo.pixels.width());
    let at = |p: &Point2| frame.to_px(*p).coords.map(|c| ((c + 0.5) * larger) * shown);
    let PictureForm::Jpeg(bytes) = jpeg(&small)? else { return None };
    let (w, h) = small.dimensions();
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\">\n\
         <image width=\"{w}\" height=\"{h}\" href=\"data:image/jpeg;base64,{}\"/>\n",
        STANDARD.encode(bytes)
    );
    let outer = if outline.lies.is_empty() { &outline.outer.points } else { &outline.lies };
    for ring in std::iter::once(outer).chain(outline.holes.iter().map(|l| &l.points)) {
        let points: String = ring.iter().map(at).map(|p| format!("{:.1},{:.1} ", p.x, p.y)).collect();
        let _ = writeln!(
            svg,
            "<polygon fill=\"none\" stroke=\"{COLOUR}\" stroke-width=\"1.6\" points=\"{points}\"/>"
        );
    }
    svg.push_str("</svg>\n");
    Some(ArtifactPicture {
        caption: format!("{name}: the outline that was found"),
        form: PictureForm::Svg(svg),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use toile_core::testkit::shapes;

    #[test]
    fn an_outline_lies_on_its_photo_and_one_without_a_photo_is_left_out() {
        let (photo, mut outline) = (shapes::photo(), shapes::outline());
        outline.frame = Some(toile_core::artifact::PhotoFrame {
            origin_px: Point2::new(10.0, 20.0),
            px_per_metre: photo.px_per_metre.unwrap_or(100.0),
            mirrored: false,
            turn: 0.0,
        });
        let PictureForm::Svg(svg) = outlined("front", &photo, &outline, 2000).unwrap().form else {
            panic!("an SVG")
        };
        let first = outline.frame.unwrap().to_px(outline.outer.points[0]);
        assert!(
            svg.contains(&format!("points=\"{:.1},{:.1} ", first.x + 0.5, first.y + 0.5)),
            "{}",
            &svg[svg.len() - 400..]
        );
        outline.frame = None;
        assert_eq!(outlined("front", &photo, &outline, 2000), None);
    }
}
