//! What colour a surface shows: soft key, fill and sky on a matt surface.

use super::camera::Camera;
use toile_core::artifact::Vector3;

/// The key light's direction in the camera's axes: from above left, low enough to rake over folds.
const KEY: [f64; 3] = [-0.66, 0.52, 0.54];
/// The fill light's direction, opposite and nearly level.
const FILL: [f64; 3] = [0.80, 0.10, 0.59];
/// Strengths, chosen so that a surface which faces the camera shows its own colour.
const KEY_LIGHT: f64 = 0.86;
const FILL_LIGHT: f64 = 0.22;
const SKY_LIGHT: f64 = 0.50;

/// The lights of one view, in the world's axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lights {
    pub(super) key: Vector3,
    fill: Vector3,
}

impl Lights {
    pub(super) fn new(camera: &Camera) -> Lights {
        Lights { key: camera.to_world(KEY), fill: camera.to_world(FILL) }
    }

    /// Light on a surface with unit normal `n` (turned to the viewer), where `ambient` of the sky and `key` of
    /// the key light reach it.
    pub(super) fn on(&self, n: &Vector3, ambient: f64, key: f64) -> f64 {
        let cosine = |l: &Vector3| n.dot(l).max(0.0);
        KEY_LIGHT * key * cosine(&self.key) + (FILL_LIGHT * cosine(&self.fill) + SKY_LIGHT) * ambient
    }
}

/// The studio's back wall, sRGB, from the picture's top to its bottom.
const WALL: [[f32; 3]; 2] = [[246.0, 247.0, 249.0], [214.0, 217.0, 222.0]];

/// The wall behind row `y` of `height`.
pub(super) fn wall(y: u32, height: u32) -> [f32; 3] {
    let t = (y as f32 + 0.5) / height.max(1) as f32;
    [0, 1, 2].map(|c| {
        let level = WALL[0][c] + (WALL[1][c] - WALL[0][c]) * t * t;
        super::mips::LINEAR[level.round() as usize]
    })
}
