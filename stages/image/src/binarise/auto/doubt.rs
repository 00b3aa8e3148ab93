//! The words and the picture of a doubt.

use super::super::marked::marked;
use super::super::small::SmallPhoto;
use super::choose::ChosenMask;
use super::methods::MethodMask;
use image::GrayImage;
use rayon::prelude::*;
use toile_core::prelude::*;

/// What the methods disagree about, sRGB.
const RED: [f64; 3] = [255.0, 0.0, 0.0];
/// How much of it covers the photo where half of them take a pixel for garment.
const COVER: f64 = 0.6;

/// The refusal of a mask that leaves doubt: what was seen, and one thing to try.
pub(super) fn refuse(file: &str, choice: &ChosenMask, confidence: f64, stage: &str) -> StageError {
    let (seen, advice) = words(choice, file);
    let take = format!("--set 'stages.{stage}.confidence={}'", (confidence * 100.0).floor() / 100.0);
    StageError::invalid(seen)
        .hint(format!("{advice}; where the picture in the report outlines the garment, take it by {take}"))
}

/// What is least sure, and what would help.
fn words(choice: &ChosenMask, file: &str) -> (String, &'static str) {
    if let Some(times) = choice.larger {
        let seen = format!(
            "what stands out in \"{file}\" may be a print: an outline around it holds {times:.1} times its area"
        );
        return (seen, "lay the garment on a ground of another colour");
    }
    let e = &choice.evidence;
    let [agree, edges, alike] = e.parts();
    if agree <= edges && agree <= alike {
        let share = 100.0 * (1.0 - e.agreement);
        let seen = format!(
            "it is not sure where the garment in \"{file}\" ends: the methods differ in {share:.0} % of it"
        );
        return (seen, "lay it on a plain ground of another colour");
    }
    if edges <= alike {
        let share = 100.0 * (1.0 - e.support);
        let seen =
            format!("{share:.0} % of the outline found in \"{file}\" lies where the photo shows no edge");
        return (seen, "use a ground of another colour, or light from both sides");
    }
    let share = 100.0 * e.symmetry;
    let seen = format!("the two halves of what was found in \"{file}\" are alike to {share:.0} % only");
    (seen, "spread both halves alike, with nothing beside the garment")
}

/// The photo with the mask's outline, and in red what the methods disagree about.
pub(super) fn doubtful(photo: &Photo, mask: &GrayImage, small: &SmallPhoto, found: &[MethodMask]) -> Photo {
    let doubt: Vec<f64> = (0..small.lab.len())
        .map(|i| found.iter().filter(|f| f.mask[i]).count() as f64 / found.len() as f64)
        .map(|garment| 4.0 * garment * (1.0 - garment))
        .collect();
    let shown = marked(photo, mask);
    let mut pixels = (*shown.pixels).clone();
    let (w, h) = (pixels.width() as usize, pixels.height() as usize);
    pixels.par_chunks_mut(3).enumerate().for_each(|(i, pixel)| {
        let (x, y) = (i % w * small.w / w, i / w * small.h / h);
        let cover = COVER * doubt[y * small.w + x];
        pixel
            .iter_mut()
            .zip(RED)
            .for_each(|(v, red)| *v = (f64::from(*v) * (1.0 - cover) + red * cover) as u8);
    });
    Photo { pixels: Shared::new(pixels), ..shown }
}
