//! What artifacts are made of: digests, named fields, shared memory, checks.

pub(crate) mod digest;
mod lend;
mod list;
mod read;
pub(crate) mod shared;
pub(crate) mod sound;

pub use lend::{KeptBytes, Lend};
pub use list::{Data, Listed, MemoryOwner, Record, RecordField};
pub use read::Reader;
