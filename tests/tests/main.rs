//! Tests of whole pipelines, in one program: linking one for each file took longer than most of
//! them run.
//!
//! Beside it stand `any_input` and `fuzz`, which `.ci/wide` runs with more cases (`fuzz` counts
//! what its process holds), and `contracts`, which holds stages to milliseconds: another test's
//! work on the same threads would be counted as theirs.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod bad_input;
mod before_run;
mod cache;
mod code;
mod command_line;
mod doctor;
mod garments;
mod goldens;
mod lock;
mod measured;
mod migrate;
mod new_stage;
mod plugins;
mod texts;
mod why;
