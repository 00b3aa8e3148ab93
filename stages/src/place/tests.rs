//! Placement of a vest and of a tee.
#![allow(clippy::unwrap_used, clippy::expect_used)]
