//! The cost model on made-up records.
#![allow(clippy::unwrap_used)]

mod kit;
mod law;
mod store;
mod words;
