//! The edges of a garment's mesh.

use std::ops::Range;
use toile_core::prelude::*;

/// Every edge once.
pub(super) struct Edges {
    /// Lower vertex first, ascending, and so panel by panel.
    pub(super) ends: Vec<[u32; 2]>,
    /// Whether an edge has one triangle.
    pub(super) is_border: Vec<bool>,
    /// The edges of each panel.
    pub(super) panels: Vec<Range<usize>>,
}

impl Edges {
    pub(super) fn of(garment: &Garment, cx: &Context) -> Result<Self, StageError> {
        let mut edges = Edges { ends: Vec::new(), is_border: Vec::new(), panels: Vec::new() };
        for panel in &garment.panels {
            cx.check()?;
            let triangles = &garment.triangles[panel.triangles.clone()];
            let side = |t: [u32; 3], k: usize| key(t[k], t[(k + 1) % 3]);
            let mut sides: Vec<[u32; 2]> =
                triangles.iter().flat_map(|t| (0..3).map(move |k| side(*t, k))).collect();
            sides.sort_unstable();
            let start = edges.ends.len();
            for same in sides.chunk_by(|a, b| a == b) {
                edges.ends.push(same[0]);
                edges.is_border.push(same.len() == 1);
            }
            edges.panels.push(start..edges.ends.len());
        }
        Ok(edges)
    }

    /// The edge between two vertices.
    pub(super) fn find(&self, a: u32, b: u32) -> Option<usize> {
        self.ends.binary_search(&key(a, b)).ok()
    }

    /// The edge between two corners of a triangle.
    pub(super) fn side(&self, a: u32, b: u32) -> usize {
        let key = key(a, b);
        self.ends.partition_point(|e| *e < key)
    }
}

fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
