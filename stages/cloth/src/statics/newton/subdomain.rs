//! Subdomain solve: the active nodes of a system as a system of their own, with all others pinned.
//!
//! Method: nonlinear elimination (Lanzkron, Rose, Wilkes 1996). Near rest most of a garment is at
//! rest while a few nodes buckle one after the other. The subdomain has the active nodes and the
//! nodes to which elements, seams and contacts couple them. Cost: a step costs what its nodes cost;
//! O(n) to cut it out. Limits: only the whole system can prove that it is at rest.

use crate::energy::Subset;
use crate::statics::forces::system::System;
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;

type Vec3 = Vector3<f64>;

/// Some nodes of a system as a system of their own.
pub(crate) struct Subdomain<'a> {
    /// The active nodes, and the pinned nodes to which they are coupled.
    pub(crate) system: System<'a>,
    cut: Subset,
    /// How many stacked subdomains of the same shape it stands for.
    multiplicity: f64,
}

/// Widens a set of nodes by the elements that they are in, `rings` times.
pub(crate) fn widen(system: &System<'_>, active: &mut [bool], rings: usize) {
    for _ in 0..rings {
        let was = active.to_vec();
        for nodes in system.elastic.faces().iter().filter(|t| t.iter().any(|&i| was[i as usize])) {
            nodes.iter().for_each(|&i| active[i as usize] = true);
        }
    }
}

impl<'a> Subdomain<'a> {
    /// The `active` nodes of a system and the nodes to which they are coupled.
    pub(crate) fn of(system: &System<'a>, active: Vec<bool>) -> Self {
        let included = active.clone();
        Self::with_neighbours(system, active, included)
    }

    /// The same with the `included` nodes, which the active ones may meet.
    pub(crate) fn with_neighbours(system: &System<'a>, active: Vec<bool>, mut included: Vec<bool>) -> Self {
        let mut include = |nodes: &[u32]| {
            if nodes.iter().any(|&i| active[i as usize]) {
                nodes.iter().for_each(|&i| included[i as usize] = true);
            }
        };
        system.neighbours(&mut include);
        let cut = Subset::new(active, &included);
        Self { system: system.restrict(&cut), cut, multiplicity: 1.0 }
    }

    /// The values of the whole system at the nodes of the subdomain.
    pub(crate) fn pick<T: Clone>(&self, of: &[T]) -> Vec<T> {
        self.cut.pick(of)
    }

    /// The tree of its triangles, in which only those of active nodes seek pairs. `layout` is that
    /// of the subdomain.
    pub(crate) fn tree(&self, whole: &ClothTree, layout: &[Vec3]) -> ClothTree {
        let active: Vec<bool> = self.pick(self.cut.active());
        whole.part(self.cut.nodes(), self.cut.index(), layout).with_active(&active)
    }

    /// This subdomain as the lowest of `count` stacked ones of the same shape, so that the cloth
    /// below carries them all. In the forces of one of them, contact and the loads of friction are
    /// smaller by that factor.
    pub(crate) fn standing_for(mut self, count: usize) -> Self {
        self.multiplicity = count as f64;
        self.system.scale_contact(1.0 / self.multiplicity);
        self
    }

    /// The number of its nodes.
    pub(crate) fn len(&self) -> usize {
        self.cut.nodes().len()
    }

    /// Writes positions and the state of contacts back into the whole system.
    pub(crate) fn put_back(mut self, x: &[Vec3], system: &mut System<'a>, whole: &mut [Vec3]) {
        if self.multiplicity != 1.0 {
            self.system.scale_contact(self.multiplicity);
        }
        self.cut.put(x, whole);
        system.merge(&self.cut, &self.system);
    }
}

#[cfg(test)]
mod tests;
