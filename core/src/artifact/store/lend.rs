//! Memory of someone else that a list may lie in.

use super::shared::Shared;
use crate::artifact::Picture;
use std::any::Any;
use std::sync::Arc;

/// Someone who can be asked to keep a list that was lent.
pub trait Lend: std::fmt::Debug + Send + Sync {
    /// Keeps the list for as long as the result lives; none where that cannot be.
    fn keep(&self) -> Option<Arc<dyn Any + Send + Sync>>;
}

/// A lent list as a picture, where it lies; none where its owner cannot keep it.
///
/// `bytes` is the list that this owner was named for.
pub(super) fn picture<P: Picture>(owner: &dyn Lend, bytes: &[u8], w: u32, h: u32) -> Option<Shared<P>> {
    let keeper = owner.keep().filter(|_| !bytes.is_empty())?;
    // The vector only shows the bytes: `Shared` gives out references alone and never drops it, so
    // that it is neither grown nor freed; the keeper keeps the bytes for as long as it lives.
    let shown = unsafe { Vec::from_raw_parts(bytes.as_ptr().cast_mut(), bytes.len(), bytes.len()) };
    let length = bytes.len() as u64;
    if length != u64::from(w) * u64::from(h) * u64::from(P::CHANNELS) {
        std::mem::forget(shown);
        return None;
    }
    P::of_bytes(w, h, shown).map(|picture| Shared::lent(picture, keeper))
}
