//! What may be turned: knobs, their values, and where they stand in the pipeline's file.

pub mod default_knobs;
pub mod dial;
pub mod knob;
pub mod slot;
pub mod source;
pub(crate) mod split;
