//! Materials of a USDZ file: `UsdPreviewSurface` (Pixar, 2.6, 2024) with its textures.

use super::text::share;
use std::fmt::Write;
use toile_core::artifact::{Material, Model};

/// The place of the materials in the scene.
pub(super) const MATERIALS: &str = "/Garment/Materials";

/// All materials; `paths` are the textures' places in the archive.
pub(super) fn materials(s: &mut String, model: &Model, names: &[String], paths: &[String]) {
    s.push_str("    def Scope \"Materials\"\n    {\n");
    for (material, name) in model.materials.iter().zip(names) {
        let place = format!("{MATERIALS}/{name}");
        let _ = writeln!(s, "        def Material \"{name}\"\n        {{");
        let _ =
            writeln!(s, "            token outputs:surface.connect = <{place}/Surface.outputs:surface>\n");
        surface(s, material, &place);
        if material.texture.is_some() || material.normal_texture.is_some() {
            let lines = ["string inputs:varname = \"st\"", "float2 outputs:result"];
            shader(s, "Reader", "UsdPrimvarReader_float2", &lines.map(str::to_owned));
        }
        let wrap = |t: usize| if model.textures[t].repeats { "repeat" } else { "clamp" };
        if let Some(t) = material.texture {
            let [r, g, b] = material.colour.map(share);
            let scale = format!("float4 inputs:scale = ({r}, {g}, {b}, 1)");
            texture(
                s,
                "Colour",
                &paths[t],
                wrap(t),
                &place,
                &["token inputs:sourceColorSpace = \"sRGB\"".into(), scale],
            );
        }
        if let Some(t) = material.normal_texture {
            let lines = [
                "float4 inputs:bias = (-1, -1, -1, 0)",
                "float4 inputs:scale = (2, 2, 2, 1)",
                "token inputs:sourceColorSpace = \"raw\"",
            ];
            texture(s, "Normals", &paths[t], wrap(t), &place, &lines.map(str::to_owned));
        }
        s.push_str("        }\n\n");
    }
    s.push_str("    }\n");
}

/// The surface: without metal; where light does not act, black that shines in its own colour.
fn surface(s: &mut String, m: &Material, place: &str) {
    let colour = |input: &str| match m.texture {
        Some(_) => format!("color3f inputs:{input}.connect = <{place}/Colour.outputs:rgb>"),
        None => {
            let [r, g, b] = m.colour.map(share);
            format!("color3f inputs:{input} = ({r}, {g}, {b})")
        }
    };
    let mut lines = match m.unlit {
        false => vec![colour("diffuseColor")],
        true => vec!["color3f inputs:diffuseColor = (0, 0, 0)".to_owned(), colour("emissiveColor")],
    };
    lines.push("float inputs:metallic = 0".to_owned());
    if m.normal_texture.is_some() {
        lines.push(format!("normal3f inputs:normal.connect = <{place}/Normals.outputs:rgb>"));
    }
    lines.push(format!("float inputs:roughness = {}", share(m.roughness)));
    lines.push("token outputs:surface".to_owned());
    shader(s, "Surface", "UsdPreviewSurface", &lines);
}

fn texture(s: &mut String, name: &str, path: &str, wrap: &str, place: &str, own: &[String]) {
    let mut lines = own.to_vec();
    lines.push(format!("asset inputs:file = @{path}@"));
    lines.push(format!("float2 inputs:st.connect = <{place}/Reader.outputs:result>"));
    lines.extend(["S", "T"].map(|axis| format!("token inputs:wrap{axis} = \"{wrap}\"")));
    lines.push("float3 outputs:rgb".to_owned());
    shader(s, name, "UsdUVTexture", &lines);
}

fn shader(s: &mut String, name: &str, id: &str, lines: &[String]) {
    let _ = writeln!(s, "            def Shader \"{name}\"\n            {{");
    let _ = writeln!(s, "                uniform token info:id = \"{id}\"");
    for line in lines {
        let _ = writeln!(s, "                {line}");
    }
    s.push_str("            }\n\n");
}
