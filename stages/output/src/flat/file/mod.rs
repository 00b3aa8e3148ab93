//! 3D files of garments: what they hold (`read_glb`, `read_obj`), what of it is the garment
//! (`chosen`), its repair (`raw`), and where it is cut (`labels`); or all of it as it stands
//! there (`meshes`).

mod accessor;
mod chosen;
mod closed;
mod extensions;
mod labels;
mod meshes;
mod raw;
mod raw_words;
mod read_glb;
mod read_obj;
#[cfg(test)]
mod tests;
mod upright;

pub(super) use chosen::{cloth_of_ours, leave_out, open_cloth};
pub(super) use closed::{list, wholes};
pub use labels::PiecesBy;
pub(super) use labels::{labels, of_corners};
pub(super) use meshes::GARMENT_SIZES;
pub use meshes::{FileMeshes, file_meshes};
pub(super) use raw::{Mended, NO_POINT, RawMesh};
pub(super) use read_glb::read_glb;
pub(super) use read_obj::read_obj;
pub(super) use upright::lies;
