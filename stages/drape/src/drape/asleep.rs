//! Rule `regions-at-rest`: vertices at rest are held fixed while few others still move.
//!
//! Fact: where a step moved few vertices (at most 15 % of all, those within two rings around them
//! counted) these are solved as a system of their own until they rest, and all others are held.
//! Tolerance: afterwards the whole mesh takes steps again, and rest is proved with all vertices, so
//! the state meets the same limit of speed. Which of several neighbouring states is found may
//! differ, as between starts that are moved by a millimetre. Source: Lanzkron, Rose, Wilkes 1996.

use super::mixed_precision::{APART_CONTINUED, APART_STRAIGHT};
use toile_core::cost::{Quantity, Size};
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};

/// Share of the stage's time that it saves, on garments of some thousand triangles: continued.
const SHARE_CONTINUED: f64 = 0.05;
/// Share of the stage's time that it saves, on garments of some thousand triangles: straight.
const SHARE_STRAIGHT: f64 = 0.25;

/// The decision of a drape of so many triangles.
pub(super) fn rule(asleep: bool, continued: bool, size: &Size) -> Option<Decision> {
    let triangles = size.get(Quantity::Triangles).filter(|n| *n > 0.0)?;
    asleep.then(|| Decision {
        rule: "regions-at-rest".into(),
        state: State::Simplified,
        what: "steps of all vertices: while few of them move, only these".into(),
        fact: format!("about {triangles:.0} triangles, most of which rest before the last ones do"),
        tolerance: Tolerance::Distance(if continued { APART_CONTINUED } else { APART_STRAIGHT }),
        saves: Saves::Share(if continued { SHARE_CONTINUED } else { SHARE_STRAIGHT }),
        source: "nonlinear elimination: Lanzkron, Rose, Wilkes 1996".into(),
        turn: Turn::Param { name: "asleep".into(), value: "false".into() },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_speaks_where_regions_may_sleep_and_there_is_cloth() {
        let size = Size::new().with(Quantity::Triangles, 4_673.0);
        let told = rule(true, true, &size).map(|d| (d.fact, d.tolerance));
        let words = "about 4673 triangles, most of which rest before the last ones do".to_owned();
        assert_eq!(told, Some((words, Tolerance::Distance(0.008))));
        assert_eq!(rule(true, false, &size).map(|d| d.tolerance), Some(Tolerance::Distance(0.02)));
        assert_eq!(rule(false, true, &size), None);
        assert_eq!(rule(true, true, &Size::new()), None);
    }
}
