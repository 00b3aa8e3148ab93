//! The motion as USDZ: one mesh whose points have a sample for every frame.
//!
//! The time codes are the frames' numbers. Written as text, some 25 bytes a vertex and frame; to a
//! hundredth of a millimetre.

use super::glb::COLOUR;
use crate::write::usdz::text::{UNIT, identifiers, list, number, tuple};
use crate::write::usdz::zip;
use std::fmt::Write;
use toile_core::StageError;
use toile_core::artifact::RecordedMotion;

/// Decimals of metres.
const METRES: usize = 5;

pub(super) fn usdz(motion: &RecordedMotion, name: &str) -> Result<Vec<u8>, StageError> {
    zip::stored(&[("scene.usda".to_owned(), scene(motion, name).into_bytes())])
}

fn scene(motion: &RecordedMotion, name: &str) -> String {
    let prim = identifiers([name]).remove(0);
    let (rate, last) = (number(1.0 / motion.every, 6), motion.len().saturating_sub(1));
    let mut s = String::from("#usda 1.0\n(\n    customLayerData = {\n");
    let mut line = |text: String| {
        let _ = writeln!(s, "{text}");
    };
    line(format!("        string creator = \"toile {}\"\n    }}", env!("CARGO_PKG_VERSION")));
    line("    defaultPrim = \"Garment\"".into());
    line(format!("    endTimeCode = {last}\n    framesPerSecond = {rate}\n    metersPerUnit = 1"));
    line(format!("    startTimeCode = 0\n    timeCodesPerSecond = {rate}\n    upAxis = \"Y\"\n)\n"));
    line("def Xform \"Garment\" (\n    kind = \"component\"\n)\n{".into());
    line(format!("    def Mesh \"{prim}\"\n    {{\n        uniform bool doubleSided = 1"));
    line("        float3[] extent.timeSamples = {".into());
    for (k, frame) in motion.frames().enumerate() {
        line(format!("            {k}: {},", extent(frame)));
    }
    line("        }".into());
    line(format!("        int[] faceVertexCounts = {}", list(motion.triangles.iter().map(|_| "3".into()))));
    let corners = motion.triangles.iter().flatten();
    line(format!("        int[] faceVertexIndices = {}", list(corners.map(u32::to_string))));
    line("        point3f[] points.timeSamples = {".into());
    for (k, frame) in motion.frames().enumerate() {
        line(format!("            {k}: {},", list(frame.iter().map(|p| place(*p)))));
    }
    line("        }".into());
    line(format!("        color3f[] primvars:displayColor = [{}]", tuple(&COLOUR.map(f64::from), UNIT)));
    line("        uniform token subdivisionScheme = \"none\"\n    }\n}".into());
    s
}

fn place(p: [f32; 3]) -> String {
    tuple(&p.map(f64::from), METRES)
}

/// The corners of the box around a frame.
fn extent(frame: &[[f32; 3]]) -> String {
    let first = frame.first().copied().unwrap_or_default();
    let join = |pick: fn(f32, f32) -> f32| {
        frame.iter().fold(first, |a, b| std::array::from_fn(|k| pick(a[k], b[k])))
    };
    list([join(f32::min), join(f32::max)].into_iter().map(place))
}
