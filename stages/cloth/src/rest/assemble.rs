//! What acts on the nodes of one level: a scene turned into a [`System`].

use super::elastic::{Elastic, Stiffness};
use super::layers::Layers;
use super::pieces::Pieces;
use super::system::{Support, System};
use crate::contact::body::Body;
use crate::mesh::Sheet;
use crate::scene::Scene;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Pressure that the contact layer carries at full depth, as a share of stretch stiffness per metre of thickness: a cloth
/// strained by 2 % around a limb of 0.1 m radius then sinks in by a fifth of its thickness. Softer converges sooner.
const CONTACT_STIFFNESS: f64 = 0.5;

/// The layer between cloth and cloth is at most this share of the shortest edge, or neighbours would push each other.
const LAYER_SHARE: f64 = 0.25;

/// The system of one level's nodes: of every vertex where seams are `open`, otherwise of every sewn point.
pub(super) fn assemble<'a>(
    scene: &Scene,
    body: Option<&'a Body>,
    pieces: &Pieces,
    sheet: &Sheet,
    open: bool,
) -> System<'a> {
    let m = &scene.material;
    let n = sheet.vertex_count();
    let mut pinned = vec![false; n];
    for (v, &p) in pieces.pinned.iter().enumerate() {
        pinned[if open { v } else { pieces.point[v] as usize }] |= p;
    }
    let stiffness: Vec<f64> = sheet
        .masses()
        .iter()
        .map(|w| CONTACT_STIFFNESS * m.stretch / m.thickness * w / m.area_density)
        .collect();
    let longest = sheet.edges().iter().map(|e| e.rest_length).fold(0.0, f64::max);
    let support = scene.body.as_ref().zip(body).map(|(b, body)| Support {
        body,
        friction: b.friction,
        offsets: vec![m.thickness; n],
        offset: m.thickness,
        depth: longest.clamp(0.02, 0.1),
        edges: sheet.edges().iter().map(|e| (e.vertices, e.rest_length)).collect(),
        clear: pieces.rest.len() == scene.rest.len(),
        stiffness: stiffness.clone(),
    });
    let mut corners = vec![0u16; n];
    sheet.triangles().iter().flatten().for_each(|&v| corners[v as usize] += 1);
    let shortest = sheet.edges().iter().map(|e| e.rest_length).fold(f64::INFINITY, f64::min);
    let thickness = m.thickness.min(LAYER_SHARE * shortest);
    let layers = scene.self_collision.then(|| Layers { thickness, stiffness, corners, ..Layers::default() });
    let elastic =
        Elastic::new(sheet, Stiffness { weft: m.stretch, warp: m.stretch, shear: m.shear, bend: m.bend });
    System {
        elastic,
        masses: sheet.masses().to_vec(),
        gravity: if open { Vec3::zeros() } else { gravity(scene) },
        pinned,
        threads: vec![],
        support,
        layers,
        touches: vec![],
        anchors: vec![None; n],
        slides: vec![Vec3::zeros(); n],
        loads: vec![0.0; n],
        seen: vec![],
        pulls: vec![],
    }
}

/// The gravity in the end.
pub(super) fn gravity(scene: &Scene) -> Vec3 {
    scene.phases.last().map(|p| p.gravity).unwrap_or_default()
}
