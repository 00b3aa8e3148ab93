//! `Obj`: the model as Wavefront OBJ with MTL and texture files.
//!
//! A group a panel. Vertices that stand in the very same place (joined seams) are written once, so
//! that the garment is one connected surface, while texture coordinates stay each panel's own.
//! Cost: the encoding of the textures. Limit: MTL knows no unlit material; *replace* becomes plain
//! ambient colour.

use super::check::check_model;
use super::shown::sheets;
use super::texture_file::TextureFormat;
use crate::file_names::{check_name, plain_names};
use std::collections::HashMap;
use std::fmt::Write;
use toile_core::prelude::*;

/// Writes the model as OBJ, its materials as MTL and its textures as pictures beside it.
///
/// Metres, Y up. Panels are groups; joined seams share their vertices. Every panel is one sheet:
/// the thickness of open edges is left out, and both sides look alike.
#[stage(
    role = Writer,
    source = "Wavefront Technologies, Object Files, 1992",
    example = "Obj(name: \"garment\", textures: Png)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Obj {
    /// The files' name without extension.
    #[param(default = "garment".to_owned())]
    name: String,
    /// How textures are stored.
    #[param(default = TextureFormat::Jpeg)]
    textures: TextureFormat,
    /// Quality of JPEG textures.
    #[param(default = 88, min = 1, max = 100, trades)]
    quality: u8,
    /// Whether vertices in the very same place are written once.
    #[param(default = true)]
    weld: bool,
}

#[stage]
impl Obj {
    pub(super) fn run(&self, model: &Model, _cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        check_model(model)?;
        let model = &sheets(model);
        let images = self.textures.encode_all(model, self.quality)?;
        // MTL ends a file name at a blank in many readers.
        let stem = self.name.replace(' ', "_");
        let parts = plain_names(model.textures.iter().map(|t| t.name.as_str()));
        let file = |part: &String| format!("{stem}_{part}.{}", self.textures.extension());
        let names: Vec<String> = parts.iter().map(file).collect();
        let materials = plain_names(model.materials.iter().map(|m| m.name.as_str()));
        let mut files = vec![
            OutputFile::new(
                format!("{stem}.obj"),
                obj(model, &materials, &format!("{stem}.mtl"), self.weld).into_bytes(),
            ),
            OutputFile::new(format!("{stem}.mtl"), mtl(model, &materials, &names).into_bytes()),
        ];
        files.extend(names.into_iter().zip(images).map(|(path, bytes)| OutputFile::new(path, bytes)));
        Ok(OutputFiles(files))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        crate::file_names::check_name(&self.name).err().into_iter().collect()
    }
}

/// The geometry.
pub(super) fn obj(model: &Model, materials: &[String], library: &str, weld: bool) -> String {
    let mut s = format!("# metres, Y up\nmtllib {library}\n");
    let mut known: HashMap<[u64; 3], usize> = HashMap::new();
    let (mut vertices, mut texts, mut normals) = (0, 0, 0);
    let groups = plain_names(model.meshes.iter().map(|m| m.name.as_str()));
    for (mesh, group) in model.meshes.iter().zip(&groups) {
        let _ = writeln!(s, "g {group}\nusemtl {}", materials.get(mesh.material).map_or("", String::as_str));
        let mut place = Vec::with_capacity(mesh.positions.len());
        for p in &mesh.positions {
            // Adding zero turns -0 into 0, which stands in the same place.
            let key = [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits());
            let found = known.get(&key).copied().filter(|_| weld);
            place.push(found.unwrap_or_else(|| {
                vertices += 1;
                let _ = writeln!(s, "v {} {} {}", p.x, p.y, p.z);
                known.insert(key, vertices);
                vertices
            }));
        }
        for [u, v] in &mesh.uv {
            let _ = writeln!(s, "vt {u} {}", 1.0 - v);
        }
        for n in &mesh.normals {
            let _ = writeln!(s, "vn {:.6} {:.6} {:.6}", n.x, n.y, n.z);
        }
        for t in &mesh.triangles {
            let corner = |i: u32| {
                let (v, t, n) = (place[i as usize], texts + i as usize + 1, normals + i as usize + 1);
                if mesh.uv.is_empty() { format!("{v}//{n}") } else { format!("{v}/{t}/{n}") }
            };
            let _ = writeln!(s, "f {} {} {}", corner(t[0]), corner(t[1]), corner(t[2]));
        }
        texts += mesh.uv.len();
        normals += mesh.normals.len();
    }
    s
}

/// The materials; `files` are the textures' names.
fn mtl(model: &Model, names: &[String], files: &[String]) -> String {
    let mut s = String::new();
    for (material, name) in model.materials.iter().zip(names) {
        let [r, g, b] = material.colour;
        // Illumination 0 is colour alone, 1 adds light without highlights.
        let model = if material.unlit { 0 } else { 1 };
        let _ = writeln!(s, "newmtl {name}\nKa {r} {g} {b}\nKd {r} {g} {b}\nKs 0 0 0\nillum {model}");
        if let Some(file) = material.texture.and_then(|t| files.get(t)) {
            let _ = writeln!(s, "map_Kd {file}");
        }
        // A word of later readers; the others pass over it.
        if let Some(file) = material.normal_texture.and_then(|t| files.get(t)) {
            let _ = writeln!(s, "norm {file}");
        }
        s.push('\n');
    }
    s
}
