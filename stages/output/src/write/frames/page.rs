//! The motion as one page that plays it: no network, no WebGL.
//!
//! Places are 16-bit numbers on one grid for all frames, 8 bytes a vertex and frame in the page: a
//! 65,535th of the motion's size. 100 frames of 5,000 triangles take 2 MB.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;
use toile_core::artifact::RecordedMotion;

const PAGE: &str = include_str!("page/page.html");
const SCRIPT: &str = include_str!("page/player.js");
const STYLE: &str = include_str!("page/player.css");
/// The largest number of a place.
const STEPS: f64 = u16::MAX as f64;

pub(super) fn page(motion: &RecordedMotion, title: &str) -> Vec<u8> {
    let (low, step) = grid(motion);
    let on_grid = |p: &[f32; 3]| -> [u16; 3] {
        std::array::from_fn(|k| ((f64::from(p[k]) - low[k]) / step).round().clamp(0.0, STEPS) as u16)
    };
    let places: Vec<u8> = motion.positions.iter().flat_map(on_grid).flat_map(u16::to_le_bytes).collect();
    let triangles: Vec<u8> = motion.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
    let data = json!({
        "title": title,
        "every": motion.every,
        "frames": motion.len(),
        "vertices": motion.vertices,
        "low": low,
        "step": step,
        "places": STANDARD.encode(places),
        "triangles": STANDARD.encode(triangles),
    });
    // No text of the data can end the script that holds it.
    let data = data.to_string().replace("</", "<\\/");
    PAGE.replace("/*CSS*/", STYLE).replace("/*JS*/", SCRIPT).replace("/*DATA*/", &data).into_bytes()
}

/// The least corner of all frames, and the step of the grid, m.
fn grid(motion: &RecordedMotion) -> ([f64; 3], f64) {
    let first = motion.positions.first().copied().unwrap_or_default();
    let join = |pick: fn(f32, f32) -> f32| {
        motion.positions.iter().fold(first, |a, b| std::array::from_fn(|k| pick(a[k], b[k])))
    };
    let (low, high) = (join(f32::min).map(f64::from), join(f32::max).map(f64::from));
    let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    (low, if size > 0.0 { size / STEPS } else { 1.0 })
}
