//! Materials of a GLB file.

use serde_json::{Value, json};
use toile_core::artifact::Material;

/// A material: metallic-roughness without metal, with its normal map, sheen and fabric.
pub(super) fn material(m: &Material) -> Value {
    let [r, g, b] = m.colour;
    let mut pbr = json!({
        "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": m.roughness,
    });
    if let Some(texture) = m.texture {
        pbr["baseColorTexture"] = json!({ "index": texture });
    }
    let mut value = json!({ "name": m.name, "pbrMetallicRoughness": pbr, "doubleSided": m.double_sided });
    if let Some(texture) = m.normal_texture {
        value["normalTexture"] = json!({ "index": texture });
    }
    if m.unlit {
        value["extensions"] = json!({ "KHR_materials_unlit": {} });
    }
    if let Some(sheen) = m.sheen {
        let factors = json!({ "sheenColorFactor": sheen.colour, "sheenRoughnessFactor": sheen.roughness });
        value["extensions"] = json!({ "KHR_materials_sheen": factors });
    }
    if !m.fabric.is_empty() {
        value["extras"] = json!({ "fabric": m.fabric });
    }
    value
}
