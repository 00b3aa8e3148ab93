//! `Glb`: the model as binary glTF 2.0 (Khronos, 2017; ISO/IEC 12113).
//!
//! One node and one mesh a panel, one buffer; textures lie in the same file. Positions, normals and texture
//! coordinates are 32-bit floats, indices 16 or 32 bits. *Replace* becomes `KHR_materials_unlit`.
//! Cost: the encoding of the textures. Limit: 4 GiB, the format's own.

use super::check::check_model;
use super::names::check_name;
use super::texture_file::TextureFormat;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// Writes the model as one GLB file that any glTF viewer opens.
///
/// Metres, Y up, the wearer faces +Z. Textures are embedded.
#[stage(
    role = Writer,
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
}

#[stage]
impl Glb {
    pub(crate) fn run(&self, model: &Model, _cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        check_model(model)?;
        let images = self.textures.encode_all(model, self.quality)?;
        let bytes = glb(model, &images, self.textures.mime())?;
        Ok(OutputFiles::one(&format!("{}.glb", self.name), bytes))
    }

    fn precheck(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        super::names::check_name(&self.name).err().into_iter().collect()
    }
}

/// Component types and buffer targets of the standard.
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Filters: linear, and linear over mip-maps; wrap: clamp to the edge, and repeat.
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33071;
const REPEAT: u32 = 10497;

/// The file: header, JSON chunk, binary chunk. `images` holds the model's textures, encoded.
pub(super) fn glb(model: &Model, images: &[Vec<u8>], mime: &str) -> Result<Vec<u8>, StageError> {
    let mut buffer = Buffer::default();
    // The standard forbids empty accessors.
    let parts: Vec<&Mesh> = model.meshes.iter().filter(|m| !m.triangles.is_empty()).collect();
    let meshes: Vec<Value> = parts.iter().map(|m| mesh(m, &mut buffer)).collect();
    let images: Vec<Value> = images
        .iter()
        .zip(&model.textures)
        .map(|(bytes, texture)| {
            let view = buffer.view(bytes, None);
            json!({ "name": texture.name, "mimeType": mime, "bufferView": view })
        })
        .collect();
    let unlit = model.materials.iter().any(|m| m.unlit);
    let nodes: Vec<Value> =
        parts.iter().enumerate().map(|(i, m)| json!({ "name": m.name, "mesh": i })).collect();
    let mut root = json!({
        "asset": { "version": "2.0", "generator": concat!("toile ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": model.materials.iter().map(material).collect::<Vec<_>>(),
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    // The standard forbids empty lists.
    if !images.is_empty() {
        let wraps: Vec<u32> = model
            .textures
            .iter()
            .map(|t| if t.repeats { REPEAT } else { CLAMP_TO_EDGE })
            .collect::<BTreeSet<_>>()
            .into_iter()
            .rev()
            .collect();
        let sampler = |t: &Texture| wraps.iter().position(|w| t.repeats == (*w == REPEAT));
        let texture = |(i, t): (usize, &Texture)| json!({ "source": i, "sampler": sampler(t) });
        let textures = model.textures.iter().enumerate().map(texture).collect();
        root["images"] = Value::Array(images);
        root["textures"] = Value::Array(textures);
        let sampler = |wrap: &u32| json!({ "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": wrap, "wrapT": wrap });
        root["samplers"] = wraps.iter().map(sampler).collect();
    }
    if unlit {
        root["extensionsUsed"] = json!(["KHR_materials_unlit"]);
    }
    pack(root.to_string().into_bytes(), buffer.bytes)
}

fn pack(mut json: Vec<u8>, mut binary: Vec<u8>) -> Result<Vec<u8>, StageError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let total = 12 + 8 + json.len() + 8 + binary.len();
    let length = |n: usize| {
        let hint = "lower `size` of the texturer or make the mesh coarser";
        u32::try_from(n).map_err(|_| StageError::invalid("the model passes glTF's 4 GiB").hint(hint))
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

fn material(m: &Material) -> Value {
    let [r, g, b] = m.colour;
    let mut pbr = json!({
        "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": m.roughness,
    });
    if let Some(texture) = m.texture {
        pbr["baseColorTexture"] = json!({ "index": texture });
    }
    let mut value = json!({ "name": m.name, "pbrMetallicRoughness": pbr, "doubleSided": m.double_sided });
    if m.unlit {
        value["extensions"] = json!({ "KHR_materials_unlit": {} });
    }
    value
}

fn mesh(m: &Mesh, buffer: &mut Buffer) -> Value {
    let positions = m.positions.iter().map(|p| [p.x, p.y, p.z].map(|c| c as f32));
    let normals = m.normals.iter().map(|n| [n.x, n.y, n.z].map(|c| c as f32));
    let mut attributes = json!({
        "POSITION": buffer.floats(positions.collect(), "VEC3", true),
        "NORMAL": buffer.floats(normals.collect(), "VEC3", false),
    });
    if !m.uv.is_empty() {
        attributes["TEXCOORD_0"] = json!(buffer.floats(m.uv.clone(), "VEC2", false));
    }
    let indices = buffer.indices(&m.triangles, m.positions.len());
    let primitive =
        json!({ "attributes": attributes, "indices": indices, "material": m.material, "mode": 4 });
    json!({ "name": m.name, "primitives": [primitive] })
}

/// The binary chunk in the making.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Appends bytes on a multiple of four; returns the view's index.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Appends vectors of floats; returns the accessor's index.
    fn floats<const N: usize>(&mut self, rows: Vec<[f32; N]>, kind: &str, bounds: bool) -> usize {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|f| f.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": rows.len(), "type": kind });
        if bounds {
            let fold = |f: fn(f32, f32) -> f32| {
                let join = |a: [f32; N], b: &[f32; N]| std::array::from_fn(|k| f(a[k], b[k]));
                rows.iter().skip(1).fold(rows.first().copied().unwrap_or([0.0; N]), join).to_vec()
            };
            accessor["min"] = json!(fold(f32::min));
            accessor["max"] = json!(fold(f32::max));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Appends triangles; 16 bits suffice for up to 65,535 vertices (the last value restarts a strip).
    fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> usize {
        let flat = triangles.iter().flatten();
        let (bytes, kind): (Vec<u8>, u32) = match vertices <= usize::from(u16::MAX) {
            true => (flat.flat_map(|&i| (i as u16).to_le_bytes()).collect(), UNSIGNED_SHORT),
            false => (flat.flat_map(|i| i.to_le_bytes()).collect(), UNSIGNED_INT),
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let count = 3 * triangles.len();
        self.accessors.push(json!({
            "bufferView": view, "componentType": kind, "count": count, "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }
}
