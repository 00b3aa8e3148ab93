//! Garments as the engine's scenes and back.

use nalgebra::Vector3;
use std::sync::Arc;
use toile_cloth::scene::{Material, Panel, Phase, Scene, Seam};
use toile_core::artifact::{
    Curve, Fabric, Garment, GarmentPanel, GarmentSeam, Point2, Point3, SeamKind, SeamState, SolveStatus,
};

/// The scene of a garment under `gravity`; the body answers for itself.
///
/// `thickness` is the distance at which cloth is held off the body and off itself, metres.
pub fn scene_of(
    garment: &Garment,
    gravity: Vector3<f64>,
    thickness: f64,
    friction: f64,
    self_collision: bool,
) -> Scene {
    Scene {
        name: "garment".into(),
        rest: garment.rest.iter().map(|p| p.coords).collect(),
        positions: garment.positions.iter().map(|p| p.coords).collect(),
        triangles: garment.triangles.clone(),
        panels: garment.panels.iter().map(panel).collect(),
        seams: garment.seams.iter().map(seam).collect(),
        pinned: garment.pinned.clone(),
        body: None,
        material: material(garment, thickness, friction),
        phases: vec![Phase { name: "drape".into(), seconds: 0.0, gravity }],
        self_collision,
    }
}

fn panel(p: &GarmentPanel) -> Panel {
    Panel { name: p.name.clone(), vertices: p.vertices.clone(), triangles: p.triangles.clone() }
}

fn seam(s: &GarmentSeam) -> Seam {
    Seam { name: s.name.clone(), pairs: s.pairs.clone() }
}

fn material(garment: &Garment, thickness: f64, friction: f64) -> Material {
    let fabric = garment.panels.first().map(|p| p.fabric.as_ref());
    let slope = |of: fn(&Fabric) -> &Curve| fabric.map_or(0.0, |f| of(f).at(0.0).1);
    let (warp, weft) = (slope(|f| &f.warp), slope(|f| &f.weft));
    Material {
        area_density: fabric.map_or(0.0, |f| f.area_density),
        stretch: 0.5 * (warp + weft),
        shear: slope(|f| &f.shear),
        bend: fabric.map_or(0.0, |f| 0.5 * (f.bending_warp + f.bending_weft)),
        friction,
        thickness,
    }
}

/// A scene as a garment, at its start.
pub fn garment_of(scene: &Scene) -> Garment {
    let n = scene.positions.len();
    let fabric = Arc::new(fabric_of(&scene.name, &scene.material));
    Garment {
        positions: scene.positions.iter().map(|p| Point3::from(*p)).collect(),
        velocities: vec![Vector3::zeros(); n],
        rest: scene.rest.iter().map(|p| Point2::from(*p)).collect(),
        triangles: scene.triangles.clone(),
        panels: scene.panels.iter().map(|p| garment_panel(p, scene, &fabric)).collect(),
        seams: scene.seams.iter().map(garment_seam).collect(),
        weld: (0..n as u32).collect(),
        pinned: scene.pinned.clone(),
        status: SolveStatus::default(),
    }
}

fn garment_seam(s: &Seam) -> GarmentSeam {
    GarmentSeam {
        name: s.name.clone(),
        kind: SeamKind::Matched,
        pairs: s.pairs.clone(),
        state: SeamState::Open,
    }
}

fn garment_panel(p: &Panel, scene: &Scene, fabric: &Arc<Fabric>) -> GarmentPanel {
    GarmentPanel {
        name: p.name.clone(),
        vertices: p.vertices.clone(),
        triangles: p.triangles.clone(),
        boundary: outline(&scene.triangles[p.triangles.clone()]),
        photo_px: Vec::new(),
        fabric: fabric.clone(),
    }
}

fn fabric_of(name: &str, m: &Material) -> Fabric {
    Fabric {
        name: name.to_owned(),
        area_density: m.area_density,
        warp: Curve::linear(m.stretch),
        weft: Curve::linear(m.stretch),
        shear: Curve::linear(m.shear),
        bending_warp: m.bend,
        bending_weft: m.bend,
        thickness: m.thickness,
        friction: m.friction,
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
    let mut weld = garment.weld.clone();
    for &[a, b] in garment.seams.iter().flat_map(|s| &s.pairs) {
        let (a, b) = (root(&weld, a), root(&weld, b));
        weld[a.max(b) as usize] = a.min(b);
    }
    garment.weld = (0..weld.len() as u32).map(|v| root(&weld, v)).collect();
    garment.seams.iter_mut().for_each(|s| s.state = SeamState::Closed);
}

fn root(weld: &[u32], mut v: u32) -> u32 {
    while weld[v as usize] != v {
        v = weld[v as usize];
    }
    v
}
