#![allow(clippy::unwrap_used)]
use super::*;

/// Thickness, m.
const THICK: f64 = 1e-3;

fn self_contact(pair: Pair, stacked: bool) -> SelfContact {
    SelfContact {
        thickness: THICK,
        stacked,
        stiffness: vec![100.0; 4],
        corners: vec![0, 2, 2, 2],
        pairs: vec![pair],
        ..SelfContact::default()
    }
}

/// An edge along x from 0 to 10 mm, and one half a millimetre over it, turned by `angle` about its
/// middle, which is at `middle` of the first one's length.
fn edges(middle: f64, angle: f64) -> [Vec3; 4] {
    let (at, way) =
        (Vec3::new(0.01 * middle, 0.5 * THICK, 0.0), Vec3::new(angle.cos(), 0.0, angle.sin()) * 0.005);
    [Vec3::zeros(), Vec3::new(0.01, 0.0, 0.0), at - way, at + way]
}

/// The share of its stiffness that the contact of these edges has.
fn share(middle: f64, angle: f64, stacked: bool) -> f64 {
    let pair = Pair { kind: Kind::EdgeEdge, nodes: [0, 1, 2, 3] };
    let found = self_contact(pair, stacked).touching(&edges(middle, angle));
    assert_eq!(found.len(), 1);
    found[0].stiffness / 50.0
}

#[test]
fn contacts_of_edges_fade_towards_an_end() {
    let right = std::f64::consts::FRAC_PI_2;
    for (middle, stack, elsewhere) in [
        (0.5, 1.0, 1.0),
        (0.1, 1.0, 1.0),
        (0.05, 0.5, 1.0),
        (0.001, 0.01, 0.2),
        (0.98, 0.2, 1.0),
        (0.999, 0.01, 0.2),
    ] {
        assert!((share(middle, right, true) - stack).abs() < 1e-9, "{middle}");
        assert!((share(middle, right, false) - elsewhere).abs() < 1e-9, "{middle}");
    }
}

#[test]
fn in_a_stack_contacts_of_edges_fade_as_they_become_parallel() {
    for (sine, wanted) in [(0.5, 1.0), (0.1, 1.0), (0.05, 0.25), (0.01, 0.01)] {
        assert!((share(0.5, f64::asin(sine), true) - wanted).abs() < 1e-9, "{sine}");
        assert!((share(0.5, f64::asin(sine), false) - 1.0).abs() < 1e-12, "{sine}");
    }
    assert_eq!(across(&[Vec3::zeros(); 4]), 0.0);
}

/// A triangle, and a vertex over it or, by `beyond`, past its first corner, where other triangles
/// may be nearer.
fn over(beyond: f64) -> [Vec3; 4] {
    let p = Vec3::new(-beyond, 0.5 * THICK, -beyond);
    [p, Vec3::zeros(), Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.01, 0.0, 0.0)]
}

fn count(self_contact: &mut SelfContact, beyond: f64) -> usize {
    self_contact.update_contacts(&over(beyond));
    self_contact.contacts.len()
}

#[test]
fn in_a_stack_a_held_pair_counts_while_it_is_near() {
    let pair = Pair { kind: Kind::VertexTriangle, nodes: [0, 1, 2, 3] };
    let mut stack = self_contact(pair, true);
    assert_eq!([count(&mut stack, -1e-5), count(&mut stack, 1e-5)], [1, 0]);
    stack.hold(true);
    assert_eq!([count(&mut stack, 1e-5), count(&mut stack, -1e-5), count(&mut stack, 1e-5)], [0, 1, 1]);
    assert_eq!(count(&mut stack, 1.1 * THICK), 0);
    // A held pair stays held until holding is switched off.
    stack.hold(true);
    assert_eq!(count(&mut stack, 1e-5), 1);
    stack.hold(false);
    assert_eq!(count(&mut stack, 1e-5), 0);
}

#[test]
fn few_cloths_hold_nothing() {
    let pair = Pair { kind: Kind::VertexTriangle, nodes: [0, 1, 2, 3] };
    let mut few = self_contact(pair, false);
    few.hold(true);
    assert_eq!([count(&mut few, -1e-5), count(&mut few, 1e-5)], [1, 0]);
    assert!(few.held.is_none());
}

#[test]
fn a_force_that_is_held_goes_on_evenly_past_the_corner() {
    let pair = Pair { kind: Kind::VertexTriangle, nodes: [0, 1, 2, 3] };
    let mut stack = self_contact(pair, true);
    stack.hold(true);
    count(&mut stack, -1e-9);
    let before = stack.contacts[0].potential.force;
    count(&mut stack, 1e-9);
    assert!((stack.contacts[0].potential.force - before).abs() < 1e-6 * before);
}
