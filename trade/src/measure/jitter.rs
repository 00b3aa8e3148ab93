//! Starts that differ a little: a garment's own spread of equilibria.
//!
//! Folds and friction have many states of rest; a start moved by a millimetre may end in another.
//! The start is moved by a smooth field, a sum of plane waves of 5 to 40 cm with random directions
//! and phases: the same field for every mesh of the same garment, and too smooth to fold a triangle
//! or cross two layers. Pinned vertices stay.
//!
//! [`insert`] puts the move before the first stage that sews or drapes; it is no stage of the
//! catalogue.

use toile_core::prelude::*;
use toile_core::{Feed, Node};
use toile_pipeline::Pipeline;

/// Waves of the field.
const WAVES: usize = 8;
/// Shortest and longest wave, metres.
const LENGTHS: [f64; 2] = [0.05, 0.4];

/// Moves every vertex of a garment by a smooth random field.
#[stage(role = Placement, source = "none", example = "JitteredStart(amount: \"1 mm\", seed: 1)", contracts(Deterministic, ThreadInvariant))]
pub struct JitteredStart {
    /// Root mean square of the move.
    #[param(default = Length::mm(1.0), min = 0.0, max = 0.1)]
    amount: Length,
    /// Which of the fields.
    #[param(default = 1, min = 0)]
    seed: u64,
}

#[stage]
impl JitteredStart {
    fn run(&self, garment: &Garment, _cx: &Context) -> Result<Garment, StageError> {
        let mut moved = garment.clone();
        let waves = waves(self.seed);
        for (v, p) in moved.positions.iter_mut().enumerate() {
            if garment.pinned.binary_search(&(v as u32)).is_err() {
                *p += field(&waves, p) * self.amount.metres();
            }
        }
        Ok(moved)
    }
}

/// Puts a jittered start before the first stage that sews or drapes.
///
/// Errors: a pipeline that does neither.
pub fn insert(pipeline: &mut Pipeline, amount: Length, seed: u64) -> Result<(), StageError> {
    let solves = |n: &Node| matches!(n.card.role, Role::Stitcher | Role::Draper);
    let at = pipeline.nodes.iter().position(solves);
    let port = at.and_then(|at| {
        pipeline.nodes[at].card.inputs.iter().position(|p| p.kind == <Garment as ArtifactType>::KIND)
    });
    let (Some(at), Some(port)) = (at, port) else {
        return Err(StageError::invalid(
            "the pipeline has no stage that sews or drapes, so it has no start to be moved",
        ));
    };
    for feed in pipeline.nodes[at..].iter_mut().flat_map(|n| &mut n.inputs) {
        if let Feed::Node { node, .. } = feed
            && *node >= at
        {
            *node += 1;
        }
    }
    let start = std::mem::replace(&mut pipeline.nodes[at].inputs[port], Feed::Node { node: at, port: 0 });
    pipeline.nodes.insert(at, node(JitteredStart { amount, seed }, start));
    Ok(())
}

/// A stage that stands in no file.
fn node(stage: JitteredStart, input: Feed) -> Node {
    let card = toile_core::Stage::card(&stage);
    Node {
        id: card.name.to_owned(),
        stage: Box::new(stage),
        card,
        span: 0..0,
        place: 0..0,
        params: Default::default(),
        inputs: vec![input],
    }
}

/// A plane wave: wave vector (1/m), phase, and the direction in which it moves.
struct Wave {
    vector: Vector3,
    phase: f64,
    way: Vector3,
}

fn waves(seed: u64) -> Vec<Wave> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(1);
    let mut next = move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        split_mix(state)
    };
    let mut wave = || {
        let length = LENGTHS[0] * (LENGTHS[1] / LENGTHS[0]).powf(next());
        let vector = direction(next(), next()) * (std::f64::consts::TAU / length);
        Wave { vector, phase: next() * std::f64::consts::TAU, way: direction(next(), next()) }
    };
    (0..WAVES).map(|_| wave()).collect()
}

/// Uniform in 0..1 (SplitMix64: Steele, Lea, Flood 2014).
fn split_mix(mut z: u64) -> f64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// A direction, uniform over the sphere (Archimedes).
fn direction(u: f64, v: f64) -> Vector3 {
    let (z, a) = (2.0 * u - 1.0, v * std::f64::consts::TAU);
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vector3::new(r * a.cos(), r * a.sin(), z)
}

/// The field at a point; its root mean square over space is 1.
fn field(waves: &[Wave], p: &Point3) -> Vector3 {
    let sum: Vector3 = waves.iter().map(|w| w.way * (w.vector.dot(&p.coords) + w.phase).sin()).sum();
    sum * (2.0 / waves.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::surface::testing::sheet;

    fn moved(n: usize, seed: u64) -> Garment {
        JitteredStart { amount: Length::mm(1.0), seed }.run(&sheet(n, 1.0), &Context::quiet()).unwrap()
    }

    #[test]
    fn the_move_is_of_the_asked_size_and_another_for_every_seed() {
        for seed in 1..4 {
            let (a, b) = (sheet(40, 1.0), moved(40, seed));
            let square: f64 = a.positions.iter().zip(&b.positions).map(|(p, q)| (q - p).norm_squared()).sum();
            let rms = (square / a.positions.len() as f64).sqrt();
            assert!((5e-4..2e-3).contains(&rms), "{rms}");
        }
        assert_ne!(moved(4, 1).positions, moved(4, 2).positions);
    }

    #[test]
    fn meshes_of_the_same_cloth_are_moved_alike() {
        let (coarse, fine) = (moved(4, 7), moved(8, 7));
        assert_eq!(coarse.positions[0], fine.positions[0]);
        assert_eq!(coarse.positions[24], fine.positions[80]);
    }

    #[test]
    fn pinned_vertices_stay() {
        let mut g = sheet(2, 1.0);
        g.pinned = vec![3];
        let stage = JitteredStart { amount: Length::mm(1.0), seed: 1 };
        let moved = stage.run(&g, &Context::quiet()).unwrap();
        assert_eq!(moved.positions[3], g.positions[3]);
        assert_ne!(moved.positions[4], g.positions[4]);
    }
}
