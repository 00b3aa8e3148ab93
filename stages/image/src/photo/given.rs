//! Photos whose pixels a program gives, in the place of a pipeline's files.

use super::photos::{DecodedPicture, read_file};
use super::resolve::resolve;
use super::{Decoded, PhotoEntry, Photos, scale};
use std::collections::BTreeMap;
use toile_core::param::ron_options;
use toile_core::prelude::*;

/// The photos of a stage [`Photos`] with these parameters, with pixels in the place of the files of
/// the sides that `given` names. Widths and scales are the pipeline's; sides that mirror another
/// mirror its pixels.
///
/// # Errors
/// For a side that the pipeline does not have or that mirrors another there; those of
/// [`read_photos`](super::read_photos) for sides that are not given.
pub fn given_photos(
    params: &str,
    given: &BTreeMap<String, Decoded>,
    cx: &Context,
) -> Result<Set<Photo>, StageError> {
    let photos: Photos = ron_options()
        .from_str(params)
        .map_err(|e| StageError::internal(format!("the photos of the pipeline are none: {e}")))?;
    let entries = photos.entries();
    given.keys().try_for_each(|name| takes_pixels(name, entries))?;
    let mut set = BTreeMap::new();
    for name in entries.keys() {
        let (file, mirrored) = resolve(entries, name)?;
        let is_of = |side: &&String| matches!(entries.get(*side), Some(PhotoEntry::File(f)) if f == file);
        let picture = match given.keys().find(is_of).and_then(|side| Some((side, given.get(side)?))) {
            Some((side, pixels)) => {
                let (seen, px_per_metre) = match file.scale {
                    None => (pixels.clone(), None),
                    Some(object) => {
                        let (above, scale) = scale::from_above(pixels.clone(), object, side, cx)?;
                        (above, Some(scale))
                    }
                };
                let Decoded { pixels, alpha } = seen;
                DecodedPicture { pixels: Shared::new(pixels), alpha: alpha.map(Shared::new), px_per_metre }
            }
            None => read_file(&file.file, file.scale, name, cx)?,
        };
        set.insert(name.clone(), Photo { file: name.clone(), ..picture.photo(file, mirrored) });
    }
    Ok(set.into_iter().collect())
}

/// Whether a side of the pipeline has a file, in whose place pixels may stand.
fn takes_pixels(name: &str, entries: &BTreeMap<String, PhotoEntry>) -> Result<(), StageError> {
    let known: Vec<&str> = entries.keys().map(String::as_str).collect();
    match entries.get(name) {
        Some(PhotoEntry::File(_)) => Ok(()),
        Some(PhotoEntry::MirrorOf(other)) => Err(StageError::invalid(format!(
            "the pipeline takes the mirror image of \"{other}\" for the photo \"{name}\""
        ))
        .hint(format!(
            "set `photos.{name}` to a file with its width, like (file: \"{name}.jpg\", width: \"52 cm\")"
        ))),
        None => Err(StageError::invalid(format!("the pipeline has no photo \"{name}\""))
            .hint(format!("its photos are {}", toile_core::quoted(&known)))),
    }
}
