//! Neighbour pairs of cloth that may collide, kept while the cloth hardly moves.
//!
//! Method: pairs are sought up to a slack beyond the thickness of contact. The pairs of a node stay
//! valid until it has moved by that slack, which near rest takes many steps. Then they are sought
//! anew for the nodes that have moved so far; the others keep theirs. The pairs of a node with a
//! long move are sought along that move, and are valid for that step only. Cost: a search of the
//! tree for each node that has moved. Limit: a subdomain knows pairs only within a region.

use crate::contact::response::respond;
use crate::contact::step_limit::{colliding, limit_with_search};
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::Pair;

type Vec3 = Vector3<f64>;

/// Share of the slack that may be used up when a subdomain begins, which keeps the known pairs.
const KEPT: f64 = 0.3;

/// Share of the nodes with a long move above which the pairs of all nodes are sought along their
/// moves.
const MOST_LONG: f64 = 0.3;

/// Neighbour pairs, and the positions of the nodes when the pairs were sought.
pub(crate) struct Nearby {
    tree: Option<ClothTree>,
    /// Where the pairs of each node were sought; `None` where they are valid for one step only.
    at: Vec<Option<Vec3>>,
    /// The region in which the pairs of a subdomain are known.
    fence: Option<Fence>,
    /// Whether merged layers collided in the last step.
    jammed: bool,
}

/// Where the nodes of a subdomain were when it was cut out, and how far they may move from there,
/// m.
struct Fence {
    at: Vec<Vec3>,
    reach: f64,
}

impl Nearby {
    pub(crate) fn new(tree: Option<ClothTree>) -> Self {
        Self { tree, at: vec![], fence: None, jammed: false }
    }

    /// Seeks the pairs about `x`, so that they are valid for a subdomain of the `active` nodes.
    pub(crate) fn seek_about(&mut self, system: &mut System<'_>, x: &[Vec3], active: &[bool]) {
        if let (Some(tree), Some(self_contact)) = (&self.tree, system.get_mut::<SelfContact>()) {
            let still = vec![Vec3::zeros(); x.len()];
            let mut moved = outside(&self.at, x, &still, self_contact.slack());
            let near_end = outside(&self.at, x, &still, KEPT * self_contact.slack());
            moved.iter_mut().zip(near_end).zip(active).for_each(|((m, n), a)| *m |= n && *a);
            if !moved.contains(&true) {
                return;
            }
            self.at.resize(x.len(), None);
            self.at.iter_mut().zip(x).zip(&moved).filter(|(_, m)| **m).for_each(|((a, p), _)| *a = Some(*p));
            self_contact.pairs = self.renewed(tree, self_contact, &self_contact.pairs, &moved, [x, &still]);
        }
    }

    /// Where the pairs of each node were sought.
    pub(crate) fn at(&self) -> &[Option<Vec3>] {
        &self.at
    }

    /// Of a subdomain whose pairs were sought at `at`, and are valid while no node moves by `reach`
    /// from there, m.
    pub(crate) fn of_subdomain(at: Vec<Option<Vec3>>, reach: f64) -> Self {
        let at = at.into_iter().flatten().collect();
        Self { tree: None, at: vec![], fence: Some(Fence { at, reach }), jammed: false }
    }

    /// Of a subdomain with a tree of its own, which holds all triangles that its nodes may meet
    /// within `reach` of `at`, m.
    pub(crate) fn fenced(tree: ClothTree, at: Vec<Vec3>, reach: f64) -> Self {
        Self { tree: Some(tree), at: vec![], fence: Some(Fence { at, reach }), jammed: false }
    }

    /// The share of `moves` from `x` that stays in the region in which pairs are known.
    pub(crate) fn within_reach(&self, x: &[Vec3], moves: &[Vec3]) -> f64 {
        let Some(Fence { at, reach }) = &self.fence else { return 1.0 };
        let share = |((a, p), m): ((&Vec3, &Vec3), &Vec3)| {
            let left = reach - (p - a).norm();
            if m.norm() < left { 1.0 } else { (left / m.norm()).max(0.0) * 0.99 }
        };
        at.iter().zip(x).zip(moves).map(share).fold(1.0, f64::min)
    }

    /// Makes the pairs valid for `moves` from `x`.
    pub(crate) fn seek(&mut self, system: &mut System<'_>, x: &[Vec3], moves: &[Vec3]) {
        let (Some(tree), Some(self_contact)) = (&self.tree, system.get_mut::<SelfContact>()) else { return };
        let slack = self_contact.slack();
        let moved = outside(&self.at, x, moves, slack);
        if !moved.contains(&true) {
            return;
        }
        let is_long = |m: &Vec3| m.norm() >= 0.5 * slack;
        let long = moved.iter().zip(moves).filter(|(moved, m)| **moved && is_long(m)).count();
        if long as f64 > MOST_LONG * x.len() as f64 {
            self.at = vec![None; x.len()];
            self_contact.pairs = tree.pairs(x, moves, self_contact.thickness);
            return;
        }
        self.at.resize(x.len(), None);
        for (i, _) in moved.iter().enumerate().filter(|(_, m)| **m) {
            self.at[i] = (!is_long(&moves[i])).then_some(x[i]);
        }
        self_contact.pairs = self.renewed(tree, self_contact, &self_contact.pairs, &moved, [x, moves]);
    }

    /// The `known` pairs, with those of the `moved` nodes sought anew at their positions or, for
    /// one step, along their moves.
    fn renewed(
        &self,
        tree: &ClothTree,
        self_contact: &SelfContact,
        known: &[Pair],
        moved: &[bool],
        [x, moves]: [&[Vec3]; 2],
    ) -> Vec<Pair> {
        let places: Vec<Vec3> = self.at.iter().zip(x).map(|(a, p)| a.unwrap_or(*p)).collect();
        let way = |(a, m): (&Option<Vec3>, &Vec3)| if a.is_some() { Vec3::zeros() } else { *m };
        let ways: Vec<Vec3> = self.at.iter().zip(moves).map(way).collect();
        let mut pairs: Vec<Pair> =
            known.iter().filter(|p| !p.nodes.iter().any(|&i| moved[i as usize])).copied().collect();
        pairs.extend(tree.pairs_of(
            moved,
            &places,
            &ways,
            self_contact.thickness + 2.0 * self_contact.slack(),
        ));
        // Both parts are sorted, which a merge sort uses.
        pairs.sort();
        pairs
    }

    /// How many crossings the cloth has at `x`.
    pub(crate) fn crossings(&self, x: &[Vec3]) -> usize {
        self.tree.as_ref().map_or(0, |t| t.crossings(x).len())
    }

    /// Changes moves that would lead cloth through cloth: the cloth gives way where it can, and
    /// otherwise its moves are shortened until no pair collides. Returns the share of the moves
    /// that is left, or 1 while intersections are resolved, which takes long moves.
    pub(crate) fn limit(&mut self, system: &mut System<'_>, x: &[Vec3], moves: &mut [Vec3]) -> f64 {
        if self.tree.is_none() && self.fence.is_none() {
            return 1.0;
        }
        let Some(self_contact) = system.get::<SelfContact>() else { return 1.0 };
        let wanted = norm(moves);
        let apart: Vec<Pair> =
            self_contact.pairs.iter().filter(|p| !self_contact.is_intersecting(p)).copied().collect();
        let colliding_pairs = colliding(x, moves, &apart);
        if !colliding_pairs.is_empty() {
            self.jammed =
                !self_contact.stacked && colliding_pairs.iter().any(|p| self_contact.is_merged(p, x));
            let changed = respond(x, moves, &apart, colliding_pairs, &system.pinned);
            self.keep_known(self_contact.slack(), x, moves, &changed);
            system.clear_of_body(x, moves, |i| changed[i]);
            self.limit_step(system, x, moves);
        }
        let free = !system.is_intersecting();
        if wanted > 0.0 && free { norm(moves) / wanted } else { 1.0 }
    }

    /// Shortens moves that were `changed` to those for which the known pairs are valid.
    fn keep_known(&self, slack: f64, x: &[Vec3], moves: &mut [Vec3], changed: &[bool]) {
        for (i, _) in changed.iter().enumerate().filter(|(_, c)| **c) {
            let known = self.at.get(i).copied().flatten().map(|a| slack - (x[i] - a).norm());
            let fenced = self.fence.as_ref().map(|f| f.reach - (x[i] - f.at[i]).norm());
            let left = 0.99 * known.into_iter().chain(fenced).fold(f64::INFINITY, f64::min).max(0.0);
            let way = moves[i].norm();
            if way > left {
                moves[i] *= left / way;
            }
        }
    }

    /// Shortens moves until no pair collides.
    fn limit_step(&self, system: &mut System<'_>, x: &[Vec3], moves: &mut [Vec3]) {
        let Some(self_contact) = system.get_mut::<SelfContact>() else { return };
        let counts = |p: &Pair| !self_contact.is_intersecting(p);
        // Pairs sought at a position are valid for every short move, those sought along a move for
        // that move.
        let long: Vec<bool> = self.at.iter().map(Option::is_none).collect();
        let all = long.iter().all(|l| *l);
        let tree = self.tree.as_ref().filter(|_| long.contains(&true));
        let seek = |moves: &[Vec3]| {
            tree.map(|t| match all {
                true => t.pairs(x, moves, self_contact.thickness),
                false => self.renewed(t, self_contact, &self_contact.pairs, &long, [x, moves]),
            })
        };
        let first = seek(moves).unwrap_or_else(|| self_contact.pairs.clone());
        self_contact.pairs = limit_with_search(x, moves, first, counts, seek).0;
    }

    /// Whether intersections are to be resolved.
    pub(crate) fn is_intersecting(&self, system: &System<'_>) -> bool {
        system.is_intersecting() || self.jammed
    }

    /// Finds the crossings at `x`, which self-contact then resolves.
    pub(crate) fn resolve_intersections(&mut self, system: &mut System<'_>, x: &[Vec3]) {
        if let (Some(tree), Some(self_contact)) = (&self.tree, system.get_mut::<SelfContact>()) {
            self_contact.resolve_intersections(&tree.crossings(x), x);
            self.jammed = false;
        }
    }
}

fn norm(moves: &[Vec3]) -> f64 {
    moves.iter().map(Vec3::norm_squared).sum::<f64>().sqrt()
}

/// Which nodes leave the sphere of radius `reach` about their known position. A node without one
/// counts as outside.
fn outside(was: &[Option<Vec3>], x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<bool> {
    let leaves = |(i, (p, m)): (usize, (&Vec3, &Vec3))| {
        let left = reach - m.norm();
        let stays = |a: &Vec3| left > 0.0 && (p - a).norm_squared() < left * left;
        !was.get(i).and_then(Option::as_ref).is_some_and(stays)
    };
    x.iter().zip(moves).enumerate().map(leaves).collect()
}

#[cfg(test)]
mod tests;
