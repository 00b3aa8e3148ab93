//! A fall past the body, told of a garment that is on its way.

use super::SchemeSkin;
use super::fault::split;
use super::pieces::pieces;
use nalgebra::Vector3;
use toile_cloth::contact::past::{BodyBox, Fallen, NO_PIECE, list};
use toile_core::artifact::{Collide, Garment};
use toile_core::{ErrorCode, StageError};

/// What a fall is told by: the body's box, and the piece of each vertex with what pins hold.
#[derive(Debug)]
pub struct FallWatch<'g> {
    garment: &'g Garment,
    body: BodyBox,
    piece: Vec<u32>,
    held: Vec<bool>,
}

impl<'g> FallWatch<'g> {
    /// Of a garment at its start; nothing without a body or weight: such a fall is followed.
    pub fn of(garment: &'g Garment, scheme: &dyn Collide, gravity: &Vector3<f64>) -> Option<Self> {
        let body = BodyBox::of(&SchemeSkin::new(scheme), gravity)?;
        let mut piece = vec![NO_PIECE; garment.positions.len()];
        for (k, p) in pieces(garment).iter().enumerate() {
            p.vertices.iter().for_each(|&v| piece[v] = k as u32);
        }
        let mut held = vec![false; piece.len()];
        garment.pinned.iter().for_each(|&v| held[v as usize] = true);
        Some(Self { garment, body, piece, held })
    }

    /// The error of what is past the body, with every vertex at its place `x`.
    pub fn look(&self, x: &[Vector3<f64>]) -> Option<StageError> {
        let past = self.body.past(x, &self.piece, &self.held);
        if past.is_empty() {
            return None;
        }
        let is_past = |v: usize| past.get(self.piece[v] as usize).copied().unwrap_or(false);
        let count = |own: &std::ops::Range<usize>| own.clone().filter(|&v| is_past(v)).count();
        let panels =
            self.garment.panels.iter().map(|p| (p.name.as_str(), count(&p.vertices), p.vertices.len()));
        let start = (0..x.len()).filter(|&v| is_past(v)).map(|v| self.garment.positions[v].coords);
        Some(fall_error(&Fallen {
            cloth: list(&panels.filter(|(_, fallen, _)| *fallen > 0).collect::<Vec<_>>()),
            start: self.body.start(&start.collect::<Vec<_>>()),
            body: self.body.height(),
            is_certain: true,
        }))
    }
}

/// Cloth that has fallen past the body.
fn fall_error(fallen: &Fallen) -> StageError {
    split(ErrorCode::StaticEquilibrium, &fallen.to_string())
}
