#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::{body, both, cube, sphere};
use super::*;
use toile_core::artifact::Vector3;

fn fault(body: &Body) -> String {
    let error = check_body(body).unwrap_err();
    assert!(error.hint.is_some());
    error.message
}

fn two_cubes(turned: bool) -> Body {
    let (one, mut two) = (cube(0.5), cube(0.5));
    two.positions.iter_mut().for_each(|p| *p += Vector3::new(3.0, 0.0, 0.0));
    if turned {
        two.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    }
    body(both((one.positions, one.triangles), (two.positions, two.triangles)))
}

#[test]
fn accepts_closed_bodies_in_one_or_several_pieces() {
    assert_eq!(check_body(&cube(0.5)), Ok(()));
    assert_eq!(check_body(&sphere(1.0, 8, 12)), Ok(()));
    assert_eq!(check_body(&two_cubes(false)), Ok(()));
}

#[test]
fn accepts_a_body_far_from_the_origin() {
    let mut far = sphere(1.0, 8, 12);
    far.positions.iter_mut().for_each(|p| *p += Vector3::new(1e7, 1e7, -1e7));
    assert_eq!(check_body(&far), Ok(()));
}

#[test]
fn names_the_fault_and_counts_it() {
    let mut infinite = cube(0.5);
    infinite.positions[3].x = f64::NAN;
    assert_eq!(fault(&infinite), "the body has 1 vertex that is not finite");
    infinite.positions[4].y = f64::INFINITY;
    assert_eq!(fault(&infinite), "the body has 2 vertices that are not finite");

    assert_eq!(fault(&body((vec![], vec![]))), "the body has no triangles");

    let mut missing = cube(0.5);
    missing.triangles[0][1] = 8;
    assert_eq!(fault(&missing), "the body has 1 triangle of vertices that do not exist");

    let mut flat = cube(0.5);
    flat.positions[0] = flat.positions[1];
    assert_eq!(fault(&flat), "the body has 2 triangles without area");
    assert_eq!(check_body(&flat).unwrap_err().code, ErrorCode::DegenerateTriangles);

    let mut open = cube(0.5);
    open.triangles.truncate(10);
    assert_eq!(
        fault(&open),
        "the body is not closed: it has 4 boundary edges, the first from (0.500, -0.500, -0.500) to (0.500, 0.500, -0.500) m"
    );

    let mut doubled = cube(0.5);
    doubled.triangles.push(doubled.triangles[0]);
    assert_eq!(
        fault(&doubled),
        "the body is not closed: it has 3 edges with more than two triangles, the first from (-0.500, -0.500, -0.500) to (-0.500, 0.500, -0.500) m"
    );

    let mut turned = cube(0.5);
    turned.triangles[0].swap(0, 1);
    assert_eq!(
        fault(&turned),
        "the body is not closed: it has 3 edges whose triangles face opposite ways, the first from (-0.500, -0.500, -0.500) to (-0.500, 0.500, -0.500) m"
    );

    let mut both = cube(0.5);
    both.triangles[0].swap(0, 1);
    both.triangles.pop();
    assert_eq!(
        fault(&both),
        "the body is not closed: it has 3 boundary edges, 3 edges whose triangles face opposite ways, \
         the first from (-0.500, -0.500, -0.500) to (-0.500, 0.500, -0.500) m"
    );

    let mut inward = cube(0.5);
    inward.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert_eq!(fault(&inward), "the body is inside out: its triangles face inwards");
    assert_eq!(fault(&two_cubes(true)), "the body is inside out: 1 of its 2 pieces face inwards");
}
