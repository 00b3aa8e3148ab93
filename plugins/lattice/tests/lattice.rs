//! The mesher by itself.
#![allow(clippy::unwrap_used)]

use toile_core::artifact::{Outline, Panel};
use toile_core::testkit::{self, shapes};
use toile_lattice::LatticeMesher;

toile_core::contracts!(LatticeMesher);

fn mesh(outline: &Outline) -> Panel {
    testkit::run_one(&LatticeMesher::default(), outline).unwrap()
}

/// Mean over triangles of twice the ratio of the inner to the outer circle: 1 for equilateral ones.
fn mean_quality(panel: &Panel) -> f64 {
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| panel.positions[v as usize]);
        let [x, y, z] = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
        (y + z - x) * (z + x - y) * (x + y - z) / (x * y * z)
    };
    panel.triangles.iter().map(of).sum::<f64>() / panel.triangles.len() as f64
}

#[test]
fn triangles_are_near_equilateral() {
    for (name, outline, least) in [
        ("vest", shapes::outline(), 26.0),
        ("T-shirt", shapes::tshirt(), 26.0),
        ("disc with a hole", shapes::holed(), 26.0),
        ("darts", shapes::darted(), 6.0),
    ] {
        let panel = mesh(&outline);
        println!("{name}: least angle {:.1}, mean quality {:.4}, {} triangles", panel.least_angle(), mean_quality(&panel), panel.triangles.len());
        assert!(panel.least_angle() > least, "{name}: {}", panel.least_angle());
        assert!(mean_quality(&panel) > 0.97, "{name}: {}", mean_quality(&panel));
        let area = outline.area();
        assert!((panel.area() - area).abs() < 2e-3 * area, "{name}: {} of {area}", panel.area());
    }
}

#[test]
fn edges_that_are_sewn_together_get_equal_counts() {
    let (front, mut back) = (shapes::vest(0.5), shapes::vest(0.62));
    for e in &mut back.edges {
        e.gauge = e.gauge.shared(&front.edge(&e.name).unwrap().gauge);
    }
    let front = Outline { edges: back.edges.clone(), ..front };
    let (a, b) = (mesh(&front), mesh(&back));
    for (e, f) in a.edges.iter().zip(&b.edges) {
        assert_eq!((&e.name, e.vertices.len()), (&f.name, f.vertices.len()));
    }
}
