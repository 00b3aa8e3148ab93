//! What artifacts are made of: digests, named fields, shared memory, checks.

pub(crate) mod digest;
mod lend;
mod list;
mod read;
pub(crate) mod shared;
pub(crate) mod sound;

pub use lend::{Kept, Lend};
pub use list::{Data, Field, Listed, Owner, Record};
pub use read::Reader;
