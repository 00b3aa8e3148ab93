//! The code itself: what imports what, what types are called, and whether each parameter acts.

mod circles;
mod every_parameter;
mod type_names;
