//! The frames of a stage's photos, before they are decoded.

use super::Photos;
use super::decode::upright_size;
use super::expected::width;
use super::resolve::resolve;
use toile_core::param::ron_options;
use toile_core::{Context, StageMeta};

/// Width and height of every photo, px, with the width of its frame, metres, the garment as wide as
/// the frame where only its width is known; none where a photo cannot be read or the stage is none
/// that reads photos.
pub fn frames(stage: &str, params: &str, cx: &Context) -> Option<Vec<((u32, u32), f64)>> {
    let photos: Photos = (stage == Photos::NAME).then(|| ron_options().from_str(params).ok()).flatten()?;
    let frame = |name: &String| {
        let (photo, _) = resolve(photos.entries(), name).ok()?;
        let (w, h) = upright_size(&cx.read(&photo.file).ok()?)?;
        Some(((w, h), width(photo, f64::from(w))))
    };
    photos.entries().keys().map(frame).collect()
}
