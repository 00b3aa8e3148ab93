//! `Scene`: a prepared scene in the form `garment-scene-1`.
//!
//! Method: the engine's reader checks every index and number; the body becomes a collider over
//! boxes along the axes, as `BvhCollider` makes it. Cost: reading the file, and the body's tree.
//! Limit: strain limits, layers and threads have no place in a garment; the stage names what it
//! leaves out, and what was mended.

use crate::collide::{BvhScheme, Distances, asked_distances, check_body};
use crate::engine::{garment_of, lost, scene_error};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_body::Units;
use toile_cloth::scene::{self, Loaded, Options, SceneError};
use toile_core::Known;
use toile_core::artifact::{Artifact, Digester};
use toile_core::cost::{Quantity, Size};
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_geometry::obj;
use toile_geometry::volume::Aabb;

/// Reads a prepared scene: flat panels with their starts and seams, pins, a body, what acts on
/// them.
///
/// The form is described in docs/reference/scene.md; benchmarks of other programs use it as well.
/// The garment's vertices keep the order of the file, so that a result can be compared with it. A
/// body that exporters left with split vertices, doubled or flat triangles is mended, as `BodyObj`
/// does.
#[stage(
    role = Reader,
    source = "garment-scene-1, docs/reference/scene.md",
    version = 2,
    example = "Scene(file: \"skirt.json\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Scene {
    /// The file, relative to the pipeline; the body's OBJ lies beside it.
    #[param(default = String::new())]
    pub file: String,
    /// When distances to the body are worked out; the results are the same.
    #[param(default = Distances::Asked)]
    pub distances: Distances,
    /// Whether vertices of a panel that lie on each other, flat and at the start, become one.
    #[param(default = false)]
    pub weld: bool,
    /// The unit of the body's OBJ; `Guess` takes metres, or where the body would be longer than 10
    /// m the unit in which it fits the cloth.
    #[param(default = Units::Guess)]
    pub units: Units,
}

/// Share of the stage's time that distances where they are requested save, on the skirt.
const SHARE: f64 = 0.75;

#[stage]
impl Scene {
    /// Runs the stage.
    pub fn run(&self, cx: &Context) -> Result<(Garment, Body, Collider, Phases), StageError> {
        self.named()?;
        let Loaded { scene, warnings } = self.load(cx).map_err(Unread::told)?;
        warnings.into_iter().chain(lost(&scene)).for_each(|what| cx.warn(what));
        let garment = garment_of(&scene);
        self.check(&garment)?;
        let body = body_of(&scene);
        self.check(&body)?;
        let collider = collider(&scene, &body, self.distances, cx)?;
        let phases = scene.phases.iter().map(|p| Phase {
            name: p.name.clone(),
            seconds: p.seconds,
            gravity: p.gravity,
            air: p.air.map(air),
        });
        let phases = Phases(phases.collect());
        self.check(&collider)?;
        self.check(&phases)?;
        Ok((garment, body, collider, phases))
    }

    fn named(&self) -> Result<(), StageError> {
        if self.file.is_empty() {
            let e = StageError::new(ErrorCode::InvalidParameter, "no file is named to read the scene from");
            return Err(e.hint("write `file: \"skirt.json\"`").at("file"));
        }
        Ok(())
    }

    /// Whether the file and that of its body are there and have their forms. What they say is
    /// checked by the run, at once: scenes come first.
    pub(crate) fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let form = || {
            placed.cx.look(&self.file).map_err(Unread::File)?;
            let text = placed.cx.read(&self.file).map_err(Unread::File)?;
            scene::check_form(&text, &|obj| self.beside(obj, placed.cx)).map_err(Unread::Scene)
        };
        let sound = self.named().map_err(|e| e.at("file")).and_then(|()| form().map_err(Unread::told));
        sound.err().into_iter().collect()
    }

    /// A file whose numbers the reader takes and no garment, body or motion can have.
    fn check(&self, made: &impl Artifact) -> Result<(), StageError> {
        made.check().map_err(|fault| {
            StageError::invalid(format!("the {} of \"{}\" cannot be used: {fault}", made.kind(), self.file))
                .hint("docs/reference/scene.md describes the format")
        })
    }

    pub(crate) fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        let size = self.sizes(known.given, known.cx).unwrap_or_default();
        asked_distances::rule(self.distances, &size, SHARE).into_iter().collect()
    }

    /// How much it will read: by counting. Reading it whole, with the repair of its body, would
    /// cost a tenth of a small skirt.
    pub(crate) fn sizes(&self, _given: &Size, cx: &Context) -> Option<Size> {
        let bytes = cx.read(&self.file).ok()?;
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
        let counted: Counted = serde_json::from_slice(text).ok()?;
        let body = match counted.body {
            Some(body) => obj::count_triangles(&self.beside(&body.obj, cx).ok()?),
            None => 0,
        };
        let size = Size::new().with(Quantity::Bytes, bytes.len() as f64);
        Some(
            size.with(Quantity::Triangles, counted.triangles.len() as f64)
                .with(Quantity::BodyTriangles, body as f64),
        )
    }

    /// The bytes of the OBJ that the scene's file names.
    fn beside(&self, obj: &str, cx: &Context) -> Result<Vec<u8>, SceneError> {
        let folder = std::path::Path::new(&self.file).parent().unwrap_or(std::path::Path::new(""));
        let path = folder.join(obj);
        cx.read(&path.to_string_lossy()).map_err(|e| SceneError::File { path, why: e.message })
    }

    fn load(&self, cx: &Context) -> Result<Loaded, Unread> {
        let text = cx.read(&self.file).map_err(Unread::File)?;
        let options = Options { weld: self.weld, body_unit: self.units.metres() };
        scene::parse(&text, &|obj| self.beside(obj, cx), &options).map_err(Unread::Scene)
    }
}

/// What is counted of a scene's file.
#[derive(serde::Deserialize)]
struct Counted {
    triangles: Vec<serde::de::IgnoredAny>,
    body: Option<CountedBody>,
}

#[derive(serde::Deserialize)]
struct CountedBody {
    obj: String,
}

/// Why there is no scene: the file is missing, or not one.
enum Unread {
    File(StageError),
    Scene(SceneError),
}

impl Unread {
    /// The error, at the parameter that mends it.
    fn told(self) -> StageError {
        match self {
            Unread::File(e) => e.at("file"),
            Unread::Scene(e @ SceneError::Unmerged { .. }) => scene_error(&e).at("weld"),
            Unread::Scene(e) => scene_error(&e).at("file"),
        }
    }
}

fn air(a: toile_cloth::energy::Air) -> Air {
    Air { density: a.density, normal: a.normal, tangential: a.tangential, wind: a.wind }
}

fn collider(
    scene: &scene::Scene,
    body: &Body,
    distances: Distances,
    cx: &Context,
) -> Result<Collider, StageError> {
    let body = Some(body).filter(|b| !b.triangles.is_empty());
    body.map(check_body).transpose()?;
    let card = ColliderCard {
        thickness: scene.material.thickness,
        friction: scene.body.as_ref().map_or(scene.material.friction, |b| b.friction),
        restitution: 0.0,
        self_collision: scene.self_collision,
        penalty: None,
    };
    let mut digester = Digester::new();
    body.iter().for_each(|b| b.digest(&mut digester));
    let signature = format!("Scene {card:?} body {}", digester.finish().short());
    Ok(Collider { scheme: Arc::new(BvhScheme::<Aabb>::new(card, body, distances, cx)?), signature })
}

/// The scene's body; one without vertices where it has none.
fn body_of(scene: &scene::Scene) -> Body {
    let (vertices, triangles) =
        scene.body.as_ref().map_or((&[][..], &[][..]), |b| (&b.vertices, &b.triangles));
    Body {
        positions: vertices.iter().map(|p| Point3::from(*p)).collect(),
        triangles: triangles.to_vec(),
        landmarks: BTreeMap::new(),
        measurements: BTreeMap::new(),
    }
}
