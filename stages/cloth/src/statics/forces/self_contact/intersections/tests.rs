use super::*;
use toile_geometry::pair::Kind;

/// A vertex `height` over a triangle of three, one millimetre thick.
fn vertex_over(height: f64) -> (SelfContact, [Vec3; 4]) {
    let pair = Pair { kind: Kind::VertexTriangle, nodes: [0, 1, 2, 3] };
    let self_contact = SelfContact {
        thickness: 1e-3,
        stiffness: vec![100.0; 4],
        corners: vec![0, 1, 1, 1],
        pairs: vec![pair],
        ..SelfContact::default()
    };
    let place = |x: f64, z: f64| Vec3::new(0.01 * x, 0.0, 0.01 * z);
    (self_contact, [place(0.3, 0.3) + Vec3::y() * height, place(0.0, 0.0), place(0.0, 1.0), place(1.0, 0.0)])
}

#[test]
fn merged_cloth_is_intersecting_until_it_is_apart() {
    for (height, wanted) in [(0.0, true), (1.9e-7, true), (1.9e-5, true), (2.1e-5, false), (0.3e-3, false)] {
        let (mut self_contact, x) = vertex_over(height);
        self_contact.resolve_intersections(&[], &x);
        assert_eq!(self_contact.intersecting.contains(&true), wanted, "{height}");
        self_contact.update_contacts(&x);
        assert_eq!(self_contact.contacts.is_empty(), wanted, "{height}");
    }
}

#[test]
fn a_crossing_is_pulled_out_on_the_side_it_came_from() {
    let (mut self_contact, mut x) = vertex_over(2e-3);
    x[0].y = -0.2e-3;
    // The edge from node 0 goes up through the triangle: its short end is pulled up.
    let up = [x[0], Vec3::new(0.003, 2e-3, 0.003)];
    let all = [up[0], x[1], x[2], x[3], up[1]];
    self_contact.stiffness.push(100.0);
    self_contact.resolve_intersections(&[([0, 4], [1, 2, 3])], &all);
    assert_eq!(self_contact.intersections.len(), 1);
    let intersection = &self_contact.intersections[0];
    assert_eq!(intersection.nodes[0], 0);
    assert!(intersection.normal.y > 0.99 && intersection.potential.force > 0.0);
    assert!(self_contact.intersecting.iter().all(|t| *t));
}
