//! Memory of someone else that a list may lie in.

use super::shared::Shared;
use crate::artifact::Picture;
use std::any::Any;
use std::mem::ManuallyDrop;
use std::sync::Arc;

/// Bytes shown where they lie, and who keeps them there.
pub type KeptBytes = (ManuallyDrop<Vec<u8>>, Arc<dyn Any + Send + Sync>);

/// Someone who can be asked to keep a list of bytes that was lent.
pub trait Lend: std::fmt::Debug + Send + Sync {
    /// Keeps the bytes, the list that this owner was named for, for as long as the keeper lives;
    /// none where that cannot be. The vector must neither grow nor be freed.
    fn keep(&self, bytes: &[u8]) -> Option<KeptBytes>;
}

/// A lent list as a picture, where it lies; none where its owner cannot keep it.
pub(super) fn picture<P: Picture>(owner: &dyn Lend, bytes: &[u8], w: u32, h: u32) -> Option<Shared<P>> {
    if bytes.is_empty() || bytes.len() as u64 != u64::from(w) * u64::from(h) * u64::from(P::CHANNELS) {
        return None;
    }
    let (shown, keeper) = owner.keep(bytes)?;
    // `Shared` gives out references alone and never drops the picture.
    P::of_bytes(w, h, ManuallyDrop::into_inner(shown)).map(|picture| Shared::lent(picture, keeper))
}
