//! Colliders of a plugin, and a stage of a plugin that is handed one.

use std::sync::Arc;
use toile_core::prelude::*;

/// Keeps cloth out of a ball around the body.
#[stage(role = Collider, contracts(Deterministic))]
pub struct Sphere {
    /// Metres.
    #[param(default = 0.1, min = 0.01, max = 10.0, unit = "m")]
    radius: f64,
}

#[stage]
impl Sphere {
    fn run(&self, _body: &Body, _: &Context) -> Result<Collider, StageError> {
        let ball = Ball { radius: self.radius, trap: false };
        Ok(Collider { scheme: Arc::new(ball), signature: format!("sphere {}", self.radius) })
    }
}

/// A collider that panics when it is asked.
#[stage(role = Collider)]
pub struct TrapCollider;

#[stage]
impl TrapCollider {
    fn run(&self, _body: &Body, _: &Context) -> Result<Collider, StageError> {
        Ok(Collider { scheme: Arc::new(Ball { radius: 1.0, trap: true }), signature: "trap".into() })
    }
}

/// Moves every vertex out of the body: a solver of a plugin, which calls whatever collider it is
/// given.
#[stage(role = Draper)]
pub struct PushesOut;

#[stage]
impl PushesOut {
    fn run(&self, garment: &Garment, collider: &Collider, _: &Context) -> Result<Garment, StageError> {
        let mut out = garment.clone();
        let mut contacts = Vec::new();
        collider.scheme.body_contacts(&garment.positions, 0.0, &mut contacts);
        for c in &contacts {
            out.positions[c.vertex as usize] = c.point;
        }
        out.status.steps = contacts.len();
        Ok(out)
    }
}

#[derive(Debug)]
struct Ball {
    radius: f64,
    trap: bool,
}

impl Collide for Ball {
    fn card(&self) -> ColliderCard {
        ColliderCard {
            thickness: 1e-3,
            friction: 0.3,
            restitution: 0.0,
            self_collision: false,
            penalty: None,
        }
    }

    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        assert!(!self.trap, "snap");
        for (i, p) in positions.iter().enumerate() {
            let distance = p.coords.norm() - self.radius;
            if distance <= reach {
                let normal = p.coords.try_normalize(1e-12).unwrap_or_else(Vector3::y);
                out.push(BodyContact {
                    vertex: i as u32,
                    point: (normal * self.radius).into(),
                    normal,
                    distance,
                });
            }
        }
    }

    fn body_hits(&self, _: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        self.body_contacts(to, 0.0, out);
    }

    fn self_contacts(&self, _: &[Point3], _: &[[u32; 3]], _: f64, _: &mut Vec<SelfContact>) {}

    fn conservative_bounds(&self, positions: &[Point3], _: &[[u32; 3]], reach: f64) -> Vec<f64> {
        vec![reach; positions.len()]
    }

    fn self_crossings(&self, _: &[Point3], _: &[[u32; 3]]) -> Vec<[u32; 2]> {
        Vec::new()
    }
}
