//! Pictures: a list of marks becomes an SVG and a PNG, so that both show the same.

pub mod axis;
mod front;
pub mod mark;
mod png;
mod svg;

pub(crate) use front::marks;
pub use png::png;
pub use svg::svg;
