//! The elements about some of a sheet's nodes.

use super::assembly::Assembly;
use super::border::Border;
use super::{Elastic, Hinge, Spring, Triangle};
use crate::rest::part::Cut;

impl Elastic {
    /// The corners of its triangles.
    pub(in crate::rest) fn faces(&self) -> impl Iterator<Item = &[u32; 3]> {
        self.triangles.iter().map(|t| &t.nodes)
    }

    /// The elements that an awake node is in.
    pub(in crate::rest) fn part(&self, cut: &Cut) -> Self {
        let awake = |t: &usize| cut.wakes(&self.triangles[*t].nodes);
        let kept: Vec<usize> = (0..self.triangles.len()).filter(awake).collect();
        let triangle = |&t: &usize| {
            let whole = &self.triangles[t];
            Triangle { nodes: cut.renamed(whole.nodes), ..whole.clone() }
        };
        let hinge = |h: &Hinge| Hinge { nodes: cut.renamed(h.nodes), ..h.clone() };
        let woken: Vec<usize> =
            (0..self.hinges.len()).filter(|&h| cut.wakes(&self.hinges[h].nodes)).collect();
        let spring = |s: &Spring| Spring { nodes: cut.renamed(s.nodes), ..s.clone() };
        Self {
            laws: self.laws.clone(),
            triangles: kept.iter().map(triangle).collect(),
            hinges: woken.iter().map(|&h| hinge(&self.hinges[h])).collect(),
            borders: self.borders.iter().filter_map(|b| Border::part(b, cut)).collect(),
            springs: self.springs.iter().filter(|s| cut.wakes(&s.nodes)).map(spring).collect(),
            creases: self.creases.iter().filter_map(|c| c.renumbered(&woken)).collect(),
            assembly: Assembly::default(),
            frictions: woken.iter().filter_map(|&h| self.frictions.get(h)).copied().collect(),
            held: woken.iter().filter_map(|&h| self.held.get(h)).copied().collect(),
            foretold: kept.iter().filter_map(|&t| self.foretold.get(t)).copied().collect(),
        }
    }

    /// Takes over what a part has foretold of its triangles, and where it holds its folds.
    pub(in crate::rest) fn learn(&mut self, cut: &Cut, part: &Self) {
        let woken = self.hinges.iter().zip(&mut self.held).filter(|(h, _)| cut.wakes(&h.nodes));
        woken.zip(&part.held).for_each(|((_, whole), new)| *whole = *new);
        if self.foretold.len() != self.triangles.len() {
            return;
        }
        let kept = self.triangles.iter().zip(&mut self.foretold).filter(|(t, _)| cut.wakes(&t.nodes));
        kept.zip(&part.foretold).for_each(|((_, whole), new)| *whole = *new);
    }
}
