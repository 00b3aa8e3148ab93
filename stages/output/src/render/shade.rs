//! What colour a surface shows: soft key, fill and sky on a matt surface, with the sheen of its
//! fibres.

use super::camera::Camera;
use super::surroundings::Surroundings;
use std::f64::consts::PI;
use toile_core::artifact::{Sheen, Vector3};

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
    /// Strengths and colours of the key light and of what comes from all sides.
    key_light: f64,
    fill_light: f64,
    sky_light: f64,
    key_tint: [f32; 3],
    tint: [f32; 3],
    /// Towards the viewer: taken as the same for the whole picture.
    view: Vector3,
}

impl Lights {
    pub(super) fn new(camera: &Camera) -> Lights {
        Lights {
            key: camera.to_world(KEY),
            fill: camera.to_world(FILL),
            key_light: KEY_LIGHT,
            fill_light: FILL_LIGHT,
            sky_light: SKY_LIGHT,
            key_tint: [1.0; 3],
            tint: [1.0; 3],
            view: camera.back,
        }
    }

    /// Those of a panorama, which stay where they are when the camera turns.
    pub(super) fn of(surroundings: &Surroundings, camera: &Camera) -> Lights {
        Lights {
            key: surroundings.key,
            key_light: KEY_LIGHT * surroundings.strength,
            // What fills the shadows comes from all sides already: pictures are as bright.
            fill_light: 0.0,
            sky_light: SKY_LIGHT + FILL_LIGHT,
            key_tint: surroundings.key_tint,
            tint: surroundings.tint,
            ..Lights::new(camera)
        }
    }

    /// Light on a surface with unit normal `n` (turned to the viewer), where `ambient` of the sky
    /// and `key` of the key light reach it.
    pub(super) fn on(&self, n: &Vector3, ambient: f64, key: f64) -> [f32; 3] {
        let cosine = |l: &Vector3| n.dot(l).max(0.0);
        let key = (self.key_light * key * cosine(&self.key)) as f32;
        let around = ((self.fill_light * cosine(&self.fill) + self.sky_light) * ambient) as f32;
        [0, 1, 2].map(|c| key * self.key_tint[c] + around * self.tint[c])
    }

    /// What fibres add of key and fill light, for white sheen; the sky's is left out. In the same
    /// units as [`Lights::on`].
    pub(super) fn sheen(&self, sheen: &Sheen, n: &Vector3, ambient: f64, key: f64) -> f64 {
        let alpha = f64::from(sheen.roughness).max(LEAST_ROUGHNESS).powi(2);
        let of = |l: &Vector3| charlie(n, l, &self.view, alpha);
        self.key_light * key * of(&self.key) + self.fill_light * ambient * of(&self.fill)
    }
}

/// Smoother sheen than this is a line of light too thin to be drawn.
const LEAST_ROUGHNESS: f64 = 0.1;

/// Light that fibres scatter from `l` to `v`, as a share of what a white matt surface that faces
/// the light would: the distribution of Estevez and Kulla (2017) with the visibility of Neubelt and
/// Pettineo (2013), as glTF's `KHR_materials_sheen` has it.
fn charlie(n: &Vector3, l: &Vector3, v: &Vector3, alpha: f64) -> f64 {
    let (light, view) = (n.dot(l), n.dot(v).max(0.0));
    let Some(half) = (l + v).try_normalize(1e-9).filter(|_| light > 0.0) else { return 0.0 };
    let sine = (1.0 - n.dot(&half).powi(2)).max(0.0).sqrt();
    let exponent = 1.0 / alpha;
    // Whole exponents, such as 4 for short fibres, need no logarithm.
    let power = if exponent.fract() == 0.0 && exponent <= 64.0 {
        sine.powi(exponent as i32)
    } else {
        sine.powf(exponent)
    };
    let distribution = (2.0 + exponent) * power / (2.0 * PI);
    let visibility = 1.0 / (4.0 * (light + view - light * view).max(1e-3));
    PI * light * distribution * visibility
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
