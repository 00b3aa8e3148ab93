//! Cloth of known shape, for the tests of this crate.

use std::sync::Arc;
use toile_core::artifact::*;

fn garment(rest: Vec<Point2>, positions: Vec<Point3>, triangles: Vec<[u32; 3]>) -> Garment {
    let n = positions.len();
    let curve = || Curve(vec![(0.1, 10.0)]);
    let fabric = Fabric {
        name: "test".into(),
        area_density: 0.1,
        warp: curve(),
        weft: curve(),
        shear: curve(),
        bending_warp: 1e-6,
        bending_weft: 1e-6,
        bending_friction_warp: 0.0,
        bending_friction_weft: 0.0,
        thickness: 1e-3,
        friction: 0.3,
        damping: 0.0,
        source: String::new(),
    };
    let panel = GarmentPanel {
        name: "sheet".into(),
        vertices: 0..n,
        triangles: 0..triangles.len(),
        boundary: vec![0, 1, 2],
        photo_px: Vec::new(),
        fabric: Arc::new(fabric),
        layer: 0,
    };
    Garment {
        velocities: vec![Vector3::zeros(); n],
        rest,
        positions,
        triangles,
        panels: vec![panel],
        seams: Vec::new(),
        weld: (0..n as u32).collect(),
        pinned: Vec::new(),
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
    }
}

/// A square of that side in the plane z = 0, n x n cells.
pub(crate) fn sheet(n: usize, side: f64) -> Garment {
    let at = |i: usize| i as f64 / n as f64 * side;
    let rest: Vec<Point2> = (0..=n).flat_map(|j| (0..=n).map(move |i| Point2::new(at(i), at(j)))).collect();
    let space = rest.iter().map(|p| Point3::new(p.x, p.y, 0.0)).collect();
    let cell = |j: usize, i: usize| {
        let a = (j * (n + 1) + i) as u32;
        let (b, c, d) = (a + 1, a + n as u32 + 1, a + n as u32 + 2);
        [[a, b, d], [a, d, c]]
    };
    garment(rest, space, (0..n).flat_map(|j| (0..n).flat_map(move |i| cell(j, i))).collect())
}

/// The sheet rolled into a sphere.
pub(crate) fn ball(n: usize, radius: f64) -> Garment {
    let mut g = sheet(n, 1.0);
    let onto = |p: &Point2| {
        let (a, b) = (p.x * std::f64::consts::TAU, p.y * std::f64::consts::PI);
        Point3::new(b.sin() * a.cos(), b.cos(), b.sin() * a.sin()) * radius
    };
    g.positions = g.rest.iter().map(onto).collect();
    g
}

/// The same cloth moved as a whole.
pub(crate) fn shifted(g: &Garment, by: [f64; 3]) -> Garment {
    let mut g = g.clone();
    g.positions.iter_mut().for_each(|p| *p += Vector3::from(by));
    g
}
