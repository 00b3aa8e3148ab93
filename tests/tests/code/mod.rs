//! The code itself: what imports what, and whether each parameter acts.

mod circles;
mod every_parameter;
