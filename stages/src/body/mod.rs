//! Bodies: made from measurements or read from a file.

mod arm;
mod body_obj;
mod bounds;
mod bridge;
mod bump;
mod estimate;
mod field;
mod figure;
mod fit;
mod form;
mod head;
mod isosurface;
mod landmarks;
mod leg;
mod limb;
mod loft;
mod mannequin;
mod measure;
mod pose_body;
mod profile;
mod refine;
mod relief;
mod shape;
mod sizes;
mod slice;
mod spline;
mod swing;
mod thin;
mod topology;
mod torso;
mod untangle;
mod wearer;

pub use body_obj::{BodyObj, Units, Up};
pub(crate) use bridge::bridged;
pub use mannequin::Mannequin;
pub use pose_body::PoseBody;
pub(crate) use slice::{convex_hull, slice, trunk};
pub(crate) use swing::Swing;
pub(crate) use thin::grown;
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
