//! The JSON form `garment-scene-1`.

use super::{Material, Panel, Phase, Scene, SceneBody, SceneError, Seam, check::check, obj::parse_obj};
use nalgebra::{Vector2, Vector3};
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
struct Head {
    format: String,
}

#[derive(Deserialize)]
struct RawScene {
    #[serde(default)]
    name: String,
    rest_uv: Vec<[f64; 2]>,
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    #[serde(default)]
    panels: Vec<RawPanel>,
    #[serde(default)]
    seams: Vec<RawSeam>,
    #[serde(default)]
    pinned: Vec<u32>,
    body: Option<RawBody>,
    material: RawMaterial,
    phases: Vec<RawPhase>,
    #[serde(default)]
    self_collision: bool,
}

#[derive(Deserialize)]
struct RawPanel {
    name: String,
    vertices: [usize; 2],
    triangles: [usize; 2],
}

#[derive(Deserialize)]
struct RawSeam {
    name: String,
    pairs: Vec<[u32; 2]>,
}

#[derive(Deserialize)]
struct RawBody {
    obj: String,
    friction: f64,
}

#[derive(Deserialize)]
struct RawMaterial {
    area_density: f64,
    stretch: f64,
    shear: f64,
    bend: f64,
    friction: f64,
    thickness: f64,
}

#[derive(Deserialize)]
struct RawPhase {
    name: String,
    seconds: f64,
    gravity: [f64; 3],
}

/// Reads a scene file and the body OBJ it names, which lies beside it.
///
/// # Errors
/// Every [`SceneError`].
pub fn read(path: &Path) -> Result<Scene, SceneError> {
    let load = |path: &Path| {
        std::fs::read_to_string(path).map_err(|e| SceneError::File { path: path.into(), why: e.to_string() })
    };
    let folder = path.parent().unwrap_or(Path::new("."));
    parse(&load(path)?, &|obj| load(&folder.join(obj)))
}

/// Reads a scene's text; `load` gives the text of the OBJ that it names.
///
/// # Errors
/// Every [`SceneError`].
pub fn parse(text: &str, load: &dyn Fn(&str) -> Result<String, SceneError>) -> Result<Scene, SceneError> {
    let form = |e: serde_json::Error| SceneError::Form { why: e.to_string() };
    let head: Head = serde_json::from_str(text).map_err(form)?;
    if head.format != "garment-scene-1" {
        return Err(SceneError::Format { found: head.format });
    }
    let raw: RawScene = serde_json::from_str(text).map_err(form)?;
    let body = raw.body.as_ref().map(|b| body(b, load)).transpose()?;
    let scene = build(raw, body);
    check(&scene)?;
    Ok(scene)
}

fn body(raw: &RawBody, load: &dyn Fn(&str) -> Result<String, SceneError>) -> Result<SceneBody, SceneError> {
    let (vertices, triangles) = parse_obj(&load(&raw.obj)?)?;
    Ok(SceneBody { vertices, triangles, friction: raw.friction })
}

fn build(raw: RawScene, body: Option<SceneBody>) -> Scene {
    let m = raw.material;
    let panel = |p: RawPanel| Panel {
        name: p.name,
        vertices: p.vertices[0]..p.vertices[1],
        triangles: p.triangles[0]..p.triangles[1],
    };
    let phase = |p: RawPhase| Phase { name: p.name, seconds: p.seconds, gravity: Vector3::from(p.gravity) };
    Scene {
        name: raw.name,
        rest: raw.rest_uv.into_iter().map(Vector2::from).collect(),
        positions: raw.positions.into_iter().map(Vector3::from).collect(),
        triangles: raw.triangles,
        panels: raw.panels.into_iter().map(panel).collect(),
        seams: raw.seams.into_iter().map(|s| Seam { name: s.name, pairs: s.pairs }).collect(),
        pinned: raw.pinned,
        body,
        material: Material {
            area_density: m.area_density,
            stretch: m.stretch,
            shear: m.shear,
            bend: m.bend,
            friction: m.friction,
            thickness: m.thickness,
        },
        phases: raw.phases.into_iter().map(phase).collect(),
        self_collision: raw.self_collision,
    }
}
