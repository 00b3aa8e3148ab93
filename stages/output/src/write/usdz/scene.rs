//! The scene of a USDZ file as text: meshes, which material each wears, and variants.

use super::materials::{MATERIALS, materials};
use super::text::{UNIT, identifiers, list, quoted, tuple};
use crate::write::glb::fabrics;
use std::fmt::Write;
use toile_core::artifact::{Mesh, Model, Point3};

/// What the file says of itself.
pub(super) struct About<'a> {
    pub(super) copyright: Option<&'a str>,
    /// In hexadecimal.
    pub(super) digest: String,
}

/// Decimals of metres and of texture coordinates: a thousandth of a millimetre, a fiftieth of a
/// texel.
const METRES: usize = 6;
const TEXTURE: usize = 5;

/// The document; `paths` are the textures' places in the archive.
pub(super) fn scene(model: &Model, paths: &[String], about: &About<'_>) -> String {
    let meshes = identifiers(model.meshes.iter().map(|m| m.name.as_str()));
    let names = identifiers(model.materials.iter().map(|m| m.name.as_str()));
    let mut s = head(model, about);
    variants(&mut s, model, &meshes, &names);
    s.push_str("    def Scope \"Geometry\"\n    {\n");
    for (mesh, name) in model.meshes.iter().zip(&meshes) {
        // Where there are variants, they alone bind: what stands here would be stronger.
        let material = model.variants.is_empty().then(|| &names[mesh.material]);
        let double_sided = model.materials[mesh.material].double_sided;
        write_mesh(&mut s, mesh, name, material, double_sided);
    }
    s.push_str("    }\n\n");
    materials(&mut s, model, &names, paths);
    s.push_str("}\n");
    s
}

/// The head of the document and of its one prim, whose braces are left open.
fn head(model: &Model, about: &About<'_>) -> String {
    let mut s = String::from("#usda 1.0\n(\n    customLayerData = {\n");
    if let Some(copyright) = about.copyright {
        let _ = writeln!(s, "        string copyright = {}", quoted(copyright));
    }
    let _ = writeln!(s, "        string creator = \"toile {}\"", env!("CARGO_PKG_VERSION"));
    let _ = writeln!(s, "        string digest = {}", quoted(&about.digest));
    let _ = writeln!(s, "        string[] fabrics = {}", list(fabrics(model).into_iter().map(quoted)));
    s.push_str("    }\n    defaultPrim = \"Garment\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n");
    s.push_str("def Xform \"Garment\" (\n    kind = \"component\"\n");
    if let Some(first) = identifiers(model.variants.iter().map(|v| v.name.as_str())).first() {
        let _ = writeln!(s, "    variants = {{\n        string look = \"{first}\"\n    }}");
        s.push_str("    prepend variantSets = \"look\"\n");
    }
    s.push_str(")\n{\n");
    s
}

/// The variant set `look`, where there are variants.
fn variants(s: &mut String, model: &Model, meshes: &[String], materials: &[String]) {
    if model.variants.is_empty() {
        return;
    }
    s.push_str("    variantSet \"look\" = {\n");
    let names = identifiers(model.variants.iter().map(|v| v.name.as_str()));
    for (variant, name) in model.variants.iter().zip(names) {
        let _ = writeln!(s, "        \"{name}\" {{\n            over \"Geometry\"\n            {{");
        for (mesh, material) in meshes.iter().zip(&variant.materials) {
            let _ = writeln!(
                s,
                "                over \"{mesh}\" (\n                    prepend apiSchemas = [\"MaterialBindingAPI\"]"
            );
            let _ = writeln!(
                s,
                "                )\n                {{\n                    {}",
                binding(&materials[*material])
            );
            s.push_str("                }\n");
        }
        s.push_str("            }\n        }\n");
    }
    s.push_str("    }\n\n");
}

fn binding(material: &str) -> String {
    format!("rel material:binding = <{MATERIALS}/{material}>")
}

fn write_mesh(s: &mut String, mesh: &Mesh, name: &str, material: Option<&String>, double_sided: bool) {
    let applied = if material.is_some() {
        " (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )"
    } else {
        ""
    };
    let _ = writeln!(s, "        def Mesh \"{name}\"{applied}\n        {{");
    let mut line = |text: String| {
        let _ = writeln!(s, "            {text}");
    };
    line(format!("uniform bool doubleSided = {}", u8::from(double_sided)));
    line(format!("float3[] extent = {}", extent(&mesh.positions)));
    line(format!("int[] faceVertexCounts = {}", list(mesh.triangles.iter().map(|_| "3".to_owned()))));
    let corners = mesh.triangles.iter().flatten();
    line(format!("int[] faceVertexIndices = {}", list(corners.map(u32::to_string))));
    if let Some(material) = material {
        line(binding(material));
    }
    let normals = mesh.normals.iter().map(|n| tuple(n.as_slice(), UNIT));
    line(vertex_values("normal3f[] normals", list(normals)));
    let points = mesh.positions.iter().map(|p| tuple(p.coords.as_slice(), METRES));
    line(format!("point3f[] points = {}", list(points)));
    if !mesh.uv.is_empty() {
        // USD counts texture rows from the bottom.
        let st = mesh.uv.iter().map(|[u, v]| tuple(&[f64::from(*u), 1.0 - f64::from(*v)], TEXTURE));
        line(vertex_values("texCoord2f[] primvars:st", list(st)));
    }
    line("uniform token subdivisionScheme = \"none\"".to_owned());
    s.push_str("        }\n\n");
}

fn vertex_values(what: &str, values: String) -> String {
    format!("{what} = {values} (\n                interpolation = \"vertex\"\n            )")
}

/// The corners of the box around points, as they are written.
fn extent(points: &[Point3]) -> String {
    let first = points.first().copied().unwrap_or_else(Point3::origin);
    let (lo, hi) = points.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    list([lo, hi].iter().map(|p| tuple(p.coords.as_slice(), METRES)))
}
