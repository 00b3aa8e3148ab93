//! Garment panels and body as meshes of a model, without their pictures.

use toile_core::artifact::{Body, Garment, GarmentPanel, Material, Mesh, Sheen, Vector3};

/// The name of the body's mesh and material.
pub(crate) const BODY: &str = "body";
/// The grey of a shop's mannequin, linear.
const MANNEQUIN: [f32; 3] = [0.42, 0.41, 0.40];
/// Undyed linen, linear: what a panel without a photo looks like.
pub(crate) const UNDYED: [f32; 3] = [0.66, 0.60, 0.49];
/// Cloth is matt.
const CLOTH_ROUGHNESS: f32 = 0.95;
/// The sheen of cloth for which the texturer has none: its share of white, and its roughness, that
/// of short fibres in all directions.
pub(crate) const SHEEN: f64 = 0.1;
const SHEEN_ROUGHNESS: f32 = 0.5;

/// One panel of a garment; `normals` are the garment's. Texture coordinates are left empty.
pub(crate) fn panel_mesh(
    garment: &Garment,
    panel: &GarmentPanel,
    normals: &[Vector3],
    material: usize,
) -> Mesh {
    let first = panel.vertices.start as u32;
    Mesh {
        name: panel.name.clone(),
        positions: garment.positions[panel.vertices.clone()].to_vec(),
        normals: normals[panel.vertices.clone()].iter().map(unit).collect(),
        uv: Vec::new(),
        triangles: garment.triangles[panel.triangles.clone()].iter().map(|t| t.map(|i| i - first)).collect(),
        material,
    }
}

/// The body.
pub(crate) fn body_mesh(body: &Body, material: usize) -> Mesh {
    Mesh {
        name: BODY.to_owned(),
        positions: body.positions.clone(),
        normals: body.vertex_normals().iter().map(unit).collect(),
        uv: Vec::new(),
        triangles: body.triangles.clone(),
        material,
    }
}

/// A normal where no triangle gives one: any unit vector does, since nothing is seen there.
fn unit(n: &Vector3) -> Vector3 {
    if *n == Vector3::zeros() { Vector3::z() } else { *n }
}

/// Cloth of one colour.
pub(crate) fn plain_cloth(name: &str, colour: [f32; 3]) -> Material {
    Material {
        name: name.to_owned(),
        colour,
        texture: None,
        normal_texture: None,
        unlit: false,
        roughness: CLOTH_ROUGHNESS,
        sheen: None,
        double_sided: true,
        wrong_side: None,
        fabric: String::new(),
    }
}

/// The cloth of a panel, of one colour; `sheen` is the share of white that its fibres shine with, 0
/// to 1.
pub(crate) fn panel_cloth(panel: &GarmentPanel, colour: [f32; 3], sheen: f64) -> Material {
    let shine = Sheen { colour: [sheen as f32; 3], roughness: SHEEN_ROUGHNESS };
    Material {
        sheen: (sheen > 0.0).then_some(shine),
        fabric: panel.fabric.name.clone(),
        ..plain_cloth(&panel.name, colour)
    }
}

/// The mannequin's skin.
pub(crate) fn mannequin() -> Material {
    Material { double_sided: false, roughness: 0.8, ..plain_cloth(BODY, MANNEQUIN) }
}
