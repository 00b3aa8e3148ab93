//! What a user has marked in a photo: places, a rectangle, strokes of a brush.

use super::small::SmallPhoto;
use crate::photo::decode;
use image::RgbImage;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// A place in a photo, as shares of its width and height, from its left upper corner.
pub type PhotoPlace = (f64, f64);

/// A point marks a disc of this radius, as a share of the photo's longer side.
const DISC: f64 = 0.012;
/// How much more of its own colour a stroke has than of the others, levels.
const PURE: i32 = 60;
/// Pictures of strokes have the photo's proportions within this share.
const SAME_FORM: f64 = 0.02;

/// The marks of one photo.
#[derive(Debug, Default)]
pub(super) struct PhotoMarks<'a> {
    /// Places on the garment.
    pub garment: &'a [PhotoPlace],
    /// Places on the ground.
    pub ground: &'a [PhotoPlace],
    /// Two opposite corners of a rectangle that holds all of the garment.
    pub rect: Option<(PhotoPlace, PhotoPlace)>,
    /// Green strokes on the garment, red strokes on the ground.
    pub strokes: Option<RgbImage>,
}

impl PhotoMarks<'_> {
    /// Puts the marks into a small picture.
    pub(super) fn mark(&self, small: &mut SmallPhoto) {
        let (w, h) = (small.w, small.h);
        for i in 0..w * h {
            let at = ((i % w) as f64 + 0.5, (i / w) as f64 + 0.5);
            small.known[i] = self.known(at, (w as f64, h as f64));
        }
    }

    /// Whether a pixel is marked as garment or as ground; what is marked as both is garment.
    fn known(&self, (x, y): (f64, f64), (w, h): (f64, f64)) -> Option<bool> {
        let near = |p: &PhotoPlace| (p.0 * w - x).hypot(p.1 * h - y) <= (DISC * w.max(h)).max(1.0);
        if self.garment.iter().any(near) {
            return Some(true);
        }
        if self.ground.iter().any(near) || self.rect.is_some_and(|r| !holds(r, (x / w, y / h))) {
            return Some(false);
        }
        self.strokes.as_ref().and_then(|strokes| stroke(strokes, (x / w, y / h)))
    }
}

fn holds((a, b): (PhotoPlace, PhotoPlace), (x, y): PhotoPlace) -> bool {
    (a.0.min(b.0)..=a.0.max(b.0)).contains(&x) && (a.1.min(b.1)..=a.1.max(b.1)).contains(&y)
}

fn stroke(strokes: &RgbImage, (x, y): PhotoPlace) -> Option<bool> {
    let (w, h) = strokes.dimensions();
    let at = |share: f64, n: u32| ((share * f64::from(n)) as u32).min(n.saturating_sub(1));
    let [r, g, b] = strokes.get_pixel_checked(at(x, w), at(y, h))?.0.map(i32::from);
    match (g - r.max(b) >= PURE, r - g.max(b) >= PURE) {
        (true, _) => Some(true),
        (_, true) => Some(false),
        _ => None,
    }
}

/// What is marked for a photo; a mirror image takes the marks of its photo where only one photo has
/// any.
pub(super) fn of_photo<'a, T>(all: &'a BTreeMap<String, T>, photo: &Photo, cx: &Context) -> Option<&'a T> {
    let only = || all.values().next().filter(|_| photo.mirrored && all.len() == 1);
    all.get(cx.entry()).or_else(only)
}

/// A picture of strokes, of the photo's proportions.
pub(super) fn strokes(file: &str, photo: &Photo, cx: &Context) -> Result<RgbImage, StageError> {
    let at = |e: StageError| e.at("strokes");
    let picture = cx.read(file).and_then(|bytes| decode(&bytes, file)).map_err(at)?.pixels;
    let form = |p: &RgbImage| f64::from(p.width()) / f64::from(p.height().max(1));
    let own = form(&photo.pixels);
    if (form(&picture) / own - 1.0).abs() > SAME_FORM {
        let size = |p: &RgbImage| format!("{} x {} px", p.width(), p.height());
        return Err(at(StageError::invalid(format!(
            "the strokes \"{file}\" are {}, and the photo \"{}\" is {}",
            size(&picture),
            photo.file,
            size(&photo.pixels)
        ))
        .hint("paint on a copy of the photo, and keep its size")));
    }
    Ok(picture)
}

/// Refuses marks for photos that are not there.
pub(super) fn check<'a>(
    param: &'static str,
    named: impl Iterator<Item = &'a String>,
    photos: Option<&[String]>,
) -> Vec<StageError> {
    let Some(photos) = photos else { return Vec::new() };
    let missing = named.filter(|name| !photos.contains(name));
    let error = |name: &String| {
        StageError::invalid(format!("there is no photo \"{name}\" to mark"))
            .hint(format!("the photos are: {}", photos.join(", ")))
            .at(param)
            .within(name)
    };
    missing.map(error).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::GraphCut;
    use super::*;
    use image::Rgb;
    use toile_core::testkit::shapes;

    /// A blue square beside a red one on white: of two garments neither is the larger.
    fn two() -> Photo {
        let pixels = RgbImage::from_fn(300, 200, |x, y| {
            let row = (60..140).contains(&y);
            Rgb(match (row && (40..140).contains(&x), row && (160..260).contains(&x)) {
                (true, _) => [40, 60, 160],
                (_, true) => [170, 40, 40],
                _ => [230; 3],
            })
        });
        Photo { pixels: Shared::new(pixels), mirrored: false, ..shapes::photo() }
    }

    fn at<T>(value: T) -> BTreeMap<String, T> {
        [(Context::quiet().entry().to_owned(), value)].into()
    }

    /// The columns between which a garment is found at half the height.
    fn found(stage: &GraphCut) -> (u32, u32) {
        let mask = stage.run(&two(), &Context::quiet()).unwrap().pixels;
        let on = || (0..mask.width()).filter(|x| mask.get_pixel(*x, 100).0[0] != 0);
        (on().min().unwrap(), on().max().unwrap())
    }

    #[test]
    fn a_rectangle_or_places_say_which_of_two_is_meant() {
        let rect = GraphCut { rect: at(((0.05, 0.1), (0.5, 0.9))), ..GraphCut::default() };
        assert_eq!(found(&rect), (40, 139));
        let places = GraphCut {
            garment: at(vec![(0.7, 0.5)]),
            ground: at(vec![(0.2, 0.4), (0.3, 0.5), (0.4, 0.6)]),
            ..GraphCut::default()
        };
        assert_eq!(found(&places), (160, 259));
    }

    #[test]
    fn green_strokes_are_garment_and_red_ones_ground() {
        let strokes =
            RgbImage::from_fn(
                30,
                20,
                |x, _| Rgb([[0, 255, 0], [255, 0, 0], [90, 90, 90]][(x / 10) as usize]),
            );
        let known = |x: f64| stroke(&strokes, (x, 0.5));
        assert_eq!([known(0.1), known(0.5), known(0.9)], [Some(true), Some(false), None]);
    }

    #[test]
    fn marks_for_no_photo_are_refused() {
        let photos = ["front".to_owned(), "back".to_owned()];
        let names = ["frnt".to_owned()];
        let errors = check("rect", names.iter(), Some(&photos));
        assert_eq!(errors[0].to_string(), "there is no photo \"frnt\" to mark");
        assert_eq!(errors[0].hint.as_deref(), Some("the photos are: front, back"));
    }

    #[test]
    fn strokes_of_another_form_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("strokes.png");
        RgbImage::new(200, 200).save(&file).unwrap();
        let file = file.to_str().unwrap();
        let e = strokes(file, &two(), &Context::quiet()).unwrap_err();
        let name = two().file;
        assert_eq!(
            e.to_string(),
            format!("the strokes \"{file}\" are 200 x 200 px, and the photo \"{name}\" is 300 x 200 px")
        );
        assert_eq!(e.hint.as_deref(), Some("paint on a copy of the photo, and keep its size"));
    }
}
