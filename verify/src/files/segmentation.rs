//! Which panel each vertex belongs to, by the text file that GarmentCode's simulator writes beside
//! a garment.
//!
//! `NAME_sim_segmentation.txt` has a line for each vertex of `NAME_sim.obj` and `NAME_boxmesh.obj`:
//! the panel's name, or, of a vertex that is sewn, the stitches that meet there, `stitch_3` or
//! `stitch_3,stitch_7` (in older data sets `stitch` and `None`). Cost: linear.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// How the file's name ends.
const ENDING: &str = "_segmentation.txt";
/// Endings of garments that share one file.
const KINDS: [&str; 2] = ["_sim", "_boxmesh"];

/// For each vertex of a file the name of its panel; none of a vertex that is sewn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Segmentation(pub Vec<Option<String>>);

impl Segmentation {
    /// Reads the text of a file.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let is_sewn = |label: &str| label.is_empty() || label == "None" || label.starts_with("stitch");
        let label = |line: &str| Some(line.trim().to_owned()).filter(|l| !is_sewn(l));
        Self(text.lines().map(label).collect())
    }

    /// The panel's name of a triangle that is in one panel by these labels.
    #[must_use]
    pub fn name(&self, triangle: &[u32; 3]) -> Option<&str> {
        triangle.iter().find_map(|v| self.0.get(*v as usize)?.as_deref())
    }

    /// What most of these triangles are called.
    #[must_use]
    pub fn most<'s>(&'s self, triangles: impl Iterator<Item = &'s [u32; 3]>) -> Option<&'s str> {
        let mut count: BTreeMap<&str, usize> = BTreeMap::new();
        triangles.filter_map(|t| self.name(t)).for_each(|name| *count.entry(name).or_insert(0) += 1);
        // Of several the first by name.
        count.into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(name, _)| name)
    }
}

/// The file beside a garment, where there is one.
#[must_use]
pub(super) fn beside(garment: &Path) -> Option<PathBuf> {
    let stem = garment.file_stem()?.to_string_lossy().into_owned();
    let bare = KINDS.iter().find_map(|kind| stem.strip_suffix(kind)).unwrap_or(&stem);
    let names = [format!("{stem}{ENDING}"), format!("{bare}_sim{ENDING}")];
    names.iter().map(|name| garment.with_file_name(name)).find(|path| path.is_file())
}
