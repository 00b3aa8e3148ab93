//! What the engine refuses or does not reach, in the words of people who have a photo, a pattern or
//! a scene.
//!
//! The main sentence names pieces, seams and places; the help is what this user can type or do;
//! what the engine itself says (forces, counts, coordinates) becomes the detail of the error.

mod motion;
mod numbers;
mod place;
mod rest;
mod start;
#[cfg(test)]
mod tests;

use super::split;
use toile_core::artifact::{Collide, Garment};
use toile_core::{ErrorCode, StageError};

pub(crate) use motion::Motions;
pub(crate) use rest::{Rests, crossing};

/// To whom and of what is told.
#[derive(Clone, Copy)]
pub(crate) struct MessageContext<'a> {
    /// Knows which panel a triangle belongs to.
    pub(crate) garment: &'a Garment,
    /// Knows where on the body a place is.
    pub(crate) scheme: Option<&'a dyn Collide>,
    /// The stage by its id, as `--set` takes it.
    pub(crate) stage: &'a str,
}

impl MessageContext<'_> {
    /// A change of the stage's parameter, as a user types it.
    fn set(&self, parameter: &str, value: impl std::fmt::Display) -> String {
        format!("`--set 'stages.{}.{parameter}={value}'`", self.stage)
    }

    /// An error with what the engine says about it as the detail.
    fn error(code: ErrorCode, message: String, engine: &dyn std::fmt::Display) -> StageError {
        let engine = split(code, &engine.to_string());
        let e = StageError::new(code, message);
        if e.message == engine.message { e } else { e.detail(engine.message) }
    }
}

/// A panel as the engine calls it ("panel 'front'"), by its name.
fn panel(engine: &str) -> &str {
    engine.strip_prefix("panel ").unwrap_or(engine)
}

/// Two panels as the subject of a sentence about each other, with its verb: "'a' and 'b' came
/// through each other", "'a' came through itself".
fn both([a, b]: &[String; 2], many: &str, one: &str) -> String {
    match a == b {
        true => format!("{} {one} itself", panel(a)),
        false => format!("{} and {} {many} each other", panel(a), panel(b)),
    }
}

/// A seam by its sides, or by its name.
pub(crate) fn seam(name: &str) -> String {
    match name.split_once(" + ") {
        Some((a, b)) => format!("the seam from {a} to {b}"),
        None => format!("the seam '{name}'"),
    }
}

/// How to turn a seam round that runs the wrong way.
pub(crate) fn turn_round(name: &str) -> String {
    let edge = name.split_once(" + ").map_or("piece.edge", |(_, edge)| edge);
    format!(
        "turn one of its sides round: in a file of seams `\"-{edge}\"` for `\"{edge}\"`, or the other way; in a scene the second vertices of \
         its pairs in reverse order"
    )
}

/// A length as people say it.
fn length(metres: f64) -> String {
    match metres {
        m if m < 0.01 => format!("{:.1} mm", m * 1e3),
        m if m < 0.1 => format!("{:.1} cm", m * 1e2),
        m if m < 1.0 => format!("{:.0} cm", m * 1e2),
        m => format!("{m:.2} m"),
    }
}
