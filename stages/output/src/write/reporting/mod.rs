//! The stage `Report`: one page with all that a run made.

pub(crate) mod data;
pub(crate) mod outline;
pub(crate) mod pieces;
pub(crate) mod report;
pub(crate) mod top;
pub(crate) mod turn;
pub(crate) mod views;
