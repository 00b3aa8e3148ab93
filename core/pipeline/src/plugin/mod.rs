//! The program's side of plugins: `whole` looks whether a library is one, `library` loads and checks a plugin, `loaded` keeps it, `card` reads its
//! stages' cards, `foreign` is its stage behind the [`Stage`](toile_core::Stage) trait, `call` what the program offers during a
//! call.
//!
//! What both sides share, and the types that cross, are in [`toile_core::plugin`].

mod call;
mod card;
mod foreign;
mod library;
mod loaded;
mod whole;

pub use call::MAX_OUTPUT_BYTES;
pub use foreign::patience;
pub use library::{load, load_plugin, plugin_files};
pub use toile_core::plugin::inside::{LastWords, end, name_who_exits, under_way};
pub use toile_core::plugin::{HEADER, Plugin, Refused};
