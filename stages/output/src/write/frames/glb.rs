//! The motion as one GLB: a mesh with a morph target for each frame after the first, and an
//! animation that goes from each to the next.
//!
//! A target holds how far every vertex is from where it was in the first frame, as 32-bit floats;
//! at the time of frame k target k has the weight 1 and all others 0, in between weights are
//! linear. Without normals, which would have to be written for every frame: viewers shade the
//! triangles. The weights take 4 bytes for each pair of frames.

use crate::write::glb::buffer::Buffer;
use crate::write::glb::pack;
use serde_json::{Value, json};
use toile_core::StageError;
use toile_core::artifact::RecordedMotion;

const FLOAT: u32 = 5126;
/// The cloth's colour, linear.
pub(super) const COLOUR: [f32; 3] = [0.51, 0.46, 0.40];

pub(super) fn glb(motion: &RecordedMotion, name: &str) -> Result<Vec<u8>, StageError> {
    let mut buffer = Buffer::default();
    let mut frames = motion.frames();
    let first = frames.next().unwrap_or(&[]);
    let position = buffer.floats(first.to_vec(), "VEC3", true);
    let apart = |frame: &[[f32; 3]]| -> Vec<[f32; 3]> {
        first.iter().zip(frame).map(|(a, b)| [b[0] - a[0], b[1] - a[1], b[2] - a[2]]).collect()
    };
    let targets: Vec<Value> =
        frames.map(|frame| json!({ "POSITION": buffer.floats(apart(frame), "VEC3", true) })).collect();
    let indices = buffer.indices(&motion.triangles, motion.vertices);
    let mut primitive =
        json!({ "attributes": { "POSITION": position }, "indices": indices, "material": 0, "mode": 4 });
    let mut mesh = json!({ "name": name });
    if !targets.is_empty() {
        mesh["weights"] = json!(vec![0.0; targets.len()]);
        let names: Vec<String> = (1..=targets.len()).map(|k| format!("frame {k}")).collect();
        mesh["extras"] = json!({ "targetNames": names });
        primitive["targets"] = json!(targets);
    }
    mesh["primitives"] = json!([primitive]);
    let [r, g, b] = COLOUR;
    let mut root = json!({
        "asset": { "version": "2.0", "generator": format!("toile {}", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": name, "mesh": 0 }],
        "meshes": [mesh],
        "materials": [{ "name": "cloth", "doubleSided": true, "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9,
        }}],
    });
    if motion.len() > 1 {
        root["animations"] = json!([animation(motion, name, &mut buffer)]);
    }
    root["accessors"] = json!(buffer.accessors);
    root["bufferViews"] = json!(buffer.views);
    root["buffers"] = json!([{ "byteLength": buffer.bytes.len() }]);
    pack(root.to_string().into_bytes(), buffer.bytes)
}

fn animation(motion: &RecordedMotion, name: &str, buffer: &mut Buffer) -> Value {
    let (count, targets) = (motion.len(), motion.len() - 1);
    let times: Vec<f32> = motion.times().map(|t| t as f32).collect();
    let input = scalars(buffer, &times);
    let (least, last) = (times.first().copied(), times.last().copied());
    buffer.accessors[input]["min"] = json!([least]);
    buffer.accessors[input]["max"] = json!([last]);
    let weight = |k: usize| (1..=targets).map(move |target| if target == k { 1.0 } else { 0.0 });
    let weights: Vec<f32> = (0..count).flat_map(weight).collect();
    let output = scalars(buffer, &weights);
    json!({
        "name": name,
        "samplers": [{ "input": input, "output": output, "interpolation": "LINEAR" }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
    })
}

/// Numbers that no vertex has: their view has no target.
fn scalars(buffer: &mut Buffer, values: &[f32]) -> usize {
    let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
    let view = buffer.view(&bytes, None);
    buffer
        .accessors
        .push(json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": "SCALAR" }));
    buffer.accessors.len() - 1
}
