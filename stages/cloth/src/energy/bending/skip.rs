//! Skip-one springs: between the two tips over every inner edge, as the classic mass-spring cloth
//! has them.
//!
//! A small fold shortens the span by its square only, so a flat sheet has no rigidity at all
//! against small bending; the spring acts once the fold is large. Stiffness `D / span² * width`:
//! the force that a strip of rigidity D would need to buckle by about half. Kept because the
//! classic systems had it, and to measure how far it is off.

use super::flap::{Flap, flaps};
use crate::energy::{Assembled, Blocks, Cloth, Element, Projection, Subset, Vec3, add_block_of};
use crate::mesh::Side;
use nalgebra::{Matrix3, Vector2};

#[derive(Debug, Clone, Copy)]
struct Span {
    nodes: [u32; 2],
    rest: f64,
    stiffness: f64,
}

/// The springs.
#[derive(Debug, Clone)]
pub struct SkipOne {
    spans: Vec<Span>,
}

impl SkipOne {
    /// One spring over each inner edge.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Assembled<2, Self> {
        let across = |side: &Side| {
            let (r, k) = (&cloth.sheet.rest()[side.triangle as usize], side.corner as usize);
            let e = (r[(k + 2) % 3] - r[(k + 1) % 3]).normalize();
            cloth.rigidity(side.triangle as usize).along(&Vector2::new(e.y, -e.x))
        };
        let inner = cloth.sheet.edges().iter().filter_map(|e| Some((e.sides.0, e.sides.1?)));
        let rigidity = inner.map(|(one, other)| 0.5 * (across(&one) + across(&other)));
        let span = |(f, rigidity): (Flap, f64)| {
            let width = (f.slenderness * f.area).sqrt();
            let stiffness = rigidity * width / f.span.powi(3);
            Span { nodes: [f.vertices[2], f.vertices[3]], rest: f.span, stiffness }
        };
        let flaps = flaps(cloth.sheet);
        Assembled(Self { spans: flaps.into_iter().zip(rigidity).map(span).collect() })
    }
}

impl Element<2> for SkipOne {
    type State = Blocks<2>;

    fn name(&self) -> &'static str {
        "skip-one springs"
    }

    fn count(&self) -> usize {
        self.spans.len()
    }

    fn nodes(&self, e: usize) -> [u32; 2] {
        self.spans[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 2]) -> f64 {
        0.5 * self.spans[e].stiffness * ((x[1] - x[0]).norm() - self.spans[e].rest).powi(2)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 2]) -> [Vec3; 2] {
        let s = &self.spans[e];
        let d = x[1] - x[0];
        let length = d.norm();
        let pull = if length > 0.0 { d * (s.stiffness * (1.0 - s.rest / length)) } else { Vec3::zeros() };
        [-pull, pull]
    }

    fn state(&self, e: usize, x: &[Vec3; 2], form: Projection) -> Blocks<2> {
        let s = &self.spans[e];
        if form == Projection::Bound {
            let h = Matrix3::identity() * s.stiffness;
            return [[h, -h], [-h, h]];
        }
        let d = x[1] - x[0];
        let length = d.norm().max(f64::MIN_POSITIVE);
        let unit = d / length;
        let mut across = s.stiffness * (1.0 - s.rest / length);
        if across < 0.0 {
            across *= form.compression();
        }
        let h = Matrix3::identity() * across + unit * unit.transpose() * (s.stiffness - across);
        [[h, -h], [-h, h]]
    }
    fn add_block(&self, _: usize, state: &Blocks<2>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        add_block_of(state, row, column, sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let span = |&e: &usize| Span { nodes: subset.renumbered(self.spans[e].nodes), ..self.spans[e] };
        Self { spans: elements.iter().map(span).collect() }
    }

    fn scale_bending(&mut self, by: f64) {
        self.spans.iter_mut().for_each(|s| s.stiffness *= by);
    }
}
