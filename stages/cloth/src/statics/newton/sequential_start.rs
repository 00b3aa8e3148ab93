//! Sequential start of a stack: many cloths come to rest one by one, from the innermost outwards,
//! before all of them move together.
//!
//! Method: block Gauss-Seidel, one sweep, as a start. If all cloths fell at once, each collision
//! would shorten the step of all of them. One cloth that falls on cloth at rest is a small problem
//! of some tens of steps. It carries the weight of all cloths that will lie on it, as if they had
//! its shape (see [`Subdomain::standing_for`]). The whole stack then needs some tens of steps.
//!
//! A cloth is solved as a subdomain with all triangles that it may meet within a reach. Where it
//! leaves the reach, the subdomain is cut out anew. Cost: O(n) for each cut, and steps of the size
//! of the subdomain. Limit: at least [`MANY`] cloths.

use crate::scene::Scene;
use crate::statics::factor::multifrontal::{Halt, Stop};
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::levels::pieces::count_cloths;
use crate::statics::newton::nearby::Nearby;
use crate::statics::newton::state::{NewtonOptions, NewtonState, Watch};
use crate::statics::newton::subdomain::Subdomain;
use nalgebra::Vector3;
use std::ops::ControlFlow;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::components::groups;

type Vec3 = Vector3<f64>;

/// Least number of cloths that start one by one. Fewer come to rest together sooner.
const MANY: usize = 6;

/// Steps of one cloth at most.
const STEPS: usize = 200;

/// First reach about a cloth, in thicknesses.
const FIRST_REACH: f64 = 16.0;

/// Least reach, in thicknesses.
const LEAST_REACH: f64 = 4.0;

/// Nodes of a subdomain for each active one, rounded down, above which the reach is halved.
const MOST_NODES: usize = 20;

/// A cloth that leaves its reach in fewer steps gets a longer one.
const SOON: usize = 3;

/// The number of cloths of a scene, if they are so many that they start one by one.
pub(crate) fn stack_size(scene: &Scene) -> Option<usize> {
    Some(scene).filter(|s| s.self_collision).map(count_cloths).filter(|n| *n >= MANY)
}

/// The context in which each cloth is solved.
pub(crate) struct StackStart<'a> {
    /// Orders the elimination.
    pub(crate) layout: &'a [Vec3],
    /// Finds neighbour pairs.
    pub(crate) tree: &'a ClothTree,
    /// The options of Newton's method.
    pub(crate) options: NewtonOptions,
    /// Asked every few milliseconds.
    pub(crate) stop: &'a Stop<'a>,
}

/// Brings each cloth near rest on those before it; ends where `watch` breaks.
///
/// # Errors
/// [`Halt`], as [`NewtonState::step`].
pub(crate) fn start_one_by_one(
    system: &mut System<'_>,
    around: &StackStart<'_>,
    x: &mut [Vec3],
    watch: &mut Watch<'_>,
) -> Result<ControlFlow<()>, Halt> {
    let (of, count) = cloths(system);
    let order = outwards(system, x, &of, count);
    for (k, cloth) in order.iter().enumerate() {
        let active: Vec<bool> = of.iter().map(|c| c == cloth).collect();
        if around.settle(system, x, &active, order.len() - k, watch)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    Ok(ControlFlow::Continue(()))
}

/// The cloth that each node belongs to, and how many there are.
fn cloths(system: &System<'_>) -> (Vec<u32>, usize) {
    groups(system.loads.masses.len(), system.links().into_iter())
}

/// The cloths with triangles, from the innermost: by layer, then by mean distance from the body, or
/// by height where there is none.
fn outwards(system: &System<'_>, x: &[Vec3], of: &[u32], count: usize) -> Vec<u32> {
    let far = distances(system, x);
    let mut mean = vec![(0u32, 0.0, 0usize); count];
    let self_contact = system.get::<SelfContact>();
    for (i, &c) in of.iter().enumerate() {
        let layer = self_contact.and_then(|c| c.order.get(i)).copied().unwrap_or(0);
        let m = &mut mean[c as usize];
        *m = (m.0.max(layer), m.1 + far[i], m.2 + 1);
    }
    let mut known: Vec<u32> = system.elastic.faces().iter().map(|t| of[t[0] as usize]).collect();
    known.sort_unstable();
    known.dedup();
    let key = |c: u32| (mean[c as usize].0, mean[c as usize].1 / mean[c as usize].2 as f64);
    known.sort_by(|&a, &b| key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)));
    known
}

fn distances(system: &System<'_>, x: &[Vec3]) -> Vec<f64> {
    let Some(body) = system.body else {
        return x.iter().map(|p| -p.dot(&system.loads.gravity)).collect();
    };
    let near = body.nearest(x, &vec![f64::INFINITY; x.len()]);
    near.into_iter().map(|n| n.map_or(f64::INFINITY, |n| n.distance)).collect()
}

/// The progress of one cloth.
struct Attempt {
    /// The reach about it, m.
    reach: f64,
    /// The step of pseudo-time, s.
    dt: f64,
    steps: usize,
}

impl Attempt {
    /// Adapts the reach, after so many steps within the last one.
    fn adapt(&mut self, thickness: f64, steps: usize, nodes_per_active: usize) {
        if nodes_per_active > MOST_NODES {
            self.reach = (0.5 * self.reach).max(LEAST_REACH * thickness);
        } else if steps < SOON {
            self.reach *= 2.0;
        }
    }
}

impl StackStart<'_> {
    /// Brings the active nodes near rest while all others are pinned. They stand for `multiplicity`
    /// stacked cloths.
    fn settle(
        &self,
        system: &mut System<'_>,
        x: &mut [Vec3],
        active: &[bool],
        multiplicity: usize,
        watch: &mut Watch<'_>,
    ) -> Result<ControlFlow<()>, Halt> {
        let tree = self.tree.clone().with_active(active);
        let thickness = system.get::<SelfContact>().map_or(0.0, |c| c.thickness);
        let own = active.iter().filter(|a| **a).count().max(1);
        let mut attempt = Attempt { reach: FIRST_REACH * thickness, dt: self.options.first, steps: 0 };
        while attempt.steps < STEPS {
            let was = attempt.steps;
            let subdomain = self.cut_out(system, &tree, x, active, attempt.reach).standing_for(multiplicity);
            let nodes_per_active = subdomain.len() / own;
            if let Some(end) = self.run(subdomain, system, x, &mut attempt, watch)? {
                return Ok(end);
            }
            attempt.adapt(thickness, attempt.steps - was, nodes_per_active);
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Moves a subdomain until it is at rest, `watch` breaks or it leaves its reach; returns which
    /// of the first two came first.
    fn run<'s>(
        &self,
        mut subdomain: Subdomain<'s>,
        system: &mut System<'s>,
        x: &mut [Vec3],
        attempt: &mut Attempt,
        watch: &mut Watch<'_>,
    ) -> Result<Option<ControlFlow<()>>, Halt> {
        let (mut own, layout) = (subdomain.pick(x), subdomain.pick(self.layout));
        let nearby = Nearby::fenced(subdomain.tree(self.tree, &layout), own.clone(), attempt.reach);
        let mut inner = NewtonState::with(nearby, &mut subdomain.system, &layout, &own, attempt.dt);
        let mut end = None;
        while end.is_none() && attempt.steps < STEPS && !inner.has_left {
            let outcome = inner.step(&mut subdomain.system, &mut own, &self.options, self.stop)?;
            attempt.steps += 1;
            let flow = watch(&subdomain.system, &own, &outcome);
            end = (flow.is_break() || outcome.at_rest).then_some(flow);
        }
        attempt.dt = inner.dt;
        subdomain.put_back(&own, system, x);
        Ok(end)
    }

    /// The active nodes and all triangles that they may meet while they move by up to `reach`.
    fn cut_out<'s>(
        &self,
        system: &mut System<'s>,
        tree: &ClothTree,
        x: &[Vec3],
        active: &[bool],
        reach: f64,
    ) -> Subdomain<'s> {
        let Some(self_contact) = system.get_mut::<SelfContact>() else {
            return Subdomain::of(system, active.to_vec());
        };
        // These pairs are those of the last cloth.
        self_contact.pairs.clear();
        let near = tree.about(x, self_contact.thickness + 2.0 * reach);
        let included = near.iter().zip(active).map(|(n, a)| *n || *a).collect();
        Subdomain::with_neighbours(system, active.to_vec(), included)
    }
}

#[cfg(test)]
mod tests;
