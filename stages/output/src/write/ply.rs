//! `Ply`: the model as one binary PLY mesh with a colour at every vertex (Turk, 1994).
//!
//! Colours are read off the textures at the vertices, so the print is as fine as the mesh. Cost:
//! one texture lookup per vertex. Limit: 2^31 vertices or triangles.

use super::check::check_model;
use super::shown::sheets;
use crate::file_names::check_name;
use crate::render::{Mips, encode};
use toile_core::prelude::*;

/// Writes the model as one PLY file with vertex colours, for tools that know no textures.
///
/// Binary, little endian, metres, Y up. Every panel is one sheet: the thickness of open edges is
/// left out.
#[stage(
    role = Writer,
    source = "Turk, The PLY Polygon File Format, 1994",
    example = "Ply(name: \"garment\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Ply {
    /// The file's name without its extension.
    #[param(default = "garment".to_owned())]
    name: String,
}

#[stage]
impl Ply {
    pub(super) fn run(&self, model: &Model, _cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        check_model(model)?;
        Ok(OutputFiles::one(&format!("{}.ply", self.name), ply(&sheets(model))))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        crate::file_names::check_name(&self.name).err().into_iter().collect()
    }
}

/// The file.
pub(super) fn ply(model: &Model) -> Vec<u8> {
    let vertices: usize = model.meshes.iter().map(|m| m.positions.len()).sum();
    let faces: usize = model.meshes.iter().map(|m| m.triangles.len()).sum();
    let mut file = header(vertices, faces).into_bytes();
    for mesh in &model.meshes {
        let colours = colours(model, mesh);
        for ((p, n), colour) in mesh.positions.iter().zip(&mesh.normals).zip(colours) {
            let floats = [p.x, p.y, p.z, n.x, n.y, n.z];
            file.extend(floats.iter().flat_map(|c| (*c as f32).to_le_bytes()));
            file.extend_from_slice(&colour);
        }
    }
    let mut first = 0;
    for mesh in &model.meshes {
        for t in &mesh.triangles {
            file.push(3);
            file.extend(t.iter().flat_map(|i| (i + first).to_le_bytes()));
        }
        first += mesh.positions.len() as u32;
    }
    file
}

fn header(vertices: usize, faces: usize) -> String {
    let floats: String = ["x", "y", "z", "nx", "ny", "nz"].map(|n| format!("property float {n}\n")).concat();
    let colours: String = ["red", "green", "blue"].map(|n| format!("property uchar {n}\n")).concat();
    format!(
        "ply\nformat binary_little_endian 1.0\ncomment metres, Y up\nelement vertex {vertices}\n{floats}{colours}\
         element face {faces}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
}

/// The sRGB colour of every vertex of a mesh.
fn colours(model: &Model, mesh: &Mesh) -> Vec<[u8; 3]> {
    let material = model.materials.get(mesh.material);
    let own = material.map_or([1.0; 3], |m| m.colour);
    let texture = material.and_then(|m| m.texture).and_then(|t| model.textures.get(t));
    match texture.map(Mips::new) {
        Some(mips) => mesh.uv.iter().map(|uv| times(mips.sample(*uv, VERTEX_LOD), own)).collect(),
        None => vec![times([1.0; 3], own); mesh.positions.len()],
    }
}

/// Halvings of the texture at which a vertex reads it: its surroundings rather than one thread.
const VERTEX_LOD: f32 = 2.0;

fn times(a: [f32; 3], b: [f32; 3]) -> [u8; 3] {
    [0, 1, 2].map(|k| encode(a[k] * b[k]))
}
