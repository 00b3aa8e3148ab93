//! What runs have written: the files of `out/`.

use crate::fault::StudioFault;
use serde_json::{Value, json};
use std::path::{Component, Path};

/// The folder of results in a project.
pub(crate) const OUT: &str = "out";

/// The most files that are listed.
const MOST_FILES: usize = 2000;

/// All files below `out/` of a folder, by path.
pub(super) fn list(folder: &Path) -> Vec<Value> {
    let root = folder.join(OUT);
    let (mut files, mut folders) = (Vec::new(), vec![root.clone()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            // A link is not followed: it may lead outside.
            let path = entry.path();
            let (Ok(kind), Ok(below)) = (entry.file_type(), path.strip_prefix(&root)) else { continue };
            let below = below.to_string_lossy().replace('\\', "/");
            if kind.is_dir() {
                folders.push(path);
            } else if kind.is_file() && files.len() < MOST_FILES {
                files.push((below, entry.metadata().map_or(0, |m| m.len())));
            }
        }
    }
    files.sort();
    files.into_iter().map(|(path, bytes)| json!({ "path": path, "bytes": bytes })).collect()
}

/// The content of a file below `out/`.
///
/// Errors: there is none of that path.
pub(super) fn read(folder: &Path, path: &str) -> Result<Vec<u8>, StudioFault> {
    let none = || StudioFault::not_found(format!("there is no file \"{path}\" in \"{OUT}\""));
    let below = Path::new(path);
    let plain = below.components().all(|c| matches!(c, Component::Normal(_)));
    if path.is_empty() || !plain || path.contains(['\\', '\0', ':']) {
        return Err(none());
    }
    let root = folder.join(OUT).canonicalize().map_err(|_| none())?;
    let real = root.join(below).canonicalize().map_err(|_| none())?;
    if !real.starts_with(&root) {
        return Err(none());
    }
    toile_core::read_file(&real).map_err(|_| none())
}
