//! Tests of whole pipelines, in one program: linking one for each file took longer than most of
//! them run.
//!
//! Beside it stand `any_input` and `fuzz`, which `.ci/wide` runs with more cases (`fuzz` counts
//! what its process holds), and `contracts`, which holds stages to milliseconds: another test's
//! work on the same threads would be counted as theirs.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod ablation;
mod bad_input;
mod before_run;
mod cache;
mod catalogue;
mod circles;
mod command_line;
mod costs;
mod decisions;
mod docs;
mod doctor;
mod drawn_as_sewn;
mod error_codes;
mod every_parameter;
mod falls;
mod flat;
mod goldens;
mod lock;
mod messages;
mod migrate;
mod new_stage;
mod outputs;
mod photos;
mod plugins;
mod proposals;
mod qualities;
mod repeatable;
mod trade;
mod turntable;
mod typos;
mod vest;
mod why;
