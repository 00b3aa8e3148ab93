//! Between artifacts and the cloth engine: garments become scenes, colliders become skins, errors
//! become stage errors.
//!
//! The engine (`toile-cloth`) knows no pipelines; everything that the stages which use it have in
//! common is here.

mod arithmetic;
mod fault;
mod kinds;
mod lost;
mod on_body;
mod pieces;
mod response;
mod scene;
mod surface;
mod words;

pub use arithmetic::arithmetic;
pub use fault::{cloth_error, scene_error, split};
pub(crate) use kinds::carries_out;
pub use lost::lost;
pub use on_body::{both, on_body};
pub use response::check_response;
pub use scene::{SceneSetting, engine_fabric, garment_of, held_of, scene_of, weld_seams};
pub use surface::SchemeSurface;
pub(crate) use words::{MessageContext, Motions, Rests, crossing, seam, turn_round};
