//! Garments as the engine's scenes and back.

use super::cloth_error;
use nalgebra::Vector3;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_cloth::energy::Air;
use toile_cloth::error::ClothError;
use toile_cloth::fabric as engine;
use toile_cloth::scene::held::{FIGURES, contact, figures};
use toile_cloth::scene::{Band, Held as EngineHeld, Panel, Phase, Scene, Seam};
use toile_core::StageError;
use toile_core::artifact::join_pairs;
use toile_core::artifact::{
    Curve, Fabric, Garment, GarmentPanel, GarmentSeam, Held, Point2, Point3, SeamKind, SeamState, SolveStatus,
};

/// What a garment's scene takes from elsewhere than the garment.
#[derive(Debug, Clone, Copy)]
pub struct SceneSetting {
    /// m/s².
    pub gravity: Vector3<f64>,
    /// What it moves in.
    pub air: Option<Air>,
    /// Distance at which cloth is held off the body and off itself, m.
    pub thickness: f64,
    /// Whether cloth is kept out of itself.
    pub self_collision: bool,
}

/// The scene of a garment; the body answers for itself.
///
/// # Errors
/// A fabric whose curves the engine does not take.
pub fn scene_of(garment: &Garment, setting: &SceneSetting) -> Result<Scene, StageError> {
    let mut panels = Vec::with_capacity(garment.panels.len());
    for p in &garment.panels {
        let material = engine_fabric(&p.fabric, setting.thickness).map_err(|e| cloth_error(&e))?;
        let panel = Panel::new(p.name.clone(), p.vertices.clone(), p.triangles.clone());
        panels.push(Panel { material: Some(material), layer: p.layer, ..panel });
    }
    let material = panels.first().and_then(|p| p.material.clone());
    Ok(Scene {
        name: "garment".into(),
        rest: garment.rest.iter().map(|p| p.coords).collect(),
        positions: garment.positions.iter().map(|p| p.coords).collect(),
        triangles: garment.triangles.clone(),
        panels,
        seams: seams(garment),
        bands: bands(garment),
        pinned: garment.pinned.clone(),
        body: None,
        material: material.unwrap_or_else(|| engine::Fabric::isotropic(0.1, 500.0, 0.0, 1e-5)),
        strain_limit: None,
        phases: vec![Phase {
            name: "drape".into(),
            seconds: 0.0,
            gravity: setting.gravity,
            air: setting.air,
        }],
        self_collision: setting.self_collision,
        held: engine_held(&garment.status.held),
    })
}

/// How friction holds a garment, for the engine.
fn engine_held(held: &Held) -> EngineHeld {
    let figures = held.figures.chunks_exact(FIGURES).filter_map(|f| f.try_into().ok());
    EngineHeld {
        slides: held.slides.clone(),
        offsets: held.offsets.clone(),
        folds: held.folds.clone(),
        contacts: held.contacts.iter().zip(figures).map(|(nodes, f)| contact(*nodes, f)).collect(),
    }
}

/// The same of the engine's.
pub fn held_of(held: &EngineHeld) -> Held {
    Held {
        slides: held.slides.clone(),
        offsets: held.offsets.clone(),
        folds: held.folds.clone(),
        contacts: held.contacts.iter().map(|c| c.nodes).collect(),
        figures: held.contacts.iter().flat_map(figures).collect(),
    }
}

/// The engine's fabric, which contact keeps at a distance of `thickness`, m.
///
/// # Errors
/// A fabric whose curves the engine does not take.
pub fn engine_fabric(f: &Fabric, thickness: f64) -> Result<engine::Fabric, ClothError> {
    let curve = |c: &Curve| {
        let points: Vec<[f64; 2]> = c.0.iter().map(|&(strain, force)| [strain, force]).collect();
        engine::Curve::through(&points)
    };
    Ok(engine::Fabric {
        density: f.area_density,
        warp: curve(&f.warp)?,
        weft: curve(&f.weft)?,
        poisson: 0.0,
        shear: curve(&f.shear)?,
        bending_warp: f.bending_warp,
        bending_weft: f.bending_weft,
        bending_friction_warp: f.bending_friction_warp,
        bending_friction_weft: f.bending_friction_weft,
        thickness,
        friction: f.friction,
        damping: 0.0,
    })
}

/// The garment's seams; a pair in which two seams meet belongs to the first.
fn seams(garment: &Garment) -> Vec<Seam> {
    let mut known = BTreeSet::new();
    let mut seam = |s: &GarmentSeam| {
        let is_new = |p: &&[u32; 2]| p[0] != p[1] && known.insert([p[0].min(p[1]), p[0].max(p[1])]);
        let seam = Seam::new(s.name.clone(), s.pairs.iter().filter(is_new).copied().collect());
        match s.kind {
            SeamKind::Matched
            | SeamKind::Dart
            | SeamKind::Pleat(_)
            | SeamKind::Elastic { .. }
            | SeamKind::Patch => seam,
            SeamKind::Folded { angle } => Seam { fold: Some(angle), ..seam },
            SeamKind::Gathered => Seam { gather: Some(gather(&seam.pairs, &garment.rest)), ..seam },
        }
    };
    garment.seams.iter().map(&mut seam).filter(|s| !s.pairs.is_empty()).collect()
}

/// The elastic bands along the garment's seams and edges.
fn bands(garment: &Garment) -> Vec<Band> {
    let band = |s: &GarmentSeam| match s.kind {
        SeamKind::Elastic { ratio, stiffness } => {
            let vertices = s.pairs.iter().map(|p| p[0]).collect();
            Some(Band { name: s.name.clone(), vertices, ratio, stiffness })
        }
        SeamKind::Matched
        | SeamKind::Gathered
        | SeamKind::Dart
        | SeamKind::Pleat(_)
        | SeamKind::Patch
        | SeamKind::Folded { .. } => None,
    };
    garment.seams.iter().filter_map(band).filter(|b| b.vertices.len() > 1).collect()
}

/// How many times longer one side of a seam is than the other.
fn gather(pairs: &[[u32; 2]], rest: &[Point2]) -> f64 {
    let side = |k: usize| -> f64 {
        pairs.windows(2).map(|w| (rest[w[1][k] as usize] - rest[w[0][k] as usize]).norm()).sum()
    };
    let (a, b) = (side(0), side(1));
    if a.min(b) > 0.0 { a.max(b) / a.min(b) } else { 1.0 }
}

/// A scene as a garment, at its start.
pub fn garment_of(scene: &Scene) -> Garment {
    let n = scene.positions.len();
    Garment {
        positions: scene.positions.iter().map(|p| Point3::from(*p)).collect(),
        velocities: vec![Vector3::zeros(); n],
        rest: scene.rest.iter().map(|p| Point2::from(*p)).collect(),
        triangles: scene.triangles.clone(),
        panels: (0..scene.panels.len()).map(|k| garment_panel(k, scene)).collect(),
        seams: scene.seams.iter().map(garment_seam).chain(scene.bands.iter().map(elastic)).collect(),
        weld: (0..n as u32).collect(),
        pinned: scene.pinned.clone(),
        status: SolveStatus { held: held_of(&scene.held), ..SolveStatus::default() },
        starts: Vec::new(),
        motion: None,
    }
}

/// A band as a seam of one side: pairs of a vertex with itself.
fn elastic(b: &Band) -> GarmentSeam {
    GarmentSeam {
        name: b.name.clone(),
        kind: SeamKind::Elastic { ratio: b.ratio, stiffness: b.stiffness },
        pairs: b.vertices.iter().map(|v| [*v, *v]).collect(),
        state: SeamState::Open,
    }
}

fn garment_seam(s: &Seam) -> GarmentSeam {
    let gathered = if s.gather.is_some() { SeamKind::Gathered } else { SeamKind::Matched };
    GarmentSeam {
        name: s.name.clone(),
        kind: s.fold.map_or(gathered, |angle| SeamKind::Folded { angle }),
        pairs: s.pairs.clone(),
        state: SeamState::Open,
    }
}

fn garment_panel(k: usize, scene: &Scene) -> GarmentPanel {
    let p = &scene.panels[k];
    GarmentPanel {
        name: p.name.clone(),
        vertices: p.vertices.clone(),
        triangles: p.triangles.clone(),
        boundary: outline(&scene.triangles[p.triangles.clone()]),
        photo_px: Vec::new(),
        fabric: Arc::new(fabric_of(&p.name, scene.fabric_of(k))),
        layer: p.layer,
    }
}

fn fabric_of(panel: &str, f: &engine::Fabric) -> Fabric {
    let curve = |c: &engine::Curve| Curve(c.points().into_iter().map(|[s, f]| (s, f)).collect());
    Fabric {
        name: format!("fabric of {panel}"),
        area_density: f.density,
        warp: curve(&f.warp),
        weft: curve(&f.weft),
        shear: curve(&f.shear),
        bending_warp: f.bending_warp,
        bending_weft: f.bending_weft,
        bending_friction_warp: f.bending_friction_warp,
        bending_friction_weft: f.bending_friction_weft,
        thickness: f.thickness,
        friction: f.friction,
        damping: 0.0,
        source: "the scene's file".into(),
    }
}

/// The longest loop of edges that have one triangle.
fn outline(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut sides: Vec<[u32; 2]> =
        triangles.iter().flat_map(|t| (0..3).map(move |k| [t[k], t[(k + 1) % 3]])).collect();
    sides.sort_unstable();
    let is_inner = |s: &[u32; 2]| sides.binary_search(&[s[1], s[0]]).is_ok();
    let mut open: Vec<[u32; 2]> = sides.iter().filter(|s| !is_inner(s)).copied().collect();
    let mut longest = Vec::new();
    while let Some([first, mut at]) = open.pop() {
        let mut round = vec![first];
        while at != first {
            round.push(at);
            let Some(next) = open.iter().position(|s| s[0] == at) else { break };
            at = open.swap_remove(next)[1];
        }
        if round.len() > longest.len() {
            longest = round;
        }
    }
    longest
}

/// Marks every seam closed and joins its vertices: each names the least vertex at its place.
pub fn weld_seams(garment: &mut Garment) {
    join_pairs(&mut garment.weld, garment.seams.iter().flat_map(|s| &s.pairs));
    garment.seams.iter_mut().for_each(|s| s.state = SeamState::Closed);
}
