//! What makes a fit one of its form and no other.

use crate::style::block::template::bow::Bow;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Mark;

/// What is said of a mark that either side lacks.
pub(crate) fn missing(fit: &Fit, mark: &Mark) -> Option<&'static str> {
    let all = |holds: &dyn Fn(&[Bow]) -> bool| fit.sides.iter().all(|side| holds(side));
    let (shown, reason) = match *mark {
        Mark::Dent(k, least, reason) => (all(&|s| -turn(s, k) >= least), reason),
        Mark::Corner(k, least, reason) => (all(&|s| turn(s, k) >= least), reason),
        Mark::Hollow(k, least, reason) => (all(&|s| 0.5 * (s[k].bow[0] + s[k].bow[1]) >= least), reason),
        Mark::Level(k, most, reason) => (all(&|s| 0.5 * (s[k].bow[0] + s[k].bow[1]).abs() <= most), reason),
        Mark::Narrower(k, than, most, reason) => (width(fit, k) <= most * width(fit, than), reason),
        Mark::Beyond(k, least, reason) => (all(&|s| s[k].b.x >= least * nearest(&s[k - 1])), reason),
        Mark::Below(k, most, reason) => (all(&|s| way(&s[k]) <= most), reason),
    };
    (!shown).then_some(reason)
}

/// How far the outline turns to the left where an edge starts, from chord to chord, degrees.
fn turn(side: &[Bow], k: usize) -> f64 {
    let (a, b) = (side[k - 1].b - side[k - 1].a, side[k].b - side[k].a);
    a.perp(&b).atan2(a.dot(&b)).to_degrees()
}

/// How near an edge comes to the axis.
fn nearest(bow: &Bow) -> f64 {
    bow.points().iter().map(|p| p.x).fold(f64::INFINITY, f64::min)
}

/// How far an edge reaches from side to side, both halves together.
fn width(fit: &Fit, k: usize) -> f64 {
    fit.sides.iter().map(|s| (s[k].b.x - s[k].a.x).abs()).sum()
}

/// The direction of an edge's chord, degrees from across.
fn way(bow: &Bow) -> f64 {
    let d = bow.b - bow.a;
    d.y.atan2(d.x).to_degrees()
}
