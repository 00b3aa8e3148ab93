//! All forces on the nodes of one level, as one potential: value, gradient and matrix.
//!
//! The potential is the sum of the elastic energy of the sheet, the loads on it and a list of other
//! forces: seam closing forces, body contact, self-contact, contact with sharp features. Sheet and
//! loads are no part of the list: they are in every system, the matrix begins with the constant
//! part of the sheet's, and the gradient with the loads.
//!
//! Cost: O(n), and one query of the body per node that may be near it. Limit: the order of the list
//! decides the rounding of the sums.

use crate::contact::collision_surface::CollisionSurface;
use crate::energy::Subset;
use crate::linear::Pattern;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::distance_query::{ContactQuery, NUDGE};
use crate::statics::forces::elastic::Elastic;
use crate::statics::forces::force::{Force, Place, of_type};
use crate::statics::forces::loads::Loads;
use crate::statics::forces::ridges::Ridges;
use crate::statics::forces::seam_force::{SeamForce, SeamForces};
use crate::statics::forces::self_contact::SelfContact;
use nalgebra::{Matrix3, Vector3};
use std::any::Any;

type Vec3 = Vector3<f64>;

/// All that acts on the nodes.
#[derive(Debug, Clone)]
pub struct System<'a> {
    /// Membrane and bending energies.
    pub elastic: Elastic,
    /// Masses, weight and pushes.
    pub loads: Loads,
    /// Nodes that do not move.
    pub pinned: Vec<bool>,
    /// The body, if there is one.
    pub body: Option<&'a dyn CollisionSurface>,
    /// All other forces, at most one of each type.
    pub forces: Vec<Box<dyn Force>>,
    /// Stiffness that holds each node still in this step, N/m; empty where nothing does.
    pub brakes: Vec<f64>,
    /// Kinematic targets: pinned nodes and the places to which they move.
    pub targets: Vec<(u32, Vec3)>,
}

/// The energy at some place, with what a step that starts there can reuse.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// Total energy, J.
    pub energy: f64,
    /// The energy that does not depend on contacts, J.
    pub contact_free: f64,
    /// The contact query of each node; empty without body contact.
    pub queries: Vec<ContactQuery>,
}

impl System<'_> {
    /// The force of that type, if there is one.
    #[must_use]
    pub fn get<F: Force>(&self) -> Option<&F> {
        self.forces.iter().find_map(|f| of_type(f.as_ref()))
    }

    /// The same, to change it.
    pub fn get_mut<F: Force>(&mut self) -> Option<&mut F> {
        self.forces.iter_mut().find_map(|f| (f.as_mut() as &mut dyn Any).downcast_mut())
    }

    /// Removes the force of that type.
    pub fn remove<F: Force>(&mut self) {
        self.forces.retain(|f| of_type::<F>(f.as_ref()).is_none());
    }

    /// Replaces the closing forces of seams.
    pub fn set_seam_forces(&mut self, seam_forces: Vec<SeamForce>) {
        self.remove::<SeamForces>();
        self.forces.insert(0, Box::new(SeamForces(seam_forces)));
    }

    /// Whether seams are pulled together.
    #[must_use]
    pub fn is_sewing(&self) -> bool {
        self.get::<SeamForces>().is_some_and(|s| !s.0.is_empty())
    }

    /// Visits the groups of nodes that elements or forces couple in every step.
    fn couplings(&self, visit: &mut dyn FnMut(&[u32])) {
        self.elastic.couplings(visit);
        self.forces.iter().for_each(|f| f.couplings(visit));
    }

    /// Visits the groups of nodes that are coupled, or may be once they touch.
    pub(crate) fn neighbours(&self, visit: &mut dyn FnMut(&[u32])) {
        self.couplings(visit);
        self.forces.iter().for_each(|f| f.candidates(visit));
    }

    /// Visits the groups of nodes that the collisions of this step couple besides.
    pub(crate) fn collisions(&self, visit: &mut dyn FnMut(&[u32; 4])) {
        self.forces.iter().for_each(|f| f.collisions(visit));
    }

    /// The pattern of its matrix without collisions.
    #[must_use]
    pub fn pattern(&self) -> Pattern {
        Pattern::holding(&self.pinned, |visit| self.couplings(visit))
    }

    /// Pairs of nodes that elements or seam forces connect.
    #[must_use]
    pub fn links(&self) -> Vec<[u32; 2]> {
        let mut links = Vec::new();
        self.couplings(&mut |nodes: &[u32]| links.extend(nodes.windows(2).map(|w| [w[0], w[1]])));
        links
    }

    /// Sets the moves of nodes with a target, by up to `farthest`; returns whether any of them has
    /// not reached its target.
    pub fn follow_targets(&self, x: &[Vec3], moves: &mut [Vec3], farthest: f64) -> bool {
        for (node, to) in &self.targets {
            let left = to - x[*node as usize];
            moves[*node as usize] = left * (farthest / left.norm().max(farthest));
        }
        self.targets.iter().any(|(node, to)| (to - x[*node as usize]).norm() > NUDGE)
    }

    /// Queries the body for each node; empty without body contact.
    fn query_body(&self, x: &[Vec3]) -> Vec<ContactQuery> {
        match (self.body, self.get::<BodyContact>()) {
            (Some(body), Some(contact)) => contact.query(body, x),
            _ => Vec::new(),
        }
    }

    /// Shortens moves that lead into the body, of the nodes that `asks` selects.
    pub fn clear_of_body(&mut self, x: &[Vec3], moves: &mut [Vec3], asks: impl Fn(usize) -> bool) {
        let (body, is_sewing) = (self.body, self.is_sewing());
        let contact = self.get_mut::<BodyContact>().filter(|contact| !contact.lets_through);
        if let (Some(body), Some(contact)) = (body, contact) {
            contact.clear(body, is_sewing, x, moves, asks);
        }
    }

    /// Finds pairs of cloth and sharp features at `x`.
    pub fn seek_ridges(&mut self, x: &[Vec3]) {
        if self.get::<Ridges>().is_some() {
            self.seek_ridges_along(x, &vec![Vec3::zeros(); x.len()]);
        }
    }

    /// The same for `moves` from `x`.
    fn seek_ridges_along(&mut self, x: &[Vec3], moves: &[Vec3]) {
        let bridges = self.get_mut::<Ridges>().and_then(|r| r.seek(x, moves));
        if let (Some(bridges), Some(contact)) = (bridges, self.get_mut::<BodyContact>()) {
            contact.bridges = bridges;
        }
    }

    /// Changes moves that lead the cloth past a sharp feature of the body: the cloth gives way
    /// where it can, and otherwise the moves are shortened.
    pub fn clear_of_ridges(&mut self, x: &[Vec3], moves: &mut [Vec3]) {
        self.seek_ridges_along(x, moves);
        let Some(changed) = self.get::<Ridges>().map(|r| r.respond(x, moves, &self.pinned)) else { return };
        if changed.contains(&true) {
            self.clear_of_body(x, moves, |i| changed[i]);
            self.seek_ridges_along(x, moves);
            self.get::<Ridges>().into_iter().for_each(|r| r.limit_step(x, moves));
        }
    }

    /// Shortens all moves alike where they still lead past a sharp feature.
    pub fn stop_at_ridges(&mut self, x: &[Vec3], moves: &mut [Vec3]) {
        self.seek_ridges_along(x, moves);
        self.get::<Ridges>().into_iter().for_each(|r| r.scale_step(x, moves));
    }

    /// Finds cloth that the body passes through at `x`, as the state of a coarser mesh may, so that
    /// it is changed back out.
    pub fn find_pierced(&mut self, x: &[Vec3]) {
        if let (Some(body), Some(r)) = (self.body, self.get_mut::<Ridges>()) {
            r.find_pierced(body, x);
        }
    }

    /// Whether a sharp edge or corner of the body passes through the cloth at `x`.
    #[must_use]
    pub fn is_pierced(&self, x: &[Vec3]) -> bool {
        matches!((self.body, self.get::<Ridges>()), (Some(body), Some(r)) if r.is_pierced(body, x))
    }

    /// Energy at `x`, J; friction is that of the step's start.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        self.evaluate(x).energy
    }

    /// Energy at `x`, with what a step that starts there can reuse.
    #[must_use]
    pub fn evaluate(&self, x: &[Vec3]) -> Evaluation {
        let (contact_free, queries) = rayon::join(|| self.contact_free(x), || self.query_body(x));
        let at = Place { x, body: self.body, on_body: &queries, loads: &self.loads };
        let mut energy = contact_free;
        self.forces.iter().for_each(|f| f.add_contact_value(&at, &mut energy));
        Evaluation { energy, contact_free, queries }
    }

    /// The energy that does not depend on contacts, J.
    fn contact_free(&self, x: &[Vec3]) -> f64 {
        let sheet = self.stored(x) + self.elastic.value_of_holds(x) + self.loads.pushed(x);
        self.forces.iter().fold(sheet, |sum, f| sum + f.value(x))
    }

    /// Energy at the step's start, J, of which `contact_free` does not depend on contacts.
    #[must_use]
    pub fn value_at_start(&self, x: &[Vec3], contact_free: f64) -> f64 {
        let mut energy = contact_free;
        self.forces.iter().for_each(|f| f.add_contact_value_at_start(x, &mut energy));
        energy
    }

    /// Elastic and gravitational energy at `x`, J.
    #[must_use]
    pub fn stored(&self, x: &[Vec3]) -> f64 {
        self.elastic.value(x) + self.loads.weight(x)
    }

    /// Whether some of the cloth still intersects itself.
    #[must_use]
    pub fn is_intersecting(&self) -> bool {
        self.get::<SelfContact>().is_some_and(|c| !c.intersecting.is_empty())
    }

    /// Disables all friction, or enables it again.
    pub fn swap_friction(&mut self) {
        self.forces.iter_mut().for_each(|f| f.swap_friction());
    }

    /// Scales the stiffness and the loads of all contact.
    pub(crate) fn scale_contact(&mut self, factor: f64) {
        self.forces.iter_mut().for_each(|f| f.scale_contact(factor));
    }

    /// Finds the contacts at `x`. Call it at the start of each step.
    pub fn update_contacts(&mut self, x: &[Vec3]) {
        self.update_contacts_with(x, None);
    }

    /// The same, with the contact queries at `x` where they are known.
    pub fn update_contacts_with(&mut self, x: &[Vec3], queries: Option<Vec<ContactQuery>>) {
        let queries = queries.unwrap_or_else(|| self.query_body(x));
        let at = Place { x, body: self.body, on_body: &queries, loads: &self.loads };
        self.forces.iter_mut().for_each(|f| f.begin_step(&at));
    }

    /// Moves anchors along with nodes that slide. Call it at the end of each step that moves far.
    pub fn drag_anchors(&mut self, x: &[Vec3]) {
        self.forces.iter_mut().for_each(|f| f.end_step(x));
        self.elastic.drag(x);
    }

    /// The tangential displacement of each node on the body from its anchor at `x`, m.
    #[must_use]
    pub fn displacements(&self, x: &[Vec3]) -> Vec<Vec3> {
        self.get::<BodyContact>().map_or_else(|| vec![Vec3::zeros(); x.len()], |c| c.displacements(x))
    }

    /// Derivative of the energy at the step's start, N; zero at pins.
    #[must_use]
    pub fn gradient(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut g = self.loads.gradient(x);
        self.elastic.add_gradient(x, &mut g);
        self.forces.iter().for_each(|f| f.add_gradient(x, &mut g));
        g.iter_mut().zip(&self.pinned).filter(|(_, p)| **p).for_each(|(g, _)| *g = Vec3::zeros());
        g
    }

    /// Matrix at the step's start: second derivative plus `inertia` times the masses. Without
    /// `compression` it is positive definite.
    pub fn matrix(
        &self,
        x: &[Vec3],
        pattern: &Pattern,
        inertia: f64,
        compression: f64,
        values: &mut Vec<Matrix3<f64>>,
    ) {
        values.resize(pattern.blocks(), Matrix3::zeros());
        self.elastic.write_matrix(x, compression, values);
        for (v, m) in values.iter_mut().zip(&self.loads.masses) {
            (0..3).for_each(|c| v[(c, c)] += m * inertia);
        }
        values.iter_mut().zip(&self.brakes).for_each(|(v, b)| *v += Matrix3::identity() * *b);
        self.loads.add_matrix(values);
        self.forces.iter().for_each(|f| f.add_matrix(x, pattern, values));
        let held = self.pinned.iter().zip(values).filter(|(p, _)| **p);
        held.for_each(|(_, v)| *v = Matrix3::identity());
    }

    /// Takes over the history of friction and folds from before the scene was changed. The nodes
    /// are at `x`.
    pub(crate) fn continue_from(&mut self, before: &Self, x: &[Vec3]) {
        self.elastic.hold(x, false);
        self.elastic.hold_at(before.elastic.held());
        for old in &before.forces {
            self.forces.iter_mut().for_each(|new| new.continue_from(old.as_ref()));
        }
        let is_pinned = |(n, _): &&(u32, Vec3)| self.pinned[*n as usize];
        self.targets = before.targets.iter().filter(is_pinned).copied().collect();
    }

    /// Takes over what a restricted copy has found.
    pub(crate) fn merge(&mut self, cut: &Subset, part: &Self) {
        self.elastic.merge(cut, &part.elastic);
        self.forces.iter_mut().zip(&part.forces).for_each(|(f, p)| f.merge(cut, p.as_ref()));
    }
}

impl<'a> System<'a> {
    /// The system of a subset of the nodes, of which those that are not active are pinned.
    pub(crate) fn restrict(&self, cut: &Subset) -> Self {
        let is_pinned = |&i: &u32| self.pinned[i as usize] || !cut.active()[i as usize];
        Self {
            elastic: self.elastic.part(cut),
            loads: self.loads.restrict(cut),
            pinned: cut.nodes().iter().map(is_pinned).collect(),
            body: self.body,
            forces: self.forces.iter().map(|f| f.restrict(cut)).collect(),
            brakes: vec![],
            targets: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests;
