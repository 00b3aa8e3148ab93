//! `Subdivide`: the garment as it lies, on a finer mesh.
//!
//! Method: every edge is cut into equal parts, every triangle into alike ones; what a vertex has is
//! interpolated linearly. Cost: O(triangles * parts^2), and a sort of the edges. Limits: the
//! outline stays the polygon of the coarse mesh; what was flat between the old vertices is flat
//! still, so on a body new vertices start nearer to the skin or within it, and a draper has to push
//! them out.

mod cut;
mod edges;
mod seams;
#[cfg(test)]
mod tests;

use cut::GarmentCut;
use edges::Edges;
use toile_core::cost::{Quantity, Size};
use toile_core::prelude::*;

/// A finer mesh would only run out of memory.
const MOST_VERTICES: usize = 4_000_000;

/// Cuts the garment's mesh into finer triangles where it lies, so that a draper goes on with the
/// folds it has.
///
/// Every edge falls into `parts` equal parts and every triangle into `parts` squared ones of its
/// own shape. No old vertex moves, and new ones lie on the flat triangles of the coarse mesh;
/// seams, joined or still open, are sewn at every new vertex. It finds no folds and no rest by
/// itself: put a draper behind it that goes on from where the cloth is, such as
/// a second `StaticEquilibrium`. The outline stays the polygon of the coarse mesh: where
/// curves matter, mesh with shorter edges. Pins hold the old vertices alone. With one part the
/// garment is left as it is.
#[stage(
    role = Placement,
    source = "uniform subdivision of triangles, a textbook method",
    example = "Subdivide(parts: 2)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable, Improves)
)]
pub struct Subdivide {
    /// Parts that every edge is cut into.
    #[param(default = 2, min = 1, max = 16, unit = "parts", trades, finer = "more")]
    pub parts: usize,
}

#[stage]
impl Subdivide {
    /// Runs the stage.
    pub fn run(&self, garment: &Garment, cx: &Context) -> Result<Garment, StageError> {
        garment.check_solvable()?;
        cx.check()?;
        if self.parts == 1 {
            return Ok(garment.clone());
        }
        let edges = Edges::of(garment, cx)?;
        let cut = GarmentCut::new(garment, &edges, self.parts);
        if cut.count() > MOST_VERTICES {
            return Err(self.too_many(cut.count()));
        }
        let mut fine = cut.garment(cx)?;
        fine.seams = seams::seams(garment, &edges, &cut, cx)?;
        seams::join(&mut fine, &cut);
        Ok(fine)
    }

    /// As many triangles as every one is cut into.
    pub(crate) fn sizes(&self, given: &Size, _cx: &Context) -> Option<Size> {
        let triangles = given.get(Quantity::Triangles)?;
        Some(given.clone().with(Quantity::Triangles, triangles * (self.parts * self.parts) as f64))
    }

    fn too_many(&self, count: usize) -> StageError {
        let text = format!(
            "with edges in {} parts the garment has {count} vertices, the limit is {MOST_VERTICES}",
            self.parts
        );
        StageError::new(ErrorCode::InvalidParameter, text).at("parts").hint("take fewer parts")
    }
}
