use super::*;
use crate::shapes::{bump, grid, surface};
use nalgebra::Point2;

fn plane(s: &PieceSurface, place: impl Fn(f64, f64) -> [f64; 2]) -> Vec<Point2<f64>> {
    s.positions().iter().map(|p| Point2::from(place(p.x, p.y))).collect()
}

#[test]
fn a_true_piece_has_no_distortion() {
    let s = surface(grid(4, 4, |u, v| [u, v, 0.0]));
    let Ok(d) = distortion(&s, &plane(&s, |x, y| [x, y])) else { unreachable!() };
    assert_eq!((d.flipped, d.crossings), (0, 0));
    let all = [
        d.area_error,
        d.local_area_error,
        d.outline_error,
        d.corner_change,
        d.warp.max,
        d.weft.max,
        d.principal.max,
    ];
    assert!(all.iter().all(|e| e.abs() < 1e-12), "{all:?}");
}

#[test]
fn a_narrow_piece_must_stretch_along_the_weft() {
    // The flat piece is 0.8 wide, so the garment's width of 1 strains the weft by a quarter.
    let s = surface(grid(4, 4, |u, v| [u, v, 0.0]));
    let Ok(d) = distortion(&s, &plane(&s, |x, y| [0.8 * x, y])) else { unreachable!() };
    assert!((d.weft.mean - 0.25).abs() < 1e-12 && (d.weft.p99 - 0.25).abs() < 1e-12);
    assert!(d.warp.max < 1e-12 && (d.principal.signed_mean - 0.25).abs() < 1e-12);
    assert!((d.area_error - 0.2).abs() < 1e-12 && (d.outline_error - 0.1).abs() < 1e-12);
}

#[test]
fn a_sheared_piece_changes_its_corners() {
    let s = surface(grid(4, 4, |u, v| [u, v, 0.0]));
    let Ok(d) = distortion(&s, &plane(&s, |x, y| [x + y, y])) else { unreachable!() };
    assert!((d.corner_change - 45.0).abs() < 1e-9);
    assert!(d.triangles.iter().all(|t| (t.shear.abs() - 45f64.to_radians()).abs() < 1e-9));
}

#[test]
fn flips_and_crossings_are_counted() {
    let s = surface(grid(2, 1, |u, v| [2.0 * u, v, 0.0]));
    // The right edge upside down: the piece is twisted like a bow.
    let mut flat = plane(&s, |x, y| [x, y]);
    flat.swap(2, 5);
    let Ok(d) = distortion(&s, &flat) else { unreachable!() };
    assert_eq!((d.flipped, d.crossings), (1, 1));
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let s = surface(bump(2, 2, 0.1));
    let text = |flat: &[Point2<f64>]| distortion(&s, flat).map_or_else(|e| e.to_string(), |_| String::new());
    assert_eq!(text(&[]), "flat places has 0 entries, but 9 are wanted");
    let nan = vec![Point2::new(f64::NAN, 0.0); 9];
    assert_eq!(text(&nan), "vertex 0 is not at a finite place");
}
