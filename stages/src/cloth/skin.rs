//! The last look at the skin: triangles, not only vertices, stay outside.
//!
//! Method: contacts hold vertices off, farther where the skin bends between two of them (see `contact`), but
//! where it bends more than the thickness makes up for, the middle of a long edge can dip below. Middles of edges and triangles that lie under [`CLEAR`] are lifted by moving the
//! nodes they belong to, a few rounds of fractions of a millimetre. Cost: one query of edges and
//! triangles a round. Limit: skin that bulges between these points is not seen.

use super::model::{Cloth, State};
use nalgebra::Vector3;
use toile_core::artifact::{BodyContact, Collide, Point3};

/// Height over the skin that middles get, metres.
const CLEAR: f64 = 1e-4;

/// Rounds after which the rest is left as it is.
const ROUNDS: usize = 10;

/// Nodes are moved by no more than this in a round, metres: well under the thickness that
/// keeps cloth off cloth.
const MOST: f64 = 3e-4;

/// Lifts edges and triangles off the skin. Returns the number of rounds that it took.
pub(super) fn lift_off_skin(scheme: &dyn Collide, cloth: &Cloth, state: &mut State) -> usize {
    let edges = cloth.edges.iter().map(|e| e.nodes.to_vec());
    let mut groups: Vec<Vec<u32>> = edges.chain(cloth.triangles.iter().map(|t| t.to_vec())).collect();
    for round in 0..ROUNDS {
        let found = sunk(scheme, &groups, state);
        if found.is_empty() {
            return round;
        }
        let mut lifts = vec![Vector3::zeros(); cloth.len()];
        for c in &found {
            let lift = c.normal * (CLEAR - c.distance).min(MOST);
            for &n in &groups[c.vertex as usize] {
                let own = &mut lifts[n as usize];
                *own = if lift.norm_squared() > own.norm_squared() { lift } else { *own };
            }
        }
        let moves = state.x.iter_mut().zip(&lifts).zip(&cloth.inverse_inertia);
        moves.filter(|(_, free)| **free > 0.0).for_each(|((x, lift), _)| *x += lift);
        if round == 0 {
            keep_near(&mut groups, &lifts);
        }
    }
    ROUNDS
}

/// Middles of the groups that lie below the clearance.
fn sunk(scheme: &dyn Collide, groups: &[Vec<u32>], state: &State) -> Vec<BodyContact> {
    let middle = |g: &Vec<u32>| {
        let sum = g.iter().fold(Vector3::zeros(), |s, &n| s + state.x[n as usize].coords);
        Point3::from(sum / g.len() as f64)
    };
    let places: Vec<Point3> = groups.iter().map(middle).collect();
    let mut found = Vec::new();
    scheme.body_contacts(&places, CLEAR, &mut found);
    found
}

/// After the first round only groups with a moved node can change.
fn keep_near(groups: &mut Vec<Vec<u32>>, lifts: &[Vector3<f64>]) {
    groups.retain(|g| g.iter().any(|&n| lifts[n as usize] != Vector3::zeros()));
}
