//! Meshes of a GLB file.

use super::buffer::Buffer;
use super::grid::ModelCube;
use crate::render::tangents::tangents;
use serde_json::{Value, json};
use toile_core::artifact::{Mesh, Model, Vector3};

/// Mesh `index` of the model; on a grid its positions, normals and tangents are whole numbers.
pub(super) fn mesh(model: &Model, index: usize, grid: Option<&ModelCube>, buffer: &mut Buffer) -> Value {
    let m = &model.meshes[index];
    let mut attributes = match grid {
        None => as_floats(m, buffer),
        Some(grid) => on_grid(m, grid, buffer),
    };
    if has_normal_map(model, index) {
        attributes["TANGENT"] = json!(tangent_accessor(m, grid, buffer));
    }
    if !m.uv.is_empty() {
        attributes["TEXCOORD_0"] = json!(buffer.floats(m.uv.clone(), "VEC2", false));
    }
    let indices = buffer.indices(&m.triangles, m.positions.len());
    let mut primitive =
        json!({ "attributes": attributes, "indices": indices, "material": m.material, "mode": 4 });
    let mappings = mappings(model, index);
    if !mappings.is_empty() {
        primitive["extensions"] = json!({ "KHR_materials_variants": { "mappings": mappings } });
    }
    json!({ "name": m.name, "primitives": [primitive] })
}

fn as_floats(m: &Mesh, buffer: &mut Buffer) -> Value {
    let positions = m.positions.iter().map(|p| [p.x, p.y, p.z].map(|c| c as f32));
    let normals = m.normals.iter().map(|n| [n.x, n.y, n.z].map(|c| c as f32));
    json!({
        "POSITION": buffer.floats(positions.collect(), "VEC3", true),
        "NORMAL": buffer.floats(normals.collect(), "VEC3", false),
    })
}

fn on_grid(m: &Mesh, grid: &ModelCube, buffer: &mut Buffer) -> Value {
    let positions = m.positions.iter().map(|p| grid.place(p));
    let normals = m.normals.iter().map(|n| small([n.x, n.y, n.z]));
    json!({
        "POSITION": buffer.shorts(positions.collect()),
        "NORMAL": buffer.bytes_of_vectors(normals.collect(), "VEC3"),
    })
}

/// A unit vector (and a sign) in steps of a 127th.
fn small<const N: usize>(v: [f64; N]) -> [i8; N] {
    v.map(|c| (c * 127.0).round().clamp(-127.0, 127.0) as i8)
}

/// Whether a look of the mesh reads a normal map.
fn has_normal_map(model: &Model, index: usize) -> bool {
    let looks = model.variants.iter().map(|v| v.materials[index]);
    looks.chain([model.meshes[index].material]).any(|m| model.materials[m].normal_texture.is_some())
}

fn tangent_accessor(m: &Mesh, grid: Option<&ModelCube>, buffer: &mut Buffer) -> usize {
    let row = |along: Vector3, sign: f64| [along.x, along.y, along.z, sign];
    let rows = tangents(m).into_iter().map(|t| row(t.along, t.sign));
    match grid {
        None => buffer.floats(rows.map(|r| r.map(|c| c as f32)).collect(), "VEC4", false),
        Some(_) => buffer.bytes_of_vectors(rows.map(small).collect(), "VEC4"),
    }
}

/// Which variants put which material on a mesh; none where all leave it its own.
fn mappings(model: &Model, index: usize) -> Vec<Value> {
    let own = model.meshes[index].material;
    let of: Vec<usize> = model.variants.iter().map(|v| v.materials[index]).collect();
    if of.iter().all(|m| *m == own) {
        return Vec::new();
    }
    let mut materials = of.clone();
    materials.sort_unstable();
    materials.dedup();
    let mapping = |m: &usize| {
        let variants: Vec<usize> = (0..of.len()).filter(|v| of[*v] == *m).collect();
        json!({ "material": m, "variants": variants })
    };
    materials.iter().map(mapping).collect()
}
