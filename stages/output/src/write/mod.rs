//! Writers: model and run to files.

mod check;
mod copyright;
mod frames;
mod garment_obj;
mod glb;
mod obj;
pub mod origin;
mod patterns;
mod pictures;
mod ply;
mod power_of_two;
mod preview;
mod reporting;
mod scene_json;
mod shown;
mod sides;
#[cfg(test)]
mod tests;
mod texture_file;
mod turntable;
mod usdz;

pub use frames::Frames;
pub use garment_obj::GarmentObj;
pub use glb::Glb;
pub use obj::Obj;
pub use patterns::dxf::{DxfStandard, PatternDxf};
pub use patterns::json::PatternJson;
pub use patterns::pdf::{PatternPaper, PatternPdf};
pub use patterns::plt::{AlongRoll, HpglStandard, PatternPlt};
pub use patterns::svg::PatternSvg;
pub use pictures::{PictureFile, Pictures};
pub use ply::Ply;
pub use preview::{Framing, Preview};
pub use reporting::report::Report;
pub use reporting::views::Views;
pub use scene_json::SceneJson;
pub use texture_file::TextureFormat;
pub use turntable::{Interpolation, Turntable};
pub use usdz::Usdz;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Frames>();
    registry.add::<Glb>();
    registry.add::<GarmentObj>();
    registry.add::<Obj>();
    registry.add_implicit::<origin::Origin>();
    registry.add::<PatternDxf>();
    registry.add::<PatternJson>();
    registry.add::<PatternPdf>();
    registry.add::<PatternPlt>();
    registry.add::<PatternSvg>();
    registry.add::<Pictures>();
    registry.add::<Ply>();
    registry.add::<Preview>();
    registry.add::<Report>();
    registry.add::<SceneJson>();
    registry.add::<Turntable>();
    registry.add::<Usdz>();
}
