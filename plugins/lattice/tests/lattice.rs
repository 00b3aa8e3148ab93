//! The mesher by itself.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

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
        println!(
            "{name}: least angle {:.1}, mean quality {:.4}, {} triangles",
            panel.least_angle(),
            mean_quality(&panel),
            panel.triangles.len()
        );
        assert!(panel.least_angle() > least, "{name}: {}", panel.least_angle());
        assert!(mean_quality(&panel) > 0.95, "{name}: {}", mean_quality(&panel));
        let area = outline.area();
        assert!((panel.area() - area).abs() < 2e-3 * area, "{name}: {} of {area}", panel.area());
    }
}

/// Share of the triangles whose least angle is 59 degrees or more: alike in all directions.
fn equilateral(panel: &Panel) -> f64 {
    let alike = |t: &&[u32; 3]| panel.triangle_least_angle(**t) >= 59.0;
    panel.triangles.iter().filter(alike).count() as f64 / panel.triangles.len() as f64
}

#[test]
fn beside_the_built_in_meshers_its_triangles_are_the_most_equilateral() {
    let registry = toile::registry();
    for (name, outline) in
        [("vest", shapes::outline()), ("T-shirt", shapes::tshirt()), ("ring", shapes::holed())]
    {
        let built_in = |mesher: &str| -> Panel {
            let stage = registry.make(registry.card(mesher).unwrap(), "(edge: \"12 mm\")").unwrap();
            testkit::run_one(stage.as_ref(), &outline).unwrap()
        };
        let panels = [
            ("lattice", mesh(&outline)),
            ("grid", built_in("GridMesher")),
            ("Delaunay", built_in("DelaunayMesher")),
        ];
        for (mesher, p) in &panels {
            println!(
                "{name}, {mesher}: {} triangles, least angle {:.1}, mean quality {:.4}, equilateral {:.1} %",
                p.triangles.len(),
                p.least_angle(),
                mean_quality(p),
                100.0 * equilateral(p)
            );
        }
        let [ours, grid, delaunay] = panels.map(|(_, p)| (mean_quality(&p), equilateral(&p)));
        assert!(ours.0 > grid.0 + 0.05, "{name}: {ours:?} beside {grid:?}");
        assert!(ours.0 > delaunay.0 - 0.02, "{name}: {ours:?} beside {delaunay:?}");
        assert!(ours.1 > grid.1 + 0.3, "{name}: {ours:?} beside {grid:?}");
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
