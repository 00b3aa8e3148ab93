//! One piece solved again with its seam lengths as equations and stiff terms for its straight
//! edges.
//!
//! The start is the flat piece as it is; what comes out has the least energy of all shapes that
//! fulfil the equations. Cost: a few Newton iterations, each with one more solution a seam side.

use super::straight::{line_terms, snap};
use super::{CareOptions, Objective, boundary_chains, straight_chains};
use crate::error::FlattenError;
use crate::flatteners::{Flattening, Placement};
use crate::frames::{TriangleFrames, flipped};
use crate::newton::{Constraint, NewtonOutcome, NewtonProblem, QuadraticTerm};
use crate::surface::PieceSurface;
use crate::system::PieceSystem;
use nalgebra::{Point2, Vector2};

/// One piece and what is asked of it.
pub(super) struct PieceCare<'a> {
    pub(super) surface: &'a PieceSurface,
    pub(super) objective: &'a Objective,
    pub(super) placement: &'a Placement,
    pub(super) options: CareOptions,
    /// Chains and the lengths that they should get.
    pub(super) sides: Vec<(Vec<u32>, f64)>,
}

impl PieceCare<'_> {
    /// Solves again, with some vertices drawn to places (in the unit of the piece); returns how
    /// many chains are straight now.
    pub(super) fn solve(&self, flat: &mut Flattening, near: &[QuadraticTerm]) -> Result<usize, FlattenError> {
        let lines = self.lines(flat, near);
        if lines.is_empty() && self.sides.is_empty() && near.is_empty() {
            return Ok(0);
        }
        let frames = TriangleFrames::new(self.surface);
        let tension = self.placement.tension;
        let plane = StretchedPlane { frames, stretch: Vector2::new(1.0 + tension.weft, 1.0 + tension.warp) };
        let mut q = plane.stretched(&flat.points);
        let lines_held = line_terms(&lines, &q);
        flat.report =
            self.minimise(&plane, [lines_held.clone(), plane.terms(near)].concat(), flat.upright, &mut q)?;
        let solved = q.clone();
        snap(&lines_held, &mut q);
        if !flipped(self.surface.triangles(), &q).is_empty() {
            q = solved;
        }
        let points = plane.relaxed(&q);
        if let Some(&triangle) = flipped(self.surface.triangles(), &points).first() {
            return Err(FlattenError::TooSmall { triangle });
        }
        flat.points = points;
        Ok(lines.len())
    }

    fn minimise(
        &self,
        plane: &StretchedPlane,
        terms: Vec<QuadraticTerm>,
        upright: bool,
        q: &mut [Point2<f64>],
    ) -> Result<NewtonOutcome, FlattenError> {
        let pairs: Vec<[u32; 2]> = terms.iter().flat_map(QuadraticTerm::pairs).collect();
        let (system, energy) = (PieceSystem::new(self.surface, &pairs), self.objective.energy(self.surface)?);
        let constraints = self.constraints(plane, upright, energy.turns_freely());
        let problem = NewtonProblem {
            system: &system,
            frames: &plane.frames,
            energy: &*energy,
            terms: &terms,
            constraints: &constraints,
        };
        problem.minimise(q, self.options.newton)
    }

    /// The chains to make straight, judged where the drawn vertices should lie.
    fn lines(&self, flat: &Flattening, near: &[QuadraticTerm]) -> Vec<Vec<u32>> {
        if self.options.straight == 0.0 {
            return Vec::new();
        }
        let ends: Vec<u32> = self.sides.iter().flat_map(|(c, _)| [c[0], c[c.len() - 1]]).collect();
        let mut points = flat.points.clone();
        near.iter().for_each(|t| points[t.vertices[0] as usize] = Point2::from(t.target));
        let chains = boundary_chains(self.surface, &points, &ends, self.options.corner.to_radians());
        straight_chains(&chains, &points, self.options.straight)
    }

    fn constraints(&self, plane: &StretchedPlane, upright: bool, turns: bool) -> Vec<Constraint> {
        let (unit, scale) = (plane.frames.unit(), plane.stretch.map(|s| 1.0 / s));
        let side = |(vertices, target): &(Vec<u32>, f64)| Constraint::ChainLength {
            vertices: vertices.clone(),
            target: target / unit,
            scale,
        };
        let mut constraints: Vec<_> = self.sides.iter().map(side).collect();
        let even = scale.x == scale.y;
        if upright && !(turns && even) {
            let weights = self.placement.grain.weights(self.surface, &plane.frames);
            constraints.push(Constraint::Balance { weights, direction: Vector2::x() });
        }
        constraints
    }
}

/// The plane in which the solver works: stretched as the garment is, so that the energy knows it,
/// lengths in the unit of the frames.
struct StretchedPlane {
    frames: TriangleFrames,
    stretch: Vector2<f64>,
}

impl StretchedPlane {
    fn stretched(&self, flat: &[Point2<f64>]) -> Vec<Point2<f64>> {
        let place = |p: &Point2<f64>| Point2::from(p.coords.component_mul(&self.stretch));
        self.frames.scaled(flat).iter().map(place).collect()
    }

    fn relaxed(&self, q: &[Point2<f64>]) -> Vec<Point2<f64>> {
        let relaxed: Vec<_> = q.iter().map(|p| Point2::from(p.coords.component_div(&self.stretch))).collect();
        self.frames.restored(&relaxed)
    }

    fn terms(&self, near: &[QuadraticTerm]) -> Vec<QuadraticTerm> {
        let target = |t: &QuadraticTerm| t.target.component_mul(&self.stretch) / self.frames.unit();
        // Normals of stretched lines.
        let normal = |t: &QuadraticTerm| t.normal.map(|n| n.component_div(&self.stretch).normalize());
        near.iter().map(|t| QuadraticTerm { target: target(t), normal: normal(t), ..*t }).collect()
    }
}
