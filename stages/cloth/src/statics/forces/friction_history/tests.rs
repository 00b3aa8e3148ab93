#![allow(clippy::unwrap_used)]
use super::*;
use crate::linear::Pattern;
use crate::statics::forces::force::Force;
use crate::statics::forces::self_contact::SelfContact;
use nalgebra::{DMatrix, Matrix3};
use toile_geometry::pair::{Kind, Pair};

const MU: f64 = 0.4;

/// Two triangles side by side, and vertex 4 half a millimetre over the first.
fn places() -> Vec<Vec3> {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z) * 0.01;
    vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 0.0, 1.0), at(1.0, 0.0, 1.0), at(0.3, 0.05, 0.3)]
}

fn over(triangle: [u32; 3]) -> Pair {
    let [a, b, c] = triangle;
    Pair { kind: Kind::VertexTriangle, nodes: [4, a, b, c] }
}

fn self_contact(triangle: [u32; 3]) -> SelfContact {
    SelfContact {
        thickness: 1e-3,
        stiffness: vec![100.0; 5],
        friction: vec![MU; 5],
        corners: vec![1, 2, 2, 1, 0],
        pairs: vec![over(triangle)],
        ..SelfContact::default()
    }
}

/// Self-contact that has touched at `x`, and the positions after it has slid.
fn slid(way: Vec3) -> (SelfContact, Vec<Vec3>) {
    let (mut self_contact, mut x) = (self_contact([0, 1, 2]), places());
    self_contact.update_contacts(&x);
    x[4] += way;
    self_contact.update_contacts(&x);
    (self_contact, x)
}

/// The force on vertex 4 along the sheet.
fn force(self_contact: &SelfContact, x: &[Vec3]) -> Vec3 {
    let mut g = vec![Vec3::zeros(); 5];
    self_contact.add_gradient(x, &mut g);
    assert!(g.iter().sum::<Vec3>().norm() < 1e-12, "what holds one pulls the other");
    Vec3::new(-g[4].x, 0.0, -g[4].z)
}

#[test]
fn friction_grows_to_its_limit_against_the_way() {
    let limit = MU * 100.0 * 0.5 * 0.5e-3;
    let at = |way: f64| force(&slid(Vec3::new(way, 0.0, 0.0)).0, &slid(Vec3::new(way, 0.0, 0.0)).1).x;
    assert!((at(1e-4) + limit * 0.5_f64.sqrt()).abs() < 1e-9, "{} {limit}", at(1e-4));
    assert!((-at(2e-3) / limit - 1.0).abs() < 0.002 && -at(2e-3) < limit);
    // Lifting off is not sliding.
    assert!(force(&slid(Vec3::new(0.0, 2e-4, 0.0)).0, &places()).norm() < 1e-12);
}

#[test]
fn a_vertex_that_slides_onto_the_next_triangle_is_held_as_before() {
    let (mut self_contact, mut x) = slid(Vec3::new(1e-4, 0.0, 0.0));
    let before = force(&self_contact, &x);
    self_contact.pairs = vec![over([1, 3, 2])];
    // A hair over the border: the way is as long as before, but the contact another one.
    let step = Vec3::new(0.0021, 0.0, 0.0021);
    self_contact.friction_contacts[0].memory.anchor += step;
    x[4] += step;
    self_contact.update_contacts(&x);
    assert_eq!(self_contact.friction_contacts[0].nodes, [4, 1, 3, 2]);
    assert!((force(&self_contact, &x) - before).norm() < 1e-9, "{before} {}", force(&self_contact, &x));
    self_contact.friction_contacts.clear();
    self_contact.update_contacts(&x);
    assert!(force(&self_contact, &x).norm() < 1e-12);
}

#[test]
fn a_contact_seen_from_the_other_side_takes_the_way_over_turned_round() {
    let (self_contact, x) = slid(Vec3::new(1e-4, 0.0, 0.0));
    let turned = Contact { nodes: [0, 4, 1, 2], weights: [1.0, -1.0, 0.0, 0.0], ..self_contact.contacts[0] };
    let new = FrictionHistory::of(&self_contact.friction_contacts, &x).friction_contact(&turned, &x, 1.0, MU);
    assert!((new.slid + Vec3::new(1e-4, 0.0, 0.0)).norm() < 1e-12, "{}", new.slid);
}

#[test]
fn the_anchor_is_dragged_only_behind_what_slides_on() {
    let (mut self_contact, mut x) = slid(Vec3::new(3e-4, 0.0, 0.0));
    let held = self_contact.friction_contacts.clone();
    self_contact.end_step(&x);
    assert_eq!(self_contact.friction_contacts, held);
    x[4].x += 2e-4;
    self_contact.end_step(&x);
    let way =
        self_contact.friction_contacts[0].coulomb().displacement(&self_contact.friction_contacts[0].at(&x));
    assert!((way.norm() - 0.577e-4).abs() < 1e-9, "{way}");
}

#[test]
fn force_and_matrix_are_derivatives_and_the_matrix_never_softens() {
    let (self_contact, mut x) = slid(Vec3::new(0.7e-4, 0.0, 0.4e-4));
    let pattern = Pattern::new(5, |visit| self_contact.collisions(&mut |g| visit(g)));
    let mut values = vec![Matrix3::zeros(); pattern.blocks()];
    self_contact.add_matrix(&x, &pattern, &mut values);
    let gradient = |x: &[Vec3]| {
        let mut g = vec![Vec3::zeros(); 5];
        self_contact.friction_contacts.iter().for_each(|r| {
            let f = r.coulomb().gradient(&r.at(x));
            r.nodes.iter().zip(&r.weights).for_each(|(i, w)| g[*i as usize] += f * *w);
        });
        g
    };
    let mut all = DMatrix::zeros(15, 15);
    for (i, block) in values[..5].iter().enumerate() {
        all.view_mut((3 * i, 3 * i), (3, 3)).copy_from(block);
    }
    for (i, j, slot) in pattern.upper() {
        let (i, j, block) = (3 * i as usize, 3 * j as usize, values[slot as usize]);
        all.view_mut((i, j), (3, 3)).copy_from(&block);
        all.view_mut((j, i), (3, 3)).copy_from(&block.transpose());
    }
    let scale = all.norm();
    assert!(all.clone().symmetric_eigenvalues().iter().all(|e| *e > -1e-12 * scale));
    let friction: f64 = self_contact.friction_contacts.iter().map(|c| c.coulomb().value(&c.at(&x))).sum();
    assert!(friction > 0.0);
    let normal = self_contact.contacts[0].normal;
    for (i, c) in (0..5).flat_map(|i| [0, 2].map(|c| (i, c))) {
        let (h, was) = (1e-8, x[i][c]);
        let value = |x: &[Vec3]| -> f64 {
            self_contact.friction_contacts.iter().map(|c| c.coulomb().value(&c.at(x))).sum()
        };
        x[i][c] = was + h;
        let (up, more) = (value(&x), gradient(&x));
        x[i][c] = was - h;
        let (down, less) = (value(&x), gradient(&x));
        x[i][c] = was;
        assert!(((up - down) / (2.0 * h) - gradient(&x)[i][c]).abs() < 1e-6 * MU);
        for (j, d) in (0..5).flat_map(|j| [0, 2].map(|d| (j, d))) {
            // The contact itself presses upwards only.
            assert!(normal[c].abs() + normal[d].abs() < 1e-9);
            let slope = (more[j][d] - less[j][d]) / (2.0 * h);
            assert!((slope - all[(3 * i + c, 3 * j + d)]).abs() < 1e-5 * scale, "{i} {c} {j} {d}");
        }
    }
}
