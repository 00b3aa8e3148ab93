//! The linear problem of each Newton step: matrix, factor and solution, kept from step to step.
//!
//! Method: a sparse Cholesky factorization by fronts (see `factor`). The pattern is that of the
//! sheet and of the contacts of the last steps. Where the matrix is not positive definite, it is
//! assembled without compression, then with more inertia. Cost: one factorization, O(n^1.5); a new
//! order of elimination where contacts are new.

use crate::linear::Pattern;
use crate::statics::factor::mixed::{Matrix, Mixed};
use crate::statics::factor::multifrontal::{Halt, Stop, Symbolic};
use crate::statics::factor::nested_dissection::smoothed;
use crate::statics::factor::scalar::Precision;
use crate::statics::forces::system::System;
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;

type Vec3 = Vector3<f64>;

/// Share of the compressive stress in the matrix near rest, where the matrix stays positive
/// definite. With all of it the matrix is the true second derivative, which is indefinite in most
/// states; without it, folds that are about to form are far too stiff.
const COMPRESSION: f64 = 0.7;

/// Longest move of a step near rest, m. Farther from rest the matrix without compression converges
/// sooner.
const NEAR_REST: f64 = 2e-3;

/// Inertia above which a matrix that is not positive definite must have numbers that are not
/// finite, 1/s².
const MOST_INERTIA: f64 = 1e12;

/// Steps for which contacts keep their places in the matrix. Contacts that end are often soon back,
/// and new places cost a new order of elimination.
const REMEMBERED: u32 = 8;

/// The matrix and its factor.
pub(crate) struct Linear {
    layout: Vec<Vec3>,
    /// Groups of nodes in contact in the last steps, with the step of their last contact.
    touched: BTreeMap<[u32; 4], u32>,
    steps: u32,
    /// The pattern of the sheet alone.
    own: Pattern,
    /// The pattern with contacts, and the slots of the sheet in it.
    pattern: Pattern,
    slots: Vec<u32>,
    symbolic: Symbolic,
    values: Vec<Matrix3<f64>>,
    factor: Mixed,
}

impl Linear {
    /// Prepares the matrix; `layout` orders the elimination.
    pub(crate) fn new(system: &mut System<'_>, layout: &[Vec3]) -> Self {
        let own = system.pattern();
        system.elastic.bind(&own);
        let mut touched = BTreeMap::new();
        system.collisions(&mut |g| _ = touched.insert(*g, 0));
        let (pattern, slots) = widened(&own, &touched);
        system.elastic.follow(&pattern, &slots);
        let layout = smoothed(&own, layout);
        let symbolic = Symbolic::new(&pattern, &layout);
        let (values, factor) = (Vec::new(), Mixed::default());
        Self { layout, touched, steps: 0, own, pattern, slots, symbolic, values, factor }
    }

    /// The places that order the elimination.
    pub(crate) fn layout(&self) -> &[Vec3] {
        &self.layout
    }

    /// Follows the contacts, of which new pairs need new places in the matrix; returns whether any
    /// did.
    pub(crate) fn follow(&mut self, system: &mut System<'_>) -> bool {
        self.steps += 1;
        let (now, mut known) = (self.steps, true);
        system.collisions(&mut |g| {
            self.touched.insert(*g, now);
            known = known && self.pattern.couples(g);
        });
        if !known {
            self.touched.retain(|_, last| now - *last < REMEMBERED);
            self.widen(system);
        }
        !known
    }

    /// Takes over changed stiffness of elements, and changed pins.
    pub(crate) fn bind(&mut self, system: &mut System<'_>) {
        if self.own.held() == system.pinned {
            system.elastic.bind(&self.own);
            system.elastic.follow(&self.pattern, &self.slots);
        } else {
            self.own = system.pattern();
            system.elastic.bind(&self.own);
            self.widen(system);
        }
    }

    /// Makes the pattern anew, for present and recent contacts.
    fn widen(&mut self, system: &mut System<'_>) {
        (self.pattern, self.slots) = widened(&self.own, &self.touched);
        system.elastic.follow(&self.pattern, &self.slots);
        self.symbolic = Symbolic::new(&self.pattern, &self.layout);
    }

    /// The step of pseudo-time `dt` from `x`; `last` is the longest move of the last step.
    pub(crate) fn step(
        &mut self,
        system: &System<'_>,
        x: &[Vec3],
        g: &[Vec3],
        [dt, last]: [f64; 2],
        precision: Precision,
        stop: &Stop,
    ) -> Result<Vec<Vec3>, Halt> {
        let mut shift = 1.0 / (dt * dt);
        let mut compression = if last < NEAR_REST { COMPRESSION } else { 0.0 };
        let right: Vec<Vec3> = g.iter().map(|g| -g).collect();
        loop {
            system.matrix(x, &self.pattern, shift, compression, &mut self.values);
            let matrix = Matrix { pattern: &self.pattern, symbolic: &self.symbolic, values: &self.values };
            match self.factor.solve(matrix, &right, precision, compression > 0.0, stop) {
                Ok(moves) => return Ok(moves),
                Err(Halt::NotPositive(_)) if compression > 0.0 => compression = 0.0,
                // Rounding may make a nearly singular matrix indefinite; more inertia prevents it.
                Err(Halt::NotPositive(_)) if shift <= MOST_INERTIA => shift *= 100.0,
                Err(halt) => return Err(halt),
            }
        }
    }

    /// The step with the factor of the last step, from nearly the same positions.
    pub(crate) fn again(&self, g: &[Vec3]) -> Vec<Vec3> {
        let mut step: Vec<Vec3> = g.iter().map(|g| -g).collect();
        self.factor.again(&self.symbolic, &mut step);
        step
    }
}

/// The pattern of a sheet and of contacts, and the slots of the sheet in it.
fn widened(own: &Pattern, touched: &BTreeMap<[u32; 4], u32>) -> (Pattern, Vec<u32>) {
    own.with(|visit| touched.keys().for_each(|g| visit(g)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::energy::Models;
    use crate::scene::generate;
    use crate::statics::forces::self_contact::SelfContact;
    use crate::statics::levels::assemble::{assemble, cloths};
    use crate::statics::levels::pieces::Pieces;
    use toile_geometry::pair::{Kind, Pair};

    /// Two sheets over each other; the one pair that may touch does, or not.
    #[test]
    fn what_touched_of_late_keeps_its_place() {
        let scene = generate::stack(2, 4);
        let pieces = Pieces::new(&scene);
        let sheet = pieces.sewn_sheet(&cloths(&scene)).unwrap();
        let mut system = assemble(&scene, None, &pieces, &sheet, false, Models::STATIC).unwrap();
        let mut x = scene.positions.clone();
        let n = (x.len() / 2) as u32;
        let [a, b, c] = scene.triangles[0];
        let middle = (x[a as usize] + x[b as usize] + x[c as usize]) / 3.0;
        let pair = Pair { kind: Kind::VertexTriangle, nodes: [n, a, b, c] };
        let self_contact = system.get_mut::<SelfContact>().unwrap();
        self_contact.pairs = vec![pair];
        let thickness = self_contact.thickness;
        let mut linear = Linear::new(&mut system, &scene.positions);
        let mut follow = |height: f64, system: &mut System<'_>| {
            x[n as usize] = middle + Vec3::y() * height;
            system.update_contacts(&x);
            linear.follow(system)
        };
        assert!(!follow(2.0 * thickness, &mut system));
        assert!(follow(0.5 * thickness, &mut system), "a new contact has no place yet");
        for _ in 0..3 {
            assert!(!follow(2.0 * thickness, &mut system));
            assert!(!follow(0.5 * thickness, &mut system));
        }
    }
}
