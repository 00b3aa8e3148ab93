//! The text of a pipeline file as a tree that knows the place of every name and value.

pub(crate) mod cut;
pub(crate) mod draft;
pub(crate) mod escapes;
pub(crate) mod parser;
pub(crate) mod repair;
pub(crate) mod tree;
