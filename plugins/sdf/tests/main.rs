//! The collider: what it promises, against exact answers, and in a pipeline.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod contracts;
mod exact;
mod vest;
