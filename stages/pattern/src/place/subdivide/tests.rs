//! A tube of two panels, a vest and small corners of cloth on finer meshes.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::Subdivide;
use proptest::prelude::*;
use std::collections::BTreeMap;
use toile_core::Cancel;
use toile_core::prelude::*;
use toile_fixtures::cloth::{ClothGrid, garment, hanging, plain, vest};
use toile_fixtures::photographed;

/// Panels of 8 by 8 cells round a body, their sides joined, the upper rim held.
fn tube() -> Garment {
    let mut tube = photographed::garment(8);
    let top = tube.rest.iter().map(|p| p.y).fold(0.0, f64::max);
    tube.pinned = (0..tube.rest.len() as u32).filter(|v| tube.rest[*v as usize].y == top).collect();
    tube
}

/// The same before it is sewn, 2 cm apart.
fn open_tube() -> Garment {
    let mut tube = tube();
    tube.weld = (0..tube.weld.len() as u32).collect();
    tube.seams.iter_mut().for_each(|s| s.state = SeamState::Open);
    tube.positions[81..].iter_mut().for_each(|p| p.z -= 0.02);
    tube
}

fn refined(garment: &Garment, parts: usize) -> Garment {
    let fine = Subdivide { parts }.run(garment, &Context::quiet()).unwrap();
    fine.check().unwrap();
    fine
}

/// Triangles on each edge, joined vertices counted as one.
fn joined_edges(garment: &Garment) -> BTreeMap<[u32; 2], usize> {
    let mut edges = BTreeMap::new();
    for t in &garment.triangles {
        let [a, b, c] = t.map(|v| garment.weld[v as usize]);
        for (a, b) in [(a, b), (b, c), (c, a)] {
            *edges.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
        }
    }
    edges
}

/// Vertices - edges + triangles, joined vertices counted as one.
fn euler(garment: &Garment) -> i64 {
    let vertices = garment.weld.iter().enumerate().filter(|(i, w)| **w as usize == *i).count();
    vertices as i64 - joined_edges(garment).len() as i64 + garment.triangles.len() as i64
}

fn counts(garment: &Garment) -> [usize; 3] {
    [garment.positions.len(), garment.edges().len(), garment.triangles.len()]
}

fn square(columns: usize, rows: usize) -> ClothGrid {
    ClothGrid { columns, rows, flat: Point2::new, lift: |p| Point3::new(p.x, p.y, 0.0) }
}

/// Grids of these columns and rows, sewn by one open seam; vertices of the second count from its
/// own first.
fn sewn(grids: &[(usize, usize)], pairs: &[[u32; 2]], shift: bool) -> Garment {
    let grids: Vec<ClothGrid> = grids.iter().map(|&(c, r)| square(c, r)).collect();
    let named: Vec<(&str, &ClothGrid)> = ["first", "second"].into_iter().zip(&grids).collect();
    let mut g = garment(&named, &plain(500.0, 50.0, 1e-5));
    let shift = if shift { g.panels[1].vertices.start as u32 } else { 0 };
    let pairs = pairs.iter().map(|p| [p[0], p[1] + shift]).collect();
    g.seams.push(GarmentSeam { name: "seam".into(), kind: SeamKind::Matched, pairs, state: SeamState::Open });
    g
}

/// Flat places of the vertices that a seam pairs: those of its old pairs left out.
fn new_pairs(coarse: &Garment, fine: &Garment) -> Vec<[[f64; 2]; 2]> {
    let places = |g: &Garment| -> Vec<[[f64; 2]; 2]> {
        g.seams[0].pairs.iter().map(|p| p.map(|v| g.rest[v as usize].coords.into())).collect()
    };
    let old = places(coarse);
    places(fine).into_iter().filter(|p| !old.contains(p)).collect()
}

#[test]
fn every_panel_has_the_vertices_of_its_edges_and_triangles() {
    let tube = tube();
    assert_eq!(counts(&tube), [162, 416, 256]);
    assert_eq!(counts(&refined(&tube, 2)), [162 + 416, 2 * 416 + 3 * 256, 4 * 256]);
    assert_eq!(counts(&refined(&tube, 3)), [162 + 2 * 416 + 256, 3 * 416 + 9 * 256, 9 * 256]);
    let fine = refined(&tube, 4);
    assert_eq!(fine.panels[0].vertices, 0..81 + 3 * 208 + 3 * 128);
    assert_eq!(fine.panels[1].triangles, 16 * 128..32 * 128);
    assert_eq!(fine.panels[0].photo_px.len(), fine.panels[0].vertices.len());
    assert_eq!(fine.panels[0].boundary.len(), 4 * tube.panels[0].boundary.len());
}

#[test]
fn the_cloth_lies_where_it_lay() {
    let tube = tube();
    let fine = refined(&tube, 3);
    for (old, new) in tube.panels.iter().zip(&fine.panels) {
        let ((flat, now), (fine_flat, fine_now)) = (tube.panel_areas(old), fine.panel_areas(new));
        assert!((flat / fine_flat - 1.0).abs() < 1e-12 && (now / fine_now - 1.0).abs() < 1e-12);
        let ((flat, now), (fine_flat, fine_now)) = (tube.panel_boundaries(old), fine.panel_boundaries(new));
        assert!((flat / fine_flat - 1.0).abs() < 1e-12 && (now / fine_now - 1.0).abs() < 1e-12);
        let start = new.vertices.start;
        for (k, v) in old.vertices.clone().enumerate() {
            assert_eq!((fine.positions[start + k], fine.rest[start + k]), (tube.positions[v], tube.rest[v]));
            assert_eq!(new.photo_px[k], old.photo_px[k]);
        }
    }
}

#[test]
fn pieces_are_like_the_triangle_that_they_are_of_and_turned_as_it_is() {
    let tube = tube();
    let shape = |g: &Garment, t: [u32; 3]| {
        let [a, b, c] = t.map(|v| g.rest[v as usize]);
        let mut sides = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
        sides.sort_by(f64::total_cmp);
        (sides, (b - a).perp(&(c - a)))
    };
    for parts in [2, 3, 5] {
        let fine = refined(&tube, parts);
        let n = parts as f64;
        for (t, pieces) in tube.triangles.iter().zip(fine.triangles.chunks(parts * parts)) {
            let (sides, area) = shape(&tube, *t);
            for piece in pieces {
                let (own, own_area) = shape(&fine, *piece);
                assert!(own.iter().zip(sides).all(|(own, side)| (own * n - side).abs() < 1e-12));
                assert!((own_area * n * n - area).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn what_moves_goes_on_and_is_no_longer_at_rest() {
    let mut tube = tube();
    tube.status = SolveStatus {
        steps: 7,
        converged: true,
        energy: 0.5,
        max_speed: 1e-4,
        on_body: vec![],
        held: Held::default(),
    };
    for (v, p) in tube.velocities.iter_mut().zip(&tube.rest) {
        *v = Vector3::new(p.x, p.y, 1.0);
    }
    let fine = refined(&tube, 2);
    assert_eq!(fine.status, SolveStatus { converged: false, ..tube.status.clone() });
    // Joined vertices are one, and have one velocity.
    let free = fine.weld.iter().enumerate().filter(|(i, w)| **w as usize == *i).map(|(i, _)| i);
    for v in free {
        let p = fine.rest[v];
        assert!((fine.velocities[v] - Vector3::new(p.x, p.y, 1.0)).norm() < 1e-12);
    }
}

#[test]
fn pins_hold_the_vertices_that_they_held() {
    let tube = tube();
    let fine = refined(&tube, 3);
    assert_eq!(tube.pinned.len(), 18);
    let held = |g: &Garment| g.pinned.iter().map(|v| g.positions[*v as usize]).collect::<Vec<_>>();
    assert_eq!(held(&fine), held(&tube));
    assert!(fine.pinned.is_sorted());
}

#[test]
fn a_closed_seam_joins_every_new_vertex_and_its_sides_have_one_place() {
    let tube = tube();
    assert_eq!(euler(&tube), 0);
    for parts in [2, 3, 4] {
        let fine = refined(&tube, parts);
        assert_eq!(euler(&fine), 0, "a tube of {parts} parts");
        assert_eq!(fine.seam_gap_max(), 0.0);
        for (old, new) in tube.seams.iter().zip(&fine.seams) {
            assert_eq!((new.pairs.len() - 1, new.state), ((old.pairs.len() - 1) * parts, old.state));
        }
        let border = joined_edges(&fine).values().filter(|n| **n == 1).count();
        assert_eq!(border, 2 * 16 * parts, "rims alone are open");
    }
}

#[test]
fn an_open_seam_stays_open_with_gaps_between_those_of_its_ends() {
    let coarse = vest(&plain(500.0, 50.0, 1e-5));
    let fine = refined(&coarse, 3);
    for (old, new) in coarse.seams.iter().zip(&fine.seams) {
        assert_eq!((new.pairs.len() - 1, new.state), ((old.pairs.len() - 1) * 3, SeamState::Open));
        // In order along the seam, and both sides at the same height.
        let mirrored = |p: &[u32; 2]| {
            let [a, b] = p.map(|v| fine.rest[v as usize]);
            (Point2::new(-a.x, a.y) - b).norm() < 1e-12
        };
        assert!(new.pairs.iter().all(mirrored));
        assert!(
            new.pairs
                .iter()
                .step_by(3)
                .map(|p| fine.positions[p[0] as usize])
                .eq(old.pairs.iter().map(|p| coarse.positions[p[0] as usize]))
        );
    }
    assert!((fine.seam_gap_max() - coarse.seam_gap_max()).abs() < 1e-12);
    assert!(fine.weld.iter().enumerate().all(|(i, w)| *w as usize == i));
}

#[test]
fn pairs_may_stand_in_any_order() {
    let tube = tube();
    let mut shuffled = tube.clone();
    shuffled.seams.iter_mut().for_each(|s| s.pairs.sort_by_key(|p| p[0].wrapping_mul(2_654_435_761)));
    let sorted = |g: &Garment| {
        let mut pairs: Vec<[u32; 2]> = g.seams.iter().flat_map(|s| s.pairs.clone()).collect();
        pairs.sort_unstable();
        pairs
    };
    let (fine, other) = (refined(&tube, 3), refined(&shuffled, 3));
    assert_ne!(tube.seams[0].pairs, shuffled.seams[0].pairs);
    assert_eq!((sorted(&fine), &fine.weld), (sorted(&other), &other.weld));
}

#[test]
fn twice_in_two_is_once_in_four() {
    let tube = tube();
    let (twice, once) = (refined(&refined(&tube, 2), 2), refined(&tube, 4));
    assert_eq!((counts(&twice), euler(&twice)), (counts(&once), euler(&once)));
    assert_eq!(twice.seams[0].pairs.len(), once.seams[0].pairs.len());
}

#[test]
fn no_corner_that_an_edge_cuts_is_sewn() {
    // Squares of two triangles, sewn along two sides; the edge between the ends of these is in
    // both.
    let coarse = sewn(&[(1, 1), (1, 1)], &[[0, 0], [1, 1], [3, 3]], true);
    let fine = refined(&coarse, 2);
    assert_eq!(new_pairs(&coarse, &fine), [[[0.5, 0.0]; 2], [[1.0, 0.5]; 2]]);
}

#[test]
fn a_border_is_sewn_onto_a_line_within_a_panel() {
    // The lower side of the first on the middle line of the second.
    let coarse = sewn(&[(2, 1), (2, 2)], &[[0, 3], [1, 4], [2, 5]], true);
    let fine = refined(&coarse, 2);
    assert_eq!(new_pairs(&coarse, &fine), [[[0.25, 0.0], [0.25, 0.5]], [[0.75, 0.0], [0.75, 0.5]]]);
}

#[test]
fn gathered_cloth_is_sewn_to_the_vertex_that_takes_it_up() {
    // Two edges of the first on one of the second: the first of them on a vertex.
    let coarse = sewn(&[(2, 1), (1, 1)], &[[0, 0], [1, 0], [2, 1]], true);
    let fine = refined(&coarse, 2);
    assert_eq!(new_pairs(&coarse, &fine), [[[0.25, 0.0], [0.0, 0.0]], [[0.75, 0.0], [0.5, 0.0]]]);
}

#[test]
fn a_dart_is_sewn_up_to_its_tip() {
    // The halves of a sheet's lower side on each other; its middle, the tip, is no pair.
    let mut coarse = sewn(&[(4, 2)], &[[0, 4], [1, 3]], false);
    coarse.seams[0].state = SeamState::Closed;
    let fine = refined(&coarse, 3);
    assert_eq!(fine.seams[0].pairs.len(), 2 + 2 * 2);
    assert_eq!(euler(&fine), 1, "a cone, without a hole at its tip");
}

#[test]
fn one_part_leaves_every_bit() {
    let tube = tube();
    let same = refined(&tube, 1);
    let digest = |g: &Garment| {
        let mut d = Digester::default();
        g.digest(&mut d);
        d.finish()
    };
    assert_eq!(digest(&same), digest(&tube));
    assert_eq!((same.status, same.panels.len()), (tube.status, tube.panels.len()));
}

#[test]
fn what_would_be_too_large_is_refused_before_it_is_made() {
    let (sheet, _) = hanging(1.4, 1.4, 0.01, &plain(500.0, 50.0, 1e-5));
    let e = Subdivide { parts: 16 }.run(&sheet, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "with edges in 16 parts the garment has 5022081 vertices, the limit is 4000000");
    assert_eq!((e.code, e.hint.as_deref()), (ErrorCode::InvalidParameter, Some("take fewer parts")));
}

#[test]
fn it_stops_when_it_is_asked_to_and_refuses_an_empty_garment() {
    let cancel = Cancel::new();
    cancel.cancel();
    let cx = Context::new("Subdivide", std::path::Path::new("."), cancel, std::sync::Arc::new(()));
    assert_eq!(Subdivide::default().run(&tube(), &cx).unwrap_err().code, ErrorCode::Cancelled);
    let mut none = tube();
    none.triangles.clear();
    let e = Subdivide::default().run(&none, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "the garment is empty: it has no triangles");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_cloth_keeps_its_area_and_its_surface(
        parts in 1..=5usize,
        closed in proptest::bool::ANY,
        sways in proptest::collection::vec(-0.1..0.1f64, 3..20),
    ) {
        let mut coarse = if closed { tube() } else { open_tube() };
        for v in 0..coarse.positions.len() {
            let w = coarse.weld[v] as usize;
            coarse.positions[v] = if w < v {
                coarse.positions[w]
            } else {
                coarse.positions[v] + Vector3::new(sways[v % sways.len()], sways[v % 3], sways[v / 2 % 3])
            };
        }
        let fine = Subdivide { parts }.run(&coarse, &Context::quiet()).unwrap();
        prop_assert_eq!(fine.check(), Ok(()));
        prop_assert!(joined_edges(&fine).values().all(|n| *n <= 2));
        prop_assert_eq!(euler(&fine), euler(&coarse));
        for (old, new) in coarse.panels.iter().zip(&fine.panels) {
            let ((flat, now), (fine_flat, fine_now)) = (coarse.panel_areas(old), fine.panel_areas(new));
            prop_assert!((fine_flat / flat - 1.0).abs() < 1e-11 && (fine_now / now - 1.0).abs() < 1e-11);
        }
        prop_assert!((fine.seam_gap_max() - coarse.seam_gap_max()).abs() < 1e-12);
        prop_assert!(!closed || fine.seam_gap_max() == 0.0);
    }
}
