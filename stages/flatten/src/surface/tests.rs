use super::*;
use crate::shapes::{cone, cylinder, grid, surface};
use proptest::prelude::*;

fn refused(places: Vec<Point3<f64>>, triangles: Vec<[u32; 3]>) -> String {
    PieceSurface::new(places, triangles).map_or_else(|e| e.to_string(), |_| "accepted".into())
}

fn points(list: &[[f64; 3]]) -> Vec<Point3<f64>> {
    list.iter().map(|&p| Point3::from(p)).collect()
}

/// Corners of the unit square, and one above it.
fn corners() -> Vec<Point3<f64>> {
    points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 1.0]])
}

#[test]
fn a_sheet_has_one_boundary_loop_counter_clockwise() {
    let s = surface(grid(2, 1, |u, v| [2.0 * u, v, 0.0]));
    assert_eq!(s.loops(), [vec![0, 1, 2, 5, 4, 3]]);
    assert_eq!(s.repairs(), SurfaceRepairs::default());
    assert!((s.area() - 2.0).abs() < 1e-15);
}

#[test]
fn a_hole_is_a_second_loop() {
    let (places, mut triangles) = grid(5, 5, |u, v| [u, v, 0.0]);
    triangles.drain(24..26);
    let s = surface((places, triangles));
    assert_eq!(s.loops().iter().map(Vec::len).collect::<Vec<_>>(), [20, 4]);
}

#[test]
fn turned_triangles_are_turned_back_by_the_majority() {
    let (places, mut triangles) = cylinder(6, 6);
    let sound = triangles.clone();
    for t in [3, 17, 18, 40] {
        triangles[t].swap(1, 2);
    }
    let s = surface((places, triangles));
    assert_eq!(s.repairs().turned, 4);
    let rotated = |t: &[u32; 3]| {
        let k = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
        [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]
    };
    assert!(s.triangles().iter().zip(&sound).all(|(a, b)| rotated(a) == rotated(b)));
    assert_eq!(s.loops().len(), 1);
}

#[test]
fn unused_vertices_are_left_out_and_counted() {
    let (mut places, _) = grid(2, 2, |u, v| [u, v, 0.0]);
    places.insert(0, Point3::new(9.0, 9.0, 9.0));
    let s = surface((places, vec![[1, 2, 5], [1, 5, 4]]));
    assert_eq!(s.repairs().unused, 6);
    assert_eq!(s.sources(), [1, 2, 4, 5]);
}

#[test]
fn a_bow_tie_between_arms_of_one_piece_is_split() {
    // A strip of triangles that comes back to touch its own first vertex.
    let (mut places, triangles) = grid(8, 1, |u, v| {
        let angle = 5.5 * u;
        let r = 1.0 + v;
        [-r * angle.cos(), r * angle.sin(), 0.0]
    });
    let (first, last) = (0u32, 8u32);
    places[last as usize] = places[first as usize];
    let triangles = triangles.into_iter().map(|t| t.map(|v| if v == last { first } else { v })).collect();
    let s = surface((places, triangles));
    assert_eq!(s.repairs(), SurfaceRepairs { turned: 0, split: 1, unused: 1 });
    assert_eq!(s.loops().len(), 1);
}

#[test]
fn every_fault_is_named_with_its_place() {
    let sheet = vec![[0, 1, 2], [0, 2, 3]];
    assert_eq!(refused(corners(), vec![]), "the mesh has no triangles");
    assert_eq!(refused(corners(), vec![[0, 1, 9]]), "triangle 0 names vertex 9, but there are 5");
    let mut places = corners();
    places[2].y = f64::NAN;
    assert_eq!(refused(places, sheet.clone()), "vertex 2 is not at a finite place");
    let mut places = corners();
    places[3].x = 1e300;
    assert_eq!(refused(places, sheet.clone()), "vertex 3 is not at a finite place");
    assert_eq!(
        refused(corners(), vec![[0, 1, 2], [0, 2, 2]]),
        "triangle 1 has no area (height / longest edge 0.0e0)"
    );
    assert_eq!(
        refused(corners(), vec![[0, 1, 2], [0, 2, 3], [2, 0, 4]]),
        "the edge of vertices 0 and 2 belongs to 3 triangles"
    );
    let tetrahedron = vec![[0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 0, 4]];
    assert_eq!(refused(corners(), tetrahedron), "the surface is closed (no edge at triangle 0 is free)");
    let far = points(&[[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 1.0, 0.0]]);
    let two = [corners(), far].concat();
    assert_eq!(
        refused(two, vec![[0, 1, 2], [0, 2, 3], [5, 6, 7]]),
        "the mesh has 2 separate components, the second at triangle 2"
    );
}

#[test]
fn a_moebius_strip_and_a_handle_are_refused() {
    let (places, triangles) = grid(9, 1, |u, v| {
        let (a, r) = (std::f64::consts::TAU * u, (v - 0.5) * 0.5);
        let radius = 2.0 + r * (a / 2.0).cos();
        [radius * a.cos(), radius * a.sin(), r * (a / 2.0).sin()]
    });
    // The end meets the beginning the other way up.
    let weld = |v: u32| if v % 10 == 9 { if v == 9 { 10 } else { 0 } } else { v };
    let strip: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(weld)).collect();
    assert!(refused(places, strip).ends_with("cannot be turned to agree with its neighbours"));

    let (places, triangles) = grid(9, 9, |u, v| {
        let (a, b) = (std::f64::consts::TAU * u, std::f64::consts::TAU * v);
        [(2.0 + b.cos()) * a.cos(), (2.0 + b.cos()) * a.sin(), b.sin()]
    });
    let weld = |v: u32| (v / 10 % 9) * 10 + v % 10 % 9;
    let torus: Vec<[u32; 3]> = triangles.iter().skip(1).map(|t| t.map(weld)).collect();
    assert_eq!(refused(places, torus), "the surface has 1 handles, so it cannot lie in the plane");
}

#[test]
fn places_can_be_exchanged_but_not_their_number() {
    let s = surface(cone(3, 8, 1.0));
    let flat = s.positions().iter().map(|p| Point3::new(p.x, p.y, 0.0)).collect();
    assert!(s.with_positions(flat).is_ok());
    let e = s.with_positions(vec![]).map_err(|e| e.to_string());
    assert_eq!(e.err().as_deref(), Some("positions has 0 entries, but 25 are wanted"));
}

proptest! {
    /// Whatever the lists say: an answer, no panic; and what is accepted is sound.
    #[test]
    fn any_mesh_is_checked_or_refused(
        places in prop::collection::vec(prop::array::uniform3(-2.0..2.0f64), 0..9),
        triangles in prop::collection::vec(prop::array::uniform3(0u32..10), 0..12),
    ) {
        if let Ok(s) = PieceSurface::new(points(&places), triangles) {
            let free = s.opposite().iter().filter(|&&o| o == FREE).count();
            prop_assert_eq!(free, s.loops().iter().map(Vec::len).sum::<usize>());
            for (h, &o) in s.opposite().iter().enumerate().filter(|(_, o)| **o != FREE) {
                prop_assert_eq!(s.opposite()[o as usize] as usize, h);
            }
        }
    }
}
