//! The studio through its interfaces: HTTP as a page speaks it, and the project without it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod client;
mod edits;
mod files;
mod kit;
mod page;
mod proposals;
mod random;
mod runs;
mod safety;
