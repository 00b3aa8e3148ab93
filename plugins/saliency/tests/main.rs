//! The network's stage: what it promises, what it finds, how it refuses, and in a pipeline.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod any;
mod border;
mod contracts;
mod kit;
mod onnx;
mod pipeline;
mod refused;
mod tiny;
mod weights;
