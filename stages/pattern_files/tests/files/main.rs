//! Files that are written, read back by small readers of the tests' own.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

mod common;
mod fuzz;
mod pages;
mod plots;
mod programs;
mod pygarment;
mod real;
mod round_trip;
mod told;
