//! The error of meshes on a cloth that hangs in one way only.
//!
//!     cargo run --release -p toile-tests --example mesh_hung
//!
//! A cotton square of 60 cm hangs by its two upper corners, held 50 cm apart, and comes to rest without friction. Each mesh is
//! solved from the same lay; its error is the distance of its surface to that of a grid of 6 mm (mean, 95 %, worst). Graded meshes are
//! made from a first drape on a grid of 30 mm, whose time counts.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, missing_docs)]

use std::sync::Arc;
use toile_core::artifact::*;
use toile_core::{ArtifactType, Context, Inputs, PortValue};
use toile_trade::measure::processor_seconds;
use toile_trade::surface::{Surface, distance};

/// Side of the square, and the distance of its upper corners, m.
const SIDE: (f64, f64) = (0.6, 0.5);

fn main() {
    let finest = drape(&lay(&grid(6.0)));
    let reference = Surface::new(&finest).unwrap();
    let tell = |name: &str, garment: &Garment, seconds: f64| {
        let d = distance(&Surface::new(garment).unwrap(), &reference);
        let [mean, p95, max] = [d.mean, d.p95, d.max].map(|x| x * 1e3);
        println!(
            "{name:34} {:6} triangles {seconds:6.2} s {mean:6.2} / {p95:.2} / {max:.2} mm",
            garment.triangles.len()
        );
    };
    for edge in [40.0, 30.0, 24.0, 20.0, 16.0, 12.0, 10.0, 8.0] {
        let (rested, seconds) = timed(|| drape(&lay(&grid(edge))));
        tell(&format!("grid {edge} mm"), &rested, seconds);
    }
    for (edge, fine, tolerance) in [
        (30.0, 7.5, 2.0),
        (30.0, 7.5, 1.0),
        (30.0, 7.5, 0.5),
        (40.0, 10.0, 1.0),
        (40.0, 10.0, 0.5),
        (24.0, 6.0, 0.5),
    ] {
        let (rested, seconds) = timed(|| {
            let first = drape(&lay(&grid(30.0)));
            drape(&lay(&graded(edge, fine, tolerance, first)))
        });
        tell(&format!("graded {edge} to {fine} mm, {tolerance} mm"), &rested, seconds);
    }
}

fn timed(work: impl Fn() -> Garment) -> (Garment, f64) {
    let before = processor_seconds();
    let made = work();
    (made, processor_seconds() - before)
}

fn grid(edge: f64) -> Panel {
    run("GridMesher", &format!("(edge: \"{edge} mm\")"), vec![Some(one(square()))])
}

fn graded(edge: f64, fine: f64, tolerance: f64, first: Garment) -> Panel {
    let set = [("square".to_owned(), Arc::new(square()) as Arc<dyn Artifact>)].into();
    let set = PortValue::Set(Outline::KIND, set);
    let ron = format!("(edge: \"{edge} mm\", fine: \"{fine} mm\", tolerance: \"{tolerance} mm\")");
    run("GradedMesher", &ron, vec![Some(set), None, Some(one(first))])
}

fn drape(garment: &Garment) -> Garment {
    run("Rest", "()", vec![Some(one(garment.clone())), None, None])
}

fn one<T: ArtifactType>(artifact: T) -> PortValue {
    PortValue::One(Arc::new(artifact))
}

/// What a registered stage makes.
fn run<T: ArtifactType + Clone>(name: &str, ron: &str, inputs: Vec<Option<PortValue>>) -> T {
    let registry = toile::registry();
    let card = registry.cards().find(|c| c.name == name).unwrap();
    let made = registry.make(card, ron).unwrap().run_ports(&Inputs(inputs), &Context::quiet()).unwrap();
    let (_, artifact) = made[0].entries()[0];
    let any: &dyn std::any::Any = artifact.as_ref();
    any.downcast_ref::<T>().unwrap().clone()
}

fn square() -> Outline {
    let points = [(0.0, 0.0), (SIDE.0, 0.0), (SIDE.0, SIDE.0), (0.0, SIDE.0)];
    let points = points.map(|(x, y)| Point2::new(x, y)).to_vec();
    Outline {
        outer: Loop { points, corners: vec![0, 1, 2, 3] },
        holes: vec![],
        edges: vec![],
        inner: vec![],
        frame: None,
    }
}

/// The panel upright, bent a little forward in the middle as its corners are drawn together.
fn lay(panel: &Panel) -> Garment {
    let (narrow, n) = (SIDE.1 / SIDE.0, panel.positions.len());
    let at = |p: &Point2| {
        let bulge = (std::f64::consts::PI * p.x / SIDE.0).sin();
        Point3::new(narrow * p.x, p.y, 0.17 * bulge)
    };
    let corner = |p: &Point2| p.y == SIDE.0 && (p.x == 0.0 || p.x == SIDE.0);
    let pinned =
        panel.positions.iter().enumerate().filter(|(_, p)| corner(p)).map(|(v, _)| v as u32).collect();
    Garment {
        positions: panel.positions.iter().map(at).collect(),
        velocities: vec![Vector3::zeros(); n],
        rest: panel.positions.clone(),
        triangles: panel.triangles.clone(),
        panels: vec![GarmentPanel {
            name: "square".into(),
            vertices: 0..n,
            triangles: 0..panel.triangles.len(),
            boundary: panel.boundary.clone(),
            photo_px: vec![],
            fabric: Arc::new(cotton()),
        }],
        seams: vec![],
        weld: (0..n as u32).collect(),
        pinned,
        status: SolveStatus::default(),
    }
}

fn cotton() -> Fabric {
    Fabric {
        name: "cotton".into(),
        area_density: 0.12,
        warp: Curve::linear(2000.0),
        weft: Curve::linear(2000.0),
        shear: Curve::linear(50.0),
        bending_warp: 1e-5,
        bending_weft: 1e-5,
        thickness: 1e-3,
        friction: 0.3,
        damping: 0.0,
        source: "round figures".into(),
    }
}
