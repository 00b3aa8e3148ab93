#![allow(clippy::unwrap_used)]
use super::*;
use crate::contact::coulomb::FrictionMemory;
use crate::contact::friction::FrictionContact;
use crate::linear::Pattern;
use crate::mesh::Sheet;
use crate::scene::{Scene, generate};
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::levels::testing::on_its_body;
use crate::statics::newton::nearby::Nearby;
use toile_geometry::cloth_tree::ClothTree;

/// A square on a ball, creased, in contact with the ball and with itself; every third node is
/// active in the half of greater x.
fn with_subdomain(check: impl Fn(System<'_>, Vec<Vec3>, Vec<bool>)) {
    let mut scene: Scene = generate::drape(14);
    scene.material.bending_friction_warp = 1e-6;
    scene.material.bending_friction_weft = 5e-7;
    on_its_body(&scene, |system, _, sheet| lay_folded(&scene, system, sheet, check));
}

fn lay_folded(
    scene: &Scene,
    mut system: System<'_>,
    sheet: &Sheet,
    check: impl Fn(System<'_>, Vec<Vec3>, Vec<bool>),
) {
    let ball = scene.body.as_ref().unwrap();
    let flat = scene.positions.clone();
    let top = ball.vertices.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    // Two halves of the square lie on each other, less than a thickness apart; the lower one
    // touches the ball's top.
    let fold = |p: &Vec3| {
        let upper = f64::from(u8::from(p.x > 0.0));
        let wave = 2e-4 * (40.0 * p.z).sin();
        Vec3::new(-p.x.abs(), top + 5e-4 + upper * 4e-4 + wave, p.z)
    };
    let x: Vec<Vec3> = flat.iter().map(fold).collect();
    let mut nearby = Nearby::new(Some(ClothTree::new(sheet.triangles(), &flat)));
    nearby.seek_about(&mut system, &x, &vec![true; x.len()]);
    system.update_contacts(&x);
    system.elastic.hold(&flat, false);
    assert!(system.elastic.holds());
    let active = flat.iter().enumerate().map(|(i, p)| p.x > 0.05 && i % 3 == 0).collect();
    check(system, x, active);
}

#[test]
fn active_nodes_have_the_forces_of_the_whole() {
    with_subdomain(|system, x, active| {
        let whole = system.gradient(&x);
        assert!(system.get::<SelfContact>().is_some_and(|c| c.contacts.len() > 20));
        assert!(system.get::<BodyContact>().is_some_and(|c| c.touches.iter().any(|t| t.force > 0.0)));
        let mut subdomain = Subdomain::of(&system, active.clone());
        let own = subdomain.pick(&x);
        subdomain.system.update_contacts(&own);
        let scale = whole.iter().map(Vec3::norm).fold(0.0, f64::max);
        for ((g, i), pinned) in
            subdomain.system.gradient(&own).iter().zip(subdomain.cut.nodes()).zip(&subdomain.system.pinned)
        {
            let i = *i as usize;
            assert_eq!(*pinned, !active[i]);
            assert!((g - if active[i] { whole[i] } else { Vec3::zeros() }).norm() < 1e-9 * scale, "{i}");
        }
    });
}

/// The matrix at `x` times `way`.
fn stiffness(system: &mut System<'_>, x: &[Vec3], way: &[Vec3]) -> Vec<Vec3> {
    let own = system.pattern();
    system.elastic.bind(&own);
    let (pattern, slots): (Pattern, _) = own.with(|visit| system.collisions(&mut |g| visit(g)));
    system.elastic.follow(&pattern, &slots);
    let mut values = Vec::new();
    system.matrix(x, &pattern, 1.0, 0.0, &mut values);
    let mut out = vec![Vec3::zeros(); x.len()];
    pattern.multiply_add(&values, way, &mut out);
    out
}

#[test]
fn active_nodes_are_as_stiff_as_in_the_whole() {
    with_subdomain(|mut system, x, active| {
        let way = |i: usize| Vec3::new((3 * i) as f64, (5 * i) as f64, (7 * i) as f64).map(f64::sin);
        let ways: Vec<Vec3> = (0..x.len()).map(|i| if active[i] { way(i) } else { Vec3::zeros() }).collect();
        system.elastic.predict(&x, &ways.iter().map(|w| w * 1e-4).collect::<Vec<_>>());
        let mut subdomain = Subdomain::of(&system, active.clone());
        let (own, own_ways) = (subdomain.pick(&x), subdomain.pick(&ways));
        subdomain.system.update_contacts(&own);
        let whole = stiffness(&mut system, &x, &ways);
        let found = stiffness(&mut subdomain.system, &own, &own_ways);
        let scale = whole.iter().map(Vec3::norm).fold(0.0, f64::max);
        for (f, &i) in found.iter().zip(subdomain.cut.nodes()).filter(|(_, i)| active[**i as usize]) {
            assert!((f - whole[i as usize]).norm() < 1e-9 * scale, "{i}");
        }
    });
}

fn memory(system: &System<'_>) -> Vec<Option<FrictionMemory>> {
    system.get::<BodyContact>().unwrap().memory.clone()
}

fn friction_contacts(system: &System<'_>) -> Vec<FrictionContact> {
    system.get::<SelfContact>().unwrap().friction_contacts.clone()
}

#[test]
fn what_a_part_found_comes_back_to_its_nodes_alone() {
    with_subdomain(|mut system, x, active| {
        let mut whole = x.clone();
        system.elastic.predict(&x, &vec![Vec3::zeros(); x.len()]);
        let before = (memory(&system), friction_contacts(&system));
        let mut subdomain = Subdomain::of(&system, active.clone());
        let held = system.elastic.held().to_vec();
        let mut own = subdomain.pick(&x);
        let moved = |i: u32| if active[i as usize] { Vec3::new(0.0, -1e-4, 0.0) } else { Vec3::zeros() };
        own.iter_mut().zip(subdomain.cut.nodes()).for_each(|(p, &i)| *p += moved(i));
        subdomain.system.update_contacts(&own);
        let among: Vec<bool> = (0..x.len() as u32).map(|i| subdomain.cut.nodes().contains(&i)).collect();
        subdomain.system.drag_anchors(&own);
        subdomain.put_back(&own, &mut system, &mut whole);
        let dragged = system.elastic.held().iter().zip(&held).filter(|(a, b)| a != b).count();
        assert!(dragged > 10 && dragged < held.len() / 2, "{dragged} of {}", held.len());
        for i in 0..x.len() {
            assert_eq!(whole[i], x[i] + moved(i as u32));
            assert!(among[i] || memory(&system)[i] == before.0[i]);
        }
        let friction_contacts = friction_contacts(&system);
        assert!(friction_contacts.is_sorted_by_key(FrictionContact::key) && friction_contacts != before.1);
        let asleep = |g: &&FrictionContact| g.nodes.iter().all(|&i| !active[i as usize]);
        assert!(friction_contacts.iter().filter(asleep).eq(before.1.iter().filter(asleep)));
    });
}

#[test]
fn friction_whose_pair_has_gone_is_left_out() {
    with_subdomain(|mut system, x, active| {
        system.get_mut::<SelfContact>().unwrap().friction = vec![0.3; x.len()];
        system.update_contacts(&x);
        let self_contact = system.get_mut::<SelfContact>().unwrap();
        let gripped = self_contact
            .friction_contacts
            .iter()
            .filter(|g| g.nodes.iter().any(|&i| active[i as usize]))
            .count();
        assert!(gripped > 0);
        self_contact.pairs.clear();
        let subdomain = Subdomain::of(&system, active);
        let self_contact = subdomain.system.get::<SelfContact>().unwrap();
        assert!(self_contact.friction_contacts.len() < gripped);
        assert!(
            self_contact
                .friction_contacts
                .iter()
                .flat_map(|g| &g.nodes)
                .all(|&i| (i as usize) < subdomain.len())
        );
    });
}

#[test]
fn what_stands_for_three_feels_a_third_of_what_carries_it() {
    with_subdomain(|mut system, x, active| {
        let mut subdomain = Subdomain::of(&system, active.clone());
        let own = subdomain.pick(&x);
        let contact = |system: &mut System<'_>| -> Vec<Vec3> {
            system.update_contacts(&own);
            let all = system.gradient(&own);
            system.forces.clear();
            all.iter().zip(system.gradient(&own)).map(|(a, rest)| a - rest).collect()
        };
        let one = contact(&mut subdomain.system);
        let mut three = Subdomain::of(&system, active.clone()).standing_for(3);
        let third = contact(&mut three.system);
        let most = one.iter().map(Vec3::norm).fold(0.0, f64::max);
        assert!(most > 0.0 && one.iter().zip(&third).all(|(a, b)| (a / 3.0 - b).norm() < 1e-9 * most));
        // What it has learnt of loads comes back in the forces of the whole.
        let of_nodes =
            |s: &System<'_>| -> Vec<f64> { memory(s).iter().map(|m| m.map_or(0.0, |m| m.load)).collect() };
        let before = of_nodes(&system);
        let friction = |s: &System<'_>| friction_contacts(s).iter().map(|c| c.memory.load).sum::<f64>();
        let loads = friction(&system);
        let mut whole = x.clone();
        Subdomain::of(&system, active).standing_for(3).put_back(&own, &mut system, &mut whole);
        assert!(of_nodes(&system).iter().zip(&before).all(|(a, b)| (a - b).abs() <= 1e-12 * b.abs()));
        assert!(loads >= 0.0 && (friction(&system) - loads).abs() <= 1e-9 * loads);
    });
}
