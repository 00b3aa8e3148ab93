//! The engine against closed forms and conservation laws.
#![allow(clippy::unwrap_used, clippy::expect_used)]
