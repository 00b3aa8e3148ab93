//! Pictures: a list of marks becomes an SVG and a PNG, so that both show the same.

mod axis;
mod front;
mod mark;
mod png;
mod stability;
mod svg;

pub(crate) use front::marks;
pub(crate) use png::png;
pub use stability::pictures;
pub(crate) use svg::svg;
