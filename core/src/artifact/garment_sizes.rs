//! Flat and present sizes of a garment: edges, triangles, panels; along gathered seams as the
//! gathers leave them.

use super::{Garment, GarmentPanel, Point2, SeamKind};
use crate::artifact::sewing::gathers;
use nalgebra::{Matrix2, Matrix3x2};

impl Garment {
    /// Every mesh edge once, ascending, with its flat length, metres: the mean of what its
    /// triangles say, whose corners are drawn together along gathered seams.
    pub fn flat_lengths(&self) -> Vec<([u32; 2], f64)> {
        let Some(corners) = gathers::corners(self) else {
            return self.edges().into_iter().map(|e| (e, self.cut_length(e))).collect();
        };
        let mut sides: Vec<([u32; 2], f64)> = Vec::with_capacity(3 * corners.len());
        for (t, c) in self.triangles.iter().zip(&corners) {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], (c[k] - c[(k + 1) % 3]).norm()));
            }
        }
        sides.sort_unstable_by_key(|s| s.0);
        let mean = |s: &[([u32; 2], f64)]| (s[0].0, s.iter().map(|s| s.1).sum::<f64>() / s.len() as f64);
        sides.chunk_by(|a, b| a.0 == b.0).map(mean).collect()
    }

    /// The flat corners of every triangle, metres, those along gathered seams drawn together as a
    /// solver has them; nothing where no seam gathers, for all are then as they are cut.
    pub fn gathered_corners(&self) -> Option<Vec<[Point2; 3]>> {
        gathers::corners(self)
    }

    /// The length of an edge as it is cut, metres.
    fn cut_length(&self, [a, b]: [u32; 2]) -> f64 {
        (self.rest[a as usize] - self.rest[b as usize]).norm()
    }

    /// Absolute strain of every mesh edge, ascending; 0 of an edge without flat length.
    pub fn edge_strains(&self) -> Vec<f64> {
        let flat = self.flat_lengths();
        let strain = |([a, b], flat): &([u32; 2], f64)| {
            let now = (self.positions[*a as usize] - self.positions[*b as usize]).norm();
            if *flat > 0.0 { (now / flat - 1.0).abs() } else { 0.0 }
        };
        let mut strains: Vec<f64> = flat.iter().map(strain).collect();
        strains.sort_by(f64::total_cmp);
        strains
    }

    /// The greatest stretch of each triangle in any direction, present over flat length; 1 of a
    /// triangle without flat area.
    pub fn stretches(&self) -> Vec<f64> {
        let gathered = gathers::corners(self);
        let one = |(k, t): (usize, &[u32; 3])| {
            let cut = || t.map(|i| self.rest[i as usize]);
            let [a, b, c] = gathered.as_ref().map_or_else(cut, |corners| corners[k]);
            let [p, q, r] = t.map(|i| self.positions[i as usize]);
            let Some(back) = Matrix2::from_columns(&[b - a, c - a]).try_inverse() else { return 1.0 };
            let gradient = Matrix3x2::from_columns(&[q - p, r - p]) * back;
            (gradient.transpose() * gradient).symmetric_eigenvalues().max().max(0.0).sqrt()
        };
        self.triangles.iter().enumerate().map(one).collect()
    }

    /// Flat and present area of a panel, square metres; flat as its gathers leave it.
    pub fn panel_areas(&self, panel: &GarmentPanel) -> (f64, f64) {
        self.panel_areas_but(panel, |_, _, _| false)
    }

    /// The same with the flat area of those triangles that are `spared` for their present one, by
    /// their vertices, flat and present area.
    pub fn panel_areas_but(
        &self,
        panel: &GarmentPanel,
        spared: impl Fn(&[u32; 3], f64, f64) -> bool,
    ) -> (f64, f64) {
        let gathered = gathers::corners(self);
        panel.triangles.clone().fold((0.0, 0.0), |(flat, now), k| {
            let t = self.triangles[k];
            let cut = || t.map(|i| self.rest[i as usize]);
            let [a, b, c] = gathered.as_ref().map_or_else(cut, |corners| corners[k]);
            let [p, q, r] = t.map(|i| self.positions[i as usize]);
            let (one, other) = ((b - a).perp(&(c - a)).abs() / 2.0, (q - p).cross(&(r - p)).norm() / 2.0);
            (flat + one, now + if spared(&t, one, other) { one } else { other })
        })
    }

    /// Flat and present length of a panel's boundary, metres.
    pub fn panel_boundaries(&self, panel: &GarmentPanel) -> (f64, f64) {
        self.panel_boundaries_but(panel, |_| false)
    }

    /// The same with the flat length of those edges that are `spared` for their present one, by
    /// their vertices.
    pub fn panel_boundaries_but(
        &self,
        panel: &GarmentPanel,
        spared: impl Fn([u32; 2]) -> bool,
    ) -> (f64, f64) {
        let gathers = self.seams.iter().any(|s| s.kind == SeamKind::Gathered);
        let flat = if gathers { self.flat_lengths() } else { Vec::new() };
        let n = panel.boundary.len();
        let length = |a: usize, b: usize| {
            let key = [a.min(b) as u32, a.max(b) as u32];
            let cut = |_| self.cut_length([a as u32, b as u32]);
            flat.binary_search_by_key(&key, |f| f.0).map_or_else(cut, |k| flat[k].1)
        };
        (0..n).fold((0.0, 0.0), |(flat, now), k| {
            let (a, b) = (panel.boundary[k] as usize, panel.boundary[(k + 1) % n] as usize);
            let (one, other) = (length(a, b), (self.positions[b] - self.positions[a]).norm());
            (flat + one, now + if spared([a as u32, b as u32]) { one } else { other })
        })
    }
}
