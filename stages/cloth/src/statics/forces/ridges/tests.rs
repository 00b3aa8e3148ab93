#![allow(clippy::unwrap_used)]
use crate::scene::Scene;
use crate::scene::generate;
use crate::statics::forces::force::{Force, Place};
use crate::statics::forces::ridges::Ridges;
use crate::statics::forces::system::System;
use crate::statics::levels::testing::on_its_body;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// A sheet of 1 m, three cells a side, none of its vertices over the blade of 2 mm that stands
/// below its middle; its height is a plane's.
fn over_a_blade(height: f64, slope: f64) -> (Scene, Vec<Vec3>) {
    let mut scene = generate::drape(3);
    scene.body = Some(generate::block([-0.001, -0.3, -0.6], [0.001, 0.0, 0.6]));
    let x = scene.positions.iter().map(|p| Vec3::new(p.x, height + slope * p.x, p.z)).collect();
    (scene, x)
}

fn ready(system: &mut System<'_>, x: &[Vec3]) {
    system.find_pierced(x);
    system.seek_ridges(x);
    let body = system.body.unwrap();
    system.get_mut::<Ridges>().unwrap().update_contacts(body, x);
}

/// The lowest height at which the sheet's edges pass over the blade's middle, m.
fn lowest(sheet: &crate::mesh::Sheet, x: &[Vec3]) -> f64 {
    let over = |[a, b]: [u32; 2]| {
        let (p, q) = (x[a as usize], x[b as usize]);
        (p.x * q.x < 0.0).then(|| p.y + (q.y - p.y) * p.x / (p.x - q.x))
    };
    sheet.edges().iter().filter_map(|e| over(e.vertices)).fold(f64::INFINITY, f64::min)
}

#[test]
fn no_step_leads_cloth_past_a_blade_between_its_vertices() {
    let (scene, x) = over_a_blade(0.01, 0.0);
    on_its_body(&scene, |mut system, _, sheet| {
        ready(&mut system, &x);
        let mut moves = vec![Vec3::y() * -0.1; x.len()];
        system.clear_of_body(&x, &mut moves, |_| true);
        let after = |moves: &[Vec3]| -> Vec<Vec3> { x.iter().zip(moves).map(|(p, m)| p + m).collect() };
        assert!((lowest(sheet, &after(&moves)) + 0.09).abs() < 1e-6, "its vertices meet nothing");
        system.clear_of_ridges(&x, &mut moves);
        system.stop_at_ridges(&x, &mut moves);
        let height = lowest(sheet, &after(&moves));
        assert!(height > 0.0 && height < 0.011, "{height}");
    });
}

#[test]
fn the_force_of_an_edge_is_the_slope_of_its_energy() {
    let (scene, x) = over_a_blade(6e-4, 2e-4);
    on_its_body(&scene, |mut system, _, _| {
        ready(&mut system, &x);
        let ridges = system.get::<Ridges>().unwrap();
        assert!(ridges.contacts.len() > 5, "{}", ridges.contacts.len());
        let mut slope = vec![Vec3::zeros(); x.len()];
        ridges.add_gradient(&x, &mut slope);
        let most = slope.iter().map(Vec3::norm).fold(0.0, f64::max);
        let (mut at, step) = (x.clone(), 1e-8);
        for i in 0..x.len() {
            let mut energy = |by: f64| {
                at[i].y = x[i].y + by;
                let place = Place { x: &at, body: system.body, on_body: &[], loads: &system.loads };
                let mut energy = 0.0;
                ridges.add_contact_value(&place, &mut energy);
                at[i] = x[i];
                energy
            };
            let found = (energy(step) - energy(-step)) / (2.0 * step);
            assert!((found - slope[i].y).abs() < 1e-4 * most, "{found} {}", slope[i].y);
        }
    });
}

#[test]
fn cloth_that_a_blade_passes_through_is_pushed_up_over_it() {
    let (scene, x) = over_a_blade(-0.02, 1e-3);
    on_its_body(&scene, |mut system, _, _| {
        ready(&mut system, &x);
        let ridges = system.get::<Ridges>().unwrap();
        assert!(!ridges.pierced.is_empty());
        let mut slope = vec![Vec3::zeros(); x.len()];
        ridges.add_gradient(&x, &mut slope);
        let up = -slope.iter().map(|g| g.y).sum::<f64>();
        assert!(up > 0.0, "{up}");
        // It may go up, past the edge.
        let mut moves = vec![Vec3::y() * 0.03; x.len()];
        system.clear_of_ridges(&x, &mut moves);
        assert!(moves.iter().all(|m| (m - Vec3::y() * 0.03).norm() < 1e-12));
    });
}

#[test]
fn a_ball_has_nothing_to_look_after() {
    on_its_body(&generate::drape(4), |system, _, _| assert!(system.get::<Ridges>().is_none()));
}
