//! Plugins: stages in libraries of their own, behind a C ABI.
//!
//! - `abi` holds the types that cross; docs/plugin-abi.md is their specification and
//!   `core/include/toile_plugin.h` their C form.
//! - The program's side: `library` loads and checks a plugin, `foreign` is its stage behind the
//!   [`Stage`](crate::Stage) trait, `call` what the program offers during a call.
//! - The plugin's side: `sdk`, behind the macro [`plugin!`](crate::plugin).
//! - Both sides: `view` (records), `collide` (colliders), `card` (stage cards), `guard` (panics).
//!
//! Architecture invariant: this folder holds all the `unsafe` code of the project. Nothing but
//! `repr(C)` types crosses, no memory is freed by the side that did not make it, no panic passes.

pub mod abi;
mod call;
mod card;
mod collide;
mod foreign;
mod guard;
mod lending;
mod library;
pub mod sdk;
mod view;

pub use call::MAX_OUTPUT_BYTES;
pub(crate) use foreign::ForeignType;
pub use lending::Lending;
pub use library::{Plugin, Refused, load, plugin_files};
