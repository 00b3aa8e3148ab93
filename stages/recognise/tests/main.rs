//! The network: what it sees, how files are refused, and pictures of any kind.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod any;
mod kit;
mod onnx;
mod places;
mod refused;
mod sees;
mod spoilt;
mod threads;
mod weights;
