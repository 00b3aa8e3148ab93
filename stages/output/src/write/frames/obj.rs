//! Every frame as a Wavefront OBJ with its number, vertex for vertex.

use std::fmt::Write;
use toile_core::artifact::OutputFile;

/// The files of all frames in a folder of the motion's name.
pub(super) fn numbered<'a>(
    name: &str,
    triangles: &[[u32; 3]],
    frames: impl Iterator<Item = &'a [[f32; 3]]>,
) -> Vec<OutputFile> {
    let faces = faces(triangles);
    let file = |(k, frame): (usize, &[[f32; 3]])| {
        let text = vertices(frame) + &faces;
        OutputFile::new(format!("{name}/{name}_{k:04}.obj"), text.into_bytes())
    };
    frames.enumerate().map(file).collect()
}

fn vertices(frame: &[[f32; 3]]) -> String {
    let mut text = String::with_capacity(34 * frame.len());
    for [x, y, z] in frame {
        let _ = writeln!(text, "v {x:.6} {y:.6} {z:.6}");
    }
    text
}

fn faces(triangles: &[[u32; 3]]) -> String {
    let mut text = String::with_capacity(20 * triangles.len());
    for t in triangles {
        let [a, b, c] = t.map(|v| v + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}
