//! Outlines for the tests of meshers and smoothers, metres.

use toile_core::artifact::*;

type Named<'a> = (&'a str, Vec<Point2>);

/// A point.
pub(crate) fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// A straight edge.
fn line(a: Point2, b: Point2) -> Vec<Point2> {
    vec![a, b]
}

/// A cubic curve as a fine polyline.
fn cubic(a: Point2, b: Point2, c: Point2, d: Point2) -> Vec<Point2> {
    let at = |t: f64| {
        let s = 1.0 - t;
        Point2::from(
            a.coords * (s * s * s)
                + b.coords * (3.0 * s * s * t)
                + c.coords * (3.0 * s * t * t)
                + d.coords * (t * t * t),
        )
    };
    (0..=200).map(|k| at(f64::from(k) / 200.0)).collect()
}

/// An outline of named edges, each of which starts where the one before it ends.
pub(crate) fn named(edges: Vec<Named<'_>>) -> Outline {
    let (mut points, mut out, mut corners) = (Vec::new(), Vec::new(), Vec::new());
    for (name, line) in &edges {
        corners.push(points.len());
        points.extend_from_slice(&line[..line.len() - 1]);
        let end = points.len();
        out.push(Edge {
            name: (*name).into(),
            start: corners[corners.len() - 1],
            end,
            gauge: Gauge::of(line, &[]),
        });
    }
    let n = points.len();
    out.iter_mut().for_each(|e| e.end %= n);
    Outline {
        outer: Loop { points, corners },
        holes: vec![],
        edges: out,
        inner: vec![],
        frame: None,
        lies: vec![],
    }
}

/// An outline without named edges.
pub(crate) fn plain(points: Vec<Point2>, corners: Vec<usize>) -> Outline {
    Outline {
        outer: Loop { points, corners },
        holes: vec![],
        edges: vec![],
        inner: vec![],
        frame: None,
        lies: vec![],
    }
}

/// A mirrored edge, run the other way, so that the outline goes on counter-clockwise.
fn mirrored(edge: &[Point2]) -> Vec<Point2> {
    edge.iter().rev().map(|q| p(-q.x, q.y)).collect()
}

/// A sleeveless vest, 52 by 66 cm.
pub(crate) fn vest() -> Outline {
    let side = cubic(p(0.25, 0.0), p(0.235, 0.15), p(0.25, 0.3), p(0.26, 0.4));
    let armhole = cubic(p(0.26, 0.4), p(0.2, 0.42), p(0.17, 0.5), p(0.185, 0.62));
    let shoulder = line(p(0.185, 0.62), p(0.095, 0.66));
    let neck = cubic(p(0.095, 0.66), p(0.08, 0.5), p(-0.08, 0.5), p(-0.095, 0.66));
    named(vec![
        ("hem", line(p(-0.25, 0.0), p(0.25, 0.0))),
        ("side_left", side.clone()),
        ("armhole_left", armhole.clone()),
        ("shoulder_left", shoulder.clone()),
        ("neck", neck),
        ("shoulder_right", mirrored(&shoulder)),
        ("armhole_right", mirrored(&armhole)),
        ("side_right", mirrored(&side)),
    ])
}

/// A T-shirt's front, sleeves and all, 80 by 70 cm.
pub(crate) fn tshirt() -> Outline {
    let side = line(p(0.25, 0.0), p(0.26, 0.45));
    let underarm = line(p(0.26, 0.45), p(0.36, 0.4));
    let cuff = line(p(0.36, 0.4), p(0.43, 0.54));
    let shoulder = cubic(p(0.43, 0.54), p(0.3, 0.65), p(0.2, 0.68), p(0.09, 0.7));
    let neck = cubic(p(0.09, 0.7), p(0.07, 0.6), p(-0.07, 0.6), p(-0.09, 0.7));
    named(vec![
        ("hem", line(p(-0.25, 0.0), p(0.25, 0.0))),
        ("side_left", side.clone()),
        ("underarm_left", underarm.clone()),
        ("cuff_left", cuff.clone()),
        ("shoulder_left", shoulder.clone()),
        ("neck", neck),
        ("shoulder_right", mirrored(&shoulder)),
        ("cuff_right", mirrored(&cuff)),
        ("underarm_right", mirrored(&underarm)),
        ("side_right", mirrored(&side)),
    ])
}

/// A circle of points, counter-clockwise.
pub(crate) fn circle(radius: f64, n: usize) -> Vec<Point2> {
    let at = |k: usize| {
        let a = std::f64::consts::TAU * k as f64 / n as f64;
        p(radius * a.cos(), radius * a.sin())
    };
    (0..n).map(at).collect()
}

/// A disc of 20 cm radius.
pub(crate) fn disc() -> Outline {
    plain(circle(0.2, 720), vec![])
}

/// A disc with a round hole.
pub(crate) fn annulus() -> Outline {
    let mut hole = circle(0.07, 360);
    hole.reverse();
    Outline { holes: vec![Loop { points: hole, corners: vec![] }], ..disc() }
}

/// A rectangle.
pub(crate) fn rectangle(width: f64, height: f64) -> Outline {
    plain(vec![p(0.0, 0.0), p(width, 0.0), p(width, height), p(0.0, height)], vec![0, 1, 2, 3])
}

/// A five-pointed star with points of 36 degrees.
pub(crate) fn star() -> Outline {
    let at = |k: usize| {
        let a = std::f64::consts::TAU * k as f64 / 10.0 + 0.1;
        let r = if k.is_multiple_of(2) { 0.3 } else { 0.3 * 0.381_966 };
        p(r * a.cos(), r * a.sin())
    };
    plain((0..10).map(at).collect(), (0..10).collect())
}

/// A panel whose flat tops, at several heights, lie on lines of a 10 mm grid.
pub(crate) fn battlements() -> Outline {
    let xy = [
        (0.0, 0.0),
        (0.3, 0.0),
        (0.3, 0.2),
        (0.25, 0.2),
        (0.25, 0.1),
        (0.2, 0.1),
        (0.2, 0.2),
        (0.15, 0.2),
        (0.15, 0.15),
        (0.1, 0.15),
        (0.1, 0.2),
        (0.05, 0.2),
        (0.05, 0.05),
        (0.0, 0.05),
    ];
    plain(xy.iter().map(|&(x, y)| p(x, y)).collect(), (0..xy.len()).collect())
}

/// A skirt front with a dart from its waist (two legs that meet), a closed fish-eye dart and a
/// fold.
pub(crate) fn darted() -> Outline {
    let mut outline = named(vec![
        ("hem", line(p(-0.3, 0.0), p(0.3, 0.0))),
        ("side_left", line(p(0.3, 0.0), p(0.24, 0.6))),
        ("waist", cubic(p(0.24, 0.6), p(0.1, 0.58), p(-0.1, 0.58), p(-0.24, 0.6))),
        ("side_right", line(p(-0.24, 0.6), p(-0.3, 0.0))),
    ]);
    let waist = outline.edge_points(&outline.edges[2]);
    let (a, b) = (waist[60], waist[45]);
    let tip = p(0.105, 0.45);
    let inner = |name: &str, kind, points| InnerLine { name: name.into(), kind, points, gauge: None };
    outline.inner = vec![
        inner("dart_a", InnerKind::Dart, vec![a, tip]),
        inner("dart_b", InnerKind::Dart, vec![tip, b]),
        inner(
            "fish_eye",
            InnerKind::Dart,
            vec![p(-0.1, 0.2), p(-0.07, 0.3), p(-0.1, 0.45), p(-0.13, 0.3), p(-0.1, 0.2)],
        ),
        inner("fold", InnerKind::Fold, vec![p(0.02, 0.1), p(0.04, 0.25), p(0.03, 0.4)]),
    ];
    outline
}
