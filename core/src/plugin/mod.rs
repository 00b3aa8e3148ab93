//! Plugins: stages in libraries of their own, behind a C ABI.
//!
//! - `abi` holds the types that cross; docs/reference/plugin-abi.md is their specification and
//!   `core/include/toile_plugin.h` their C form.
//! - The program's side: `whole` looks whether a library is one, `library` loads and checks a plugin, `foreign` is its stage behind the
//!   [`Stage`](crate::Stage) trait, `call` what the program offers during a call.
//! - The plugin's side: `sdk`, behind the macro [`plugin!`](crate::plugin).
//!   `inside` knows which plugin the program is in.
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
mod inside;
mod lending;
mod library;
pub mod sdk;
mod view;
mod whole;

pub use call::MAX_OUTPUT_BYTES;
pub(crate) use foreign::ForeignType;
pub use foreign::patience;
pub use inside::{LastWords, end, name_who_exits, under_way};
pub use lending::Lending;
pub use library::{Plugin, Refused, load, plugin_files};

/// The C header of plugins, docs/reference/plugin-abi.md in C.
pub const HEADER: &str = include_str!("../../include/toile_plugin.h");
