//! Errors of the engine, each with the place and the value at fault.

use thiserror::Error;

/// A fault of the input or a stop of a solver. Checked before the first step wherever that is
/// possible.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ClothError {
    /// A triangle without area, or so thin that its strain is noise.
    #[error(
        "triangle {index} is degenerate (quality {quality:.1e}, least {least:.0e}); remesh or remove it",
        least = crate::mesh::LEAST_QUALITY
    )]
    DegenerateTriangle {
        /// The triangle.
        index: usize,
        /// 1 for equilateral, 0 for no area.
        quality: f64,
    },
    /// Two vertices of one edge at the same place.
    #[error("the edge between vertices {a} and {b} has no length; merge the two vertices")]
    ZeroLengthEdge {
        /// The lower vertex.
        a: usize,
        /// The higher vertex.
        b: usize,
    },
    /// A triangle that runs clockwise in its rest frame.
    #[error("triangle {index} is turned over in the rest shape; list its corners counter-clockwise")]
    InvertedTriangle {
        /// The triangle.
        index: usize,
    },
    /// NaN or infinity.
    #[error("{field}[{index}] is not a finite number")]
    NonFiniteInput {
        /// Which array or parameter.
        field: &'static str,
        /// Its entry; 0 for a scalar.
        index: usize,
    },
    /// A parameter outside its range.
    #[error("{name} = {value} is out of range: {range}")]
    InvalidParameter {
        /// The parameter.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The allowed range, in words.
        range: &'static str,
    },
    /// An edge of more than two triangles, or two triangles that disagree on which side is up.
    #[error("the edge between vertices {a} and {b} is not manifold: {why}")]
    NonManifoldEdge {
        /// The lower vertex.
        a: usize,
        /// The higher vertex.
        b: usize,
        /// The fault.
        why: &'static str,
    },
    /// A triangle that is listed twice.
    #[error("triangles {first} and {second} are the same: both join vertices {}, {} and {}; remove one of them", of[0], of[1], of[2])]
    TriangleTwice {
        /// The first of them.
        first: usize,
        /// The second.
        second: usize,
        /// Their vertices, ascending.
        of: [u32; 3],
    },
    /// Nothing to simulate.
    #[error("the scene has no triangles")]
    EmptyScene,
    /// An index that points past the end.
    #[error("{what} {index} refers to vertex {vertex}, but there are {count}")]
    VertexOutOfRange {
        /// The kind of element that refers to it.
        what: &'static str,
        /// Which of them.
        index: usize,
        /// The requested vertex.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// An explicit step that would blow up.
    #[error("time step {dt:.3e} s is unstable: the limit 2/omega_max is {limit:.3e} s")]
    TimeStepUnstable {
        /// The requested step.
        dt: f64,
        /// The largest stable step.
        limit: f64,
    },
    /// Wind where only a potential can be solved for.
    #[error(
        "wind of {speed} m/s has no potential, so this solver finds no state of rest in it; take ImplicitEuler, \
         CentralDifferences, Xpbd or Projective, which move the cloth until it rests"
    )]
    Wind {
        /// Its speed, m/s.
        speed: f64,
    },
    /// More stretch than the model is meant for.
    #[error("triangle {index} is stretched by {strain:.3}, above the limit {limit:.3}")]
    StrainLimitExceeded {
        /// The triangle.
        index: usize,
        /// Greatest principal engineering strain.
        strain: f64,
        /// The allowed value.
        limit: f64,
    },
    /// A solver that ran out of iterations before its residual was small.
    #[error("no convergence after {iterations} iterations: residual {residual:.2e} N, wanted {wanted:.2e} N")]
    NotConverged {
        /// Iterations made.
        iterations: usize,
        /// Largest force left on a free vertex.
        residual: f64,
        /// The tolerance.
        wanted: f64,
    },
    /// A matrix that could not be factored even with the largest shift.
    #[error("the stiffness matrix could not be factored: {why}")]
    Factorization {
        /// The message of the factorization.
        why: String,
    },
    /// The caller asked to stop.
    #[error("stopped")]
    Stopped,
    /// A value that became NaN or infinite while solving.
    #[error("{what} became non-finite in step {step}")]
    Diverged {
        /// Which quantity.
        what: &'static str,
        /// When.
        step: usize,
    },
}

/// Checks one scalar against NaN, infinity and a range.
///
/// # Errors
/// [`ClothError::NonFiniteInput`] or [`ClothError::InvalidParameter`].
pub fn check_parameter(
    name: &'static str,
    value: f64,
    allowed: impl Fn(f64) -> bool,
    range: &'static str,
) -> Result<(), ClothError> {
    if !value.is_finite() {
        return Err(ClothError::NonFiniteInput { field: name, index: 0 });
    }
    if allowed(value) { Ok(()) } else { Err(ClothError::InvalidParameter { name, value, range }) }
}
