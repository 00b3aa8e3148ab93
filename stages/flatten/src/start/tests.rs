use super::*;
use crate::shapes::{bump, cone, cylinder, grid, surface};

fn ready(mesh: crate::shapes::PlainMesh) -> (PieceSurface, PieceSystem, TriangleFrames) {
    let s = surface(mesh);
    let (system, frames) = (PieceSystem::new(&s, &[]), TriangleFrames::new(&s));
    (s, system, frames)
}

#[test]
fn a_flat_panel_starts_from_its_projection_and_a_tube_from_conformal_maps() {
    let (s, system, frames) = ready(bump(8, 8, 0.3));
    assert_eq!(start(&s, &system, &frames).map(|r| r.1), Ok(StartMethod::Projection));
    let (s, system, frames) = ready(grid(40, 8, |u, v| {
        let a = 6.0 * (0.5 - u);
        [-a.sin(), v, a.cos()]
    }));
    assert_eq!(start(&s, &system, &frames).map(|r| r.1), Ok(StartMethod::Lscm));
}

#[test]
fn conformal_maps_keep_a_developable_surface_exact() {
    let (s, system, frames) = ready(cylinder(12, 8));
    let flat = lscm_map(&s, &system, &frames).map(|q| with_true_area(&system, q)).unwrap_or_default();
    for (t, &c) in s.triangles().iter().enumerate() {
        let j = frames.map(t, corners(&flat, c));
        assert!((j.transpose() * j - nalgebra::Matrix2::identity()).amax() < 1e-2);
    }
}

#[test]
fn the_embedding_flips_nothing_even_on_a_tube_and_with_holes() {
    let tube = grid(16, 30, |u, v| {
        let a = std::f64::consts::TAU * u;
        [-a.sin(), 9.0 * v, a.cos()]
    });
    let weld = |v: u32| v / 17 * 17 + v % 17 % 16;
    let tube = (tube.0, tube.1.iter().map(|t| t.map(weld)).collect());
    let (mut holes, mut kept) = bump(12, 12, 2.0);
    kept.retain(|t| !t.contains(&30) && !t.contains(&100));
    holes[50].z += 0.5;
    for mesh in [tube, (holes, kept), cone(5, 12, 4.0)] {
        let (s, system, frames) = ready(mesh);
        let flat = tutte(&s, &frames).unwrap_or_default();
        assert!(flipped(system.triangles(), &flat).is_empty());
    }
}

#[test]
fn neighbours_lay_out_a_developable_surface_exactly() {
    let (s, system, frames) = ready(cylinder(12, 8));
    let flat = frames.scaled(&neighbour_layout(&s));
    for (t, &c) in system.triangles().iter().enumerate() {
        let j = frames.map(t, corners(&flat, c));
        assert!((j.transpose() * j - nalgebra::Matrix2::identity()).amax() < 1e-9);
    }
}
