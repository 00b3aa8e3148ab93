//! Bodies: made from measurements or read from a file.

mod body_obj;
mod depth;
mod figure;
mod form;
mod limbs;
mod mannequin;
mod measures;
mod pose_body;
mod shape;
mod skin;
mod wearer;

pub use body_obj::{BodyObj, HUMAN_HEIGHTS, Units, Up, body_of_mesh};
pub use depth::DepthMap;
pub use limbs::bridge::bridged;
pub use limbs::swing::Swing;
pub use mannequin::Mannequin;
pub use measures::sizes::size_names;
pub use pose_body::PoseBody;
pub use skin::slice::{convex_hull, slice, trunk};
pub use skin::thin::grown;
pub use wearer::Wearer;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Mannequin>();
    registry.add::<BodyObj>();
    registry.add::<PoseBody>();
}

#[cfg(test)]
pub(crate) mod tests;
