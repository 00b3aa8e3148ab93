#![allow(clippy::unwrap_used)]
use super::*;
use crate::scene::{Scene, Seam, generate};
use nalgebra::{Vector2, Vector3};

/// Two panels of one shape, sewn along two sides of an ear.
fn ears() -> Scene {
    let rest = [[0.0, 0.0], [0.5, -0.1], [1.0, 0.0], [0.5, 1.0]].map(|[x, y]| Vector2::new(x, y));
    let mut scene = Scene::new("ears", generate::cloth());
    for z in [0.0, 0.1] {
        let at = rest.map(|p| Vector3::new(p.x, p.y, z));
        scene.add_panel(format!("at {z}"), &rest, &at, &[[0, 1, 2], [0, 2, 3]]);
    }
    scene.seams = vec![Seam::new("side", vec![[0, 6], [1, 5], [2, 4]])];
    scene
}

#[test]
fn ears_of_two_panels_at_a_seam_are_parted_by_a_flip_in_one_of_them() {
    let (scene, cloth) = (ears(), generate::cloth());
    let cloths = [&cloth; 3];
    let mut pieces = Pieces::new(&scene);
    let parted = pieces.triangles.clone();
    assert_eq!(parted.iter().zip(&scene.triangles).filter(|(a, b)| a != b).count(), 2);
    assert!(parted.iter().all(|t| signed_quality(&t.map(|v| pieces.rest[v as usize])) > 0.1));
    let area = |p: &Pieces| p.sewn_sheet(&cloths).map(|s| s.areas().iter().sum::<f64>());
    assert!((area(&pieces).unwrap() - 1.1).abs() < 1e-12);
    pieces.triangles.clone_from(&scene.triangles);
    pieces.part_ears(&scene.seams);
    assert_eq!(pieces.triangles, parted);
}
