//! Parameters of stages: lengths with units, and the table that documents and checks them.
//!
//! - `length`, `kind`: what a parameter may be; `doc`: what is known of one; `group`: what several stages share; `check`, `words`: whether a text is its value, and
//!   why not; `dialect`: the form of the files.

mod check;
mod dialect;
mod doc;
#[doc(hidden)]
pub mod group;
mod kind;
mod length;
mod words;

#[doc(hidden)]
pub use check::check_number;
pub use check::{Check, ParamFault};
pub use dialect::ron_options;
#[doc(hidden)]
pub use dialect::ron_text;
pub use doc::{Finer, ParamDoc};
pub use group::Params;
pub use kind::ParamType;
pub use length::{LENGTH_UNITS, Length};
#[doc(hidden)]
pub use words::ron_fault;
