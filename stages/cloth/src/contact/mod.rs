//! What cloth touches: the body and itself.

pub mod body;
pub mod closest;
