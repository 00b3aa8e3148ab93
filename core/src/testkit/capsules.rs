//! A collider of capsules: the body of the suite as cloth meets it.

use crate::artifact::*;
use std::sync::Arc;

/// A body of capsules: exact, cheap, without the cloth's own contacts.
#[derive(Debug, Clone)]
struct CapsuleScheme(Vec<(Point3, Point3, f64)>);

/// A trunk, shoulders and a neck.
pub fn collider() -> Collider {
    let part = |a: [f64; 3], b: [f64; 3], r: f64| (Point3::from(a), Point3::from(b), r);
    let parts = vec![
        part([-0.08, 1.38, 0.0], [0.08, 1.38, 0.0], 0.06),
        part([-0.05, 0.8, 0.0], [-0.05, 1.3, 0.0], 0.1),
        part([0.05, 0.8, 0.0], [0.05, 1.3, 0.0], 0.1),
        part([0.0, 1.4, 0.0], [0.0, 1.6, 0.0], 0.05),
    ];
    Collider { scheme: Arc::new(CapsuleScheme(parts)), signature: "capsules".into() }
}

impl CapsuleScheme {
    fn distance(&self, q: &Point3) -> (f64, Vector3) {
        let one = |(a, b, r): &(Point3, Point3, f64)| {
            let (ab, aq) = (b - a, q - a);
            let out = aq - ab * (aq.dot(&ab) / ab.norm_squared()).clamp(0.0, 1.0);
            (out.norm() - r, out.try_normalize(1e-12).unwrap_or_else(Vector3::z))
        };
        self.0.iter().map(one).fold((f64::INFINITY, Vector3::y()), |a, b| if b.0 < a.0 { b } else { a })
    }
}

impl Collide for CapsuleScheme {
    fn card(&self) -> ColliderCard {
        ColliderCard {
            thickness: 1.5e-3,
            friction: 0.3,
            restitution: 0.0,
            self_collision: false,
            penalty: None,
        }
    }

    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        for (i, q) in positions.iter().enumerate() {
            let (distance, normal) = self.distance(q);
            if distance <= reach {
                out.push(BodyContact { vertex: i as u32, point: q - normal * distance, normal, distance });
            }
        }
    }

    fn body_hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        for (i, (a, b)) in from.iter().zip(to).enumerate() {
            let (distance, normal) = self.distance(b);
            if distance < 0.0 && self.distance(a).0 >= 0.0 {
                out.push(BodyContact { vertex: i as u32, point: b - normal * distance, normal, distance });
            }
        }
    }

    fn self_contacts(&self, _: &[Point3], _: &[[u32; 3]], _: f64, _: &mut Vec<SelfContact>) {}

    fn conservative_bounds(&self, positions: &[Point3], _: &[[u32; 3]], reach: f64) -> Vec<f64> {
        vec![reach; positions.len()]
    }

    fn self_crossings(&self, _: &[Point3], _: &[[u32; 3]]) -> Vec<[u32; 2]> {
        Vec::new()
    }
}
