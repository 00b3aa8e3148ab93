//! A whole scene to rest: sewn on the coarsest level, draped there, and carried from level to level.

use super::coarsen::{Coarser, coarsen};
use super::elastic::{Elastic, Stiffness};
use super::newton::{Outcome, Pace, relax};
use super::pieces::Pieces;
use super::system::{Support, System, Thread};
use super::layers::Layers;
use crate::contact::body::Body;
use crate::contact::tree::ClothTree;
use crate::mesh::Sheet;
use crate::scene::Scene;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// What came out.
#[derive(Debug, Clone)]
pub struct Rested {
    /// Position of every vertex of the scene, m.
    pub positions: Vec<Vec3>,
    /// The finest level's end.
    pub outcome: Outcome,
    /// Nodes, steps and seconds of each level, coarse to fine.
    pub levels: Vec<(usize, usize, f64)>,
}

/// Solves a scene.
pub fn solve(scene: &Scene) -> Result<Rested, Box<dyn std::error::Error>> {
    let clock = std::time::Instant::now();
    let m = scene.material;
    let stiffness = Stiffness { weft: m.stretch, warp: m.stretch, shear: m.shear, bend: m.bend };
    let body = scene.body.as_ref().map(|b| Body::new(b.vertices.clone(), &b.triangles));
    let mut levels: Vec<Coarser> = Vec::new();
    let finest = Pieces::new(scene);
    let coarsest = std::env::var("COARSEST").ok().and_then(|v| v.parse().ok()).unwrap_or(150);
    while levels.last().map_or(&finest, |l| &l.pieces).points > coarsest {
        match coarsen(levels.last().map_or(&finest, |l| &l.pieces)) {
            Some(c) => levels.push(c),
            None => break,
        }
    }
    let mut start = scene.positions.clone();
    for l in &levels {
        start = l.kept.iter().map(|&v| start[v as usize]).collect();
    }
    eprintln!("setup {:?}", clock.elapsed());
    let gravity = scene.phases.iter().rev().map(|p| p.gravity).find(|g| g.norm() > 0.0).unwrap_or_default();
    let kappa = std::env::var("KAPPA").ok().and_then(|v| v.parse().ok()).unwrap_or(0.5);
    let system = |pieces: &Pieces, sheet: &Sheet, open: bool, threads: Vec<Thread>| {
        let n = sheet.vertex_count();
        let mut pinned = vec![false; n];
        for (v, &p) in pieces.pinned.iter().enumerate() {
            pinned[if open { v } else { pieces.point[v] as usize }] |= p;
        }
        let support = scene.body.as_ref().zip(body.as_ref()).map(|(b, body)| Support {
            body,
            friction: b.friction,
            offsets: vec![m.thickness; n],
            stiffness: sheet.masses().iter().map(|w| kappa * m.stretch / m.thickness * w / m.area_density).collect(),
        });
        let mut corners = vec![0u16; n];
        sheet.triangles().iter().flatten().for_each(|&v| corners[v as usize] += 1);
        let layers = scene.self_collision.then(|| Layers {
            thickness: m.thickness,
            stiffness: sheet.masses().iter().map(|w| kappa * m.stretch / m.thickness * w / m.area_density).collect(),
            corners,
            ..Layers::default()
        });
        System {
            layers,
            elastic: Elastic::new(sheet, stiffness),
            masses: sheet.masses().to_vec(),
            gravity: if open { Vec3::zeros() } else { gravity },
            pinned,
            threads,
            support,
            touches: vec![],
            anchors: vec![None; n],
        }
    };
    let pieces = levels.last().map_or(&finest, |l| &l.pieces);
    let mut report = Vec::new();
    let open_masses = pieces.open_sheet(m.area_density)?.masses().to_vec();
    if !scene.seams.is_empty() {
        let t = std::time::Instant::now();
        let sheet = pieces.open_sheet(m.area_density)?;
        let pairs = pieces.seam_pairs();
        let threads = pairs.iter().map(|&nodes| Thread { nodes, force: 0.3, soft: 0.001 }).collect();
        let mut s = system(pieces, &sheet, true, threads);
        let layout = start.clone();
        let pace = Pace { first: 0.02, longest: 0.2, steps: 60, speed: 1e-3, farthest: 0.05 };
        let out = relax(&mut s, &layout, scene.self_collision.then(|| ClothTree::new(&sheet, &layout)).as_ref(), &mut start, &pace, &mut |_, x, _| {
            pairs.iter().all(|&[a, b]| (x[a as usize] - x[b as usize]).norm() < 5e-4)
        })?;
        let gap = pairs.iter().map(|&[a, b]| (start[a as usize] - start[b as usize]).norm()).fold(0.0, f64::max);
        eprintln!("sewn: gap {gap:.2e} {out:?}");
        report.push((sheet.vertex_count(), out.steps, t.elapsed().as_secs_f64()));
    }
    let mut x = pieces.sew(&start, &open_masses);
    let mut outcome = Outcome::default();
    for k in (0..=levels.len()).rev() {
        let t = std::time::Instant::now();
        let pieces = if k == 0 { &finest } else { &levels[k - 1].pieces };
        let sheet = pieces.sewn_sheet(m.area_density)?;
        let mut s = system(pieces, &sheet, false, vec![]);
        let place: Vec<Vec3> = match k {
            0 => scene.positions.clone(),
            _ => (0..k).fold(scene.positions.clone(), |p, l| levels[l].kept.iter().map(|&v| p[v as usize]).collect()),
        };
        let layout = pieces.sew(&place, &vec![1.0; place.len()]);
        let steps = std::env::var("STEPS").ok().and_then(|v| v.parse().ok()).unwrap_or(100);
        let pace = Pace { first: 0.05, longest: 0.3, steps, speed: 1e-3, farthest: 0.1 };
        outcome = relax(&mut s, &layout, scene.self_collision.then(|| ClothTree::new(&sheet, &layout)).as_ref(), &mut x, &pace, &mut |_, _, _| false)?;
        report.push((sheet.vertex_count(), outcome.steps, t.elapsed().as_secs_f64()));
        if k > 0 {
            let coarse = pieces.spread(&x);
            let fine = levels[k - 1].prolong(&coarse);
            let above = if k == 1 { &finest } else { &levels[k - 2].pieces };
            x = above.sew(&fine, &vec![1.0; fine.len()]);
        }
    }
    Ok(Rested { positions: finest.spread(&x), outcome, levels: report })
}
