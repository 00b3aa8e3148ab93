//! Artifacts as a page takes them: JSON, pictures, meshes.
//!
//! - `view`: photos, outlines, figures; `pattern`: pieces and seams; `proposals`: seams that are
//!   proposed; `mesh`: garment and body as flat arrays; `pictures`: photos, masks, textures;
//!   `measures`: the body's; `trade`: the qualities.

pub(crate) mod measures;
pub(crate) mod mesh;
mod pattern;
pub(crate) mod pictures;
mod proposals;
pub(crate) mod trade;
pub(crate) mod view;

use std::collections::BTreeMap;
use std::sync::Arc;

/// What belongs to a panel in a set by photos: that of its name, or of the last word of its name,
/// such as `front` for `left_sleeve_front`; with the photo's name.
fn of_panel<'a, T>(set: &'a BTreeMap<String, Arc<T>>, panel: &str) -> Option<(&'a str, &'a Arc<T>)> {
    let found = set.get_key_value(panel).or_else(|| set.get_key_value(panel.rsplit('_').next()?));
    found.map(|(name, value)| (name.as_str(), value))
}
