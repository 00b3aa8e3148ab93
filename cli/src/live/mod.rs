//! Commands that go on until Ctrl-C: a run that follows edits of its files, and the studio.

pub(crate) mod reads;
#[cfg(feature = "studio")]
pub(crate) mod studio;
pub(crate) mod watch;
