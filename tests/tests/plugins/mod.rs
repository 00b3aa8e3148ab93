//! The plugin ABI: what crosses, and what is refused or reported, word for word, with the program
//! alive afterwards. `docs/reference/plugin-abi.md` is what they hold it against.

mod bad;
mod colliders;
mod kit;
mod layout;
mod pipelines;
mod runs;
mod shipped;
