//! Runs with a cache: what runs again, what does not, and what becomes of damage.
#![allow(clippy::unwrap_used)]

mod bench;
mod causes;
mod damage;
mod rerun;
mod watch;
