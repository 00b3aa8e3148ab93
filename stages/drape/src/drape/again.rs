//! Whether a garment that was sewn through itself is sewn once more, around a thin figure, and
//! which of the two results is better.

use toile_body::grown;
use toile_cloth::contact::body::Body as Solid;
use toile_cloth::contact::past::Start;
use toile_cloth::statics::drive::solve::{Equilibrium, StaticsError};
use toile_core::prelude::*;

/// Triangles may dip this deep into the body before it is said, m: the limit that vertices are
/// judged by.
pub(super) const MOST_DIP: f64 = 1e-4;

/// Why a garment is sewn once more around a thin figure, in words; nothing where it came out well,
/// or where that would not help.
pub(super) fn why_again(result: &Result<Equilibrium, StaticsError>) -> Option<&'static str> {
    match result {
        Err(StaticsError::SeamNotClosed { .. }) => Some("the body keeps seams open"),
        Err(StaticsError::Tangled { .. } | StaticsError::Crossing { .. }) => {
            Some("cloth does not come out of cloth")
        }
        // What stands beside the body falls past the thin figure, too.
        Err(StaticsError::FallsPast(fallen)) => {
            (fallen.start == Start::Around).then_some("the cloth slides off the body")
        }
        Ok(state) => (state.dip > MOST_DIP).then_some("the body comes through the cloth"),
        Err(StaticsError::NotAtRest { state, .. }) => {
            (state.dip > MOST_DIP).then_some("the body comes through the cloth")
        }
        Err(_) => None,
    }
}

/// Whether the second result of a garment replaces its first: only if its fault is less severe. Of
/// two equal faults the first is kept, because its error says more.
pub(super) fn is_better(
    second: &Result<Equilibrium, StaticsError>,
    first: &Result<Equilibrium, StaticsError>,
) -> bool {
    let faults = |result: &Result<Equilibrium, StaticsError>| match result {
        Ok(state) => usize::from(state.dip > MOST_DIP),
        Err(StaticsError::NotAtRest { state, .. }) => 1 + usize::from(state.dip > MOST_DIP),
        Err(StaticsError::Crossing { .. }) => 3,
        Err(_) => 4,
    };
    faults(second) < faults(first)
}

/// What a garment is sewn on where the body keeps its seams open: the body drawn in, which grows;
/// nothing where the collider shows no mesh.
pub(super) fn thin_of(collider: &Collider) -> Vec<Solid> {
    let Some(surface) = collider.scheme.surface() else { return Vec::new() };
    let solid =
        |points: Vec<Point3>| Solid::new(points.iter().map(|p| p.coords).collect(), surface.triangles);
    grown(surface.positions, surface.triangles).into_iter().map(solid).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_cloth::contact::past::Fallen;
    use toile_cloth::statics::report::unbalanced::{Meets, Unbalanced};

    fn state(dip: f64) -> Box<Equilibrium> {
        Box::new(Equilibrium {
            positions: vec![],
            outcome: Default::default(),
            residual: 0.0,
            unbalanced: Unbalanced { vertex: 0, force: 0.0, meets: Meets::Nothing },
            slides: vec![],
            folds: vec![],
            friction_contacts: vec![],
            offsets: vec![],
            energy: 0.0,
            dip,
            joined_at: None,
            levels: vec![],
            restarts: 0,
        })
    }

    fn at_rest(dip: f64) -> Result<Equilibrium, StaticsError> {
        Ok(*state(dip))
    }

    fn not_at_rest(dip: f64) -> Result<Equilibrium, StaticsError> {
        Err(StaticsError::NotAtRest { wanted: 1e-3, panel: "front".into(), state: state(dip) })
    }

    fn crossing() -> Result<Equilibrium, StaticsError> {
        Err(StaticsError::Crossing { pairs: 3, state: state(0.0) })
    }

    fn open() -> Result<Equilibrium, StaticsError> {
        let (seam, reversed, positions) = ("side".into(), vec![], vec![]);
        Err(StaticsError::SeamNotClosed { seam, gap: 0.1, force: 1.0, reversed, positions })
    }

    fn fallen(start: Start) -> Result<Equilibrium, StaticsError> {
        let fallen = Fallen { cloth: "'front'".into(), start, body: 1.7, is_certain: true };
        Err(StaticsError::FallsPast(Box::new(fallen)))
    }

    #[test]
    fn a_garment_is_sewn_again_where_another_way_may_help() {
        assert_eq!(why_again(&at_rest(0.0)), None);
        assert_eq!(why_again(&not_at_rest(0.0)), None, "more steps would help, another way would not");
        assert_eq!(why_again(&Err(StaticsError::Stopped)), None);
        assert_eq!(why_again(&at_rest(1e-3)), Some("the body comes through the cloth"));
        assert_eq!(why_again(&not_at_rest(1e-3)), Some("the body comes through the cloth"));
        assert_eq!(why_again(&crossing()), Some("cloth does not come out of cloth"));
        assert_eq!(why_again(&open()), Some("the body keeps seams open"));
        assert_eq!(why_again(&fallen(Start::Around)), Some("the cloth slides off the body"));
        assert_eq!(why_again(&fallen(Start::Below(0.1))), None, "it would fall past the thin figure, too");
    }

    #[test]
    fn the_second_result_is_taken_only_where_it_has_fewer_faults() {
        let ranked: [fn() -> Result<Equilibrium, StaticsError>; 5] =
            [|| at_rest(0.0), || at_rest(1e-3), || not_at_rest(1e-3), crossing, open];
        for (k, better) in ranked.iter().enumerate() {
            for (l, worse) in ranked.iter().enumerate() {
                assert_eq!(is_better(&better(), &worse()), k < l, "{k} and {l}");
            }
        }
    }
}
