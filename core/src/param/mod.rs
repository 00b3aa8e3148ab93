//! Parameters of stages: lengths with units, and the table that documents and checks them.
//!
//! - `length`, `kind`: what a parameter may be; `doc`: what is known of one; `group`: what several
//!   stages share; `check`, `range`, `words`, `fault`: whether a text is its value, and why not;
//!   `dialect`: the form of the files.

mod check;
mod dialect;
mod doc;
mod fault;
#[doc(hidden)]
pub mod group;
mod kind;
mod length;
mod range;
mod words;

pub use dialect::ron_options;
#[doc(hidden)]
pub use dialect::ron_text;
pub use doc::{Check, FILE_PARAMS, Finer, ParamDoc};
pub use fault::ParamFault;
pub use group::Params;
pub use kind::ParamType;
pub use length::{LENGTH_UNITS, Length};
#[doc(hidden)]
pub use range::check_number;
#[doc(hidden)]
pub use words::ron_fault;
