//! The stage that reads a pipeline's photos.

use super::decode::check;
use super::expected;
use super::resolve::resolve;
use super::scale::{self, ScaleObject};
use super::side_names;
use super::{Decoded, PhotoEntry, PhotoFile, decode};
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_core::cost::Size;
use toile_core::param::ron_options;
use toile_core::prelude::*;
use toile_core::{Node, StageMeta};

/// Reads the photos of the garment's sides.
///
/// JPEG, PNG, WebP and TIFF, 8 or 16 bits, grey or colour, turned upright by their EXIF
/// orientation. HEIC, AVIF and cameras' raw files are not read: export them as JPEG. `width` is the
/// real width of the garment's bounding box; the scale is worked out once its mask is known. Or an
/// object of known size lies beside the garment and gives the scale (`scale`): a bank card, a sheet
/// of paper, a chessboard, by which the photo is rectified as well, so that it need not be taken
/// from straight above; or a ruler, which gives the scale alone. Where only one side was taken,
/// `MirrorOf("front")` stands in: its pattern is the mirror image of that photo.
///
/// An opacity channel that is not full everywhere is kept: binarisers take what is transparent as
/// ground.
///
/// At most 30,000 px per side, 200 megapixels and 1 GiB decoded.
#[stage(
    role = Reader,
    source = "ITU-T T.81, 1992; ISO/IEC 15948, 2004; RFC 9649, 2024; TIFF 6.0, 1992",
    example = "Photos(photos: {\"front\": (file: \"front.jpg\", width: \"52 cm\"), \"back\": MirrorOf(\"front\")})",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Photos {
    /// The photos by the name of their side, each a file with the garment's real width (or
    /// `px_per_metre`), or the mirror image of another.
    photos: BTreeMap<String, PhotoEntry>,
}

#[stage]
impl Photos {
    pub(crate) fn run(&self, cx: &Context) -> Result<Set<Photo>, StageError> {
        read_photos(&self.photos, cx)
    }

    /// Names, widths, mirrors, and whether each file is a whole picture by its header.
    pub(crate) fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        if self.photos.is_empty() {
            return vec![none()];
        }
        let of_name = self.photos.keys().filter_map(|name| named(name).err());
        let of_side = self.photos.iter().flat_map(|(name, entry)| {
            let (own, target) = match entry {
                PhotoEntry::File(file) => (look(name, &file.file, placed.cx).err(), None),
                PhotoEntry::MirrorOf(other) => (None, self.photos.get(other)),
            };
            // The faults of a file that is mirrored are reported at that file.
            let of_scale =
                if let Some(PhotoEntry::File(_)) = target { None } else { resolve(&self.photos, name).err() };
            of_scale.into_iter().chain(own)
        });
        of_name.chain(of_side).chain(side_names::misnamed(&self.names(), placed)).collect()
    }

    /// Photos that the style makes nothing of.
    fn warnings(&self, placed: &Placed<'_>) -> Vec<StageError> {
        side_names::unused(&self.names(), placed)
    }

    /// How much it will read: from the files' headers.
    pub(crate) fn sizes(&self, _given: &Size, cx: &Context) -> Option<Size> {
        expected::size(&self.photos, cx)
    }
}

impl Photos {
    /// The stage for these photos.
    pub fn new(photos: BTreeMap<String, PhotoEntry>) -> Self {
        Photos { photos }
    }

    fn names(&self) -> Vec<&str> {
        self.photos.keys().map(String::as_str).collect()
    }

    pub(super) fn entries(&self) -> &BTreeMap<String, PhotoEntry> {
        &self.photos
    }
}

/// The names of the photos that a stage's panels are made from; none where they do not come from
/// one `Photos`.
pub fn sides(sources: &[&Node]) -> Option<Vec<String>> {
    let mut readers = sources.iter().filter(|n| n.card.name == Photos::NAME);
    let reader = readers.next().filter(|_| readers.next().is_none())?;
    let photos: Photos = ron_options().from_str(&reader.stage.params()).ok()?;
    Some(photos.photos.into_keys().collect())
}

/// Reads all photos in parallel; a file that is named twice is decoded once.
///
/// # Errors
/// For no photos at all, a name that no file could have, a width or scale that cannot be, a mirror
/// of nothing or of itself, and what [`decode`] refuses.
pub fn read_photos(entries: &BTreeMap<String, PhotoEntry>, cx: &Context) -> Result<Set<Photo>, StageError> {
    if entries.is_empty() {
        return Err(none());
    }
    entries.keys().try_for_each(|name| named(name))?;
    let sides = entries
        .keys()
        .map(|name| resolve(entries, name).map(|side| (name, side)))
        .collect::<Result<Vec<_>, _>>()?;
    // A file is decoded once for each object that is looked for in it; its faults are those of the
    // side that names it.
    let last_wins = [true, false]
        .into_iter()
        .flat_map(|mirrored| sides.iter().rev().filter(move |(_, side)| side.1 == mirrored));
    let files: BTreeMap<(&str, Option<ScaleObject>), &str> =
        last_wins.map(|(name, (file, _))| ((file.file.as_str(), file.scale), name.as_str())).collect();
    cx.progress(0.0, format!("reading {} file(s)", files.len()));
    let files: Vec<_> = files.into_iter().collect();
    let read =
        |((file, object), name): &((&str, Option<ScaleObject>), &str)| read_file(file, *object, name, cx);
    let pictures = files.par_iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let pictures: BTreeMap<_, DecodedPicture> = files.iter().map(|(key, _)| *key).zip(pictures).collect();
    cx.progress(1.0, "photos read");
    let photo = |(name, (file, mirrored)): (&String, (&PhotoFile, bool))| {
        let picture = pictures.get(&(file.file.as_str(), file.scale))?;
        Some((name.clone(), picture.photo(file, mirrored)))
    };
    Ok(sides.into_iter().filter_map(photo).collect())
}

fn none() -> StageError {
    StageError::invalid("there are no photos")
        .hint("add `photos: {\"front\": (file: \"front.jpg\", width: \"52 cm\")}`")
        .at("photos")
}

/// Looks at a side's file without decoding it.
fn look(side: &str, file: &str, cx: &Context) -> Result<(), StageError> {
    let seen = cx.read(file).and_then(|bytes| check(&bytes, file));
    seen.map_err(|e| e.at("photos").within(side).within("file"))
}

/// A side's name stands in the names of files: textures, kept artifacts, goldens.
fn named(name: &str) -> Result<(), StageError> {
    let is_apart = |c: char| c.is_control() || matches!(c, '/' | '\\' | ':');
    match name.is_empty() || name.starts_with('.') || name.contains(is_apart) {
        true => Err(StageError::invalid(format!("a photo is named {name:?}, as no file can be"))
            .hint("name it after the garment's side: \"front\", \"back\"")
            .at("photos")
            .within(name)),
        false => Ok(()),
    }
}

/// Decoded pixels that several photos may share.
pub(super) struct DecodedPicture {
    pub(super) pixels: Shared<image::RgbImage>,
    pub(super) alpha: Option<Shared<image::GrayImage>>,
    /// Where an object in it tells.
    pub(super) px_per_metre: Option<f64>,
}

impl DecodedPicture {
    pub(super) fn photo(&self, file: &PhotoFile, mirrored: bool) -> Photo {
        Photo {
            pixels: self.pixels.clone(),
            alpha: self.alpha.clone(),
            px_per_metre: file.px_per_metre.or(self.px_per_metre),
            garment_width: file.width.map(Length::metres),
            mirrored,
            joined: 1,
            file: file.file.clone(),
        }
    }
}

/// Reads a file for the side `name`, and looks for an object in it.
pub(super) fn read_file(
    file: &str,
    object: Option<ScaleObject>,
    name: &str,
    cx: &Context,
) -> Result<DecodedPicture, StageError> {
    cx.check()?;
    let bytes = cx.read(file).map_err(|e| e.at("photos"))?;
    let decoded = decode(&bytes, file).map_err(|e| e.at("photos"))?;
    let (Decoded { pixels, alpha }, px_per_metre) = match object {
        None => (decoded, None),
        Some(object) => {
            let (above, scale) = scale::from_above(decoded, object, file, cx)
                .map_err(|e| e.at("photos").within(name).within("scale"))?;
            (above, Some(scale))
        }
    };
    Ok(DecodedPicture { pixels: Shared::new(pixels), alpha: alpha.map(Shared::new), px_per_metre })
}
