//! Why a file is not the network that this stage runs.

use thiserror::Error;
use toile_core::{ErrorCode, StageError};

/// Why a file is not a network that can be run here.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Unfit {
    /// Its bytes are no ONNX file.
    #[error("it is no ONNX file")]
    NoOnnx,
    /// It begins as an ONNX file but does not parse to its end.
    #[error("it is damaged or cut short")]
    Damaged,
    /// It holds what this stage does not know, such as an operator that the expected network does
    /// not have.
    #[error("it cannot be read: {0}")]
    Unreadable(String),
    /// Its input is not one photo.
    #[error("it takes {found}, where {wanted} is needed")]
    Takes {
        /// What it takes.
        found: String,
        /// What it should take.
        wanted: String,
    },
    /// Its output is not one map.
    #[error("it gives {found}, where {wanted} is needed")]
    Gives {
        /// What it gives.
        found: String,
        /// What it should give.
        wanted: String,
    },
    /// It failed while it ran.
    #[error("it cannot be run: {0}")]
    Broken(String),
    /// Its map holds values that are not finite.
    #[error("it gives values that are no numbers")]
    NoNumbers,
}

impl Unfit {
    /// The error for the file of that name.
    pub(crate) fn of(&self, file: &str) -> StageError {
        let message = format!("\"{file}\" is not a network that finds objects in photos: {self}");
        StageError::new(ErrorCode::PatternLoading, message).hint(self.remedy()).at("weights")
    }

    fn remedy(&self) -> &'static str {
        match self {
            Unfit::NoOnnx => {
                "name the network's ONNX file itself: not an archive, a web page or a file of another format"
            }
            Unfit::Damaged | Unfit::Unreadable(_) | Unfit::Broken(_) | Unfit::NoNumbers => {
                "get the file again; networks other than U2-Net and U2-Net-p do not fit"
            }
            Unfit::Takes { .. } | Unfit::Gives { .. } => {
                "use U2-Net or U2-Net-p as exported for photos of 320 x 320 pixels"
            }
        }
    }
}
