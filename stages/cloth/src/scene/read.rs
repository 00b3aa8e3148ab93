//! The JSON form `garment-scene-1`.

use super::check::{check, check_lists};
use super::held::{Held, contact};
use super::raw::{
    RawAir, RawBand, RawBody, RawCurve, RawHeld, RawMaterial, RawPanel, RawPhase, RawScene, RawSeam,
};
use super::{Band, Panel, Phase, Scene, SceneBody, SceneError, Seam, StrainLimit, mend, strict, units};
use crate::energy::Air;
use crate::error::{ClothError, check_parameter};
use crate::fabric::{Curve, Fabric};
use nalgebra::{Vector2, Vector3};
use serde::Deserialize;
use std::path::Path;
use toile_geometry::obj;

/// How a scene is read.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Options {
    /// Whether vertices of a panel that lie on each other, flat and at the start, are joined.
    pub weld: bool,
    /// Metres of the unit of the body's OBJ; found from its size where it is not said.
    pub body_unit: Option<f64>,
}

/// A scene that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The scene, checked.
    pub scene: Scene,
    /// What was mended, and what is odd but allowed: a sentence each.
    pub warnings: Vec<String>,
}

#[derive(Deserialize)]
struct SceneHead {
    format: String,
}

/// Reads a scene file and the body OBJ it names, which lies beside it.
///
/// # Errors
/// Every [`SceneError`].
pub fn read(path: &Path, options: &Options) -> Result<Loaded, SceneError> {
    let load = |path: &Path| {
        std::fs::read(path).map_err(|e| SceneError::File { path: path.into(), why: e.to_string() })
    };
    let folder = path.parent().unwrap_or(Path::new("."));
    parse(&load(path)?, &|obj| load(&folder.join(obj)), options)
}

/// Loads the bytes of the OBJ that a scene names.
pub type Load<'a> = dyn Fn(&str) -> Result<Vec<u8>, SceneError> + 'a;

/// Reads a scene's text; `load` gives the bytes of the OBJ that it names.
///
/// # Errors
/// Every [`SceneError`].
pub fn parse(text: &[u8], load: &Load<'_>, options: &Options) -> Result<Loaded, SceneError> {
    let raw = fields(text)?;
    let mut warnings = Vec::new();
    warnings.extend(other_seconds(&raw));
    let body = raw.body.as_ref().map(|b| body(b, load)).transpose()?;
    let (body, repairs) = body.unzip();
    let told = repairs.and_then(|r: obj::Repairs| r.words());
    warnings.extend(told.map(|what| format!("the body's OBJ was repaired: {what}")));
    let mut scene = build(raw, body)?;
    check_lists(&scene)?;
    warnings.extend(units::settle(&mut scene, options.body_unit)?);
    warnings.extend(mend::mend(&mut scene, options.weld)?);
    check(&scene)?;
    Ok(Loaded { scene, warnings })
}

/// Looks whether a scene's text has the form and its OBJ can be read, and at nothing that stands in
/// them: a small part of reading it.
///
/// # Errors
/// [`SceneError`] as [`parse`] gives it.
pub fn check_form(text: &[u8], load: &Load<'_>) -> Result<(), SceneError> {
    match fields(text)?.body {
        Some(body) => Ok(obj::parse(&load(&body.obj)?).map(|_| ())?),
        None => Ok(()),
    }
}

/// The fields of a scene's text.
fn fields(text: &[u8]) -> Result<RawScene, SceneError> {
    let text = obj::decode(text);
    let form = |e: serde_json::Error| SceneError::Form { why: e.to_string() };
    let head: SceneHead = serde_json::from_slice(&text).map_err(form)?;
    if head.format != "garment-scene-1" {
        return Err(SceneError::Format { found: head.format });
    }
    let faults = strict::faults(&text);
    if !faults.is_empty() {
        return Err(SceneError::Fields(faults));
    }
    let raw: RawScene = serde_json::from_slice(&text).map_err(form)?;
    match raw.up.as_ref().filter(|up| !up.eq_ignore_ascii_case("y")) {
        Some(found) => Err(SceneError::Up { found: found.clone() }),
        None => Ok(raw),
    }
}

/// A total that is not that of the phases.
fn other_seconds(raw: &RawScene) -> Option<String> {
    let sum: f64 = raw.phases.iter().map(|p| p.seconds).sum();
    let said = raw.seconds.filter(|s| (s - sum).abs() > 1e-9 * sum.abs())?;
    Some(format!("`seconds` is {said}, but the phases last {sum} s together; the phases count"))
}

fn body(raw: &RawBody, load: &Load<'_>) -> Result<(SceneBody, obj::Repairs), SceneError> {
    let (mesh, mut repairs) = obj::repair(obj::parse(&load(&raw.obj)?)?);
    let obj::Mesh { vertices, triangles } = obj::outer_surface(mesh, &mut repairs);
    Ok((SceneBody { vertices, triangles, friction: raw.friction }, repairs))
}

fn build(raw: RawScene, body: Option<SceneBody>) -> Result<Scene, SceneError> {
    let phase = |p: RawPhase| Phase {
        name: p.name,
        seconds: p.seconds,
        gravity: Vector3::from(p.gravity),
        air: p.air.map(air),
    };
    let seam = |s: RawSeam| Seam {
        name: s.name,
        pairs: s.pairs,
        joined: s.joined,
        gather: s.gather,
        fold: s.fold.map(f64::to_radians),
    };
    let band =
        |b: RawBand| Band { name: b.name, vertices: b.vertices, ratio: b.ratio, stiffness: b.stiffness };
    Ok(Scene {
        name: raw.name,
        rest: raw.rest_uv.into_iter().map(Vector2::from).collect(),
        positions: raw.positions.into_iter().map(Vector3::from).collect(),
        triangles: raw.triangles,
        panels: raw.panels.into_iter().map(panel).collect::<Result<_, _>>()?,
        seams: raw.seams.into_iter().map(seam).collect(),
        bands: raw.bands.into_iter().map(band).collect(),
        pinned: raw.pinned,
        body,
        material: fabric(raw.material, "the scene")?,
        strain_limit: raw.strain_limit.map(|l| StrainLimit { warp: l.warp, weft: l.weft }),
        phases: raw.phases.into_iter().map(phase).collect(),
        self_collision: raw.self_collision,
        held: raw.held.map(held).unwrap_or_default(),
    })
}

fn held(raw: RawHeld) -> Held {
    let RawHeld { slides, offsets, folds, contacts } = raw;
    Held {
        slides: slides.into_iter().map(Vector3::from).collect(),
        offsets,
        folds,
        contacts: contacts.into_iter().map(|c| contact(c.nodes, &c.figures)).collect(),
    }
}

fn air(raw: RawAir) -> Air {
    let RawAir { density, normal, tangential, wind } = raw;
    Air { density, normal, tangential, wind: Vector3::from(wind) }
}

fn panel(raw: RawPanel) -> Result<Panel, SceneError> {
    let of = format!("panel '{}'", raw.name);
    let material = raw.material.map(|m| fabric(m, &of)).transpose()?;
    let (vertices, triangles) = (raw.vertices[0]..raw.vertices[1], raw.triangles[0]..raw.triangles[1]);
    let (body_friction, layer) = (raw.body_friction, raw.layer);
    Ok(Panel { material, body_friction, layer, ..Panel::new(raw.name, vertices, triangles) })
}

fn fabric(raw: RawMaterial, of: &str) -> Result<Fabric, SceneError> {
    check_parameter("area_density", raw.area_density, |v| v > 0.0, "above 0 kg/m^2")?;
    let lacks = |either, first, second| SceneError::Material { of: of.into(), either, first, second };
    let tensile = |own: Option<RawCurve>, name| match own
        .map(|c| (c, name))
        .or(raw.stretch.clone().map(|c| (c, "stretch")))
    {
        Some((c, name)) => Ok(curve(c, name)?),
        None => Err(lacks("stretch", "warp", "weft")),
    };
    let bending = |own: Option<f64>, name| match own.map(|b| (b, name)).or(raw.bend.map(|b| (b, "bend"))) {
        Some((b, name)) => {
            check_parameter(name, b, |v| v >= 0.0, "0 N m or more")?;
            Ok(b)
        }
        None => Err(lacks("bend", "bend_warp", "bend_weft")),
    };
    let friction = |own: Option<f64>, name| {
        let couple = own.or(raw.bend_friction).unwrap_or(0.0);
        check_parameter(
            if own.is_some() { name } else { "bend_friction" },
            couple,
            |v| v >= 0.0,
            "0 N m/m or more",
        )?;
        Ok::<_, SceneError>(couple)
    };
    Ok(Fabric {
        density: raw.area_density,
        warp: tensile(raw.warp, "warp")?,
        weft: tensile(raw.weft, "weft")?,
        poisson: raw.poisson,
        shear: curve(raw.shear, "shear")?,
        bending_warp: bending(raw.bend_warp, "bend_warp")?,
        bending_weft: bending(raw.bend_weft, "bend_weft")?,
        bending_friction_warp: friction(raw.bend_friction_warp, "bend_friction_warp")?,
        bending_friction_weft: friction(raw.bend_friction_weft, "bend_friction_weft")?,
        thickness: raw.thickness,
        friction: raw.friction,
        damping: raw.damping.unwrap_or(0.0),
    })
}

fn curve(raw: RawCurve, name: &'static str) -> Result<Curve, ClothError> {
    match raw {
        RawCurve::Points(points) => Curve::through(&points),
        RawCurve::Straight(k) => {
            check_parameter(name, k, |k| k > 0.0, "above 0 N/m")?;
            Ok(Curve::linear(k))
        }
    }
}
