//! The model's mesh for the page: positions in 65,536 steps, triangles as differences of vertex
//! numbers.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use toile_core::artifact::{Mesh, Model, Vector3};

/// Steps along the longest side of the model's box.
const STEPS: f64 = 65_535.0;

/// Parts, positions and triangles, as `docs/reference/turntable.md` has them.
pub(super) fn mesh(model: &Model) -> Value {
    let parts: Vec<&Mesh> = model.meshes.iter().filter(|m| !m.triangles.is_empty()).collect();
    let mut numbers = BTreeMap::new();
    let (mut order, mut corners) = (Vec::new(), Vec::new());
    for (k, part) in parts.iter().enumerate() {
        for &v in part.triangles.iter().flatten() {
            let number = *numbers.entry((k, v)).or_insert_with(|| {
                order.push(part.positions[v as usize].coords);
                order.len() as u32 - 1
            });
            corners.push(number);
        }
    }
    let first = order.first().copied().unwrap_or_else(Vector3::zeros);
    let (lo, hi) = order.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    let quantum = ((hi - lo).max() / STEPS).max(f64::MIN_POSITIVE);
    let step = |v: f64| ((v / quantum).round().clamp(0.0, STEPS) as u16).to_le_bytes();
    let positions: Vec<u8> =
        order.iter().flat_map(|p| (p - lo).iter().flat_map(|v| step(*v)).collect::<Vec<u8>>()).collect();
    let mut from = 0;
    let part = |m: &&Mesh| {
        let first = from;
        from += m.triangles.len();
        json!({ "name": m.name, "first": first, "count": m.triangles.len() })
    };
    json!({
        "parts": parts.iter().map(part).collect::<Vec<_>>(),
        "quantum": quantum,
        "origin": [lo.x, lo.y, lo.z],
        "positions": STANDARD.encode(positions),
        "triangles": STANDARD.encode(differences(&corners)),
    })
}

/// Each number as its difference to the one before.
fn differences(numbers: &[u32]) -> Vec<u8> {
    let (mut bytes, mut last) = (Vec::new(), 0i64);
    for &number in numbers {
        super::numbers::push(&mut bytes, i64::from(number) - last);
        last = i64::from(number);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_core::testkit::dress;

    #[test]
    fn differences_take_a_byte_each_while_they_are_small() {
        assert_eq!(differences(&[0, 1, 2, 0, 200]), [0, 2, 2, 3, 0x90, 3]);
    }

    #[test]
    fn parts_follow_each_other_and_every_vertex_is_within_half_a_step() {
        let model = dress::model();
        let found = mesh(&model);
        let counts: Vec<u64> = model.meshes.iter().map(|m| m.triangles.len() as u64).collect();
        assert_eq!(found["parts"][1]["first"], counts[0]);
        assert_eq!(found["parts"][1]["count"], counts[1]);
        let bytes = STANDARD.decode(found["positions"].as_str().unwrap_or_default()).unwrap_or_default();
        let quantum = found["quantum"].as_f64().unwrap_or_default();
        // The first vertex is the first corner of the first triangle.
        let at = |k: usize| f64::from(u16::from_le_bytes([bytes[2 * k], bytes[2 * k + 1]])) * quantum;
        let p = model.meshes[0].positions[model.meshes[0].triangles[0][0] as usize];
        for k in 0..3 {
            let origin = found["origin"][k].as_f64().unwrap_or_default();
            assert!((origin + at(k) - p[k]).abs() <= 0.5 * quantum + 1e-12);
        }
    }
}
