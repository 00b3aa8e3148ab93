//! Scenes made by a program: panels are added one after the other, then sewn and dressed.
//!
//! ```
//! use nalgebra::{Vector2, Vector3};
//! use toile_cloth::fabric::Fabric;
//! use toile_cloth::scene::{Scene, Seam};
//!
//! let rest = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|[x, y]| Vector2::new(x, y));
//! let at = |z: f64| rest.map(|p| Vector3::new(p.x, p.y, z));
//! // 0.12 kg/m2, 10 kN/m, no Poisson effect, 1e-5 N m.
//! let mut scene = Scene::new("pouch", Fabric::isotropic(0.12, 1e4, 0.0, 1e-5));
//! let front = scene.add_panel("front", &rest, &at(0.05), &[[0, 1, 2]]);
//! let back = scene.add_panel("back", &rest, &at(-0.05), &[[0, 1, 2]]);
//! scene.seams.push(Seam::new("side", vec![[front.start, back.start], [front.start + 1, back.start + 1]]));
//! scene.check()?;
//! # Ok::<(), toile_cloth::scene::SceneError>(())
//! ```

use super::{Held, Panel, Phase, Scene, SceneBody, SceneError, Seam, check};
use crate::error::ClothError;
use crate::fabric::Fabric;
use nalgebra::{Vector2, Vector3};
use std::ops::Range;

/// Standard gravity, m/s².
pub const GRAVITY: f64 = 9.81;

impl Scene {
    /// A scene without cloth yet: sewn without weight, then draped under gravity, with
    /// self-collision.
    #[must_use]
    pub fn new(name: impl Into<String>, material: Fabric) -> Self {
        let phase = |name: &str, g: f64| Phase {
            name: name.into(),
            seconds: 1.0,
            gravity: Vector3::new(0.0, -g, 0.0),
            air: None,
        };
        Self {
            name: name.into(),
            rest: vec![],
            positions: vec![],
            triangles: vec![],
            panels: vec![],
            seams: vec![],
            bands: vec![],
            pinned: vec![],
            body: None,
            material,
            strain_limit: None,
            phases: vec![phase("sew", 0.0), phase("drape", GRAVITY)],
            self_collision: true,
            held: Held::default(),
        }
    }

    /// Adds a panel of the scene's material: its flat shape (metres, warp along y), where it
    /// starts, its triangles counted from its own first vertex. Returns its vertices' numbers in
    /// the scene; change `panels.last_mut()` for a material of its own.
    pub fn add_panel(
        &mut self,
        name: impl Into<String>,
        rest: &[Vector2<f64>],
        positions: &[Vector3<f64>],
        triangles: &[[u32; 3]],
    ) -> Range<u32> {
        let (first, from) = (self.rest.len(), self.triangles.len());
        self.rest.extend_from_slice(rest);
        self.positions.extend_from_slice(positions);
        // An index too large stays too large, and is named by the check.
        self.triangles.extend(triangles.iter().map(|t| t.map(|v| v.saturating_add(first as u32))));
        self.panels.push(Panel::new(name, first..self.rest.len(), from..self.triangles.len()));
        first as u32..self.rest.len() as u32
    }

    /// Checks every index and number: what [`super::parse`] checks, for scenes made otherwise.
    ///
    /// # Errors
    /// The first [`SceneError`].
    pub fn check(&self) -> Result<(), SceneError> {
        check::check(self)
    }

    /// Whether the air of the last phase is still, as states of rest require.
    ///
    /// # Errors
    /// [`ClothError::Wind`].
    pub fn check_still(&self) -> Result<(), ClothError> {
        self.phases.last().and_then(|p| p.air).map_or(Ok(()), |air| air.check_still())
    }

    /// The fabric of panel `k`.
    #[must_use]
    pub fn fabric_of(&self, k: usize) -> &Fabric {
        self.panels.get(k).and_then(|p| p.material.as_ref()).unwrap_or(&self.material)
    }
}

impl Panel {
    /// A panel of the scene's material.
    #[must_use]
    pub fn new(name: impl Into<String>, vertices: Range<usize>, triangles: Range<usize>) -> Self {
        Self { name: name.into(), vertices, triangles, material: None, body_friction: None, layer: 0 }
    }
}

impl Seam {
    /// A seam whose pairs become one point each.
    #[must_use]
    pub fn new(name: impl Into<String>, pairs: Vec<[u32; 2]>) -> Self {
        Self { name: name.into(), pairs, joined: true, gather: None, fold: None }
    }
}

impl SceneBody {
    /// A closed mesh that faces outwards.
    #[must_use]
    pub fn new(vertices: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>, friction: f64) -> Self {
        Self { vertices, triangles, friction }
    }
}
