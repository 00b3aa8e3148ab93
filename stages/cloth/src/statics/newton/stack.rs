//! A pile of many cloths comes to rest one by one, from the innermost outwards, before all of them
//! move together.
//!
//! Where many cloths start in the air they all fall at once, and wherever two meet the step of all
//! of them is cut short. One that comes down on cloth that holds still is a small problem: some
//! tens of steps of a sheet's own size. Each is laid down with the weight of all that will lie on
//! it, as if these had its shape (see [`Subdomain::standing_for`]). What is left for the whole is what
//! this leaves out, and takes some tens of steps (block Gauss-Seidel, used once, as a start).
//!
//! What a cloth may meet is cut out with it (see `subdomain`) and known within a reach of where it
//! is; beyond that it is cut out anew. Cost: for each cloth O(n) a cut, and steps of its own and
//! its neighbours' size.

use crate::scene::Scene;
use crate::statics::factor::multifrontal::{Halt, Stop};
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

/// Cloths from which on they are laid down one by one; fewer come to rest together sooner.
const MANY: usize = 6;

/// Steps of one cloth at most.
const STEPS: usize = 200;

/// How far about a cloth is known at first, and at least, in thicknesses.
const REACH: (f64, f64) = (16.0, 4.0);

/// Nodes of a part for each that is awake, rounded down, above which the reach is halved.
const MOST_SEEN: usize = 20;

/// Steps within which a cloth that leaves its reach is given a longer one.
const SOON: usize = 3;

/// How many cloths a scene has, where they are so many and may meet that they are laid down one by
/// one.
pub(crate) fn stack_size(scene: &Scene) -> Option<usize> {
    Some(scene).filter(|s| s.self_collision).map(count_cloths).filter(|n| *n >= MANY)
}

/// What cloths are laid down with.
pub(crate) struct StackStart<'a> {
    /// Orders the elimination.
    pub(crate) layout: &'a [Vec3],
    /// Finds cloth near cloth.
    pub(crate) tree: &'a ClothTree,
    /// How fast to go.
    pub(crate) options: NewtonOptions,
    /// Asked every few milliseconds.
    pub(crate) stop: &'a Stop<'a>,
}

/// Brings each cloth near rest on those before it; breaks where `watch` does.
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
    groups(system.masses.len(), system.links().into_iter())
}

/// The cloths with triangles, from the innermost: by layer, then by mean distance from the body, or
/// by height where there is none.
fn outwards(system: &System<'_>, x: &[Vec3], of: &[u32], count: usize) -> Vec<u32> {
    let far = distances(system, x);
    let mut mean = vec![(0u32, 0.0, 0usize); count];
    for (i, &c) in of.iter().enumerate() {
        let layer = system.self_contact.as_ref().and_then(|c| c.order.get(i)).copied().unwrap_or(0);
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
    let Some(s) = &system.body_contact else { return x.iter().map(|p| -p.dot(&system.gravity)).collect() };
    let near = s.body.nearest(x, &vec![f64::INFINITY; x.len()]);
    near.into_iter().map(|n| n.map_or(f64::INFINITY, |n| n.distance)).collect()
}

/// How far a cloth has come.
struct Attempt {
    /// How far about it is known, m.
    reach: f64,
    /// The step of pseudo-time, s.
    dt: f64,
    steps: usize,
}

impl Attempt {
    /// Finds the next reach, after so many steps within the last.
    fn adapt(&mut self, thickness: f64, steps: usize, seen_for_each: usize) {
        if seen_for_each > MOST_SEEN {
            self.reach = (0.5 * self.reach).max(REACH.1 * thickness);
        } else if steps < SOON {
            self.reach *= 2.0;
        }
    }
}

impl StackStart<'_> {
    /// Brings the awake nodes near rest, all else holding still; they stand for so many cloths, one
    /// on the other.
    fn settle(
        &self,
        system: &mut System<'_>,
        x: &mut [Vec3],
        active: &[bool],
        bundle: usize,
        watch: &mut Watch<'_>,
    ) -> Result<ControlFlow<()>, Halt> {
        let tree = self.tree.clone().with_active(active);
        let thickness = system.self_contact.as_ref().map_or(0.0, |c| c.thickness);
        let own = active.iter().filter(|a| **a).count().max(1);
        let mut way = Attempt { reach: REACH.0 * thickness, dt: self.options.first, steps: 0 };
        while way.steps < STEPS {
            let was = way.steps;
            let subdomain = self.cut_out(system, &tree, x, active, way.reach).standing_for(bundle);
            let seen = subdomain.len() / own;
            if let Some(end) = self.go(subdomain, system, x, &mut way, watch)? {
                return Ok(end);
            }
            way.adapt(thickness, way.steps - was, seen);
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Moves a part until it is at rest, `watch` breaks or it leaves what it knows; what came first
    /// of the first two.
    fn go<'s>(
        &self,
        mut subdomain: Subdomain<'s>,
        system: &mut System<'s>,
        x: &mut [Vec3],
        way: &mut Attempt,
        watch: &mut Watch<'_>,
    ) -> Result<Option<ControlFlow<()>>, Halt> {
        let (mut own, layout) = (subdomain.pick(x), subdomain.pick(self.layout));
        let nearby = Nearby::fenced(subdomain.tree(self.tree, &layout), own.clone(), way.reach);
        let mut inner = NewtonState::with(nearby, &mut subdomain.system, &layout, &own, way.dt);
        let mut end = None;
        while end.is_none() && way.steps < STEPS && !inner.has_left {
            let outcome = inner.step(&mut subdomain.system, &mut own, &self.options, self.stop)?;
            way.steps += 1;
            let flow = watch(&subdomain.system, &own, &outcome);
            end = (flow.is_break() || outcome.at_rest).then_some(flow);
        }
        way.dt = inner.dt;
        subdomain.put_back(&own, system, x);
        Ok(end)
    }

    /// The awake nodes and all triangles that they may meet while they move by up to `reach`.
    fn cut_out<'s>(
        &self,
        system: &mut System<'s>,
        tree: &ClothTree,
        x: &[Vec3],
        active: &[bool],
        reach: f64,
    ) -> Subdomain<'s> {
        let Some(self_contact) = &mut system.self_contact else {
            return Subdomain::of(system, active.to_vec());
        };
        // Those of the last cloth; this one seeks its own.
        self_contact.pairs.clear();
        let near = tree.about(x, self_contact.thickness + 2.0 * reach);
        let seen = near.iter().zip(active).map(|(n, a)| *n || *a).collect();
        Subdomain::beside(system, active.to_vec(), seen)
    }
}

#[cfg(test)]
mod tests;
