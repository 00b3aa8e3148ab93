//! The same garment in other colours: photos that show it where the first ones do.
//!
//! A shop photographs each colour in the same place. So a variant needs no outline of its own: its
//! pixels stand for those of the first photo. Whether the garment lies where the first one did is
//! looked up in a mask of the variant's photo. Cost: that of `Auto` a file.

use super::of_panel;
use std::collections::BTreeMap;
use toile_core::prelude::*;
use toile_image::binarise::Auto;
use toile_image::photo::decode;

/// Name of the look in the pipeline's own photos, beside the variants.
pub(super) const ORIGINAL: &str = "original";
/// So many of a panel's triangles lie on the variant's garment at least; the rest may be lost at
/// the outline.
const COVERED: f64 = 0.9;

/// What photos of variants must be like.
const ALIKE: &str = "photos of variants show the garment where the first one does: take them from the same place, and crop them alike";

/// Whether a variant may be called so.
pub(super) fn is_name(name: &str) -> bool {
    !name.trim().is_empty() && name != ORIGINAL
}

/// Refuses a variant without a name, photo or meaning of its own.
pub(super) fn bad_variant((name, files): (&String, &BTreeMap<String, String>)) -> Option<StageError> {
    let refused = |text: String| {
        let hint = "a variant is a name with the file of a photo for each side that differs, such as \"red\": {\"front\": \"red.jpg\"}";
        Some(StageError::invalid(text).hint(hint).at("variants"))
    };
    match () {
        () if !is_name(name) => {
            refused(format!("the variant {name:?} has the name of the model's own look, or none"))
        }
        () if files.is_empty() => refused(format!("the variant \"{name}\" has no photo")),
        () => None,
    }
}

/// The photos with those of a variant in their places; one that stood in for the mirror image of a
/// replaced one does so again.
///
/// Errors: no photo has the name, a file cannot be read or is of another size, the garment lies
/// elsewhere in it.
pub(super) fn replaced(
    photos: &Set<Photo>,
    files: &BTreeMap<String, String>,
    garment: &Garment,
    cx: &Context,
) -> Result<Set<Photo>, StageError> {
    if let Some(name) = files.keys().find(|name| photos.get(name).is_none()) {
        let known: Vec<&str> = photos.iter().map(|(name, _)| name).collect();
        return Err(StageError::invalid(format!("no photo is called \"{name}\""))
            .hint(format!("the photos are {}", known.join(", ")))
            .at("variants"));
    }
    let mut read: BTreeMap<&str, Photo> = BTreeMap::new();
    for (name, file) in files {
        let Some(first) = photos.get(name) else { continue };
        let photo = read_like(first, file, cx).map_err(|e| e.at("variants"))?;
        lies_alike(&photo, name, garment, cx)?;
        read.insert(name, photo);
    }
    let replace = |(name, photo): (&str, &Photo)| {
        let own = read.get(name).cloned();
        let mirror = || {
            let same = |p: &Photo| p.file == photo.file && p.mirrored != photo.mirrored;
            let of = read.iter().find(|(n, _)| photos.get(n).is_some_and(same))?.1;
            Some(Photo { pixels: of.pixels.clone(), file: of.file.clone(), ..photo.clone() })
        };
        (name.to_owned(), own.or_else(mirror).unwrap_or_else(|| photo.clone()))
    };
    Ok(photos.iter().map(replace).collect())
}

/// A photo of the size of another.
fn read_like(first: &Photo, file: &str, cx: &Context) -> Result<Photo, StageError> {
    let pixels = cx.read(file).and_then(|bytes| decode(&bytes, file))?.pixels;
    let (given, wanted) = (pixels.dimensions(), first.pixels.dimensions());
    // The runner may have joined pixels of the first photo.
    let scale = first.joined.max(1);
    let fits = |given: u32, wanted: u32| [given / scale, given.div_ceil(scale)].contains(&wanted);
    if !(fits(given.0, wanted.0) && fits(given.1, wanted.1)) {
        let text = format!(
            "\"{file}\" is {} x {} px, and not {} x {} px as \"{}\"",
            given.0,
            given.1,
            wanted.0 * scale,
            wanted.1 * scale,
            first.file
        );
        return Err(StageError::invalid(text).hint(ALIKE));
    }
    let pixels = match given == wanted {
        true => pixels,
        false => image::imageops::thumbnail(&pixels, wanted.0, wanted.1),
    };
    Ok(Photo { file: file.to_owned(), alpha: None, ..first.with_pixels(pixels) })
}

/// Whether the panels that a photo shows lie on its garment.
fn lies_alike(photo: &Photo, name: &str, garment: &Garment, cx: &Context) -> Result<(), StageError> {
    let mask = Auto::default().run(photo, None, cx).map_err(|e| e.at("variants"))?;
    let (w, h) = mask.pixels.dimensions();
    for panel in &garment.panels {
        let names: Set<()> = [(name.to_owned(), ())].into_iter().collect();
        if panel.photo_px.len() != panel.vertices.len() || of_panel(&names, &panel.name).is_none() {
            continue;
        }
        // Vertices lie on the outline, where a mask may end a pixel earlier; middles of triangles
        // lie within.
        let first = panel.vertices.start;
        let triangles = &garment.triangles[panel.triangles.clone()];
        let is_on_it = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|i| panel.photo_px[i as usize - first].coords);
            let middle = (a + b + c) / 3.0;
            let [x, y] =
                [(middle.x, w), (middle.y, h)].map(|(v, n)| v.round().clamp(0.0, f64::from(n - 1)) as u32);
            mask.pixels.get_pixel(x, y).0[0] > 127
        };
        let share = triangles.iter().filter(is_on_it).count() as f64 / triangles.len().max(1) as f64;
        if share < COVERED {
            let text = format!(
                "the garment lies elsewhere in \"{}\": {:.0} % of panel \"{}\" is on it",
                photo.file,
                100.0 * share,
                panel.name
            );
            return Err(StageError::invalid(text).hint(ALIKE).at("variants"));
        }
    }
    Ok(())
}
