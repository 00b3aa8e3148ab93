//! From outlines and pattern files to panels around a body: a folder a role, a file a stage.
//!
//! ```text
//! outline --style--> pieces with named edges --mesher--> panels --smoother--> panels --placement--> garment
//! pattern file --reader-------^
//! ```

pub mod mesh;
pub mod pattern;
pub mod place;
pub mod smooth;
pub mod style;

use toile_core::Registry;

/// Adds this crate's stages.
pub fn register(registry: &mut Registry) {
    style::register(registry);
    mesh::register(registry);
    smooth::register(registry);
    place::register(registry);
    pattern::register(registry);
}
