//! Plugins: stages in libraries of their own, behind a C ABI.
//!
//! - `abi` holds the types that cross; docs/reference/plugin-abi.md is their specification and
//!   `core/include/toile_plugin.h` their C form.
//! - The plugin's side: `sdk`, behind the macro [`plugin!`](crate::plugin).
//! - Both sides: `view` (records), `lending` (pictures), `collide` (colliders), `guard` (panics),
//!   `inside` (which plugin the program is in), `loaded` (what a plugin brings).
//! - The program's side, which loads libraries, is `toile_pipeline::plugin`.
//!
//! Architecture invariant: this folder and that one hold all the `unsafe` code of the project, but
//! for that of `python/src/view.rs`, which shows artifacts as arrays of numpy.
//! Nothing but `repr(C)` types crosses, no memory is freed by the side that did not make it, no
//! panic passes.

pub mod abi;
mod card;
#[doc(hidden)]
pub mod collide;
#[doc(hidden)]
pub mod guard;
#[doc(hidden)]
pub mod inside;
#[doc(hidden)]
pub mod lending;
mod loaded;
pub mod sdk;
#[doc(hidden)]
pub mod view;

pub use lending::Lending;
pub use loaded::{Make, Plugin, Refused};

/// The C header of plugins, docs/reference/plugin-abi.md in C.
pub const HEADER: &str = include_str!("../../include/toile_plugin.h");
