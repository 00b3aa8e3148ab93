//! Colour difference to a photo of the same ground without the garment.
//!
//! Both pictures are compared at a reduced size in CIE Lab. The camera's exposure may have changed
//! between them: the median difference along the frame, where both show ground, is taken off. What
//! is darker by no more than `shadow` of the ground's lightness and has its colour is the garment's
//! shadow (Horprasert, Harwood, Davis 1999). The threshold is the larger of a just visible
//! difference and so many times the noise, which is the median deviation along the frame. Then
//! closing, opening, the largest piece, its holes, and the boundary set anew at the photo's own
//! size (`refine`).
//!
//! Cost: as `Background`, and reading the second photo. Limits: the camera and the ground must not
//! move between the photos; what has the very colours of the ground behind it is not seen.

use super::background::{SHADOW, clean};
use super::finish::{CleanUp, mask_of, no_garment};
use super::refine::refine;
use super::small::{Lab, SmallPhoto};
use crate::photo::decode;
use image::RgbImage;
use toile_core::prelude::*;

/// A difference in CIE Lab that is seen at a glance; less is no garment.
const VISIBLE: f64 = 5.0;
/// So many times the noise is a difference.
const NOISES: f64 = 6.0;
/// The rim along the frame that shows ground, as a share of the shorter side.
const RIM: f64 = 0.03;
/// Of a shadow, how far the colour may be from the ground's, in CIE Lab.
const SAME_COLOUR: f64 = 6.0;
/// Both photos have the same proportions within this share.
const SAME_FORM: f64 = 0.01;

/// Takes for garment what differs from a photo of the ground without it.
///
/// For a camera on a stand: photograph the empty ground, then the garments. Any ground will do, and
/// any garment that is not camouflaged on it. Transparent pixels are ground.
#[stage(
    role = Binariser,
    source = "Horprasert, Harwood, Davis 1999; CIE Lab, 1976",
    example = "Difference(ground: \"empty.jpg\")",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Difference {
    /// A photo of the same ground without the garment, by the same camera from the same place.
    #[param(default = String::new())]
    pub ground: String,
    /// How much of the ground's lightness a shadow may take: 0 for no shadows.
    #[param(default = SHADOW, min = 0.0, max = 1.0)]
    pub shadow: f64,
    /// The longer side at which colours are compared.
    #[param(default = 600, min = 64, max = 2000, unit = "px", trades)]
    pub size: u32,
    /// Holes up to this share of the garment's area are filled.
    #[param(default = 1.0, min = 0.0, max = 1.0)]
    pub holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side.
    #[param(default = 0.05, min = 0.0, max = 4.0)]
    pub touch: f64,
}

#[stage]
impl Difference {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        let settings = CleanUp { open: 0, close: 0, holes: self.holes, touch: self.touch, next: "`Auto()`" };
        mask_of(photo, settings, cx, || {
            let ground = self.ground(photo, cx)?;
            let (small, ground) = (SmallPhoto::of(photo, self.size), SmallPhoto::of(&ground, self.size));
            cx.check()?;
            let raw = different(&small, &ground, self.shadow);
            let mask = clean(&small, &raw).ok_or_else(|| {
                no_garment(photo, "it shows what its ground shows without it", settings.next)
            })?;
            cx.progress(0.5, "garment and ground parted");
            refine(photo, &small, &mask, cx)
        })
    }
}

impl Difference {
    /// The photo of the ground, of the photo's proportions.
    fn ground(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        let at = |e: StageError| e.at("ground");
        let file = self.ground.as_str();
        if file.is_empty() {
            return Err(at(StageError::invalid("no photo of the ground is named")
                .hint("photograph the ground without the garment: Difference(ground: \"empty.jpg\")")));
        }
        let empty = cx.read(file).and_then(|bytes| decode(&bytes, file)).map_err(at)?.pixels;
        let form = |p: &RgbImage| f64::from(p.width()) / f64::from(p.height().max(1));
        if (form(&empty) / form(&photo.pixels) - 1.0).abs() > SAME_FORM {
            let size = |p: &RgbImage| format!("{} x {} px", p.width(), p.height());
            return Err(at(StageError::invalid(format!(
                "the ground \"{file}\" is {}, and the photo \"{}\" is {}",
                size(&empty),
                photo.file,
                size(&photo.pixels)
            ))
            .hint("take both photos with the same camera from the same place")));
        }
        Ok(Photo { pixels: Shared::new(empty), alpha: None, ..photo.clone() })
    }
}

/// Which small pixels differ from the ground's.
fn different(small: &SmallPhoto, ground: &SmallPhoto, shadow: f64) -> Vec<bool> {
    let behind = |i: usize| {
        let (x, y) = (i % small.w * ground.w / small.w, i / small.w * ground.h / small.h);
        ground.lab[y * ground.w + x]
    };
    let width = (RIM * small.w.min(small.h) as f64).ceil() as usize;
    let rim: Vec<usize> = (0..small.lab.len()).filter(|&i| small.depth(i) < width && small.seen[i]).collect();
    let off = |c: usize| median(rim.iter().map(|&i| small.lab[i][c] - behind(i)[c]).collect());
    let exposure = Lab::new(off(0), off(1), off(2));
    let noise = median(rim.iter().map(|&i| (small.lab[i] - behind(i) - exposure).norm()).collect());
    let least = VISIBLE.max(NOISES * noise);
    let differs = |i: usize| {
        let (seen, empty) = (small.lab[i], behind(i) + exposure);
        let off = seen - empty;
        let darker = (-off[0] / empty[0].max(1.0)).max(0.0);
        let is_shadow = darker > 0.0 && darker <= shadow && off[1].hypot(off[2]) < SAME_COLOUR;
        small.seen[i] && off.norm() > least && !is_shadow
    };
    (0..small.lab.len()).map(differs).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use image::Rgb;
    use toile_core::testkit::shapes;

    /// Boards of two browns; the garment is a rectangle of brown and white stripes, with a shadow
    /// to its right.
    fn scene(garment: bool, brighter: i32) -> RgbImage {
        RgbImage::from_fn(300, 200, |x, y| {
            let board = if x / 37 % 2 == 0 { [150, 110, 70] } else { [128, 92, 60] };
            let inside = (80..200).contains(&x) && (50..150).contains(&y);
            let shaded = (200..212).contains(&x) && (50..150).contains(&y);
            let level = match (garment && inside, garment && shaded) {
                (true, _) if y / 10 % 2 == 0 => [120, 84, 100],
                (true, _) => [235, 232, 228],
                (_, true) => board.map(|v: i32| v * 8 / 10),
                _ => board,
            };
            Rgb(level.map(|v| (v + brighter).clamp(0, 255) as u8))
        })
    }

    fn stage(file: &str) -> Difference {
        Difference { ground: file.into(), shadow: SHADOW, size: 300, holes: 1.0, touch: 0.05 }
    }

    fn photo() -> Photo {
        Photo { pixels: Shared::new(scene(true, 6)), mirrored: false, ..shapes::photo() }
    }

    #[test]
    fn a_garment_of_the_grounds_own_colours_is_found_by_the_ground_without_it() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("empty.png");
        scene(false, 0).save(&file).unwrap();
        let mask = stage(file.to_str().unwrap()).run(&photo(), &Context::quiet()).unwrap();
        let [left, top, right, bottom] = mask.bounds().unwrap();
        for (is, want) in [(left, 80), (top, 50), (right, 199), (bottom, 149)] {
            assert!(is.abs_diff(want) <= 2, "{is} for {want}");
        }
        assert!(mask.area_px().abs_diff(12_000) < 400, "{}", mask.area_px());
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let e = Difference::default().run(&photo(), &Context::quiet()).unwrap_err();
        assert_eq!(e.message, "no photo of the ground is named");
        assert_eq!(
            e.hint.unwrap(),
            "photograph the ground without the garment: Difference(ground: \"empty.jpg\")"
        );
        assert!(stage("empty.png").run(&photo(), &Context::quiet()).is_err());
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("square.png");
        RgbImage::new(200, 200).save(&file).unwrap();
        let file = file.to_str().unwrap();
        let e = stage(file).run(&photo(), &Context::quiet()).unwrap_err();
        let photo = photo().file;
        assert_eq!(
            e.message,
            format!("the ground \"{file}\" is 200 x 200 px, and the photo \"{photo}\" is 300 x 200 px")
        );
        assert_eq!(e.hint.unwrap(), "take both photos with the same camera from the same place");
    }

    #[test]
    fn a_photo_of_the_ground_alone_holds_no_garment() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("empty.png");
        scene(false, 0).save(&file).unwrap();
        let empty = Photo { pixels: Shared::new(scene(false, 3)), ..photo() };
        let e = stage(file.to_str().unwrap()).run(&empty, &Context::quiet()).unwrap_err();
        assert!(e.message.starts_with("no garment found in "), "{}", e.message);
        assert!(!e.hint.unwrap().contains("Difference"));
    }
}
