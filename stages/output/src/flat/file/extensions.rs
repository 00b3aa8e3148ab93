//! Extensions of glTF that a file needs: those that change no mesh are passed over, all others are
//! refused by name, with what to do.

use serde_json::Value;

/// Beginnings of the names of extensions that change looks, light and labels alone, or are read.
const HARMLESS: [&str; 10] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_animation_",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
];

/// Extensions that compress meshes, and how programs leave that off.
const COMPRESSED: [(&str, &str); 3] = [
    (
        "KHR_draco_mesh_compression",
        "export it without compression (in Blender's glTF export, leave \"Compression\" off), or as OBJ",
    ),
    (
        "EXT_meshopt_compression",
        "export it without compression (gltfpack: leave out `-c` and `-cc`), or as OBJ",
    ),
    (
        "KHR_meshopt_compression",
        "export it without compression (gltfpack: leave out `-c` and `-cc`), or as OBJ",
    ),
];

/// What is wrong with the extensions of a file's JSON, and what to do; none where it can be read.
pub(in crate::flat) fn unread(root: &Value) -> Option<(String, &'static str)> {
    let names = |list: &str| {
        let all = root.get(list).and_then(Value::as_array).into_iter().flatten();
        all.filter_map(Value::as_str).collect::<Vec<_>>()
    };
    let required = names("extensionsRequired");
    // A file that names a compression and does not say that it needs it has the plain numbers, too,
    // unless its lists have no place in the file.
    let is_needed = |name: &str| {
        required.contains(&name) || names("extensionsUsed").contains(&name) && has_bare_lists(root)
    };
    if let Some((name, remedy)) = COMPRESSED.iter().find(|(name, _)| is_needed(name)) {
        return Some((format!("its mesh is compressed ({name}), which is not read"), remedy));
    }
    let unknown = required.iter().find(|n| !HARMLESS.iter().any(|known| n.starts_with(known)))?;
    let name: String = unknown.chars().take(60).collect();
    let what = format!("it needs the extension {name} of glTF, which is not read");
    Some((what, "export the garment as plain glTF 2.0 (.glb) without extensions, or as OBJ"))
}

/// Whether a list of numbers names no part of the file.
fn has_bare_lists(root: &Value) -> bool {
    let lists = root.get("accessors").and_then(Value::as_array);
    lists.into_iter().flatten().any(|a| a.get("bufferView").is_none() && a.get("sparse").is_none())
}

/// Takes off what does not change a mesh: its library knows not every extension of looks, and
/// refuses files for them.
pub(in crate::flat) fn geometry_only(root: &mut Value) {
    let Some(all) = root.as_object_mut() else { return };
    for list in [
        "textures",
        "images",
        "samplers",
        "animations",
        "skins",
        "cameras",
        "extensions",
        "extensionsRequired",
    ] {
        all.remove(list);
    }
    let each = |list: Option<&mut Value>, change: &dyn Fn(&mut Value)| {
        list.and_then(Value::as_array_mut).into_iter().flatten().for_each(change);
    };
    each(all.get_mut("materials"), &|m| {
        let name = m.get("name").filter(|n| n.is_string()).cloned();
        *m = Value::Object(name.map(|n| ("name".to_owned(), n)).into_iter().collect());
    });
    let without = |value: &mut Value, fields: &[&str]| {
        if let Some(object) = value.as_object_mut() {
            fields.iter().for_each(|f| drop(object.remove(*f)));
        }
    };
    each(all.get_mut("nodes"), &|n| without(n, &["skin", "camera", "extensions"]));
    each(all.get_mut("meshes"), &|m| {
        let primitives = m.get_mut("primitives").and_then(Value::as_array_mut);
        primitives.into_iter().flatten().for_each(|p| without(p, &["targets", "extensions"]));
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn compression_and_what_is_not_known_are_named_with_what_to_do() {
        let needs = |name: &str| unread(&json!({ "extensionsUsed": [name], "extensionsRequired": [name] }));
        let (what, remedy) = needs("EXT_meshopt_compression").unwrap_or_default();
        assert_eq!(what, "its mesh is compressed (EXT_meshopt_compression), which is not read");
        assert_eq!(remedy, "export it without compression (gltfpack: leave out `-c` and `-cc`), or as OBJ");
        let (what, remedy) = needs("EXT_mesh_gpu_instancing").unwrap_or_default();
        assert_eq!(what, "it needs the extension EXT_mesh_gpu_instancing of glTF, which is not read");
        assert_eq!(remedy, "export the garment as plain glTF 2.0 (.glb) without extensions, or as OBJ");
        for harmless in ["KHR_texture_basisu", "KHR_materials_unlit", "KHR_mesh_quantization"] {
            assert_eq!(needs(harmless), None);
        }
    }

    #[test]
    fn a_compression_that_is_only_used_is_passed_over_where_the_plain_numbers_are_there() {
        let file = |accessor: Value| json!({ "extensionsUsed": ["KHR_draco_mesh_compression"], "accessors": [accessor] });
        assert_eq!(unread(&file(json!({ "bufferView": 0 }))), None);
        assert!(unread(&file(json!({ "count": 3 }))).is_some());
    }
}
