//! All forces on the nodes of one level, as one potential: value, gradient and matrix.
//!
//! The potential is the sum of membrane and bending energy, weight, seam closing forces, body
//! contact (a penalty within a thickness of the surface, so that vertices rest outside it),
//! self-contact, and regularised Coulomb friction. Friction is a potential of the tangential
//! displacement from an anchor (see `coulomb`): its force approaches Coulomb's limit without
//! reaching it, so that every equilibrium obeys the law. Anchors move along while the cloth moves
//! fast. Normals and limits of friction are those of the start of the step.
//!
//! Cost: O(n), and one query of the body per node that may be near it.

use crate::linear::Pattern;
use crate::statics::forces::body_contact::{BodyContact, ContactQuery, DistanceCache, NEAR, NUDGE};
use crate::statics::forces::coulomb::Coulomb;
use crate::statics::forces::elastic::Elastic;
use crate::statics::forces::height_springs::HeightSprings;
use crate::statics::forces::ridges::Ridges;
use crate::statics::forces::seam_force::SeamForce;
use crate::statics::forces::self_contact::SelfContact;
use nalgebra::{Matrix3, Vector3};
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// A node in contact with the body.
#[derive(Debug, Clone, Copy)]
pub struct BodyTouch {
    /// The node.
    pub node: u32,
    /// Outward normal of the body at the contact.
    pub normal: Vec3,
    /// Contact force, N.
    pub force: f64,
    /// The normal force that limits friction, a mean over the last steps, N.
    pub load: f64,
}

/// All that acts on the nodes.
#[derive(Debug, Clone)]
pub struct System<'a> {
    /// Membrane and bending energies.
    pub elastic: Elastic,
    /// Mass of each node, kg.
    pub masses: Vec<f64>,
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Forces on the nodes besides their weight, N; empty where there are none.
    pub push: Vec<Vec3>,
    /// Springs that hold the nodes at their initial height, if any.
    pub height_springs: Option<HeightSprings>,
    /// Nodes that do not move.
    pub pinned: Vec<bool>,
    /// Seam closing forces.
    pub seam_forces: Vec<SeamForce>,
    /// Body contact.
    pub body_contact: Option<BodyContact<'a>>,
    /// Contact with the sharp edges and corners of the body.
    pub ridges: Option<Ridges>,
    /// Self-contact.
    pub self_contact: Option<SelfContact>,
    /// Nodes in contact at the start of the step.
    pub touches: Vec<BodyTouch>,
    /// The anchor of the friction of each node on the body.
    pub anchors: Vec<Option<Vec3>>,
    /// Tangential displacement with which the friction of each node begins at its first contact, as
    /// the coarser level found it, m.
    pub slides: Vec<Vec3>,
    /// Contact force of each node on the body, a mean over the last steps, N.
    pub loads: Vec<f64>,
    /// Stiffness that holds each node still in this step, N/m; empty where nothing does.
    pub brakes: Vec<f64>,
    /// Kinematic targets: pinned nodes and the places to which they move.
    pub targets: Vec<(u32, Vec3)>,
    /// The last known distance of each node from the body; empty before the first step.
    pub distance_cache: Vec<DistanceCache>,
}

/// The energy at some place, with what a step that starts there can reuse.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// Total energy, J.
    pub energy: f64,
    /// The energy that does not depend on contacts, J.
    pub contact_free: f64,
    /// The contact query of each node; empty without a body.
    pub queries: Vec<ContactQuery>,
}

impl System<'_> {
    /// The pattern of its matrix without self-contact.
    #[must_use]
    pub fn pattern(&self) -> Pattern {
        Pattern::holding(&self.pinned, |visit| {
            self.elastic.couplings(visit);
            self.seam_forces.iter().for_each(|t| visit(&t.nodes));
        })
    }

    /// Pairs of nodes that elements or seam forces connect.
    #[must_use]
    pub fn links(&self) -> Vec<[u32; 2]> {
        let mut links = Vec::new();
        let mut link = |nodes: &[u32]| links.extend(nodes.windows(2).map(|w| [w[0], w[1]]));
        self.elastic.couplings(&mut link);
        self.seam_forces.iter().for_each(|t| link(&t.nodes));
        links
    }

    /// The nearest place of the body for each node near it, by `queries` where they are known.
    /// Updates the distance cache.
    fn nearest_on_body(&mut self, x: &[Vec3], queries: Option<Vec<ContactQuery>>) -> Vec<Option<Nearest>> {
        if self.body_contact.is_none() {
            return vec![None; x.len()];
        }
        let found = queries.unwrap_or_else(|| self.query_body(x));
        self.distance_cache = found.iter().map(|(cached, _)| *cached).collect();
        found.into_iter().map(|(_, near)| near).collect()
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

    /// Queries the body for each node. Cached distances save the search, or narrow it.
    fn query_body(&self, x: &[Vec3]) -> Vec<ContactQuery> {
        let Some(contact) = &self.body_contact else { return Vec::new() };
        let within: Vec<Option<f64>> = x
            .iter()
            .enumerate()
            .map(|(i, p)| contact.reach(p, contact.offsets[i], self.distance_cache.get(i)))
            .collect();
        let asked: Vec<usize> = (0..x.len()).filter(|&i| within[i].is_some()).collect();
        let points: Vec<Vec3> = asked.iter().map(|&i| x[i]).collect();
        let reach: Vec<f64> = asked.iter().filter_map(|&i| within[i]).collect();
        let mut found = contact.body.nearest(&points, &reach).into_iter();
        let one = |(i, p): (usize, &Vec3)| match (within[i], self.distance_cache.get(i)) {
            (None, Some(cached)) => (*cached, None),
            (reach, _) => match found.next().flatten() {
                Some(n) => {
                    let cached = DistanceCache { at: *p, distance: n.distance, exact: true };
                    (cached, (n.distance < NEAR * contact.offsets[i]).then_some(n))
                }
                None => (DistanceCache { at: *p, distance: reach.unwrap_or(0.0), exact: false }, None),
            },
        };
        x.iter().enumerate().map(one).collect()
    }

    /// Shortens moves that lead into the body, of the nodes that `asks` selects.
    pub fn clear_of_body(&mut self, x: &[Vec3], moves: &mut [Vec3], asks: impl Fn(usize) -> bool) {
        let is_sewing = !self.seam_forces.is_empty();
        let Some(contact) = self.body_contact.as_mut().filter(|contact| !contact.lets_through) else {
            return;
        };
        let cache = &self.distance_cache;
        let is_free = |i: usize| {
            cache
                .get(i)
                .is_some_and(|n| n.distance - (x[i] - n.at).norm() - moves[i].norm() > contact.guard(i))
        };
        let asked: Vec<usize> = (0..x.len()).filter(|&i| asks(i) && !is_free(i)).collect();
        let points: Vec<Vec3> = asked.iter().map(|&i| x[i]).collect();
        let gaps: Vec<f64> = asked.iter().map(|&i| contact.guard(i)).collect();
        let mut guarded: Vec<Vec3> = asked.iter().map(|&i| moves[i]).collect();
        contact.body.guard(&points, &mut guarded, &gaps);
        for (&i, m) in asked.iter().zip(guarded) {
            if (moves[i] - m).norm() > NUDGE {
                let distance = cache.get(i).map_or(0.0, |n| n.distance);
                match contact.grows_offsets {
                    true => contact.grow(i, distance),
                    // Stiffer contact would keep the seam open.
                    false if is_sewing => {}
                    false => contact.mark_overloaded(i, distance),
                }
            }
            moves[i] = m;
        }
    }

    /// Finds pairs of cloth and sharp features at `x`.
    pub fn seek_ridges(&mut self, x: &[Vec3]) {
        self.ridges.iter_mut().for_each(|r| r.seek(x, &vec![Vec3::zeros(); x.len()]));
    }

    /// Changes moves that lead the cloth past a sharp feature of the body: the cloth gives way
    /// where it can, and otherwise the moves are shortened.
    pub fn clear_of_ridges(&mut self, x: &[Vec3], moves: &mut [Vec3]) {
        let Some(r) = &mut self.ridges else { return };
        r.seek(x, moves);
        let changed = r.respond(x, moves, &self.pinned);
        if changed.contains(&true) {
            self.clear_of_body(x, moves, |i| changed[i]);
            self.ridges.iter_mut().for_each(|r| {
                r.seek(x, moves);
                r.limit_step(x, moves);
            });
        }
    }

    /// Shortens all moves alike where they still lead past a sharp feature.
    pub fn stop_at_ridges(&mut self, x: &[Vec3], moves: &mut [Vec3]) {
        if let Some(r) = &mut self.ridges {
            r.seek(x, moves);
            r.scale_step(x, moves);
        }
    }

    /// Finds cloth that the body passes through at `x`, as the state of a coarser mesh may, so that
    /// it is changed back out.
    pub fn find_pierced(&mut self, x: &[Vec3]) {
        if let (Some(r), Some(contact)) = (&mut self.ridges, &self.body_contact) {
            r.find_pierced(contact, x);
        }
    }

    /// Whether a sharp edge or corner of the body passes through the cloth at `x`.
    #[must_use]
    pub fn is_pierced(&self, x: &[Vec3]) -> bool {
        matches!((&self.ridges, &self.body_contact), (Some(r), Some(contact)) if r.is_pierced(contact, x))
    }

    /// Energy at `x`, J; `touches` and `anchors` are those of the step's start.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        self.evaluate(x).energy
    }

    /// Energy at `x`, with what a step that starts there can reuse.
    #[must_use]
    pub fn evaluate(&self, x: &[Vec3]) -> Evaluation {
        let seams = || self.seam_forces.iter().map(|t| t.value(x)).sum::<f64>();
        let (contact_free, queries) = rayon::join(
            || self.stored(x) + self.elastic.value_of_holds(x) + self.pushed(x) + seams(),
            || self.query_body(x),
        );
        let body: f64 = match &self.body_contact {
            Some(contact) => {
                let penalty = |((n, o), k): ((&ContactQuery, &f64), &f64)| {
                    n.1.as_ref().map_or(0.0, |n| 0.5 * k * (o - n.distance).max(0.0).powi(2))
                };
                queries.iter().zip(&contact.offsets).zip(&contact.stiffness).map(penalty).sum()
            }
            None => 0.0,
        };
        let friction: f64 = self.body_friction().map(|(i, r)| r.value(&x[i])).sum();
        let self_contact = self.self_contact.as_ref().map_or(0.0, |c| c.value(x));
        let ridges = self.ridges.as_ref().map_or(0.0, |r| r.value(x));
        Evaluation { energy: contact_free + body + friction + self_contact + ridges, contact_free, queries }
    }

    /// Energy at the step's start, J, of which `contact_free` does not depend on contacts.
    #[must_use]
    pub fn value_at_start(&self, x: &[Vec3], contact_free: f64) -> f64 {
        let body: f64 = match &self.body_contact {
            Some(contact) => {
                let penalty = |t: &BodyTouch| 0.5 * t.force * t.force / contact.stiffness[t.node as usize];
                self.touches.iter().filter(|t| t.force > 0.0).map(penalty).sum()
            }
            None => 0.0,
        };
        let friction: f64 = self.body_friction().map(|(i, r)| r.value(&x[i])).sum();
        let self_contact = self.self_contact.as_ref().map_or(0.0, |c| c.value_at_start(x));
        let ridges = self.ridges.as_ref().map_or(0.0, |r| r.value_at_start(x));
        contact_free + body + friction + self_contact + ridges
    }

    /// Elastic and gravitational energy at `x`, J.
    #[must_use]
    pub fn stored(&self, x: &[Vec3]) -> f64 {
        let weight: f64 = x.iter().zip(&self.masses).map(|(p, m)| -m * self.gravity.dot(p)).sum();
        self.elastic.value(x) + weight
    }

    /// Energy of the forces besides weight, J.
    fn pushed(&self, x: &[Vec3]) -> f64 {
        let held = self.height_springs.as_ref().map_or(0.0, |h| h.value(x, &self.masses));
        held - self.push.iter().zip(x).map(|(p, x)| p.dot(x)).sum::<f64>()
    }

    /// Whether some of the cloth still intersects itself.
    #[must_use]
    pub fn is_intersecting(&self) -> bool {
        self.self_contact.as_ref().is_some_and(|c| !c.intersecting.is_empty())
    }

    /// Whether there is no friction with a body.
    #[must_use]
    pub fn is_frictionless_on_body(&self) -> bool {
        self.body_contact.as_ref().is_none_or(|contact| contact.friction.iter().all(|f| *f == 0.0))
    }

    /// Exchanges the friction with the body for `friction`, and disables or enables that of cloth
    /// on cloth.
    pub fn swap_friction(&mut self, friction: &mut Vec<f64>) {
        if let Some(contact) = &mut self.body_contact {
            std::mem::swap(&mut contact.friction, friction);
        }
        self.self_contact.iter_mut().for_each(SelfContact::swap_friction);
        self.ridges.iter_mut().for_each(Ridges::swap_friction);
        self.anchors.fill(None);
        self.loads.fill(0.0);
    }

    /// Finds the contacts at `x`. Call it at the start of each step.
    pub fn update_contacts(&mut self, x: &[Vec3]) {
        self.update_contacts_with(x, None);
    }

    /// The same, with the contact queries at `x` where they are known.
    pub fn update_contacts_with(&mut self, x: &[Vec3], queries: Option<Vec<ContactQuery>>) {
        self.self_contact.iter_mut().for_each(|c| c.update_contacts(x));
        #[cfg(toile_without = "body")]
        return;
        let near = self.nearest_on_body(x, queries);
        let Some(contact) = &mut self.body_contact else { return };
        contact.stiffen_overloaded();
        let ridges = &mut self.ridges;
        ridges.iter_mut().for_each(|r| r.update_contacts(contact, x));
        if !contact.lets_through {
            contact.allow_for_sag(&near, x, |edge| ridges.as_ref().is_some_and(|r| r.bridges(edge)));
        }
        let mut anchors = vec![None; x.len()];
        let mut loads = vec![0.0; x.len()];
        self.touches.clear();
        for (i, n) in near.iter().enumerate() {
            let Some(n) = n else { continue };
            if contact.stiffens_inside && n.distance < 0.0 {
                contact.overloaded.push(i as u32);
            }
            let force = contact.stiffness[i] * (contact.offsets[i] - n.distance).max(0.0);
            // Contact may alternate from step to step, so the limit of friction is a mean. A node
            // that has just come into contact will carry at least its weight.
            let weight = -self.masses[i] * self.gravity.dot(&n.normal);
            let first = if n.distance < 1.1 * contact.offsets[i] { force.max(weight) } else { force };
            loads[i] = if self.anchors[i].is_some() { 0.5 * (self.loads[i] + force) } else { first };
            if force > 0.0 || loads[i] > 0.0 {
                anchors[i] = Some(self.anchors[i].unwrap_or(x[i] - std::mem::take(&mut self.slides[i])));
                self.touches.push(BodyTouch { node: i as u32, normal: n.normal, force, load: loads[i] });
            }
        }
        (self.anchors, self.loads) = (anchors, loads);
    }

    /// Moves anchors along with nodes that slide. Call it at the end of each step that moves far.
    pub fn drag_anchors(&mut self, x: &[Vec3]) {
        let dragged: Vec<(usize, Vec3)> = self.body_friction().map(|(i, r)| (i, r.dragged(&x[i]))).collect();
        dragged.into_iter().for_each(|(i, anchor)| self.anchors[i] = Some(anchor));
        self.self_contact.iter_mut().for_each(|c| c.drag_anchors(x));
        self.ridges.iter_mut().for_each(|r| r.drag_anchors(x));
        self.elastic.drag(x);
    }

    /// The tangential displacement of each node from its anchor at `x`, m.
    #[must_use]
    pub fn displacements(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut slides = vec![Vec3::zeros(); x.len()];
        self.body_friction().for_each(|(i, r)| slides[i] = r.displacement(&x[i]));
        slides
    }

    /// The nodes with friction on the body, and that friction.
    fn body_friction(&self) -> impl Iterator<Item = (usize, Coulomb)> + '_ {
        let contact = self.body_contact.as_ref();
        self.touches.iter().filter_map(move |t| {
            let node = t.node as usize;
            let contact = contact.filter(|contact| contact.friction[node] > 0.0)?;
            let anchor = self.anchors[node]?;
            Some((node, Coulomb { normal: t.normal, anchor, limit: contact.friction[node] * t.load }))
        })
    }

    /// Derivative of the energy at the step's start, N; zero at pins.
    #[must_use]
    pub fn gradient(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut g: Vec<Vec3> = self.masses.iter().map(|m| -self.gravity * *m).collect();
        g.iter_mut().zip(&self.push).for_each(|(g, p)| *g -= p);
        self.height_springs.iter().for_each(|h| h.add_gradient(x, &self.masses, &mut g));
        self.elastic.add_gradient(x, &mut g);
        self.seam_forces.iter().for_each(|t| t.add_gradient(x, &mut g));
        self.touches.iter().for_each(|t| g[t.node as usize] -= t.normal * t.force);
        self.body_friction().for_each(|(i, r)| g[i] += r.gradient(&x[i]));
        self.self_contact.iter().for_each(|c| c.add_gradient(x, &mut g));
        self.ridges.iter().for_each(|r| r.add_gradient(x, &mut g));
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
        for (v, m) in values.iter_mut().zip(&self.masses) {
            (0..3).for_each(|c| v[(c, c)] += m * inertia);
        }
        values.iter_mut().zip(&self.brakes).for_each(|(v, b)| *v += Matrix3::identity() * *b);
        self.height_springs.iter().for_each(|h| h.add_matrix(&self.masses, values));
        self.seam_forces.iter().for_each(|t| t.add_matrix(x, pattern, values));
        if let Some(contact) = &self.body_contact {
            for t in self.touches.iter().filter(|t| t.force > 0.0) {
                values[t.node as usize] +=
                    t.normal * t.normal.transpose() * contact.stiffness[t.node as usize];
            }
        }
        self.body_friction().for_each(|(i, r)| values[i] += r.matrix(&x[i]));
        self.self_contact.iter().for_each(|c| c.add_matrix(x, pattern, values));
        self.ridges.iter().for_each(|r| r.add_matrix(x, pattern, values));
        let held = self.pinned.iter().zip(values).filter(|(p, _)| **p);
        held.for_each(|(_, v)| *v = Matrix3::identity());
    }
}
