#![allow(clippy::unwrap_used)]
use super::*;
use crate::shapes::{self, ShapeMesh};
use crate::signed_distance::SignedDistance;

fn block(low: [f64; 3], high: [f64; 3]) -> ShapeMesh {
    shapes::block(low, high)
}

fn near(sharp: &Sharp, kind: Kind, low: [f64; 3], high: [f64; 3]) -> Vec<u32> {
    let mut found = Vec::new();
    sharp.within(kind, &Vec3::from(low), &Vec3::from(high), |f| found.push(f));
    found
}

#[test]
fn a_box_has_twelve_edges_and_eight_corners_and_its_faces_no_diagonals() {
    let (vertices, triangles) = block([-1.0; 3], [1.0; 3]);
    let sharp = Sharp::of(&vertices, &triangles).unwrap();
    let all = |kind| near(&sharp, kind, [-2.0; 3], [2.0; 3]).len();
    assert_eq!([all(Kind::EdgeEdge), all(Kind::VertexTriangle), sharp.count()], [12, 8, 20]);
    let about_one = near(&sharp, Kind::EdgeEdge, [0.9, 0.9, -0.1], [1.1, 1.1, 0.1]);
    assert_eq!(about_one.len(), 1);
    let edge = sharp.feature(about_one[0]);
    let side = |x: f64, y: f64| edge.side(&Vec3::new(x, y, 0.0));
    assert_eq!([side(0.1, 0.1), side(0.1, 0.0), side(0.0, 0.1)], [Side::Out; 3]);
    assert_eq!([side(-0.1, -0.1), side(-0.1, -0.01)], [Side::In; 2]);
    assert_eq!([side(-0.1, 0.1), side(0.1, -0.1)], [Side::Beside; 2]);
}

#[test]
fn a_ball_has_none_and_a_cone_its_tip_and_rim() {
    let ball = shapes::sphere(0.3, 24, 48);
    assert!(Sharp::of(&ball.0, &ball.1).is_none());
    let around = 32;
    let at = |k: u32| f64::from(k) * std::f64::consts::TAU / f64::from(around);
    let mut vertices = vec![Vec3::y(), Vec3::zeros()];
    vertices.extend((0..around).map(|k| Vec3::new(at(k).cos(), 0.0, at(k).sin()) * 0.5));
    let (rim, next) = (|k: u32| 2 + k, |k: u32| 2 + (k + 1) % 32);
    let triangles: Vec<_> = (0..around).flat_map(|k| [[0, next(k), rim(k)], [1, rim(k), next(k)]]).collect();
    let sharp = Sharp::of(&vertices, &triangles).unwrap();
    assert_eq!(near(&sharp, Kind::VertexTriangle, [-0.1, 0.9, -0.1], [0.1, 1.1, 0.1]).len(), 1);
    assert_eq!(near(&sharp, Kind::EdgeEdge, [-0.01, 0.9, -0.01], [0.01, 1.1, 0.01]).len(), 32);
    assert_eq!(near(&sharp, Kind::VertexTriangle, [-0.1, -0.1, -0.1], [0.1, 0.1, 0.1]).len(), 0);
}

#[test]
fn where_a_feature_is_closest_a_point_is_on_its_outer_side() {
    let (vertices, triangles) = block([-0.3, -0.1, -0.2], [0.3, 0.1, 0.2]);
    let (sharp, body) = (
        Sharp::of(&vertices, &triangles).unwrap(),
        SignedDistance::<Aabb>::new(vertices.clone(), triangles.clone()),
    );
    let mut counts = [0; 2];
    for k in 0..4000u32 {
        let share = |m: u32| f64::from(k * m % 997) / 996.0 - 0.5;
        let p = Vec3::new(share(7), share(31) * 0.6, share(101) * 0.8);
        let nearest = body.nearest(&p, 1.0).unwrap();
        for f in 0..sharp.count() as u32 {
            let feature = sharp.feature(f);
            let s = crate::closest::on_segment(&p, &feature.ends[0], &feature.ends[1]);
            let off = p - (feature.ends[0] + (feature.ends[1] - feature.ends[0]) * s);
            if off.norm() < 1e-3 || feature.kind == Kind::EdgeEdge && !(0.01..0.99).contains(&s) {
                continue;
            }
            let side = feature.side(&off);
            let is_closest = nearest.distance > 0.0 && off.norm() < nearest.distance * (1.0 + 1e-9);
            assert!(!is_closest || side == Side::Out, "{p:?} {feature:?}");
            assert!(!(nearest.distance < -1e-3 && side == Side::Out), "{p:?} {feature:?}");
            counts[usize::from(is_closest)] += 1;
        }
    }
    assert!(counts[1] > 100, "{counts:?}");
}
