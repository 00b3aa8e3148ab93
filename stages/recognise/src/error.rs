//! Why a photo is not recognised, or a file is not the network.

use thiserror::Error;

/// Why a photo is not recognised, or a file is not the network.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RecogniseError {
    /// The photo has no pixels.
    #[error("the photo has no pixels")]
    NoPixels,
    /// The file is not the one that the program was built for.
    #[error("the network's file has the digest {found}, where {wanted} is needed")]
    OtherFile {
        /// BLAKE3 digest of the file, 64 hexadecimal digits.
        found: String,
        /// The digest that it should have.
        wanted: &'static str,
    },
    /// Its bytes are no ONNX file.
    #[error("the network's file is no ONNX file")]
    NoOnnx,
    /// It begins as an ONNX file but does not parse to its end.
    #[error("the network's file is damaged or cut short")]
    Damaged,
    /// It holds what is not known here, such as an operator that the network does not use.
    #[error("the network's file cannot be read: {0}")]
    Unreadable(String),
    /// Its input is not one photo.
    #[error("the network takes {found}, where {wanted} is needed")]
    Takes {
        /// What it takes.
        found: String,
        /// What it should take.
        wanted: String,
    },
    /// One of its outputs is missing.
    #[error("the network gives no \"{0}\"")]
    GivesNo(&'static str),
    /// One of its outputs has another shape.
    #[error("the network gives {found} as \"{output}\", where {wanted} is needed")]
    Gives {
        /// The output's name.
        output: &'static str,
        /// What it gives.
        found: String,
        /// What it should give.
        wanted: String,
    },
    /// It failed while it ran.
    #[error("the network cannot be run: {0}")]
    Broken(String),
    /// One of its outputs holds values that are not finite.
    #[error("the network gives values as \"{0}\" that are no numbers")]
    NoNumbers(&'static str),
}
