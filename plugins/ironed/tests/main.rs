//! The texturer: what it promises, by itself, and in a pipeline.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod ironed;
mod vest;
