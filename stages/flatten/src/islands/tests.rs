use super::*;
use crate::shapes::{cylinder, grid};
use nalgebra::{Point2, Point3};
use proptest::prelude::*;

/// A tube of two halves, front and back, each 4 squares wide; vertices of the seams are shared.
fn tube() -> (Vec<Point3<f64>>, Vec<[u32; 3]>, Vec<u32>) {
    let (places, triangles) = grid(8, 3, |u, v| {
        let a = std::f64::consts::TAU * u;
        [-a.sin(), v, a.cos()]
    });
    let weld = |v: u32| v / 9 * 9 + v % 9 % 8;
    let groups = (0..triangles.len()).map(|t| u32::from(t / 2 % 8 >= 4)).collect();
    (places, triangles.iter().map(|t| t.map(weld)).collect(), groups)
}

#[test]
fn groups_become_pieces_with_their_seams() {
    let (places, triangles, groups) = tube();
    let Ok(garment) = islands_by_group(&places, &triangles, &groups) else { unreachable!() };
    assert_eq!(garment.pieces.iter().map(|p| p.triangles.len()).collect::<Vec<_>>(), [24, 24]);
    assert_eq!(garment.seams.len(), 2);
    for seam in &garment.seams {
        assert_eq!((seam.a.piece, seam.b.piece), (0, 1));
        assert_eq!(seam.a.vertices.len(), 4);
        let of = |c: &Chain| {
            c.vertices.iter().map(|&v| garment.pieces[c.piece].vertices[v as usize]).collect::<Vec<_>>()
        };
        assert_eq!(of(&seam.a), of(&seam.b));
    }
}

#[test]
fn uv_islands_are_cut_where_indices_differ() {
    let (places, triangles, groups) = tube();
    let uv: Vec<_> = triangles.iter().zip(&groups).map(|(t, g)| t.map(|v| v + 100 * g)).collect();
    let by_uv = islands_by_uv(&places, &triangles, &uv);
    assert_eq!(by_uv, islands_by_group(&places, &triangles, &groups));
}

#[test]
fn a_marked_seam_may_end_inside_a_piece() {
    let (places, triangles) = cylinder(6, 6);
    // From the lower boundary up the middle column, three edges.
    let Ok(garment) = islands_by_seams(&places, &triangles, &[[3, 10], [10, 17], [17, 24]]) else {
        unreachable!()
    };
    assert_eq!(garment.pieces.len(), 1);
    let piece = &garment.pieces[0];
    assert_eq!(piece.surface.positions().len(), 49 + 3);
    assert_eq!(garment.seams.len(), 1);
    let seam = &garment.seams[0];
    assert_eq!((seam.a.vertices.len(), seam.b.vertices.len()), (4, 4));
    // Both legs end at the tip.
    let tip = |c: &Chain| [c.vertices[0], c.vertices[3]].contains(&seam.a.vertices[3]);
    assert!(tip(&seam.a) && (tip(&seam.b) || seam.a.vertices[0] == seam.b.vertices[0]));
}

#[test]
fn a_tube_cut_along_one_seam_meets_itself() {
    let (places, triangles, _) = tube();
    let seams: Vec<[u32; 2]> = (0..3).map(|j| [9 * j, 9 * (j + 1)]).collect();
    let Ok(garment) = islands_by_seams(&places, &triangles, &seams) else { unreachable!() };
    assert_eq!(garment.pieces[0].surface.loops().len(), 1);
    assert_eq!(garment.seams.len(), 1);
    assert_eq!((garment.seams[0].a.piece, garment.seams[0].b.piece), (0, 0));
}

#[test]
fn a_piece_that_shows_its_wrong_side_is_turned() {
    let (places, mut triangles, groups) = tube();
    // The back inside out, and one triangle of the front.
    for (t, g) in triangles.iter_mut().zip(&groups) {
        if *g == 1 {
            t.swap(1, 2);
        }
    }
    triangles[0].swap(1, 2);
    // 24 triangles against 24: the first piece decides.
    let Ok(garment) = islands_by_group(&places, &triangles, &groups) else { unreachable!() };
    assert_eq!(garment.pieces.iter().map(|p| p.surface.repairs().turned).collect::<Vec<_>>(), [1, 24]);
    assert_eq!(garment.seams.len(), 2);
    let outward = |p: &SurfacePiece| {
        p.surface.area_vector(0).dot(&p.surface.positions()[0].coords.xz().insert_row(1, 0.0))
    };
    // The right side of this tube is its inside.
    assert!(garment.pieces.iter().all(|p| outward(p) < 0.0));
}

#[test]
fn faults_are_named_by_the_garment() {
    let (places, triangles, groups) = tube();
    let text =
        |r: Result<SurfacePieces, crate::SurfaceError>| r.map_or_else(|e| e.to_string(), |_| String::new());
    assert_eq!(
        text(islands_by_group(&places, &triangles, &groups[1..])),
        "groups has 47 entries, but 48 are wanted"
    );
    assert_eq!(
        text(islands_by_seams(&places, &triangles, &[[0, 4]])),
        "seam edge 0 joins vertices 0 and 4, which no triangle does"
    );
    let places =
        [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [5., 5., 5.], [6., 5., 5.], [5., 6., 5.]];
    let places: Vec<_> = places.iter().map(|&p| Point3::from(p)).collect();
    let closed = [[4, 5, 6], [0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    assert_eq!(
        text(split_components(&places, &closed)),
        "the surface is closed (no edge at triangle 1 is free)"
    );
}

#[test]
fn welding_joins_what_is_near() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0009, 0.0], [1.0, 0.0], [f64::NAN, 0.0]].map(Point2::from);
    assert_eq!(weld_uv(&points, 0.0), [0, 1, 2, 1, 4]);
    assert_eq!(weld_uv(&points, 0.001), [0, 1, 0, 1, 4]);
}

proptest! {
    /// Any grouping of a sound mesh: every triangle is in one piece, and seams pair equal places.
    #[test]
    fn every_triangle_is_in_one_piece(groups in prop::collection::vec(0u32..3, 48)) {
        let (places, triangles, _) = tube();
        if let Ok(garment) = islands_by_group(&places, &triangles, &groups) {
            let mut all: Vec<u32> = garment.pieces.iter().flat_map(|p| p.triangles.clone()).collect();
            all.sort_unstable();
            prop_assert!(all.iter().enumerate().all(|(k, &t)| k == t as usize) && all.len() == 48);
            for seam in &garment.seams {
                prop_assert_eq!(seam.a.vertices.len(), seam.b.vertices.len());
                for (&v, &w) in seam.a.vertices.iter().zip(&seam.b.vertices) {
                    let (a, b) = (&garment.pieces[seam.a.piece], &garment.pieces[seam.b.piece]);
                    prop_assert_eq!(a.vertices[v as usize], b.vertices[w as usize]);
                }
            }
        }
    }

    #[test]
    fn any_lists_are_cut_or_refused(
        places in prop::collection::vec(prop::array::uniform3(-2.0..2.0f64), 0..9),
        triangles in prop::collection::vec(prop::array::uniform3(0u32..9), 0..12),
        uv in prop::collection::vec(prop::array::uniform3(0u32..4), 0..12),
        seams in prop::collection::vec(prop::array::uniform2(0u32..9), 0..4),
    ) {
        let places: Vec<_> = places.iter().map(|&p| Point3::from(p)).collect();
        let _ = islands_by_uv(&places, &triangles, &uv);
        let _ = islands_by_seams(&places, &triangles, &seams);
        let _ = split_components(&places, &triangles);
    }
}
