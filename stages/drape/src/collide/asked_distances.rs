//! Rule `asked-distances`: distances to the body only where cloth comes.
//!
//! Fact: a body is there, of so many triangles. What sorts vertices out before the skin is looked
//! at, a lattice of distances around the whole body, is filled cell by cell where a vertex asks,
//! not ahead: feet, head and hands of a wearer, and the corners of the body's box, are never asked
//! for. Tolerance: the same bits, since the lattice bounds and never decides. Source: lazy
//! evaluation (Henderson and Morris 1976).

use toile_core::cost::{Quantity, Size};
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};
use toile_core::prelude::*;

/// When distances to the skin are worked out.
#[choice]
#[derive(Copy, Eq)]
pub enum Distances {
    /// Where a vertex needs them, each once.
    Asked,
    /// All around the body, before any cloth comes.
    Ahead,
}

/// The decision of a stage that sets up a collider for a body of so many triangles, `share` of
/// whose time it saves.
pub(crate) fn rule(distances: Distances, size: &Size, share: f64) -> Option<Decision> {
    let triangles = size.get(Quantity::BodyTriangles).filter(|n| *n > 0.0)?;
    (distances == Distances::Asked).then(|| Decision {
        rule: "asked-distances".into(),
        state: State::Simplified,
        what: "distances to the body: only where cloth comes".into(),
        fact: format!("a body of about {triangles:.0} triangles, of which cloth covers a part"),
        tolerance: Tolerance::SameBits,
        saves: Saves::Share(share),
        source: "lazy evaluation: Henderson, Morris 1976".into(),
        turn: Turn::Param { name: "distances".into(), value: "Ahead".into() },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_speaks_where_there_is_a_body_and_nothing_is_ahead() {
        let body = Size::new().with(Quantity::BodyTriangles, 17_000.0);
        let told = rule(Distances::Asked, &body, 0.5).map(|d| (d.fact, d.tolerance));
        let words = "a body of about 17000 triangles, of which cloth covers a part".to_owned();
        assert_eq!(told, Some((words, Tolerance::SameBits)));
        assert_eq!(rule(Distances::Ahead, &body, 0.5), None);
        assert_eq!(rule(Distances::Asked, &Size::new(), 0.5), None);
        assert_eq!(rule(Distances::Asked, &Size::new().with(Quantity::BodyTriangles, 0.0), 0.5), None);
    }
}
