//! How a garment moved: its places at equal steps of time.
//!
//! Places are 32-bit floats, a tenth of a micrometre on a garment: they are looked at and written
//! to files, never solved from. Cost: 12 bytes a vertex and frame.

use crate::artifact::store::sound::{ensure, finite_figure, indices};

/// Frames of a garment while solvers stepped in time, the first at the beginning.
///
/// It has triangles of its own: the garment that carries it may have been cut finer since.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordedMotion {
    /// Time from one frame to the next, s.
    pub every: f64,
    /// Time at which the last solver ended, s: another goes on from there.
    pub end: f64,
    /// Triangles, as in the garment that moved.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices in a frame.
    pub vertices: usize,
    /// Places of all vertices, frame after frame, m.
    pub positions: Vec<[f32; 3]>,
}

impl RecordedMotion {
    /// How many frames it has.
    pub fn len(&self) -> usize {
        self.positions.len().checked_div(self.vertices).unwrap_or(0)
    }

    /// Whether it has no frame.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The places of each frame, in order.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &[[f32; 3]]> {
        self.positions.chunks_exact(self.vertices.max(1))
    }

    /// The time of each frame, s.
    pub fn times(&self) -> impl ExactSizeIterator<Item = f64> + use<> {
        let every = self.every;
        (0..self.len()).map(move |k| k as f64 * every)
    }

    /// What is wrong with it, as of an artifact.
    pub fn check(&self) -> Result<(), String> {
        finite_figure("time between two frames", self.every)?;
        finite_figure("end of the motion", self.end)?;
        ensure(self.every > 0.0, || format!("the frames are {} s apart", self.every))?;
        let whole = self.vertices > 0 && self.positions.len().is_multiple_of(self.vertices);
        ensure(whole, || {
            format!("{} places are no frames of {} vertices", self.positions.len(), self.vertices)
        })?;
        let finite = self.positions.iter().flatten().all(|x| x.is_finite());
        ensure(finite, || "a place of a frame is not finite".to_owned())?;
        indices("a triangle of the motion", self.vertices, self.triangles.iter().flatten())
    }
}
