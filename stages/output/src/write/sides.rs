//! Right and wrong side of cloth as two meshes, for formats whose materials know one look alone.
//!
//! The wrong side has the same places, turned about. Both are seen from their own side only, so
//! neither shows through the other and no room is needed between them. Cost: one copy of the mesh.

use super::shown::{drop_unread_uv, keep_used_materials};
use toile_core::artifact::{Material, Mesh, Model};

/// What is added to the names of a mesh and its material.
pub(super) const WRONG_SIDE: &str = " wrong side";

/// The model with a mesh more for the wrong side of every mesh that has a look of its own there.
pub(super) fn with_wrong_sides(model: &mut Model) {
    for i in 0..model.meshes.len() {
        let own = model.meshes[i].material;
        let looks: Vec<usize> = model.variants.iter().map(|v| v.materials[i]).collect();
        let has_back = |m: &usize| model.materials[*m].wrong_side.is_some();
        if !has_back(&own) && !looks.iter().any(has_back) {
            continue;
        }
        let mut back = turned(&model.meshes[i]);
        (model.meshes[i].material, back.material) = sides(&mut model.materials, own);
        model.meshes.push(back);
        for (v, look) in looks.into_iter().enumerate() {
            let (right, wrong) = sides(&mut model.materials, look);
            model.variants[v].materials[i] = right;
            model.variants[v].materials.push(wrong);
        }
    }
    keep_used_materials(model);
    drop_unread_uv(model);
}

/// The same places, seen from behind.
fn turned(mesh: &Mesh) -> Mesh {
    Mesh {
        name: format!("{}{WRONG_SIDE}", mesh.name),
        normals: mesh.normals.iter().map(|n| -n).collect(),
        triangles: mesh.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
        ..mesh.clone()
    }
}

/// The materials of both sides, each seen from its own side.
fn sides(materials: &mut Vec<Material>, of: usize) -> (usize, usize) {
    let right = Material { double_sided: false, wrong_side: None, ..materials[of].clone() };
    let wrong = match materials[of].wrong_side {
        None => right.clone(),
        Some(colour) => Material {
            name: format!("{}{WRONG_SIDE}", right.name),
            colour,
            texture: None,
            normal_texture: None,
            ..right.clone()
        },
    };
    (place(materials, right), place(materials, wrong))
}

fn place(materials: &mut Vec<Material>, material: Material) -> usize {
    materials.iter().position(|m| *m == material).unwrap_or_else(|| {
        materials.push(material);
        materials.len() - 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::parts::plain_cloth;
    use toile_core::artifact::{Point3, Variant, Vector3};

    fn model(looks: [Option<[f32; 3]>; 2]) -> Model {
        let mesh = Mesh {
            name: "front".into(),
            positions: vec![Point3::origin(); 3],
            normals: vec![Vector3::z(); 3],
            uv: vec![[0.0; 2]; 3],
            triangles: vec![[0, 1, 2]],
            material: 0,
        };
        let cloth = |(name, wrong_side)| Material { wrong_side, ..plain_cloth(name, [0.5; 3]) };
        let worn = |name: &str, m| Variant { name: name.into(), materials: vec![m] };
        Model {
            meshes: vec![mesh],
            materials: ["blue", "red"].into_iter().zip(looks).map(cloth).collect(),
            variants: vec![worn("one", 0), worn("two", 1)],
            ..Model::default()
        }
    }

    #[test]
    fn the_wrong_side_is_a_mesh_that_is_turned_about() {
        let mut both = model([Some([0.1; 3]), Some([0.2; 3])]);
        with_wrong_sides(&mut both);
        assert_eq!(both.meshes.len(), 2);
        let (right, wrong) = (&both.meshes[0], &both.meshes[1]);
        assert_eq!((wrong.name.as_str(), wrong.triangles[0]), ("front wrong side", [0, 2, 1]));
        assert_eq!(wrong.normals[0], -right.normals[0]);
        assert_eq!(both.materials.len(), 4, "two sides of two looks");
        assert!(wrong.uv.is_empty(), "plain cloth reads no picture");
        let looks = [right.material, wrong.material].map(|m| &both.materials[m]);
        assert!(looks.iter().all(|m| !m.double_sided && m.wrong_side.is_none()));
        assert_eq!((looks[0].colour, looks[1].colour), ([0.5; 3], [0.1; 3]));
        let second = both.variants[1].materials.iter().map(|m| both.materials[*m].colour);
        assert_eq!(second.collect::<Vec<_>>(), [[0.5; 3], [0.2; 3]]);
    }

    #[test]
    fn a_look_without_a_wrong_side_shows_its_right_side_behind() {
        let mut both = model([None, Some([0.2; 3])]);
        with_wrong_sides(&mut both);
        assert_eq!(both.materials[both.meshes[1].material].name, "blue");
    }

    #[test]
    fn cloth_that_looks_alike_on_both_sides_stays_one_mesh() {
        let mut one = model([None, None]);
        with_wrong_sides(&mut one);
        assert_eq!((one.meshes.len(), one.materials[0].double_sided), (1, true));
    }
}
