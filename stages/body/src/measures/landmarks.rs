//! Landmarks of a mannequin: where its figure's skeleton and levels meet its skin.

use crate::figure::BodyFigure;
use crate::shape::level;
use crate::skin::slice::{SliceLoop, slice, trunk};
use std::collections::BTreeMap;
use toile_core::artifact::{Hand, Landmark, Point3};

/// Halvings by which a level is looked for: a tenth of a millimetre on a metre.
const HALVINGS: usize = 13;

/// Landmarks by name.
pub(crate) type NamedLandmarks = BTreeMap<String, Landmark>;

/// The landmarks that [`Body`](toile_core::artifact::Body) lists; `None` where the arms or legs
/// have grown into the trunk.
pub(crate) fn landmarks(
    figure: &BodyFigure,
    positions: &[Point3],
    triangles: &[[u32; 3]],
) -> Option<NamedLandmarks> {
    let mut marks = BTreeMap::new();
    let cut = |y: f64| slice(positions, triangles, y);
    let rings =
        [("bust", level::BUST), ("waist", level::WAIST), ("hip", level::HIP), ("neck_base", level::NECK)];
    for (name, level) in rings {
        let y = figure.y(level);
        let (front, back) = trunk(&cut(y), 0.0)?.depths_at(0.0)?;
        marks.insert(format!("{name}_front"), Point3::new(0.0, y, front));
        marks.insert(format!("{name}_back"), Point3::new(0.0, y, back));
    }
    let whole = |y: f64| trunk(&cut(y), 0.0).and_then(|l| l.depths_at(0.0));
    let crotch = bisect(figure.y(level::HIP), 0.8 * figure.y(level::CROTCH), |y| whole(y).is_some())?;
    let (front, back) = whole(crotch)?;
    marks.insert("crotch".into(), Point3::new(0.0, crotch, (front + back) / 2.0));

    let chin = figure.shape.chin;
    let half = figure.size().shoulder_width / 2.0;
    let neck = figure.size().neck / std::f64::consts::TAU;
    let [_, elbow, wrist] = figure.arm_axis;
    let left = [
        ("elbow", elbow),
        ("wrist", wrist),
        (
            "armpit",
            armpit(
                cut,
                [(level::BUST + level::WAIST) / 2.0, (level::SHOULDER + level::NECK) / 2.0]
                    .map(|l| figure.y(l)),
            )?,
        ),
        ("shoulder", ridge(positions, triangles, half, chin)?),
        ("neck", ridge(positions, triangles, neck * 1.15, chin)?),
    ];
    for (name, p) in left {
        for hand in Hand::BOTH {
            marks.insert(hand.name(name), Point3::new(hand.sign() * p.x, p.y, p.z));
        }
    }
    Some(marks)
}

/// The last height, from `good` towards `bad`, at which a test holds; `None` where it does not
/// hold at `good` or still holds at `bad`.
pub(crate) fn bisect(mut good: f64, mut bad: f64, holds: impl Fn(f64) -> bool) -> Option<f64> {
    if !holds(good) || holds(bad) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = (good + bad) / 2.0;
        if holds(middle) { good = middle } else { bad = middle }
    }
    Some(good)
}

/// Where the left arm leaves the trunk: midway between the two in the last slice that keeps them
/// apart.
fn armpit(cut: impl Fn(f64) -> Vec<SliceLoop>, [low, high]: [f64; 2]) -> Option<Point3> {
    let gap = |y: f64| {
        let loops = cut(y);
        let body = trunk(&loops, 0.0)?;
        let arm = loops.iter().find(|l| l.bounds[0] > body.bounds[1] - 1e-3 && l.width() > 0.02)?;
        Some(Point3::new((body.bounds[1] + arm.bounds[0]) / 2.0, y, arm.centre().y))
    };
    let y = bisect(low, high, |y| gap(y).is_some())?;
    gap(y)
}

/// The highest point of the skin below `top` in the plane of a given x.
pub(crate) fn ridge(positions: &[Point3], triangles: &[[u32; 3]], x: f64, top: f64) -> Option<Point3> {
    let crossing = |&(a, b): &(u32, u32)| {
        let (p, q) = (positions[a as usize], positions[b as usize]);
        ((p.x < x) != (q.x < x)).then(|| p + (q - p) * ((x - p.x) / (q.x - p.x)))
    };
    let sides = triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let points = sides.filter_map(|s| crossing(&s)).filter(|p| p.y < top);
    points.reduce(|a, b| if b.y > a.y { b } else { a })
}
