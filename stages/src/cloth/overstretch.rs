//! Correction of over-stretched springs.
//!
//! Method: an edge that would end a step longer than allowed is shortened: its free end is moved
//! if one is held, both by their share of the inverse mass if none is (Provot 1995) [METHODS 4]. The
//! move is made as an impulse, so that velocities agree with positions and momentum is kept.
//! Cost: one root an edge, only in steps where a triangle comes near the limit.
//! Limit: one sweep; neighbours may be stretched again and are caught in the next step.

use super::model::{Cloth, State};

/// Shortens every edge that would be longer than `1 + limit` times its flat length after `dt`.
/// Returns how many were.
pub fn limit_stretch(cloth: &Cloth, state: &mut State, limit: f64, dt: f64) -> usize {
    let mut corrected = 0;
    for e in &cloth.edges {
        let [a, b] = e.nodes.map(|n| n as usize);
        let free = cloth.inverse_inertia[a] + cloth.inverse_inertia[b];
        let apart = (state.x[b] + state.v[b] * dt) - (state.x[a] + state.v[a] * dt);
        let longest = e.length * (1.0 + limit);
        let square = apart.norm_squared();
        if square <= longest * longest || free <= 0.0 {
            continue;
        }
        let length = square.sqrt();
        let impulse = apart * ((length - longest) / (length * dt * free));
        state.v[a] += impulse * cloth.inverse_inertia[a];
        state.v[b] -= impulse * cloth.inverse_inertia[b];
        corrected += 1;
    }
    corrected
}
