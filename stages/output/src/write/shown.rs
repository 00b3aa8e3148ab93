//! The part of a model that a file shows.

use crate::render::parts::BODY;
use crate::texture::edge::is_edge;
use toile_core::StageError;
use toile_core::artifact::{Material, Mesh, Model};

/// The model without what a file must not hold: meshes without triangles, materials and textures
/// that no mesh uses, texture coordinates that no material reads, sheen and normal maps of
/// materials on which light does not act; and without the body unless it is requested.
///
/// Errors: nothing is left.
pub(super) fn shown(model: &Model, body: bool) -> Result<Model, StageError> {
    let is_kept = |m: &Mesh| !m.triangles.is_empty() && (body || m.name != BODY);
    let kept: Vec<usize> = (0..model.meshes.len()).filter(|i| is_kept(&model.meshes[*i])).collect();
    if kept.is_empty() {
        let hint = "the model holds only the body: leave out `body: false`";
        return Err(StageError::invalid("`body: false` leaves nothing to write").hint(hint).at("body"));
    }
    let mut part = Model { materials: model.materials.clone(), ..Model::default() };
    part.meshes = kept.iter().map(|i| model.meshes[*i].clone()).collect();
    part.variants.clone_from(&model.variants);
    for variant in &mut part.variants {
        variant.materials = kept.iter().map(|i| variant.materials[*i]).collect();
    }
    part.materials.iter_mut().filter(|m| m.unlit).for_each(|m| (m.sheen, m.normal_texture) = (None, None));
    keep_used_materials(&mut part);
    part.textures.clone_from(&model.textures);
    keep_used_textures(&mut part);
    drop_unread_uv(&mut part);
    Ok(part)
}

/// The model without the strips along its open edges: every panel is one sheet, as programs want it
/// that work on cloth.
pub(super) fn sheets(model: &Model) -> Model {
    let kept: Vec<usize> = (0..model.meshes.len()).filter(|i| !is_edge(&model.meshes[*i], model)).collect();
    let mut part = Model { meshes: kept.iter().map(|i| model.meshes[*i].clone()).collect(), ..model.clone() };
    for variant in &mut part.variants {
        variant.materials = kept.iter().map(|i| variant.materials[*i]).collect();
    }
    keep_used_materials(&mut part);
    part
}

/// The new index of every item that is used; the order stays.
fn renumbered(count: usize, used: impl Iterator<Item = usize>) -> Vec<Option<usize>> {
    let mut is_used = vec![false; count];
    used.for_each(|i| is_used[i] = true);
    let mut next = 0..;
    is_used.into_iter().map(|used| if used { next.next() } else { None }).collect()
}

/// Takes off materials that no mesh wears in any look.
pub(super) fn keep_used_materials(model: &mut Model) {
    let own = model.meshes.iter().map(|m| m.material);
    let used = own.chain(model.variants.iter().flat_map(|v| v.materials.iter().copied()));
    let place = renumbered(model.materials.len(), used);
    keep(&mut model.materials, &place);
    let here = |i: &mut usize| *i = place[*i].unwrap_or(*i);
    model.meshes.iter_mut().for_each(|m| here(&mut m.material));
    model.variants.iter_mut().flat_map(|v| &mut v.materials).for_each(here);
}

fn keep_used_textures(model: &mut Model) {
    let used = model.materials.iter().flat_map(|m| [m.texture, m.normal_texture]).flatten();
    let place = renumbered(model.textures.len(), used);
    keep(&mut model.textures, &place);
    let here = |t: &mut Option<usize>| *t = t.and_then(|t| place[t]);
    model.materials.iter_mut().for_each(|m| {
        here(&mut m.texture);
        here(&mut m.normal_texture);
    });
}

fn keep<T>(items: &mut Vec<T>, place: &[Option<usize>]) {
    let mut at = place.iter();
    items.retain(|_| at.next().is_some_and(Option::is_some));
}

/// Takes off texture coordinates that no look of their mesh reads.
pub(super) fn drop_unread_uv(model: &mut Model) {
    let reads = |m: &Material| m.texture.is_some() || m.normal_texture.is_some();
    for (i, mesh) in model.meshes.iter_mut().enumerate() {
        let mut looks = model.variants.iter().map(|v| v.materials[i]).chain([mesh.material]);
        if !looks.any(|m| reads(&model.materials[m])) {
            mesh.uv.clear();
        }
    }
}
