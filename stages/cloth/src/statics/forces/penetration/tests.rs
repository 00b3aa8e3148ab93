#![allow(clippy::unwrap_used)]
use super::*;
use crate::contact::body::Body;
use crate::scene::{Scene, generate};
use crate::statics::drive::solve::StaticEquilibrium;
use nalgebra::{Rotation3, Vector2};
use std::ops::ControlFlow;

/// The arm of [`generate::sleeve`]; its axis runs from the origin along -y, turned.
fn arm() -> (Body, Rotation3<f64>) {
    let body = generate::sleeve(8, 16).body.unwrap();
    let turn = Rotation3::from_axis_angle(&Vec3::z_axis(), 60.0_f64.to_radians());
    (Body::new(body.vertices, &body.triangles), turn)
}

/// A triangle of the arm's own axes.
fn triangle(corners: [Vec3; 3]) -> (Sheet, Vec<Vec3>, Body) {
    let (body, turn) = arm();
    let sides = [corners[1] - corners[0], corners[2] - corners[0]];
    let (length, height) = (sides[0].norm(), sides[0].cross(&sides[1]).norm() / sides[0].norm());
    let along = sides[1].dot(&sides[0]) / length;
    let flat = [Vector2::zeros(), Vector2::new(length, 0.0), Vector2::new(along, height)];
    (Sheet::flat(&flat, &[[0, 1, 2]], 1.0).unwrap(), corners.map(|c| turn * c).to_vec(), body)
}

#[test]
fn an_arm_comes_through_a_triangle_across_or_along_it() {
    let across = [[-0.12, -0.3, -0.1], [0.12, -0.3, -0.1], [0.0, -0.3, 0.15]];
    let slanting = [[-0.12, -0.4, -0.1], [0.12, -0.2, -0.1], [0.0, -0.3, 0.15]];
    for corners in [across, slanting] {
        let (sheet, x, body) = triangle(corners.map(Vec3::from));
        assert_eq!(pierced(&sheet, &body, &x), 1);
    }
}

#[test]
fn a_triangle_that_sags_into_an_arm_or_lies_beside_it_is_not_pierced() {
    // At this place the arm's radius is 5 cm: a chord 3.5 cm from the axis.
    let sags = [[0.035, -0.25, -0.06], [0.035, -0.35, 0.0], [0.035, -0.25, 0.06]];
    let beside = [[0.08, -0.25, -0.06], [0.08, -0.35, 0.0], [0.08, -0.25, 0.06]];
    for corners in [sags, beside] {
        let (sheet, x, body) = triangle(corners.map(Vec3::from));
        assert_eq!(pierced(&sheet, &body, &x), 0);
    }
}

/// A wide sleeve that is laid out at an angle to the arm.
fn askew(wide: f64, degrees: f64) -> Scene {
    let mut scene = generate::sleeve(14, 30);
    let turn = Rotation3::from_axis_angle(&Vec3::y_axis(), degrees.to_radians());
    scene.rest.iter_mut().for_each(|p| p.x *= wide);
    let free = (0..scene.positions.len()).filter(|&v| !scene.pinned.contains(&(v as u32)));
    for v in free.collect::<Vec<_>>() {
        let p = scene.positions[v];
        scene.positions[v] = turn * Vec3::new(p.x, p.y, wide * p.z);
    }
    scene
}

/// How often the cuff winds around the arm.
fn windings(x: &[Vec3]) -> f64 {
    let (_, turn) = arm();
    let lower = 31 * 15;
    let cuff: Vec<usize> = (0..15).chain((lower..lower + 15).rev()).collect();
    let angle = |v: usize| {
        let p = turn.inverse() * x[v];
        p.z.atan2(p.x)
    };
    let full = std::f64::consts::TAU;
    let steps = (0..cuff.len()).map(|k| angle(cuff[(k + 1) % cuff.len()]) - angle(cuff[k]));
    steps.map(|d| d - full * (d / full).round()).sum::<f64>() / full
}

#[test]
fn an_arm_at_an_angle_to_its_sleeve_stays_inside_it() {
    let rest = StaticEquilibrium { coarsest: 20, ..StaticEquilibrium::default() };
    for degrees in [15.0, 20.0] {
        let state = rest.solve(&askew(1.6, degrees), &mut |_, _| ControlFlow::Continue(())).unwrap();
        assert!((windings(&state.positions).abs() - 1.0).abs() < 1e-9);
        assert_eq!((state.dip, state.restarts > 0), (0.0, true));
    }
}
