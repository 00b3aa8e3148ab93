//! `Glb`: the model as binary glTF 2.0 (Khronos, 2017; ISO/IEC 12113).
//!
//! One node and one mesh per panel (two where its wrong side looks unlike the right one), one
//! buffer; textures lie in the same file. Positions, normals and texture coordinates are 32-bit
//! floats (or whole numbers, [`grid`]), indices 16 or 32 bits. Of Khronos' extensions it uses,
//! where they are needed, `KHR_materials_unlit` for *replace*, `KHR_materials_sheen`,
//! `KHR_materials_variants` and `KHR_mesh_quantization`. Tangents of normal maps are written, so
//! that every viewer reads the map in the same frame. Cost: the encoding of the textures. Limit: 4
//! GiB, the format's own.

pub(in crate::write) mod buffer;
mod grid;
mod material;
mod mesh;
#[cfg(test)]
mod tests;

use super::check::check_model;
use super::copyright::check_copyright;
use super::power_of_two::to_powers_of_two;
use super::shown::shown;
use super::sides::with_wrong_sides;
use super::texture_file::TextureFormat;
use crate::file_names::check_name;
use buffer::Buffer;
use grid::ModelCube;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use toile_core::artifact::{Artifact, Digester};
use toile_core::prelude::*;

/// Writes the model as one GLB file that any glTF viewer opens.
///
/// Metres, Y up, the wearer faces +Z. Textures are embedded, with normal maps and their tangents,
/// sheen and variants where the model has them. `asset.extras` names the unit, the fabrics and the
/// digest of the model.
#[stage(
    role = Writer,
    version = 3,
    source = "Khronos Group, glTF 2.0, 2017",
    example = "Glb(name: \"garment\", textures: Jpeg, quality: 88)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Glb {
    /// The file's name without its extension.
    #[param(default = "garment".to_owned())]
    name: String,
    /// How textures are stored.
    #[param(default = TextureFormat::Jpeg)]
    textures: TextureFormat,
    /// Quality of JPEG textures.
    #[param(default = 88, min = 1, max = 100, trades)]
    quality: u8,
    /// Whether the body is written, where the model has one.
    #[param(default = true)]
    body: bool,
    /// Whether both sides of textures are brought to powers of two, as old graphics cards want
    /// them: to the next one, or to the one below where that takes off a fifth at most.
    #[param(default = true)]
    power_of_two: bool,
    /// Whether positions, normals and tangents are written as whole numbers of 16 and 8 bits: a
    /// third of the size, to a 65,534th of the model's largest side. Viewers without
    /// `KHR_mesh_quantization` do not open such a file.
    #[param(default = false)]
    quantise: bool,
    /// Who holds the rights to the file: `asset.copyright`.
    #[param(default = None)]
    copyright: Option<String>,
}

#[stage]
impl Glb {
    pub(crate) fn run(&self, model: &Model, _cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        check_copyright(self.copyright.as_deref())?;
        check_model(model)?;
        let about = GlbAsset { copyright: self.copyright.as_deref(), digest: digest(model) };
        let mut model = shown(model, self.body)?;
        with_wrong_sides(&mut model);
        if self.power_of_two {
            to_powers_of_two(&mut model);
        }
        let images = self.textures.encode_all(&model, self.quality)?;
        let grid = self.quantise.then(|| ModelCube::around(&model));
        let bytes = glb(&model, &images, self.textures.mime(), grid.as_ref(), &about)?;
        Ok(OutputFiles::one(&format!("{}.glb", self.name), bytes))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        let name = check_name(&self.name).err();
        name.into_iter().chain(check_copyright(self.copyright.as_deref()).err()).collect()
    }
}

/// What the file says of itself.
struct GlbAsset<'a> {
    copyright: Option<&'a str>,
    /// In hexadecimal.
    digest: String,
}

/// The digest of a model, in hexadecimal.
pub(super) fn digest(model: &Model) -> String {
    let mut digester = Digester::new();
    model.digest(&mut digester);
    digester.finish().hex()
}

/// The names of the fabrics, each once.
pub(super) fn fabrics(model: &Model) -> BTreeSet<&str> {
    model.materials.iter().map(|m| m.fabric.as_str()).filter(|name| !name.is_empty()).collect()
}

/// Filters: linear, and linear over mip-maps; wrap: clamp to the edge, and repeat.
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33071;
const REPEAT: u32 = 10497;

/// The file: header, JSON chunk, binary chunk. `images` holds the model's textures, encoded.
fn glb(
    model: &Model,
    images: &[Vec<u8>],
    mime: &str,
    grid: Option<&ModelCube>,
    about: &GlbAsset<'_>,
) -> Result<Vec<u8>, StageError> {
    let mut buffer = Buffer::default();
    let meshes: Vec<Value> =
        (0..model.meshes.len()).map(|i| mesh::mesh(model, i, grid, &mut buffer)).collect();
    let images: Vec<Value> = images
        .iter()
        .zip(&model.textures)
        .map(|(bytes, texture)| {
            let view = buffer.view(bytes, None);
            json!({ "name": texture.name, "mimeType": mime, "bufferView": view })
        })
        .collect();
    let node = |(i, m): (usize, &Mesh)| {
        let mut node = json!({ "name": m.name, "mesh": i });
        if let Some(grid) = grid {
            (node["translation"], node["scale"]) = (json!(grid.centre), json!(vec![grid.half; 3]));
        }
        node
    };
    let mut root = json!({
        "asset": asset(model, about),
        "scene": 0,
        "scenes": [{ "nodes": (0..meshes.len()).collect::<Vec<_>>() }],
        "nodes": model.meshes.iter().enumerate().map(node).collect::<Vec<_>>(),
        "meshes": meshes,
        "materials": model.materials.iter().map(material::material).collect::<Vec<_>>(),
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    // The standard forbids empty lists.
    if !images.is_empty() {
        root["images"] = Value::Array(images);
        samplers(model, &mut root);
    }
    extensions(model, grid.is_some(), &mut root);
    pack(root.to_string().into_bytes(), buffer.bytes)
}

fn asset(model: &Model, about: &GlbAsset<'_>) -> Value {
    let mut asset = json!({
        "version": "2.0",
        "generator": concat!("toile ", env!("CARGO_PKG_VERSION")),
        "extras": { "units": "m", "fabrics": fabrics(model), "digest": about.digest },
    });
    if let Some(copyright) = about.copyright {
        asset["copyright"] = json!(copyright);
    }
    asset
}

/// A texture for every picture, and a sampler for every way to go on beyond a picture's edges.
fn samplers(model: &Model, root: &mut Value) {
    let wrap = |t: &Texture| if t.repeats { REPEAT } else { CLAMP_TO_EDGE };
    let wraps: Vec<u32> =
        model.textures.iter().map(wrap).collect::<BTreeSet<_>>().into_iter().rev().collect();
    let sampler = |t: &Texture| wraps.iter().position(|w| *w == wrap(t));
    let texture = |(i, t): (usize, &Texture)| json!({ "source": i, "sampler": sampler(t) });
    root["textures"] = model.textures.iter().enumerate().map(texture).collect();
    let sampler = |wrap: &u32| json!({ "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": wrap, "wrapT": wrap });
    root["samplers"] = wraps.iter().map(sampler).collect();
}

/// Names the extensions that the file uses.
fn extensions(model: &Model, quantised: bool, root: &mut Value) {
    let used = [
        (model.materials.iter().any(|m| m.sheen.is_some()), "KHR_materials_sheen"),
        (model.materials.iter().any(|m| m.unlit), "KHR_materials_unlit"),
        (!model.variants.is_empty(), "KHR_materials_variants"),
        (quantised, "KHR_mesh_quantization"),
    ];
    let names: Vec<&str> = used.iter().filter(|u| u.0).map(|u| u.1).collect();
    if !names.is_empty() {
        root["extensionsUsed"] = json!(names);
    }
    if quantised {
        root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    }
    if !model.variants.is_empty() {
        let names: Vec<Value> = model.variants.iter().map(|v| json!({ "name": v.name })).collect();
        root["extensions"] = json!({ "KHR_materials_variants": { "variants": names } });
    }
}

pub(in crate::write) fn pack(mut json: Vec<u8>, mut binary: Vec<u8>) -> Result<Vec<u8>, StageError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let total = 12 + 8 + json.len() + 8 + binary.len();
    let length = |n: usize| {
        let hint = "lower `size` of the texturer or make the mesh coarser";
        u32::try_from(n).map_err(|_| StageError::invalid("the model exceeds glTF's 4 GiB").hint(hint))
    };
    let mut file = Vec::with_capacity(total);
    file.extend_from_slice(b"glTF");
    file.extend_from_slice(&2u32.to_le_bytes());
    file.extend_from_slice(&length(total)?.to_le_bytes());
    for (chunk, kind) in [(json, b"JSON"), (binary, b"BIN\0")] {
        file.extend_from_slice(&length(chunk.len())?.to_le_bytes());
        file.extend_from_slice(kind);
        file.extend_from_slice(&chunk);
    }
    Ok(file)
}
