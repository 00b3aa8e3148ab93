//! What both meshers promise, on every fixture and on random panels.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::crossing::first_crossing;
use super::fixtures::*;
use super::predicates::{distance_to_segment, segments_meet};
use super::{DelaunayMesher, GradedMesher, GridMesher};
use proptest::prelude::*;
use toile_core::prelude::*;
use toile_core::{Cancel, Context, StageError};

type Mesher = fn(&Outline, f64) -> Result<Panel, StageError>;

fn grid(outline: &Outline, h: f64) -> Result<Panel, StageError> {
    GridMesher { edge: Length::m(h) }.run(outline, &Context::quiet())
}

fn delaunay(outline: &Outline, h: f64) -> Result<Panel, StageError> {
    DelaunayMesher { edge: Length::m(h), ..DelaunayMesher::default() }.run(outline, &Context::quiet())
}

/// Edges from `h` down to a third of it.
pub(super) fn graded(outline: &Outline, h: f64) -> Result<Panel, StageError> {
    let mesher = GradedMesher { edge: Length::m(h), ..GradedMesher::default() };
    let outlines = [("panel".to_owned(), outline.clone())].into_iter().collect();
    let panels = mesher.run(outlines, None, None, &Context::quiet())?;
    Ok(panels.get("panel").unwrap().clone())
}

/// Those that cut a named edge evenly.
const EVEN: [Mesher; 2] = [grid, delaunay];

const MESHERS: [Mesher; 3] = [grid, delaunay, graded];

/// Outlines, each with the least angle that its own corners leave to a mesh (degrees).
fn fixtures() -> Vec<(&'static str, Outline, f64)> {
    vec![
        ("vest", vest(), 15.0),
        ("tshirt", tshirt(), 15.0),
        ("disc", disc(), 15.0),
        ("annulus", annulus(), 15.0),
        ("square", rectangle(0.3, 0.3), 15.0),
        ("strip", rectangle(0.6, 0.02), 15.0),
        ("star", star(), 15.0),
        ("battlements", battlements(), 15.0),
        // The legs of its dart meet at 14.9 degrees.
        ("darted", darted(), 14.8),
    ]
}

/// All that makes a mesh a panel.
pub(super) fn check_sound(panel: &Panel) {
    let mut sides: Vec<[u32; 2]> =
        panel.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]).collect();
    sides.sort_unstable();
    assert!(sides.windows(2).all(|w| w[0] != w[1]), "a side is run through twice the same way");
    let alone = |s: &&[u32; 2]| sides.binary_search(&[s[1], s[0]]).is_err();
    let border: Vec<[u32; 2]> = sides.iter().filter(alone).copied().collect();
    let loops = std::iter::once(&panel.boundary).chain(&panel.holes);
    let mut listed: Vec<[u32; 2]> =
        loops.flat_map(|l| (0..l.len()).map(|k| [l[k], l[(k + 1) % l.len()]])).collect();
    listed.sort_unstable();
    assert_eq!(border, listed, "the border is not the boundary and the holes");

    let mut used = vec![false; panel.positions.len()];
    panel.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    assert!(used.into_iter().all(|u| u), "a vertex is in no triangle");
    assert!(panel.triangles.iter().all(|t| panel.triangle_area(*t) > 0.0), "a triangle is turned over");
    let (v, f) = (panel.positions.len() as i64, panel.triangles.len() as i64);
    let e = (sides.len() + border.len()) as i64 / 2;
    assert_eq!(v - e + f, 1 - panel.holes.len() as i64, "not one piece");

    let boundary_area: f64 = std::iter::once(&panel.boundary)
        .chain(&panel.holes)
        .map(|l| polygon_area(&l.iter().map(|&v| panel.positions[v as usize]).collect::<Vec<_>>()))
        .sum();
    assert!((panel.area() - boundary_area).abs() < 1e-9 * boundary_area, "the mesh leaves gaps or overlaps");
    for c in &panel.inner {
        let lies = |w: &[u32]| [[w[0], w[1]], [w[1], w[0]]].iter().any(|s| sides.binary_search(s).is_ok());
        assert!(c.vertices.windows(2).all(lies), "{} leaves the mesh's edges", c.name);
    }
    for e in &panel.edges {
        let on = |w: &[u32]| listed.binary_search(&[w[0], w[1]]).is_ok();
        assert!(e.vertices.windows(2).all(on), "{} leaves the boundary", e.name);
    }
}

fn to_loop(q: Point2, l: &[Point2]) -> f64 {
    (0..l.len()).map(|k| distance_to_segment(q, l[k], l[(k + 1) % l.len()]).0).fold(f64::INFINITY, f64::min)
}

/// Vertices lie exactly on the outline, the outline within 2 % of `h` of the mesh, corners are
/// vertices.
fn check_outline_kept(truth: &Loop, panel: &Panel, chain: &[u32], h: f64) {
    let mesh: Vec<Point2> = chain.iter().map(|&v| panel.positions[v as usize]).collect();
    let off = mesh.iter().map(|&q| to_loop(q, &truth.points)).fold(0.0, f64::max);
    assert!(off < 1e-15, "a vertex is {off} m off the outline");
    let leaves = truth.points.iter().map(|&q| to_loop(q, &mesh)).fold(0.0, f64::max);
    assert!(leaves < CHORD_TOLERANCE * h, "the mesh leaves the outline by {} h", leaves / h);
    assert!(truth.corners.iter().all(|&c| mesh.contains(&truth.points[c])), "a corner is lost");
}

#[test]
fn every_fixture_at_every_resolution() {
    for (name, outline, own_angle) in fixtures() {
        for h in [0.08, 0.04, 0.02, 0.012, 0.005] {
            for mesher in MESHERS {
                let panel = mesher(&outline, h).expect(name);
                check_sound(&panel);
                check_outline_kept(&outline.outer, &panel, &panel.boundary, h);
                for (hole, chain) in outline.holes.iter().zip(&panel.holes) {
                    check_outline_kept(hole, &panel, chain, h);
                }
                let angle = panel.least_angle();
                assert!(angle >= own_angle, "{name} at {h} m has an angle of {angle} degrees");
            }
        }
    }
}

#[test]
fn named_edges_are_cut_into_equal_parts_as_their_gauge_says() {
    let outline = vest();
    for mesher in EVEN {
        let panel = mesher(&outline, 0.012).unwrap();
        assert_eq!(panel.edges.len(), 8);
        for (edge, chain) in outline.edges.iter().zip(&panel.edges) {
            assert_eq!(chain.name, edge.name);
            assert_eq!(chain.vertices.len(), edge.gauge.divisions(0.012) + 1);
            let at = |v: u32| panel.positions[v as usize];
            let part: Vec<f64> = chain.vertices.windows(2).map(|w| (at(w[1]) - at(w[0])).norm()).collect();
            let mean = part.iter().sum::<f64>() / part.len() as f64;
            // Equal by arc length: the chords of a curve differ in the second order.
            assert!(part.iter().all(|p| (p / mean - 1.0).abs() < 0.02), "{}: {part:?}", chain.name);
        }
        // The first edge ends where the second starts, and the last where the first starts.
        let ends = |k: usize| (panel.edges[k].vertices[0], *panel.edges[k].vertices.last().unwrap());
        assert_eq!(ends(0).1, ends(1).0);
        assert_eq!(ends(7).1, ends(0).0);
    }
}

#[test]
fn the_grid_runs_along_warp_and_weft() {
    // A square of 25 cells per side: nothing but the grid.
    let panel = grid(&rectangle(0.3, 0.3), 0.012).unwrap();
    assert_eq!(panel.positions.len(), 26 * 26);
    assert_eq!(panel.triangles.len(), 2 * 25 * 25);
    assert!((panel.least_angle() - 45.0).abs() < 1e-6);
}

#[test]
fn inner_grid_vertices_have_neighbours_along_both_axes() {
    let h = 0.012;
    let outline = vest();
    let panel = grid(&outline, h).unwrap();
    let (low, high) = outline.bounds();
    let step = |length: f64| length / (length / h).ceil();
    let (dx, dy) = (step(high.x - low.x), step(high.y - low.y));
    let mut neighbours = vec![Vec::new(); panel.positions.len()];
    for t in &panel.triangles {
        for k in 0..3 {
            neighbours[t[k] as usize].extend([t[(k + 1) % 3], t[(k + 2) % 3]]);
        }
    }
    let (mut crossings, mut straight) = (0, 0);
    for (v, q) in panel.positions.iter().enumerate() {
        let (i, j) = ((q.x - low.x) / dx, (q.y - low.y) / dy);
        let on_crossing = (i - i.round()).abs() < 1e-9 && (j - j.round()).abs() < 1e-9;
        if !on_crossing || panel.boundary.contains(&(v as u32)) {
            continue;
        }
        crossings += 1;
        let exact = |along: Vector2| {
            neighbours[v].iter().any(|&w| (panel.positions[w as usize] - q - along).norm() < 1e-9)
        };
        // At the band the neighbour may be the outline's vertex that a crossing was merged into.
        let near = |axis: Vector2| {
            neighbours[v].iter().any(|&w| {
                let spoke = panel.positions[w as usize] - q;
                spoke.dot(&axis).abs() > 30f64.to_radians().cos() * spoke.norm()
            })
        };
        for axis in [Vector2::new(dx, 0.0), Vector2::new(0.0, dy)] {
            let both = [axis, -axis].into_iter().any(exact);
            assert!(both || near(axis.normalize()), "no neighbour along {axis} at {q}");
            straight += usize::from(both);
        }
    }
    // Nearly all keep the grid's own.
    assert!(straight > 99 * 2 * crossings / 100, "{straight} of {}", 2 * crossings);
    assert!(crossings > 1500, "only {crossings} crossings");
}

#[test]
fn delaunay_triangles_are_nearly_equilateral() {
    let panel = delaunay(&vest(), 0.012).unwrap();
    let quality = |t: &[u32; 3]| {
        let p = t.map(|v| panel.positions[v as usize]);
        let squares: f64 = (0..3).map(|k| (p[(k + 1) % 3] - p[k]).norm_squared()).sum();
        4.0 * 3f64.sqrt() * panel.triangle_area(*t) / squares
    };
    let mean = panel.triangles.iter().map(quality).sum::<f64>() / panel.triangles.len() as f64;
    assert!(mean > 0.97, "mean quality {mean}");
    assert!(panel.least_angle() > 28.0);
}

#[test]
fn darts_and_folds_lie_on_mesh_edges() {
    let outline = darted();
    for mesher in MESHERS {
        let panel = mesher(&outline, 0.012).unwrap();
        let [a, b, eye, fold] = [0, 1, 2, 3].map(|k| &panel.inner[k].vertices);
        assert_eq!(a.len(), b.len(), "the legs of a dart are sewn to each other");
        assert_eq!(a.last(), b.first(), "they meet at the tip");
        let waist = &panel.edge("waist").unwrap().vertices;
        assert!(waist.contains(&a[0]) && waist.contains(b.last().unwrap()), "they start on the waist");
        assert_eq!(waist.len(), outline.edges[2].gauge.divisions(0.012) + 1, "which keeps its count");
        assert_eq!(eye.first(), eye.last(), "a fish-eye dart is closed");
        let on = |q: &Point2| fold.iter().any(|&v| panel.positions[v as usize] == *q);
        assert!(outline.inner[3].points.iter().all(on), "the fold keeps its corner and ends");
    }
}

#[test]
fn a_thin_strip_without_names_is_divided_finer() {
    for mesher in MESHERS {
        let panel = mesher(&rectangle(0.6, 0.02), 0.08).unwrap();
        assert!(panel.least_angle() > 25.0, "{}", panel.least_angle());
    }
}

#[test]
fn photo_coordinates_follow_the_frame() {
    let frame = PhotoFrame { origin_px: p(800.0, 1500.0), px_per_metre: 2000.0, mirrored: true, turn: 0.0 };
    let outline = Outline { frame: Some(frame), ..vest() };
    for mesher in MESHERS {
        let panel = mesher(&outline, 0.03).unwrap();
        assert_eq!(panel.photo_px.len(), panel.positions.len());
        assert!(panel.positions.iter().zip(&panel.photo_px).all(|(q, px)| *px == frame.to_px(*q)));
        assert!(mesher(&vest(), 0.03).unwrap().photo_px.is_empty());
    }
}

#[test]
fn a_rough_outline_is_told() {
    // A zigzag of 1 mm that its gauge knows nothing of.
    let mut outline = vest();
    let hem = outline.edges[0].clone();
    let zigzag: Vec<Point2> =
        (0..100).map(|k| p(-0.25 + 0.005 * f64::from(k), 0.001 * f64::from(k % 2))).collect();
    outline.outer.points.splice(hem.start..hem.start + 1, zigzag);
    let shift = |i: usize| if i > 0 { i + 99 } else { i };
    outline.edges.iter_mut().for_each(|e| (e.start, e.end) = (shift(e.start), shift(e.end)));
    outline.outer.corners.iter_mut().for_each(|c| *c = shift(*c));
    let cx = Context::quiet();
    let panel = GridMesher { edge: Length::mm(12.0) }.run(&outline, &cx).unwrap();
    check_sound(&panel);
    assert_eq!(panel.edges[0].vertices.len(), hem.gauge.divisions(0.012) + 1);
    let warnings = cx.take_remarks().warnings;
    assert_eq!(
        warnings,
        [
            "edge \"hem\" leaves the outline by 0.84 mm, more than 2 % of the edge of 12 mm; a smoother outline or a smaller edge helps"
        ]
    );
}

fn refused(outline: &Outline, h: f64) -> (ErrorCode, String) {
    let [a, b] = EVEN.map(|m| m(outline, h).expect_err("refused"));
    assert_eq!(a, b);
    (a.code, a.message)
}

#[test]
fn what_cannot_be_meshed_is_refused_in_words() {
    use ErrorCode::{DegenerateTriangles, InvalidInput, InvalidParameter};
    let is = |outline: &Outline, h: f64, code: ErrorCode, text: &str| {
        assert_eq!(refused(outline, h), (code, text.to_owned()));
    };
    let square = rectangle(0.3, 0.3);
    let of = |xy: &[(f64, f64)]| plain(xy.iter().map(|&(x, y)| p(x, y)).collect(), vec![]);
    is(&square, 0.5, InvalidInput, "an edge of 50 cm is larger than the panel, which measures 300 by 300 mm");
    is(
        &square,
        0.0001,
        InvalidInput,
        "an edge of 0.1 mm would make 21 million triangles, the limit is 5 million",
    );
    is(&square, f64::NAN, InvalidParameter, "the edge length must be above zero");
    is(
        &of(&[(0.0, 0.0), (1.0, 1.0)]),
        0.01,
        DegenerateTriangles,
        "the outline has 2 points, a panel needs three",
    );
    is(&of(&[(0.0, 0.0), (1.0, 0.0), (0.5, 0.0)]), 0.01, DegenerateTriangles, "the outline encloses no area");
    is(&of(&[(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)]), 0.01, InvalidInput, "the outline runs clockwise");
    is(
        &of(&[(0.0, 0.0), (f64::NAN, 1.0), (1.0, 0.0)]),
        0.01,
        InvalidInput,
        "the outline has a point that is not a finite number",
    );
    is(
        &of(&[(0.0, 0.0), (0.4, 0.0), (0.0, 0.3), (0.3, 0.3), (0.1, -0.1)]),
        0.01,
        DegenerateTriangles,
        "the outline crosses or touches itself near (0.0, 0.0) mm",
    );
    let hole = |points| Loop { points, corners: vec![] };
    let outside = circle(0.02, 20).iter().map(|q| q + Vector2::new(1.0, 0.0)).collect();
    is(
        &Outline { holes: vec![hole(outside)], ..square.clone() },
        0.01,
        InvalidInput,
        "hole 1 lies outside the cloth",
    );
    let inner = |points| vec![InnerLine { name: "fold".into(), kind: InnerKind::Fold, points, gauge: None }];
    let lined = |points| Outline { inner: inner(points), ..square.clone() };
    is(
        &lined(vec![p(0.1, 0.1), p(0.5, 0.2)]),
        0.012,
        DegenerateTriangles,
        "inner line \"fold\" crosses the outline or another line near (294.3, 148.6) mm",
    );
    is(
        &lined(vec![p(0.5, 0.1), p(0.6, 0.2)]),
        0.012,
        InvalidInput,
        "inner line \"fold\" lies outside the cloth",
    );
    is(&lined(vec![p(0.1, 0.1)]), 0.012, InvalidInput, "inner line \"fold\" has fewer than two points");
    let mut pleated = named(vec![
        ("hem", vec![p(0.0, 0.0), p(0.1, 0.0)]),
        ("rest", vec![p(0.1, 0.0), p(0.1, 0.3), p(0.0, 0.3), p(0.0, 0.0)]),
    ]);
    pleated.inner = inner(vec![p(0.04, 0.0), p(0.04, 0.2)]);
    is(
        &pleated,
        0.1,
        InvalidInput,
        "edge \"hem\" is divided into 1 at an edge of 10 cm, too few for its corners and inner lines",
    );
}

#[test]
fn stops_on_request() {
    let cancel = Cancel::new();
    cancel.cancel();
    let cx = Context::new("test", std::path::Path::new("."), cancel, std::sync::Arc::new(()));
    let error = DelaunayMesher::default().run(&vest(), &cx).expect_err("stopped");
    assert_eq!(error.code, ErrorCode::Cancelled);
}

/// A star-shaped panel: named edges from corners at random angles and radii, which bulge at random.
fn star_shaped(corners: &[(f64, f64)], bulges: &[f64]) -> Outline {
    let total: f64 = corners.iter().map(|c| c.0).sum();
    let mut angle = 0.0;
    let mut at = Vec::new();
    for c in corners {
        at.push((angle, c.1));
        angle += std::f64::consts::TAU * c.0 / total;
    }
    at.push((angle, at[0].1));
    let curve = |k: usize, i: i32| {
        let ((a0, r0), (a1, r1), t) = (at[k], at[k + 1], f64::from(i) / 100.0);
        let (a, r) = (a0 + (a1 - a0) * t, r0 + (r1 - r0) * t + bulges[k % bulges.len()] * t * (1.0 - t));
        p(r * a.cos(), r * a.sin())
    };
    let names: Vec<String> = (0..corners.len()).map(|k| format!("edge_{k}")).collect();
    let edges =
        names.iter().enumerate().map(|(k, name)| (name.as_str(), (0..=100).map(|i| curve(k, i)).collect()));
    named(edges.collect())
}

type Shape = (Vec<(f64, f64)>, Vec<f64>);

fn shapes() -> impl Strategy<Value = Shape> {
    (
        proptest::collection::vec((0.5..1.5f64, 0.12..0.35f64), 3..9),
        proptest::collection::vec(-0.15..0.2f64, 1..9),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn random_panels_are_meshed_soundly((corners, bulges) in shapes(), h in 0.008..0.06f64) {
        let outline = star_shaped(&corners, &bulges);
        for mesher in MESHERS {
            let panel = mesher(&outline, h).unwrap();
            check_sound(&panel);
            check_outline_kept(&outline.outer, &panel, &panel.boundary, h);
            // 15 degrees held in 20,000 such panels; here a margin, so that no rare one fails the
            // build.
            prop_assert!(panel.least_angle() > 12.0, "{}", panel.least_angle());
            prop_assert_eq!(&mesher(&outline, h).unwrap(), &panel);
        }
    }

    #[test]
    fn sewn_edges_get_equal_counts((corners, bulges) in shapes(), other in -0.1..0.1f64, h in 0.008..0.06f64) {
        let mut front = star_shaped(&corners, &bulges);
        let mut back = star_shaped(&corners, &bulges.iter().map(|b| b * 0.5 + other).collect::<Vec<_>>());
        for (a, b) in front.edges.iter_mut().zip(&mut back.edges) {
            a.gauge = a.gauge.shared(&b.gauge);
            b.gauge = a.gauge;
        }
        let (a, b) = (grid(&front, h).unwrap(), delaunay(&back, h).unwrap());
        for (x, y) in a.edges.iter().zip(&b.edges) {
            prop_assert_eq!(x.vertices.len(), y.vertices.len());
        }
    }

    #[test]
    fn any_polygon_is_meshed_soundly_or_refused(
        xy in proptest::collection::vec((0.0..0.5f64, 0.0..0.5f64), 0..8),
        h in 0.01..0.3f64,
    ) {
        let corners = (0..xy.len()).collect();
        let outline = plain(xy.into_iter().map(|(x, y)| p(x, y)).collect(), corners);
        for mesher in MESHERS {
            if let Ok(panel) = mesher(&outline, h) {
                check_sound(&panel);
                check_outline_kept(&outline.outer, &panel, &panel.boundary, h);
            }
        }
    }

    #[test]
    fn random_folds_lie_on_mesh_edges(
        fold in proptest::collection::vec((-0.12..0.12f64, -0.12..0.12f64), 2..5),
        h in 0.008..0.05f64,
    ) {
        let points = fold.into_iter().map(|(x, y)| p(x, y)).collect();
        let inner = vec![InnerLine { name: "fold".into(), kind: InnerKind::Fold, points, gauge: None }];
        let outline = Outline { inner, ..disc() };
        for mesher in MESHERS {
            if let Ok(panel) = mesher(&outline, h) {
                check_sound(&panel);
                let chain = &panel.inner[0].vertices;
                let ends = [chain[0], chain[chain.len() - 1]].map(|v| panel.positions[v as usize]);
                prop_assert_eq!(ends[0], outline.inner[0].points[0]);
                prop_assert!((ends[1] - outline.inner[0].points.last().unwrap()).norm() <= 0.05 * h);
            }
        }
    }

    #[test]
    fn crossings_are_those_that_brute_force_finds(xy in proptest::collection::vec((0..12u8, 0..12u8), 4..24)) {
        // Whole numbers, so that touches and overlaps are frequent.
        let points: Vec<Point2> = xy.iter().map(|&(x, y)| p(f64::from(x), f64::from(y))).collect();
        let segments: Vec<[u32; 2]> = (0..points.len() as u32 / 2).map(|k| [2 * k, 2 * k + 1]).collect();
        let at = |s: [u32; 2]| s.map(|v| points[v as usize]);
        let meet = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (at(segments[i]), at(segments[j]));
            segments_meet(a, b, c, d)
        };
        let pairs = (0..segments.len()).flat_map(|i| (i + 1..segments.len()).map(move |j| [i, j]));
        prop_assert_eq!(first_crossing(&points, &segments), pairs.filter(|p| meet(p[0], p[1])).min());
    }
}
