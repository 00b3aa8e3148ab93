//! What the graded mesher promises beyond what all meshers do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::fixtures::*;
use super::super::tests::check_sound;
use super::field::{Range, SizeField};
use super::{GradedMesher, check_count};
use proptest::prelude::*;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

fn mesher(edge: f64, fine: f64) -> GradedMesher {
    GradedMesher { edge: Length::m(edge), fine: Some(Length::m(fine)), ..GradedMesher::default() }
}

fn set(panels: &[(&str, &Outline)]) -> Set<Outline> {
    panels.iter().map(|(name, o)| ((*name).to_owned(), (*o).clone())).collect()
}

fn sewn(pairs: &[(&str, &str)], reversed: bool) -> SewingPlan {
    let of = |text: &str| EdgeRef::try_from(text.to_owned()).unwrap();
    let seam = |(a, b): &(&str, &str)| Seam { a: of(a), b: of(b), kind: SeamKind::Matched, reversed };
    SewingPlan { seams: pairs.iter().map(seam).collect() }
}

fn run(mesher: &GradedMesher, outlines: &[(&str, &Outline)], plan: Option<&SewingPlan>) -> Set<Panel> {
    mesher.run(set(outlines), plan, None, &Context::quiet()).unwrap()
}

fn refused(mesher: &GradedMesher, outline: &Outline) -> StageError {
    mesher.run(set(&[("front", outline)]), None, None, &Context::quiet()).unwrap_err()
}

/// Arc lengths of an edge's vertices as shares of its length.
fn shares(panel: &Panel, edge: &str) -> Vec<f64> {
    let at: Vec<Point2> =
        panel.edge(edge).unwrap().vertices.iter().map(|&v| panel.positions[v as usize]).collect();
    let arcs: Vec<f64> = (1..=at.len()).map(|k| polyline_length(&at[..k])).collect();
    arcs.iter().map(|a| a / arcs[arcs.len() - 1]).collect()
}

fn lengths(panel: &Panel, edge: &str) -> Vec<f64> {
    let of = |w: &[u32]| (panel.positions[w[1] as usize] - panel.positions[w[0] as usize]).norm();
    panel.edge(edge).unwrap().vertices.windows(2).map(of).collect()
}

/// Each side of each triangle, with its middle.
fn sides(panel: &Panel) -> Vec<(Point2, f64)> {
    let side = |t: &[u32; 3], k: usize| {
        let (a, b) = (panel.positions[t[k] as usize], panel.positions[t[(k + 1) % 3] as usize]);
        (nalgebra::center(&a, &b), (b - a).norm())
    };
    panel.triangles.iter().flat_map(|t| (0..3).map(|k| side(t, k)).collect::<Vec<_>>()).collect()
}

#[test]
fn the_vest_is_fine_where_it_curves_and_coarse_where_it_does_not() {
    let panels = run(&mesher(0.024, 0.008), &[("front", &vest())], None);
    let panel = panels.get("front").unwrap();
    let mean = |near: Point2, reach: f64| {
        let of: Vec<f64> =
            sides(panel).into_iter().filter(|(m, _)| (m - near).norm() < reach).map(|s| s.1).collect();
        of.iter().sum::<f64>() / of.len() as f64
    };
    let (neck, middle) = (mean(p(0.0, 0.54), 0.02), mean(p(0.0, 0.25), 0.08));
    assert!(neck < 0.014, "at the neck {neck}");
    assert!((0.020..0.027).contains(&middle), "in the middle {middle}");
    assert!(panel.least_angle() > 24.0, "{}", panel.least_angle());
    assert!(lengths(panel, "hem").iter().all(|l| *l <= 0.024 + 1e-12));
}

#[test]
fn equal_lengths_make_the_grid() {
    let panels = run(&mesher(0.012, 0.012), &[("front", &rectangle(0.3, 0.3))], None);
    let panel = panels.get("front").unwrap();
    assert_eq!((panel.positions.len(), panel.triangles.len()), (26 * 26, 2 * 25 * 25));
    assert!((panel.least_angle() - 45.0).abs() < 1e-6);
    // Diagonals alternate: as many rise as fall.
    let diagonal = |t: &[u32; 3], k: usize| {
        let way = panel.positions[t[(k + 1) % 3] as usize] - panel.positions[t[k] as usize];
        if way.norm() > 0.0121 { (way.x * way.y).signum() } else { 0.0 }
    };
    let sum: f64 = panel.triangles.iter().map(|t| (0..3).map(|k| diagonal(t, k)).sum::<f64>()).sum();
    assert!(sum.abs() <= 2.0, "{sum}");
}

#[test]
fn both_sides_of_a_seam_are_cut_alike_though_one_alone_asks_for_it() {
    let bent = named(vec![
        ("hem", vec![p(0.0, 0.0), p(0.3, 0.0)]),
        ("side", vec![p(0.3, 0.0), p(0.3, 0.4)]),
        // The neck's sharp curve makes the end of the side fine.
        (
            "neck",
            (0..=200)
                .map(|k| p(0.3 - 0.0015 * f64::from(k), 0.4 - 0.02 * (f64::from(k) * 0.3).sin().abs()))
                .collect(),
        ),
        ("fold", vec![p(0.0, 0.4), p(0.0, 0.0)]),
    ]);
    let straight = named(vec![
        ("hem", vec![p(0.0, 0.0), p(0.3, 0.0)]),
        ("fold", vec![p(0.3, 0.0), p(0.3, 0.4)]),
        ("neck", vec![p(0.3, 0.4), p(0.0, 0.4)]),
        ("side", vec![p(0.0, 0.4), p(0.0, 0.0)]),
    ]);
    let outlines = [("back", &straight), ("front", &bent)];
    let alone = run(&mesher(0.03, 0.008), &outlines, None);
    let plan = sewn(&[("front.side", "back.side")], false);
    let both = run(&mesher(0.03, 0.008), &outlines, Some(&plan));
    let count = |s: &Set<Panel>, name: &str| s.get(name).unwrap().edge("side").unwrap().vertices.len();
    assert!(count(&alone, "front") > count(&alone, "back"), "the front asks for more by itself");
    assert_eq!(count(&both, "front"), count(&both, "back"));
    let front = shares(both.get("front").unwrap(), "side");
    let back: Vec<f64> = shares(both.get("back").unwrap(), "side").iter().rev().map(|s| 1.0 - s).collect();
    assert!(front.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-9), "{front:?} {back:?}");
    // What the front asks for is felt inside the back, and beyond it at the back's own neck.
    let neck = lengths(both.get("back").unwrap(), "neck");
    assert!(neck[neck.len() - 1] < 0.6 * neck[0], "{neck:?}");
    assert!(both.iter().all(|(_, p)| {
        check_sound(p);
        true
    }));
}

#[test]
fn a_reversed_seam_is_cut_from_start_to_start() {
    let outline = vest();
    let plan = sewn(&[("front.side_left", "back.side_left")], true);
    let panels =
        run(&mesher(0.03, 0.008), &[("back", &outline), ("front", &rectangle_like_side())], Some(&plan));
    let [a, b] = ["front", "back"].map(|name| shares(panels.get(name).unwrap(), "side_left"));
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 2e-3), "{a:?} {b:?}");
}

/// A rectangle whose right side is called as the vest's.
fn rectangle_like_side() -> Outline {
    named(vec![
        ("hem", vec![p(0.0, 0.0), p(0.3, 0.0)]),
        ("side_left", vec![p(0.3, 0.0), p(0.3, 0.4)]),
        ("rest", vec![p(0.3, 0.4), p(0.0, 0.4), p(0.0, 0.0)]),
    ])
}

#[test]
fn the_legs_of_a_dart_are_cut_alike_from_its_tip() {
    let panels = run(&mesher(0.04, 0.008), &[("front", &darted())], None);
    let panel = panels.get("front").unwrap();
    let leg = |name: &str| {
        let chain = &panel.inner.iter().find(|c| c.name == name).unwrap().vertices;
        let at: Vec<Point2> = chain.iter().map(|&v| panel.positions[v as usize]).collect();
        let total = polyline_length(&at);
        (1..=at.len()).map(|k| polyline_length(&at[..k]) / total).collect::<Vec<_>>()
    };
    let (down, up) = (leg("dart_a"), leg("dart_b"));
    assert!(down.len() > 3 && down.len() == up.len(), "{down:?} {up:?}");
    assert!(down.iter().zip(up.iter().rev()).all(|(a, b)| (a - (1.0 - b)).abs() < 1e-9));
}

/// A flat sheet 40 by 30 cm of one panel, rolled about `x = 0.2` onto a cylinder of the given
/// radius, flat elsewhere.
fn rolled(radius: f64, half: f64) -> Garment {
    let (columns, rows) = (40u32, 30u32);
    let mut rest = Vec::new();
    let mut positions = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let q = p(0.01 * f64::from(i), 0.01 * f64::from(j));
            rest.push(q);
            let bent = (q.x - 0.2).clamp(-half, half);
            let (angle, over) = (bent / radius, q.x - 0.2 - bent);
            let x = radius * angle.sin() + over * angle.cos();
            let z = radius * (angle.cos() - 1.0) - over * angle.sin();
            positions.push(Point3::new(x, q.y, z));
        }
    }
    let at = |i: u32, j: u32| j * (columns + 1) + i;
    let cell = |i: u32, j: u32| {
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    };
    let triangles: Vec<[u32; 3]> =
        (0..rows).flat_map(|j| (0..columns).flat_map(move |i| cell(i, j))).collect();
    let n = positions.len();
    let panel = GarmentPanel {
        name: "front".into(),
        vertices: 0..n,
        triangles: 0..triangles.len(),
        boundary: vec![at(0, 0), at(columns, 0), at(columns, rows), at(0, rows)],
        photo_px: vec![],
        fabric: toile_fixtures::cloth::plain(1000.0, 100.0, 1e-5),
        layer: 0,
    };
    Garment {
        velocities: vec![Vector3::zeros(); n],
        positions,
        rest,
        triangles,
        panels: vec![panel],
        seams: vec![],
        weld: (0..n as u32).collect(),
        pinned: vec![],
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
    }
}

#[test]
fn the_curvature_of_a_cylinder_is_one_over_its_radius() {
    let garment = rolled(0.05, 0.1);
    let curvatures = super::folds::curvatures(&garment);
    let in_bend = |t: &[u32; 3]| t.iter().all(|&v| (garment.rest[v as usize].x - 0.2).abs() < 0.08);
    let inside = garment.triangles.iter().zip(&curvatures).filter(|(t, _)| in_bend(t)).map(|(_, k)| *k);
    let bent: Vec<f64> = inside.collect();
    let mean = bent.iter().sum::<f64>() / bent.len() as f64;
    assert!((mean * 0.05 - 1.0).abs() < 0.25, "{mean} for 20");
    let flat = |t: &[u32; 3]| t.iter().all(|&v| (garment.rest[v as usize].x - 0.2).abs() > 0.115);
    assert!(garment.triangles.iter().zip(&curvatures).filter(|(t, _)| flat(t)).all(|(_, k)| *k < 1e-6));
}

#[test]
fn a_fold_of_a_first_drape_makes_short_edges_there_and_nowhere_else() {
    let outline = rectangle(0.4, 0.3);
    let mesher = mesher(0.03, 0.008);
    let drape = rolled(0.01, 0.015);
    let meshed = |drape: Option<&Garment>| {
        let panels = mesher.run(set(&[("front", &outline)]), None, drape, &Context::quiet()).unwrap();
        panels.get("front").unwrap().clone()
    };
    let (plain, folded) = (meshed(None), meshed(Some(&drape)));
    let mean = |panel: &Panel, from: f64, to: f64| {
        let all = sides(panel);
        let of: Vec<f64> =
            all.iter().filter(|(m, _)| (from..to).contains(&(m.x - 0.2).abs())).map(|s| s.1).collect();
        of.iter().sum::<f64>() / of.len() as f64
    };
    // A radius of 1 cm and 1 mm of tolerance: edges of 8.9 mm.
    assert!(mean(&folded, 0.0, 0.015) < 0.012, "{}", mean(&folded, 0.0, 0.015));
    assert!(mean(&folded, 0.12, 0.2) > 0.024, "{}", mean(&folded, 0.12, 0.2));
    assert!(folded.triangles.len() > 2 * plain.triangles.len());
    check_sound(&folded);
    assert!(folded.least_angle() > 24.0, "{}", folded.least_angle());
    // A drape of other panels says nothing about this one.
    let mut other = drape.clone();
    other.panels[0].name = "back".into();
    assert_eq!(meshed(Some(&other)), plain);
}

#[test]
fn a_bend_across_a_closed_seam_is_seen() {
    // Two flat squares that meet at right angles, sewn along the edge they share.
    let mut garment = rolled(0.05, 0.1);
    let quad = |z: bool| if z { Point3::new(0.0, 0.0, -0.1) } else { Point3::new(0.1, 0.0, 0.0) };
    let up = Vector3::new(0.0, 0.1, 0.0);
    let origin = Point3::origin();
    garment.positions = vec![origin, quad(false), origin + up, origin, origin + up, quad(true)];
    garment.rest = vec![p(0.0, 0.0), p(0.1, 0.0), p(0.0, 0.1), p(0.1, 0.0), p(0.1, 0.1), p(0.0, 0.0)];
    garment.triangles = vec![[0, 1, 2], [3, 4, 5]];
    garment.weld = (0..6).collect();
    assert_eq!(super::folds::curvatures(&garment), [0.0, 0.0]);
    garment.weld = vec![0, 1, 2, 0, 2, 5];
    let bent = super::folds::curvatures(&garment);
    // A right angle over a side of 10 cm and an area of 50 cm2.
    assert!(bent.iter().all(|k| (k - std::f64::consts::FRAC_PI_2 * 0.1 / 0.01).abs() < 1e-9), "{bent:?}");
}

#[test]
fn what_cannot_be_meshed_is_refused_in_words() {
    let error = refused(&mesher(0.024, 0.03), &vest());
    assert_eq!(error.code, ErrorCode::InvalidParameter);
    assert_eq!(error.message, "the shortest edge of 30 mm is longer than the longest of 24 mm");
    assert_eq!(
        error.hint.unwrap(),
        "`fine` is what edges shrink to where something curves; make it smaller, or `edge` larger"
    );
    let error = refused(&mesher(0.9, 0.1), &vest());
    assert_eq!(
        error.message,
        "panel \"front\": an edge of 90 cm is larger than the panel, which measures 520 by 660 mm"
    );
    let tiny = Range { fine: 1e-4, edge: 1e-4, grading: 0.3 };
    let error = check_count(&disc(), &SizeField::new(disc().bounds(), tiny)).unwrap_err();
    assert_eq!(
        error.message,
        "edges of 0.1 mm to 0.1 mm would make 29 million triangles, the limit is 5 million"
    );
    assert_eq!(error.hint.unwrap(), "use longer edges, or let them grow faster (`grading`)");
    let none = mesher(0.02, 0.01).run(set(&[]), None, None, &Context::quiet()).unwrap_err();
    assert_eq!(none.message, "there are no outlines to mesh");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn random_panels_sewn_to_each_other_agree(
        slope in 0.0..1.0f64, waves in 1..6u32, tall in 0.1..0.5f64, edge in 0.015..0.06f64, finer in 1.0..5.0f64,
        reversed in proptest::bool::ANY,
    ) {
        // The side leaves the vertical by 45 degrees at most: a panel with a corner as sharp as a
        // thorn has a triangle as sharp.
        let wave = slope * tall / (std::f64::consts::PI * f64::from(waves));
        let curve = |k: u32| {
            let t = f64::from(k) / 200.0;
            p(0.3 + wave * (std::f64::consts::PI * f64::from(waves) * t).sin() * t, tall * t)
        };
        let panel = |side: Vec<Point2>| {
            let (top, low) = (side[side.len() - 1], side[0]);
            named(vec![
                ("hem", vec![p(0.0, 0.0), low]),
                ("side", side),
                ("rest", vec![top, p(0.0, tall), p(0.0, 0.0)]),
            ])
        };
        let front = panel((0..=200).map(curve).collect());
        let back = panel(vec![p(0.28, 0.0), p(0.28, tall)]);
        let plan = sewn(&[("front.side", "back.side")], reversed);
        let mesher = mesher(edge, edge / finer);
        let panels = run(&mesher, &[("back", &back), ("front", &front)], Some(&plan));
        let count = |name: &str| panels.get(name).unwrap().edge("side").unwrap().vertices.len();
        prop_assert_eq!(count("front"), count("back"));
        for (name, panel) in panels.iter() {
            check_sound(panel);
            prop_assert!(panel.least_angle() > 12.0, "{}: {}", name, panel.least_angle());
        }
        let again = run(&mesher, &[("back", &back), ("front", &front)], Some(&plan));
        prop_assert_eq!(&again.get("front").unwrap(), &panels.get("front").unwrap());
    }
}
