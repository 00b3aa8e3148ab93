//! The program's side of plugins: `first_bytes` names what a file is that is no plugin for this
//! machine, `whole` checks that a library is complete, `library` loads and checks a plugin,
//! `refused_by_system` explains why the system does not load one, `loaded` keeps it, `card` reads
//! its stages' cards, `foreign` is its stage behind the [`Stage`](toile_core::Stage) trait, `call`
//! what the program offers during a call.
//!
//! What both sides share, and the types that cross, are in [`toile_core::plugin`].

mod call;
mod card;
mod first_bytes;
mod foreign;
mod library;
mod loaded;
mod refused_by_system;
mod whole;

pub use call::MAX_OUTPUT_BYTES;
pub use foreign::patience;
pub use library::{library_of, load, load_plugin, plugin_files};
pub use toile_core::plugin::inside::{LastWords, end, name_who_exits, under_way};
pub use toile_core::plugin::{HEADER, Plugin, Refused};
