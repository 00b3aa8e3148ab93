//! For tests: the system of a scene's sewn cloth on its body.
#![allow(clippy::unwrap_used)]

use crate::contact::body::Body;
use crate::energy::Models;
use crate::mesh::Sheet;
use crate::scene::Scene;
use crate::statics::forces::system::System;
use crate::statics::levels::assemble::{Collider, assemble, cloths};
use crate::statics::levels::pieces::Pieces;

pub(crate) fn on_its_body(scene: &Scene, check: impl FnOnce(System<'_>, &Body, &Sheet)) {
    let worn = scene.body.as_ref().unwrap();
    let body = Body::new(worn.vertices.clone(), &worn.triangles);
    let collider = Collider { surface: &body, friction: worn.friction };
    let pieces = Pieces::new(scene);
    let sheet = pieces.sewn_sheet(&cloths(scene)).unwrap();
    let system = assemble(scene, Some(collider), &pieces, &sheet, false, Models::STATIC).unwrap();
    check(system, &body, &sheet);
}
