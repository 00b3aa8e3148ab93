//! What the tests of whole pipelines share: calling the command, and the repository's folders.

pub mod napkin;
pub mod plugins;

use std::path::{Path, PathBuf};

/// What a call of the command printed, and its exit code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// The exit code.
    pub code: u8,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

/// Calls `toile` with arguments, in this process. A run uses no cache but one that the arguments
/// name: tests run stages, and leave no trace in the home folder.
pub fn toile(arguments: &[&str]) -> Answer {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let caches = matches!(arguments.first(), Some(&"run" | &"explain"));
    let off = caches && !arguments.contains(&"--cache-dir");
    let off = off.then_some("--no-cache").filter(|flag| !arguments.contains(flag));
    let all = std::iter::once("toile").chain(arguments.iter().copied()).chain(off);
    let code = toile::command(all, &mut out, &mut err);
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Answer { code, out: text(out), err: text(err) }
}

/// Whether an output folder holds nothing but what a run that failed leaves for a look.
pub fn wrote_no_result(out: &Path) -> bool {
    let Ok(entries) = std::fs::read_dir(out) else { return true };
    entries.flatten().all(|e| e.file_name() == "failed")
}

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A pipeline's text without its solver: no line of `StaticEquilibrium` or `Subdivide`, and no
/// qualities, which set them.
#[must_use]
pub fn without_rest(text: &str) -> String {
    let (head, qualities) = text.split_once("    qualities: [").unwrap_or((text, ""));
    let tail = qualities.split_once("\n    ],\n").map_or("", |(_, tail)| tail);
    let lines = head
        .lines()
        .chain(tail.lines())
        .filter(|l| !["StaticEquilibrium(", "Subdivide("].iter().any(|s| l.trim().starts_with(s)));
    lines.collect::<Vec<_>>().join("\n")
}

/// A shipped pipeline file.
pub fn pipeline(name: &str) -> String {
    root().join("pipelines").join(name).display().to_string()
}

/// The shipped pipelines.
pub const PIPELINES: [&str; 24] = [
    "vest.ron",
    "tshirt.ron",
    "photo.ron",
    "photo_tee.ron",
    "photo_vest.ron",
    "scene.ron",
    "skirt.ron",
    "pattern.ron",
    "shirt.ron",
    "trousers.ron",
    "dress.ron",
    "onepiece.ron",
    "pleats.ron",
    "outfit.ron",
    "photo_longsleeve.ron",
    "photo_skirt.ron",
    "photo_dress.ron",
    "photo_trousers.ron",
    "photo_shorts.ron",
    "photo_gathered.ron",
    "photo_onepiece.ron",
    "photo_pleated.ron",
    "photo_shirt.ron",
    "flatten.ron",
];
