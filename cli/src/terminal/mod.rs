//! What stands between the program and who uses it: streams, progress, the keyboard's stop.

pub(crate) mod interrupt;
pub(crate) mod last_words;
pub(crate) mod progress;
pub(crate) mod stdin;
pub(crate) mod streams;
pub(crate) mod threads;
