//! Assembles the [`System`] of one level from a scene. Cost: O(n).

use crate::contact::collision_surface::CollisionSurface;
use crate::energy::{Cloth, Models};
use crate::error::ClothError;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use crate::scene::Scene;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::elastic::Elastic;
use crate::statics::forces::force::Force;
use crate::statics::forces::loads::Loads;
use crate::statics::forces::ridges::Ridges;
use crate::statics::forces::seam_force::SeamForce;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::levels::pieces::Pieces;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Pressure of contact at distance 0, as a share of stretch stiffness per metre of thickness. Cloth
/// strained by 2 % around a limb of 0.1 m radius then sinks in by a fifth of its thickness. Softer
/// contact converges sooner.
const CONTACT_STIFFNESS: f64 = 0.5;

/// Greatest thickness of self-contact, as a share of the shortest edge: neighbours must not repel
/// each other.
const LAYER_SHARE: f64 = 0.25;

/// A collider: the solid that wears the garment, with its friction.
#[derive(Debug, Clone, Copy)]
pub struct Collider<'a> {
    /// The solid.
    pub surface: &'a dyn CollisionSurface,
    /// Coefficient of friction of cloth on it.
    pub friction: f64,
    #[cfg(toile_without = "body")]
    pub(crate) never: std::convert::Infallible,
}

/// The system of the nodes of one level: of all vertices where seams are `open`, otherwise of all
/// sewn nodes.
pub(crate) fn assemble<'a>(
    scene: &Scene,
    body: Option<Collider<'a>>,
    pieces: &Pieces,
    sheet: &Sheet,
    open: bool,
    models: Models,
) -> Result<System<'a>, ClothError> {
    let cloths = cloths(scene);
    let nodes = Nodes::new(pieces, sheet, open);
    let stiffness = contact_stiffness(sheet, &nodes, &cloths);
    let mut forces: Vec<Box<dyn Force>> = Vec::new();
    let mut ridges = None;
    if let Some(body) = body {
        let contact = BodyContact {
            keeps_edges_out: pieces.rest.len() == scene.rest.len(),
            ..body_contact(body, scene, sheet, &nodes, &cloths, open, stiffness.clone())
        };
        ridges = Ridges::new(body.surface, &contact, sheet);
        forces.push(Box::new(contact));
    }
    if scene.self_collision {
        forces.push(Box::new(self_contact(scene, sheet, &nodes, &cloths, open, stiffness)));
    }
    if let Some(ridges) = ridges {
        forces.push(Box::new(ridges));
    }
    let uncut = pieces.uncut().transpose()?;
    let one = [&scene.material];
    let cloth = Cloth {
        cut: uncut.as_ref().unwrap_or(sheet),
        fabrics: &cloths,
        fabric: &|t| pieces.cloth(t),
        limit: scene.strain_limit,
        ..Cloth::of(sheet, &one)
    };
    let creases = if open { Vec::new() } else { pieces.creases(sheet) };
    let elastic = Elastic::new(models, &cloth, pieces.springs(open), &creases)?;
    let gravity = if open { Vec3::zeros() } else { gravity(scene) };
    Ok(System {
        elastic,
        loads: Loads::new(sheet.masses().to_vec(), gravity),
        pinned: nodes.pinned,
        body: body.map(|b| b.surface),
        forces,
        brakes: vec![],
        targets: vec![],
    })
}

/// The panel of each node, counted from 1 (0 for none), and whether it is pinned.
struct Nodes {
    panel: Vec<usize>,
    pinned: Vec<bool>,
}

impl Nodes {
    fn new(pieces: &Pieces, sheet: &Sheet, open: bool) -> Self {
        let mut pinned = vec![false; sheet.vertex_count()];
        let mut panel = vec![0; sheet.vertex_count()];
        for (v, &p) in pieces.pinned.iter().enumerate() {
            let node = if open { v } else { pieces.node[v] as usize };
            pinned[node] |= p;
            panel[node] = pieces.panel[v] as usize;
        }
        Self { panel, pinned }
    }
}

/// Stiffness of contact at each node, N/m.
fn contact_stiffness(sheet: &Sheet, nodes: &Nodes, cloths: &[&Fabric]) -> Vec<f64> {
    sheet
        .masses()
        .iter()
        .zip(&nodes.panel)
        .map(|(w, &p)| (w, cloths[p]))
        .map(|(w, c)| CONTACT_STIFFNESS * c.stretch() / c.thickness * w / c.density)
        .collect()
}

/// Contact with the body, without friction while seams are `open`.
fn body_contact(
    body: Collider<'_>,
    scene: &Scene,
    sheet: &Sheet,
    nodes: &Nodes,
    cloths: &[&Fabric],
    open: bool,
    stiffness: Vec<f64>,
) -> BodyContact {
    let longest = sheet.edges().iter().map(|e| e.rest_length).fold(0.0, f64::max);
    let thickness = |p: &usize| cloths[*p].thickness;
    let friction = |p: usize| {
        let own = p.checked_sub(1).and_then(|k| scene.panels[k].body_friction);
        if open { 0.0 } else { own.unwrap_or(body.friction) }
    };
    let n = sheet.vertex_count();
    BodyContact {
        friction: nodes.panel.iter().map(|&p| friction(p)).collect(),
        disabled_friction: vec![0.0; n],
        offsets: nodes.panel.iter().map(thickness).collect(),
        offset: nodes.panel.iter().map(thickness).fold(f64::INFINITY, f64::min),
        depth: longest.clamp(0.02, 0.1),
        edges: sheet.distinct_edges().collect(),
        bridges: vec![],
        keeps_edges_out: false,
        grows_offsets: false,
        stiffens_inside: false,
        lets_through: false,
        #[cfg(toile_without = "body")]
        never: body.never,
        stiffness,
        overloaded: vec![],
        touches: vec![],
        memory: vec![None; n],
        slides: vec![Vec3::zeros(); n],
        distance_cache: vec![],
    }
}

/// Contact of the cloth with itself, without friction while seams are `open`.
fn self_contact(
    scene: &Scene,
    sheet: &Sheet,
    nodes: &Nodes,
    cloths: &[&Fabric],
    open: bool,
    stiffness: Vec<f64>,
) -> SelfContact {
    let mut corners = vec![0u16; sheet.vertex_count()];
    sheet.triangles().iter().flatten().for_each(|&v| corners[v as usize] += 1);
    let thickness = layer_thickness(cloths, nodes.panel.iter().copied(), sheet);
    let edge = sheet.edges().iter().map(|e| e.rest_length).sum::<f64>() / sheet.edges().len().max(1) as f64;
    let order = |p: &usize| p.checked_sub(1).map_or(0, |k| scene.panels[k].layer);
    let no_friction = cloths.iter().all(|c| c.friction == 0.0);
    let ordered = scene.panels.iter().any(|p| p.layer > 0);
    SelfContact {
        thickness,
        edge,
        stiffness,
        friction: if open || no_friction {
            vec![]
        } else {
            nodes.panel.iter().map(|&p| cloths[p].friction).collect()
        },
        corners,
        order: if ordered { nodes.panel.iter().map(order).collect() } else { vec![] },
        ..SelfContact::default()
    }
}

/// Thickness of self-contact on a level whose nodes belong to these panels, counted from 1, m.
pub(crate) fn layer_thickness(cloths: &[&Fabric], panels: impl Iterator<Item = usize>, sheet: &Sheet) -> f64 {
    let shortest = sheet.edges().iter().map(|e| e.rest_length).fold(f64::INFINITY, f64::min);
    panels.map(|p| cloths[p].thickness).fold(0.0, f64::max).min(LAYER_SHARE * shortest)
}

/// The fabric of vertices without a panel, then that of each panel.
pub(crate) fn cloths(scene: &Scene) -> Vec<&Fabric> {
    std::iter::once(&scene.material).chain((0..scene.panels.len()).map(|k| scene.fabric_of(k))).collect()
}

/// Gravity in the last phase.
pub(crate) fn gravity(scene: &Scene) -> Vec3 {
    scene.phases.last().map(|p| p.gravity).unwrap_or_default()
}

/// Force per metre of seams that are not joined, as a share of stretch stiffness: strong enough to
/// carry the garment without a gap.
pub(crate) const KEPT_FORCE: f64 = 0.1;

/// The closing forces of the seams that are not joined.
pub(crate) fn kept_seam_forces(scene: &Scene, pieces: &Pieces, join_gap: f64) -> Vec<SeamForce> {
    let force = KEPT_FORCE * strongest(&cloths(scene)) * spacing(pieces, &pieces.seam_pairs());
    pieces
        .kept_pairs()
        .into_iter()
        .map(|nodes| SeamForce { nodes, force, softening: 2.0 * join_gap })
        .collect()
}

/// Stretch stiffness of the stiffest panel, N/m.
pub(crate) fn strongest(cloths: &[&Fabric]) -> f64 {
    cloths.iter().map(|c| c.stretch()).fold(0.0, f64::max)
}

/// Mean length of seam per pair, m.
pub(crate) fn spacing(pieces: &Pieces, pairs: &[[u32; 2]]) -> f64 {
    let mut sewn = vec![false; pieces.rest.len()];
    pairs.iter().flatten().for_each(|&v| sewn[v as usize] = true);
    let edges = pieces.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let along: Vec<f64> = edges
        .filter(|e| e.iter().all(|&v| sewn[v as usize]))
        .map(|[a, b]| (pieces.rest[a as usize] - pieces.rest[b as usize]).norm())
        .collect();
    if along.is_empty() { 0.01 } else { along.iter().sum::<f64>() / along.len() as f64 }
}
