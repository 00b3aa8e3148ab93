//! The network's file, which is part of the program, and its digest.
//!
//! To renew it: put the new file in the place of `weights/parts.onnx`, run `cargo test --release -p
//! toile-recognise`, and write the digest that the failing test prints into [`DIGEST`]. A program
//! whose file and digest differ refuses to see.

/// The network as an ONNX file.
pub const FILE: &[u8] = include_bytes!("../weights/parts.onnx");

/// The BLAKE3 digest of [`FILE`], 64 hexadecimal digits.
pub const DIGEST: &str = "744a128ea2e3018f75b662001224e22aeebe0b47aef3a3498573c645ab0f1847";
