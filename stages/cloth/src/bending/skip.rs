//! Skip-one springs: between the two tips over every inner edge, as the classic mass-spring cloth has them.
//!
//! A small fold shortens the span by its square only, so a flat sheet has no rigidity at all against small bending; the spring acts once
//! the fold is large. Stiffness `D / span² * width`: the force that a strip of rigidity D would need to buckle by about half.
//! Kept because the classic systems had it, and to measure how far it is off.

use nalgebra::Matrix3;

use super::Rigidity;
use super::flap::{Flap, flaps};
use crate::error::ClothError;
use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::Sheet;

#[derive(Debug, Clone, Copy)]
struct Span {
    vertices: [u32; 2],
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
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn new(sheet: &Sheet, rigidity: &Rigidity) -> Result<Assembled<2, Self>, ClothError> {
        rigidity.check()?;
        let span = |f: Flap| {
            let width = (f.slenderness * f.area).sqrt();
            Span {
                vertices: [f.vertices[2], f.vertices[3]],
                rest: f.span,
                stiffness: f.rigidity * width / f.span.powi(3),
            }
        };
        let spans = flaps(sheet, rigidity).into_iter().map(span);
        Ok(Assembled(Self { spans: spans.collect() }))
    }
}

impl Element<2> for SkipOne {
    fn name(&self) -> &'static str {
        "skip-one springs"
    }

    fn count(&self) -> usize {
        self.spans.len()
    }

    fn vertices(&self, e: usize) -> [u32; 2] {
        self.spans[e].vertices
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

    fn hessian(&self, e: usize, x: &[Vec3; 2], projection: Projection) -> [[Matrix3<f64>; 2]; 2] {
        let s = &self.spans[e];
        let d = x[1] - x[0];
        let length = d.norm().max(f64::MIN_POSITIVE);
        let unit = d / length;
        let mut across = s.stiffness * (1.0 - s.rest / length);
        if projection == Projection::PositiveSemiDefinite {
            across = across.max(0.0);
        }
        let h = Matrix3::identity() * across + unit * unit.transpose() * (s.stiffness - across);
        [[h, -h], [-h, h]]
    }
}
