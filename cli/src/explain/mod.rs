//! `toile explain`.

pub(crate) mod command;
pub(crate) mod json;
pub(crate) mod words;
