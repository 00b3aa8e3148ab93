//! The program as users of a shell meet it: every test starts it as a process.
//!
//! `apart` and `panics` stand beside it: they call the library in their own process, and `panics`
//! starts itself.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

mod batch;
mod bench_costs;
mod full_disk;
mod interrupt;
mod manners;
mod own_files;
mod plugin_ends;
mod readme;
mod remedies;
mod sheet;
mod verify;
mod watch;
