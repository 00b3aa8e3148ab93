//! What every writer asks of a model before it writes a byte.

use toile_core::StageError;
use toile_core::artifact::{Mesh, Model, Variant};

/// Refuses a model whose file would hold NaN or point past its own lists.
pub(super) fn check_model(model: &Model) -> Result<(), StageError> {
    if model.meshes.iter().all(|m| m.triangles.is_empty()) {
        let hint = "did the mesher or the stitcher lose the panels?";
        return Err(StageError::invalid("the model has no triangle").hint(hint));
    }
    model.meshes.iter().try_for_each(|mesh| check_mesh(mesh, model))?;
    model.variants.iter().try_for_each(|variant| check_variant(variant, model))
}

fn check_variant(variant: &Variant, model: &Model) -> Result<(), StageError> {
    let fault = |what: &str| StageError::invalid(format!("variant \"{}\" {what}", variant.name));
    if variant.materials.len() != model.meshes.len() {
        return Err(fault("has not one material for each mesh"));
    }
    let mut worn = model.meshes.iter().zip(&variant.materials);
    worn.try_for_each(|(mesh, material)| check_look(mesh, *material, model)).map_err(fault)
}

/// Checks that a mesh can have a material; the error is the message.
fn check_look(mesh: &Mesh, material: usize, model: &Model) -> Result<(), &'static str> {
    let material = model.materials.get(material).ok_or("has no material")?;
    let pictures = || [material.texture, material.normal_texture].into_iter().flatten();
    if pictures().any(|t| t >= model.textures.len()) {
        return Err("has a texture that does not exist");
    }
    if pictures().next().is_some() && mesh.uv.is_empty() {
        return Err("has a texture but no texture coordinates");
    }
    Ok(())
}

fn check_mesh(mesh: &Mesh, model: &Model) -> Result<(), StageError> {
    let fault = |what: &str| StageError::invalid(format!("mesh \"{}\" {what}", mesh.name));
    let count = mesh.positions.len();
    let finite3 = |v: &[f64]| v.iter().all(|c| c.is_finite() && c.abs() <= f64::from(f32::MAX));
    if !mesh.positions.iter().all(|p| finite3(p.coords.as_slice())) {
        return Err(fault("has a vertex that is not finite"));
    }
    if mesh.normals.len() != count || !mesh.normals.iter().all(|n| finite3(n.as_slice())) {
        return Err(fault("has not one finite normal for each vertex"));
    }
    if !(mesh.uv.is_empty() || mesh.uv.len() == count) || !mesh.uv.iter().flatten().all(|c| c.is_finite()) {
        return Err(fault("has not one finite texture coordinate for each vertex"));
    }
    if !mesh.triangles.iter().flatten().all(|&i| (i as usize) < count) {
        return Err(fault("has a triangle with a vertex that does not exist"));
    }
    check_look(mesh, mesh.material, model).map_err(fault)
}
