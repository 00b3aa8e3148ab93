#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::locate::corners;
use super::*;
use crate::scene::generate;

fn area(p: &Pieces) -> f64 {
    p.triangles.iter().map(|t| corners(p, t)).map(|[a, b, c]| 0.5 * (b - a).perp(&(c - a))).sum()
}

#[test]
fn levels_shrink_and_keep_the_area_and_the_seams() {
    for scene in [generate::hang(33), generate::tube(22, 25)] {
        let mut fine = Pieces::new(&scene);
        let whole = area(&fine);
        let mut sizes = vec![fine.points];
        while let Some(coarser) = coarsen(&fine) {
            let p = &coarser.pieces;
            assert!((area(p) - whole).abs() < 1e-9);
            assert_eq!(p.pinned.iter().filter(|b| **b).count(), scene.pinned.len());
            let worst = p.triangles.iter().map(|t| signed_quality(&corners(p, t))).fold(1.0, f64::min);
            assert!(worst > 0.2, "{worst}");
            let flat: Vec<Vector3<f64>> = p.rest.iter().map(|r| Vector3::new(r.x, r.y, 0.0)).collect();
            for (back, r) in coarser.prolong(&flat).iter().zip(&fine.rest) {
                assert!((back.xy() - r).norm() < 1e-9);
            }
            sizes.push(p.points);
            fine = coarser.pieces;
            if fine.points < 60 {
                break;
            }
        }
        assert!(sizes.len() > 2 && sizes[1] * 2 < sizes[0], "{sizes:?}");
        let cloth = generate::cloth();
        fine.sewn_sheet(&[&cloth; 3]).unwrap();
    }
}

#[test]
fn levels_of_narrow_panels_that_are_sewn_to_each_other_stay_surfaces() {
    let cloth = generate::cloth();
    for (nx, ny) in (2..7).flat_map(|nx| (8..30).step_by(3).map(move |ny| (nx, ny))) {
        let mut fine = Pieces::new(&generate::sleeve(nx, ny));
        while let Some(coarser) = coarsen(&fine) {
            fine = coarser.pieces;
            fine.sewn_sheet(&[&cloth; 3]).unwrap();
        }
    }
}
