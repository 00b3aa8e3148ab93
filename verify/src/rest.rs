//! Whether a garment is at rest, where its fabric and its friction are known.
//!
//! The engine lets it go where it is (`released`): how fast it gets, and how far it goes until it
//! is at rest.

use crate::released::{NON_STATIC, Released, released};
use crate::subject::KnownCloth;
use nalgebra::Vector3;
use serde::Serialize;
use toile_core::StageError;
use toile_core::artifact::{Garment, quantile};

/// What a garment does when it is let go.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RestFigures {
    /// The fabric's name.
    pub fabric: String,
    /// Coefficient of friction on the body.
    pub friction: f64,
    /// Distance at which the body holds cloth off, metres.
    pub thickness_m: f64,
    /// The least share of the vertices that got faster than 5 mm/s in a step.
    pub moving: f64,
    /// How far vertices move, but for the 1.5 % that move farthest, metres.
    pub moved_m: f64,
    /// The farthest that a vertex moves, metres.
    pub farthest_m: f64,
    /// Steps that were made.
    pub steps: usize,
    /// The vertex that moves farthest.
    #[serde(skip)]
    pub worst: usize,
}

/// Lets the garment go.
///
/// # Errors
/// Why it cannot be let go.
pub fn rest(garment: &Garment, cloth: &KnownCloth) -> Result<RestFigures, StageError> {
    let Released { moving, moves, steps } = released(garment, &cloth.fabric, &cloth.collider)?;
    let mut sorted: Vec<f64> = moves.iter().map(Vector3::norm).collect();
    sorted.sort_by(f64::total_cmp);
    let far = |v: usize| moves[v].norm_squared();
    let worst = (0..moves.len()).reduce(|a, b| if far(b) > far(a) { b } else { a }).unwrap_or(0);
    let card = cloth.collider.scheme.card();
    Ok(RestFigures {
        fabric: cloth.fabric.name.clone(),
        friction: card.friction,
        thickness_m: card.thickness,
        moving,
        moved_m: quantile(&sorted, 1.0 - NON_STATIC),
        farthest_m: sorted.last().copied().unwrap_or(0.0),
        steps,
        worst,
    })
}
