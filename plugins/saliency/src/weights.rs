//! The network's file: it must be named, there, and the one that is meant.
//!
//! A pipeline states the file's digest, so that it gives the same mask wherever the file came from,
//! and so that nothing is parsed but what the user has chosen.
//!
//! Cost: 15 ms for 4.6 MB. Limits: a run is not stopped while the file is read and digested, which
//! takes half a second for 176 MB.

use toile_core::artifact::Digester;
use toile_core::{Context, ErrorCode, StageError};

/// The largest file, bytes: U2-Net has 176 MB, U2-Net-p 4.6 MB.
const MAX_BYTES: usize = 1 << 28;
/// Hexadecimal digits of a digest.
const DIGITS: usize = 64;

/// Refuses an empty name.
pub(crate) fn named(file: &str) -> Result<(), StageError> {
    match file.is_empty() {
        true => Err(StageError::new(
            ErrorCode::InvalidParameter,
            "no file is named to read the network from",
        )
        .hint("write `weights: \"u2netp.onnx\"`; plugins/saliency/README.md says where to get the file")
        .at("weights")),
        false => Ok(()),
    }
}

/// Whether the file is there.
pub(crate) fn there(file: &str, cx: &Context) -> Result<(), StageError> {
    cx.look(file).map_err(missing)
}

/// The bytes of the file that has that digest.
pub(crate) fn read(file: &str, digest: &str, cx: &Context) -> Result<Vec<u8>, StageError> {
    named(file)?;
    let bytes = cx.read(file).map_err(missing)?;
    let found = Digester::new().bytes(&bytes).finish().hex();
    is_meant(file, &found, digest)?;
    match bytes.len() > MAX_BYTES {
        true => Err(too_large(file, bytes.len())),
        false => Ok(bytes),
    }
}

/// A file that cannot be read, with where it may come from.
fn missing(e: StageError) -> StageError {
    let paths = e.hint.clone().unwrap_or_default();
    e.hint(format!("{paths}; plugins/saliency/README.md says where to get the file")).at("weights")
}

/// Holds the file's digest against the one that is given.
fn is_meant(file: &str, found: &str, given: &str) -> Result<(), StageError> {
    let wrong = |message: String, hint: String| {
        Err(StageError::new(ErrorCode::InvalidParameter, message).hint(hint).at("digest"))
    };
    let write = format!("write `digest: \"{found}\"` if this is the file that you mean");
    if given.is_empty() {
        return wrong(format!("no digest is given for \"{file}\""), write);
    }
    if given.len() != DIGITS || !given.chars().all(|c| c.is_ascii_hexdigit()) {
        return wrong(format!("`digest` must be {DIGITS} hexadecimal digits, found \"{given}\""), write);
    }
    match given.eq_ignore_ascii_case(found) {
        true => Ok(()),
        false => wrong(
            format!("\"{file}\" is not the file that is meant: its digest is {found}, `digest` says {given}"),
            format!("get the file again, or {write}"),
        ),
    }
}

fn too_large(file: &str, bytes: usize) -> StageError {
    let message = format!("\"{file}\" has {bytes} bytes, a network may have {MAX_BYTES}");
    StageError::new(ErrorCode::PatternLoading, message)
        .hint("use U2-Net-p, which has 4.6 MB, or U2-Net, which has 176 MB")
        .at("weights")
}
