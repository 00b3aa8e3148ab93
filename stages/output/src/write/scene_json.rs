//! `SceneJson`: the placed garment as a prepared scene for other programs.

use crate::file_names::check_name;
use nalgebra::Vector3;
use toile_cloth::scene::{Phase, SceneBody, body_to_obj, to_json};
use toile_core::prelude::*;
use toile_drape::engine::{SceneSetting, scene_of};

/// Writes the garment, its seams, fabric and body as a prepared scene, `garment-scene-1`.
///
/// `Scene` reads it again, and programs that know the form can be compared with our solvers on a
/// garment of ours. Take the garment before it is sewn: `SceneJson(from: "Arrange")`. The body's
/// mesh is written beside it as OBJ. The form is described in docs/reference/scene.md.
#[stage(
    role = Writer,
    version = 2,
    source = "garment-scene-1, docs/reference/scene.md",
    example = "SceneJson(name: \"vest\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct SceneJson {
    /// The files' name without extension.
    #[param(default = "scene".to_owned())]
    pub name: String,
    /// How long the seams pull before there is weight.
    #[param(default = 1.0, min = 0.0, max = 1000.0, unit = "s")]
    pub sew: f64,
    /// How long the garment falls and settles.
    #[param(default = 1.0, min = 0.0, max = 1000.0, unit = "s")]
    pub drape: f64,
    /// Downward acceleration in the end.
    #[param(default = 9.81, min = 0.0, max = 1000.0, unit = "m/s2")]
    pub gravity: f64,
}

/// Distance at which cloth is held off itself without a collider, metres.
const PLAIN_THICKNESS: f64 = 1e-3;
/// Coefficient of friction on the body without a collider.
const PLAIN_FRICTION: f64 = 0.3;

#[stage]
impl SceneJson {
    pub(super) fn run(
        &self,
        garment: &Garment,
        body: Option<&Body>,
        collider: Option<&Collider>,
        _cx: &Context,
    ) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        let card = collider.map(|c| c.scheme.card());
        let down = Vector3::new(0.0, -self.gravity, 0.0);
        let setting = SceneSetting {
            gravity: down,
            air: None,
            thickness: card.map_or(PLAIN_THICKNESS, |c| c.thickness),
            self_collision: card.is_none_or(|c| c.self_collision),
        };
        let mut scene = scene_of(garment, &setting)?;
        scene.name.clone_from(&self.name);
        let phase = |name: &str, seconds, gravity| Phase { name: name.into(), seconds, gravity, air: None };
        scene.phases = vec![phase("sew", self.sew, Vector3::zeros()), phase("drape", self.drape, down)];
        scene.body = body.filter(|b| !b.triangles.is_empty()).map(|b| SceneBody {
            vertices: b.positions.iter().map(|p| p.coords).collect(),
            triangles: b.triangles.clone(),
            friction: card.map_or(PLAIN_FRICTION, |c| c.friction),
        });
        let obj = format!("{}_body.obj", self.name);
        let json = OutputFile::new(format!("{}.json", self.name), to_json(&scene, &obj).into());
        let body = OutputFile::new(obj, body_to_obj(&scene).into());
        Ok(OutputFiles(if scene.body.is_some() { vec![json, body] } else { vec![json] }))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        crate::file_names::check_name(&self.name).err().into_iter().collect()
    }
}
