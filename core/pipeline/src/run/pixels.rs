//! What a stage makes of a photo of joined pixels, in the pixels of the photo's file again.
//!
//! Stages work in the pixels of the photo that they are given, and need not know that it was
//! brought down: the frame of an outline that is made from it is parted here, and a photo that a
//! stage made anew (a filter of a plugin that knows nothing of joined pixels) is said to be joined
//! as the one before.

use super::typed;
use std::sync::Arc;
use toile_core::artifact::{ArtifactType, Outline, Photo};
use toile_core::{Inputs, PortValue};

/// The values that a stage made of its inputs, in the pixels of the file.
pub(super) fn of_the_file(inputs: &Inputs, made: Vec<PortValue>) -> Vec<PortValue> {
    match given(inputs) {
        None => made,
        Some(photo) => made.into_iter().map(|value| restored(value, photo)).collect(),
    }
}

/// The photo of joined pixels that a stage was given; none where an outline came with it, whose
/// frame is right already.
fn given(inputs: &Inputs) -> Option<&Photo> {
    let values = || inputs.0.iter().flatten();
    if values().any(|v| v.kind() == Outline::KIND) {
        return None;
    }
    values().flat_map(|v| v.entries()).find_map(|(_, a)| typed::<Photo>(a)).filter(|p| p.joined > 1)
}

fn restored(value: PortValue, photo: &Photo) -> PortValue {
    let PortValue::One(artifact) = &value else { return value };
    if let Some(outline) = typed::<Outline>(artifact) {
        let frame = outline.frame.map(|f| f.parted(photo.joined));
        return PortValue::One(Arc::new(Outline { frame, ..outline.clone() }));
    }
    let lost = |p: &&Photo| p.joined == 1 && p.pixels.dimensions() == photo.pixels.dimensions();
    match typed::<Photo>(artifact).filter(lost) {
        Some(made) => PortValue::One(Arc::new(Photo { joined: photo.joined, ..made.clone() })),
        None => value,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use toile_core::artifact::{Loop, PhotoFrame, Point2, Shared};

    fn photo(joined: u32, side: u32) -> PortValue {
        PortValue::One(Arc::new(Photo {
            pixels: Shared::new(image::RgbImage::new(side, side)),
            alpha: None,
            px_per_metre: None,
            garment_width: None,
            mirrored: false,
            joined,
            file: "a.png".into(),
        }))
    }

    fn outline() -> PortValue {
        let frame =
            PhotoFrame { origin_px: Point2::new(10.0, 20.0), px_per_metre: 100.0, mirrored: true, turn: 0.0 };
        PortValue::One(Arc::new(Outline {
            outer: Loop::default(),
            holes: Vec::new(),
            edges: Vec::new(),
            inner: Vec::new(),
            frame: Some(frame),
            lies: Vec::new(),
        }))
    }

    /// Photos: how many pixels are joined; outlines: origin and scale.
    fn figures(inputs: &[PortValue], made: PortValue) -> Vec<f64> {
        let inputs = Inputs(inputs.iter().cloned().map(Some).collect());
        let made = of_the_file(&inputs, vec![made]).remove(0);
        let (_, artifact) = made.entries()[0];
        match (typed::<Photo>(artifact), typed::<Outline>(artifact).and_then(|o| o.frame)) {
            (Some(p), _) => vec![f64::from(p.joined)],
            (_, Some(f)) => vec![f.origin_px.x, f.origin_px.y, f.px_per_metre],
            _ => Vec::new(),
        }
    }

    #[test]
    fn outlines_are_framed_in_the_pixels_of_the_file() {
        assert_eq!(figures(&[photo(1, 8)], outline()), [10.0, 20.0, 100.0]);
        // The middle of a pixel lies one pixel right of the first of its three.
        assert_eq!(figures(&[photo(3, 8)], outline()), [31.0, 61.0, 300.0]);
        assert_eq!(figures(&[outline(), photo(3, 8)], outline()), [10.0, 20.0, 100.0], "framed before");
        let frame =
            PhotoFrame { origin_px: Point2::new(31.0, 61.0), px_per_metre: 300.0, mirrored: true, turn: 0.0 };
        let back = frame.joined(3);
        assert_eq!((back.origin_px, back.px_per_metre), (Point2::new(10.0, 20.0), 100.0));
        assert_eq!((frame.joined(1), frame.parted(1)), (frame, frame));
    }

    #[test]
    fn photos_that_lose_their_joint_get_it_back() {
        assert_eq!(figures(&[photo(3, 8)], photo(1, 8)), [3.0]);
        assert_eq!(figures(&[photo(3, 8)], photo(1, 9)), [1.0], "another size is another photo");
        assert_eq!(figures(&[photo(3, 8)], photo(6, 8)), [6.0], "joined again");
        assert_eq!(figures(&[photo(1, 8)], photo(2, 4)), [2.0]);
    }
}
