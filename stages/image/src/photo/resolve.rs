//! The file that a photo of a pipeline comes from.

use super::entry::{scale_fault, width_fault};
use super::{PhotoEntry, PhotoFile};
use std::collections::BTreeMap;
use toile_core::nearest;
use toile_core::prelude::*;

/// Follows mirrors to a file; true where the pattern is that file's mirror image.
pub(super) fn resolve<'a>(
    entries: &'a BTreeMap<String, PhotoEntry>,
    name: &str,
) -> Result<(&'a PhotoFile, bool), StageError> {
    let mut at = name;
    let mut mirrored = false;
    // A chain longer than the number of entries visits one of them twice.
    for _ in 0..=entries.len() {
        match entries.get(at) {
            Some(PhotoEntry::File(file)) => return checked(name, file).map(|f| (f, mirrored != f.mirror)),
            Some(PhotoEntry::MirrorOf(other)) => (at, mirrored) = (other, !mirrored),
            None => return Err(no_such_photo(entries, name, at)),
        }
    }
    Err(StageError::invalid(format!("photo \"{name}\" mirrors itself"))
        .hint("one of the photos must be a file")
        .at("photos")
        .within(name))
}

fn no_such_photo(entries: &BTreeMap<String, PhotoEntry>, name: &str, target: &str) -> StageError {
    let known: Vec<String> = entries.keys().map(|k| format!("\"{k}\"")).collect();
    let others = entries.keys().map(String::as_str).filter(|k| *k != name);
    let near = nearest(target, others).map_or_else(String::new, |n| format!("did you mean \"{n}\"? "));
    StageError::invalid(format!("photo \"{name}\" is to mirror \"{target}\", which does not exist"))
        .hint(format!("{near}the photos are {}", known.join(", ")))
        .at("photos")
        .within(name)
}

/// What is wrong with a file's width and scale.
fn checked<'a>(name: &str, file: &'a PhotoFile) -> Result<&'a PhotoFile, StageError> {
    let width = file.width.and_then(width_fault).map(|fault| ("width", fault));
    let scale = || file.px_per_metre.and_then(scale_fault).map(|fault| ("px_per_metre", fault));
    if let Some((field, fault)) = width.or_else(scale) {
        let text = format!("photo \"{name}\": {fault}");
        return Err(StageError::new(ErrorCode::InvalidParameter, text)
            .at("photos")
            .within(name)
            .within(field));
    }
    let given = [
        ("width", file.width.is_some()),
        ("px_per_metre", file.px_per_metre.is_some()),
        ("scale", file.scale.is_some()),
    ];
    let given: Vec<&str> = given.into_iter().filter(|g| g.1).map(|g| g.0).collect();
    if given.len() > 1 {
        let text =
            format!("photo \"{name}\": both {} are given; one of them fixes the scale", given.join(" and "));
        return Err(StageError::new(ErrorCode::InvalidParameter, text).at("photos").within(name));
    }
    Ok(file)
}
