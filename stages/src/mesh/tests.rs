//! What both meshers promise, on every fixture.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::fixtures::*;
use super::{DelaunayMesher, GridMesher};
use std::collections::BTreeMap;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

type Mesher = fn(&Outline, f64) -> Result<Panel, StageError>;

fn grid(outline: &Outline, h: f64) -> Result<Panel, StageError> {
    GridMesher { edge: Length::m(h) }.run(outline, &Context::quiet())
}

fn delaunay(outline: &Outline, h: f64) -> Result<Panel, StageError> {
    DelaunayMesher { edge: Length::m(h), ..DelaunayMesher::default() }.run(outline, &Context::quiet())
}

const MESHERS: [(&str, Mesher); 2] = [("grid", grid), ("delaunay", delaunay)];

fn fixtures() -> Vec<(&'static str, Outline)> {
    vec![
        ("vest", vest()),
        ("tshirt", tshirt()),
        ("disc", disc()),
        ("annulus", annulus()),
        ("square", rectangle(0.3, 0.3)),
        ("strip", rectangle(0.6, 0.02)),
        ("star", star()),
        ("battlements", battlements()),
        ("darted", darted()),
    ]
}

/// The farthest of the true loop's points from the meshed loop, and of the vertices from the loop.
fn deviation(truth: &[Point2], panel: &Panel, chain: &[u32]) -> (f64, f64) {
    use super::predicates::distance_to_segment;
    let mesh: Vec<Point2> = chain.iter().map(|&v| panel.positions[v as usize]).collect();
    let to = |q: Point2, l: &[Point2]| {
        (0..l.len())
            .map(|k| distance_to_segment(q, l[k], l[(k + 1) % l.len()]).0)
            .fold(f64::INFINITY, f64::min)
    };
    let farthest = |a: &[Point2], b: &[Point2]| a.iter().map(|&q| to(q, b)).fold(0.0, f64::max);
    (farthest(truth, &mesh), farthest(&mesh, truth))
}

#[test]
#[ignore = "prints a table"]
fn table() {
    for (shape, outline) in fixtures() {
        for h in [0.08, 0.04, 0.02, 0.012, 0.005, 0.002] {
            for (mesher, run) in MESHERS {
                let start = std::time::Instant::now();
                match run(&outline, h) {
                    Ok(panel) => {
                        let s = start.elapsed().as_secs_f64();
                        let (d, e) = deviation(&outline.outer.points, &panel, &panel.boundary);
                        let poor =
                            panel.triangles.iter().filter(|t| panel.triangle_least_angle(**t) < 24.9).count();
                        println!(
                            "{shape:12} {mesher:9} {:5.1} mm {:7} tris {s:7.3} s least {:6.2} poor {poor:4} dev {:6.4} h off {e:.1e} short {:.3} h, border {:.3} h",
                            h * 1e3,
                            panel.triangles.len(),
                            panel.least_angle(),
                            d / h,
                            shortest(&panel).0 / h,
                            shortest(&panel).1 / h
                        );
                        draw(&format!("{shape}_{mesher}_{}", h * 1e3), &panel);
                    }
                    Err(e) => println!("{shape:12} {mesher:9} {:5.1} mm {e}", h * 1e3),
                }
            }
        }
    }
}

fn draw(name: &str, panel: &Panel) {
    if panel.triangles.len() > 20_000 {
        return;
    }
    let Ok(dir) = std::env::var("TOILE_DRAW") else { return };
    let mut s = String::new();
    use std::fmt::Write;
    for p in &panel.positions {
        writeln!(s, "v {} {} 0", p.x, p.y).unwrap();
    }
    for t in &panel.triangles {
        writeln!(s, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1).unwrap();
    }
    for c in &panel.inner {
        writeln!(s, "l {}", c.vertices.iter().map(|v| (v + 1).to_string()).collect::<Vec<_>>().join(" "))
            .unwrap();
    }
    std::fs::write(format!("{dir}/{name}.obj"), s).unwrap();
}

fn shortest(panel: &Panel) -> (f64, f64) {
    let d = |a: u32, b: u32| (panel.positions[a as usize] - panel.positions[b as usize]).norm();
    let all = panel
        .triangles
        .iter()
        .flat_map(|t| [d(t[0], t[1]), d(t[1], t[2]), d(t[2], t[0])])
        .fold(9.0, f64::min);
    let n = panel.boundary.len();
    (all, (0..n).map(|k| d(panel.boundary[k], panel.boundary[(k + 1) % n])).fold(9.0, f64::min))
}

/// A star-shaped panel: corners at random angles and radii, joined by curves that bulge at random.
fn star_shaped(corners: &[(f64, f64)], bulges: &[f64]) -> Outline {
    let n = corners.len();
    let total: f64 = corners.iter().map(|c| c.0).sum();
    let mut angle = 0.0;
    let mut at = Vec::new();
    for c in corners {
        at.push((angle, c.1));
        angle += std::f64::consts::TAU * c.0 / total;
    }
    at.push((angle, at[0].1));
    let polar = |a: f64, r: f64| p(r * a.cos(), r * a.sin());
    let names: Vec<String> = (0..n).map(|k| format!("edge_{k}")).collect();
    let edges = (0..n)
        .map(|k| {
            let ((a0, r0), (a1, r1)) = (at[k], at[k + 1]);
            let curve = |i: i32| {
                let t = f64::from(i) / 100.0;
                let r = r0 + (r1 - r0) * t + bulges[k % bulges.len()] * t * (1.0 - t);
                polar(a0 + (a1 - a0) * t, r)
            };
            (names[k].as_str(), (0..=100).map(curve).collect::<Vec<_>>())
        })
        .collect();
    named(edges)
}

#[test]
#[ignore = "prints a table"]
fn random_table() {
    use proptest::strategy::{Strategy, ValueTree};
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let strat = (
        proptest::collection::vec((0.5..1.5f64, 0.12..0.35f64), 3..9),
        proptest::collection::vec(-0.15..0.2f64, 1..9),
        0.005..0.06f64,
    );
    let mut hist = [0; 12];
    for i in 0..400 {
        let (c, b, h) = strat.new_tree(&mut runner).unwrap().current();
        let outline = star_shaped(&c, &b);
        for (mesher, run) in MESHERS {
            match run(&outline, h) {
                Ok(panel) => {
                    let a = panel.least_angle();
                    hist[(a / 4.0) as usize] += 1;
                    let corner = (0..outline.outer.corners.len())
                        .map(|k| {
                            let n = outline.outer.points.len();
                            let c = outline.outer.corners[k];
                            let q = |i: usize| outline.outer.points[i % n];
                            let (u, v) = (q(c + 1) - q(c), q(c + n - 1) - q(c));
                            u.angle(&v).to_degrees()
                        })
                        .fold(180.0, f64::min);
                    if a < 15.0 {
                        println!(
                            "{i} {mesher} h {:.1} mm least {a:.2} corner {corner:.1} {} tris",
                            h * 1e3,
                            panel.triangles.len()
                        );
                        draw(&format!("r{i}_{mesher}"), &panel);
                    }
                }
                Err(e) => println!("{i} {mesher} {h} {e}"),
            }
        }
    }
    println!("{hist:?}");
}
