//! Views between views: pictures from places where no camera stood.
//!
//! | file | what it holds |
//! |---|---|
//! | `flow_view` | the stage `FlowView`: two photos, by the motion between them |
//! | `dense` | a vector for each pixel, from those of the blocks |
//! | `depth_view` | the stage `DepthView`: two photos around an object, by depth |
//! | `orbit` | the cameras of two photos around an object |
//! | `sweep` | depth along the epipolar lines: planes and semi-global matching |
//! | `light_field` | the stage `LightField`: many photos on a grid, by rays |
//! | `photos` | what all of them ask of photos |

mod dense;
mod depth_view;
mod flow_view;
mod light_field;
mod orbit;
mod photos;
mod sweep;
#[cfg(test)]
mod tests;

pub use depth_view::DepthView;
pub use flow_view::FlowView;
pub use light_field::LightField;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<DepthView>();
    registry.add::<FlowView>();
    registry.add::<LightField>();
}
