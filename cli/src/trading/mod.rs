//! The commands that measure accuracy against time.

pub(crate) mod ablate;
pub(crate) mod apart;
pub(crate) mod bench_costs;
pub(crate) mod costs;
pub(crate) mod measuring;
pub(crate) mod qualities;
pub(crate) mod study;
pub(crate) mod tune;
pub(crate) mod tuned;
