//! Whether a finished garment is sound, judged from its files alone.
//!
//! ```text
//! files --files--> Subject --judge--> Judgement --certificate--> certificate.json, words
//! ```
//!
//! - [`files`]: a garment, its body and its pattern from files, by the readers of the stages.
//! - [`judge`]: the checks. [`mesh`] looks at triangles, [`crossings`] at cloth through cloth and
//!   body by exact signs, [`lay`] lays panels on the pieces of a pattern, [`seams`] measures the
//!   gaps of seams, [`strain`] holds panels against their flat pieces, [`rest`] lets the garment go
//!   where it is.
//! - [`compare`]: two garments of one pattern side by side.
//! - [`certificate`]: what is written, and its words.
//!
//! No figure that a run wrote is used: of a run's folder only the garment, the body and the flat
//! pieces are read. Every sum runs in a fixed order, so that the result does not depend on the
//! number of threads. Limit: whether the garment is at rest is judged where the fabric is named; no
//! file of a garment contains it.

pub mod certificate;
pub mod compare;
pub mod crossings;
pub mod files;
pub mod judge;
pub mod laid;
pub mod lay;
pub mod limits;
mod loops;
pub mod mesh;
mod released;
pub mod rest;
pub mod seams;
pub mod strain;
pub mod subject;

#[cfg(test)]
mod tests;

pub use certificate::{Certificate, InputFile};
pub use judge::{FigureCheck, Judgement, Verdict, judge};
pub use limits::CheckLimits;
pub use subject::Subject;
