//! How pieces are sewn: kinds of seams, plans, gathers.

pub(crate) mod arrow;
pub(crate) mod gathers;
pub(crate) mod gauge;
pub(crate) mod lying;
pub(crate) mod plan;
pub(crate) mod seam_kind;
pub(crate) mod weld;
