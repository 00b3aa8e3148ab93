//! Sewing patterns as files: GarmentCode JSON, SVG, DXF, PDF and HP-GL.
//!
//! Every writer is a function of a pattern, and of options, to the bytes of a file. The same
//! pattern gives the same bytes each time. What a file cannot hold is told in sentences; seams
//! stand in a file beside it, by the names that the file's reader will give.

pub mod allowance;
mod drawing;
pub mod dxf;
mod error;
mod flatten;
mod font;
pub mod garment_code;
mod inside;
mod label;
mod marks;
mod names;
mod options;
mod parts;
pub mod pdf;
pub mod plt;
mod shelf;
mod sidecar;
pub mod svg;
mod written;

pub use error::{FARTHEST, WriteError};
pub use options::DrawingOptions;
pub use sidecar::{kind_word, sidecar};
pub use written::Written;
