//! The fields of the JSON form as they stand in the file.

use super::held::FIGURES;
use crate::energy::Air;
use serde::{Deserialize, de};

#[derive(Deserialize)]
pub(super) struct RawScene {
    #[serde(rename = "format")]
    pub(super) _format: String,
    #[serde(default)]
    pub(super) name: String,
    pub(super) up: Option<String>,
    pub(super) rest_uv: Vec<[f64; 2]>,
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    #[serde(default)]
    pub(super) panels: Vec<RawPanel>,
    #[serde(default)]
    pub(super) seams: Vec<RawSeam>,
    #[serde(default)]
    pub(super) bands: Vec<RawBand>,
    #[serde(default)]
    pub(super) pinned: Vec<u32>,
    pub(super) body: Option<RawBody>,
    pub(super) material: RawMaterial,
    pub(super) strain_limit: Option<RawLimit>,
    pub(super) phases: Vec<RawPhase>,
    pub(super) seconds: Option<f64>,
    #[serde(default)]
    pub(super) self_collision: bool,
    pub(super) held: Option<RawHeld>,
}

#[derive(Deserialize)]
pub(super) struct RawHeld {
    pub(super) slides: Vec<[f64; 3]>,
    #[serde(default)]
    pub(super) offsets: Vec<f64>,
    #[serde(default)]
    pub(super) folds: Vec<f64>,
    #[serde(default)]
    pub(super) contacts: Vec<RawContact>,
}

#[derive(Deserialize)]
pub(super) struct RawContact {
    pub(super) nodes: [u32; 4],
    pub(super) figures: [f64; FIGURES],
}

#[derive(Deserialize)]
pub(super) struct RawPanel {
    pub(super) name: String,
    pub(super) vertices: [usize; 2],
    pub(super) triangles: [usize; 2],
    pub(super) material: Option<RawMaterial>,
    pub(super) body_friction: Option<f64>,
    #[serde(default)]
    pub(super) layer: u32,
}

#[derive(Deserialize)]
pub(super) struct RawSeam {
    pub(super) name: String,
    pub(super) pairs: Vec<[u32; 2]>,
    #[serde(default = "yes")]
    pub(super) joined: bool,
    pub(super) gather: Option<f64>,
    pub(super) fold: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct RawBand {
    pub(super) name: String,
    pub(super) vertices: Vec<u32>,
    pub(super) ratio: f64,
    pub(super) stiffness: f64,
}

#[derive(Deserialize)]
pub(super) struct RawLimit {
    pub(super) warp: f64,
    pub(super) weft: f64,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
pub(super) struct RawBody {
    pub(super) obj: String,
    pub(super) friction: f64,
}

#[derive(Deserialize)]
pub(super) struct RawMaterial {
    pub(super) area_density: f64,
    pub(super) stretch: Option<RawCurve>,
    pub(super) warp: Option<RawCurve>,
    pub(super) weft: Option<RawCurve>,
    #[serde(default)]
    pub(super) poisson: f64,
    pub(super) shear: RawCurve,
    pub(super) bend: Option<f64>,
    pub(super) bend_warp: Option<f64>,
    pub(super) bend_weft: Option<f64>,
    pub(super) bend_friction: Option<f64>,
    pub(super) bend_friction_warp: Option<f64>,
    pub(super) bend_friction_weft: Option<f64>,
    pub(super) friction: f64,
    pub(super) thickness: f64,
    pub(super) damping: Option<f64>,
}

/// A stiffness, or the points of a curve.
#[derive(Clone)]
pub(super) enum RawCurve {
    Straight(f64),
    Points(Vec<[f64; 2]>),
}

impl<'de> Deserialize<'de> for RawCurve {
    fn deserialize<D: de::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> de::Visitor<'de> for Either {
            type Value = RawCurve;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a stiffness in N/m or a curve [[strain, N/m], ...]")
            }

            fn visit_f64<E>(self, k: f64) -> Result<RawCurve, E> {
                Ok(RawCurve::Straight(k))
            }

            fn visit_u64<E>(self, k: u64) -> Result<RawCurve, E> {
                Ok(RawCurve::Straight(k as f64))
            }

            fn visit_i64<E>(self, k: i64) -> Result<RawCurve, E> {
                Ok(RawCurve::Straight(k as f64))
            }

            fn visit_seq<A: de::SeqAccess<'de>>(self, mut list: A) -> Result<RawCurve, A::Error> {
                let mut points = Vec::new();
                while let Some(point) = list.next_element()? {
                    points.push(point);
                }
                Ok(RawCurve::Points(points))
            }
        }
        from.deserialize_any(Either)
    }
}

#[derive(Deserialize)]
pub(super) struct RawPhase {
    pub(super) name: String,
    pub(super) seconds: f64,
    pub(super) gravity: [f64; 3],
    pub(super) air: Option<RawAir>,
}

#[derive(Deserialize)]
pub(super) struct RawAir {
    pub(super) density: f64,
    #[serde(default = "normal")]
    pub(super) normal: f64,
    #[serde(default = "tangential")]
    pub(super) tangential: f64,
    #[serde(default)]
    pub(super) wind: [f64; 3],
}

fn normal() -> f64 {
    Air::NORMAL
}

fn tangential() -> f64 {
    Air::TANGENTIAL
}
