//! What a collider asks of its solver beside distance and friction, and a solver for rest has no
//! use for.

use toile_core::prelude::*;

/// Refuses a collider with a setting that `solver` would not use.
pub fn check_response(collider: Option<&Collider>, solver: &str) -> Result<(), StageError> {
    let Some(card) = collider.map(|c| c.scheme.card()) else { return Ok(()) };
    let unused = match (card.restitution != 0.0, card.penalty.is_some()) {
        (true, _) => "restitution",
        (_, true) => "penalty",
        _ => return Ok(()),
    };
    let message = format!("`{solver}` does not use the collider's `{unused}`");
    let e = StageError::new(ErrorCode::InvalidParameter, message).at("collider");
    Err(e.hint(format!(
        "take `{unused}` out of the collider, or drape in time with `ImplicitEuler`, which uses it"
    )))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use toile_fixtures::cloth::Capsules;

    fn collider(restitution: f64, penalty: Option<Penalty>) -> Collider {
        let plain = Capsules::torso();
        Capsules { card: ColliderCard { restitution, penalty, ..plain.card }, ..plain }.collider()
    }

    #[test]
    fn what_the_solver_does_not_use_is_refused_by_name() {
        assert!(check_response(None, "StaticEquilibrium").is_ok());
        assert!(check_response(Some(&collider(0.0, None)), "StaticEquilibrium").is_ok());
        let e = check_response(Some(&collider(0.5, None)), "StaticEquilibrium").unwrap_err();
        assert_eq!(e.code, ErrorCode::InvalidParameter);
        assert_eq!(e.message, "`StaticEquilibrium` does not use the collider's `restitution`");
        assert_eq!(
            e.hint.as_deref(),
            Some(
                "take `restitution` out of the collider, or drape in time with `ImplicitEuler`, which uses it"
            )
        );
        let e = check_response(Some(&collider(0.0, Some(Penalty::Exponential(1.0)))), "StaticEquilibrium")
            .unwrap_err();
        assert_eq!(e.message, "`StaticEquilibrium` does not use the collider's `penalty`");
    }
}
