//! Scenes of what sewing does beside plain seams: gathers, darts, pleats, elastic bands, folds,
//! three sheets in one seam, patches.

use super::{cloth, patch};
use crate::fabric::Fabric;
use crate::scene::{Band, Scene, Seam};
use nalgebra::{Vector2, Vector3};

/// Places in the upright plane before the eye, from flat coordinates.
fn upright(rest: &[Vector2<f64>], by: Vector3<f64>) -> Vec<Vector3<f64>> {
    rest.iter().map(|p| Vector3::new(p.x, p.y, 0.0) + by).collect()
}

/// A flat panel `width` by `height`, the origin in the middle of its upper edge.
fn panel(nx: u32, ny: u32, width: f64, height: f64) -> (Vec<Vector2<f64>>, Vec<[u32; 3]>) {
    let (points, triangles) = patch(nx, ny);
    (points.iter().map(|p| Vector2::new((p.x - 0.5) * width, (p.y - 1.0) * height)).collect(), triangles)
}

/// A frill of `nx` by `ny` cells, `ratio` times as wide as the strip of 0.3 m that it is gathered
/// to; the strip is held at its upper edge.
#[must_use]
pub fn gathered(nx: u32, ny: u32, ratio: f64) -> Scene {
    let (strip, strip_cells) = panel(nx, 4, 0.3, 0.06);
    let (frill, frill_cells) = panel(nx, ny, 0.3 * ratio, 0.2);
    let mut scene = Scene::new(format!("gathered_{nx}x{ny}"), cloth());
    let top = scene.add_panel("strip", &strip, &upright(&strip, Vector3::zeros()), &strip_cells).start;
    // Slight waves: a flat sheet under compression has no preferred direction of buckling.
    let wave = |p: &Vector2<f64>| {
        let across = p.x / ratio;
        Vector3::new(across, p.y - 0.08, 0.02 * (across * 70.0).sin())
    };
    let waves: Vec<_> = frill.iter().map(wave).collect();
    let below = scene.add_panel("frill", &frill, &waves, &frill_cells).start;
    let pairs = (0..=nx).map(|i| [top + i, below + ny * (nx + 1) + i]).collect();
    scene.seams = vec![Seam { gather: Some(ratio), ..Seam::new("gathers", pairs) }];
    scene.pinned = (0..=nx).map(|i| top + 4 * (nx + 1) + i).collect();
    scene
}

/// A panel of `2 nx` by `ny` cells, held at its upper edge, with a dart from its lower edge half
/// way up, 0.06 m wide.
#[must_use]
pub fn dart(nx: u32, ny: u32) -> Scene {
    let (width, height, open) = (0.4, 0.4, 0.06);
    let (mut rest, mut triangles) = panel(2 * nx, ny, width, height);
    let (row, tip) = (2 * nx + 1, ny / 2);
    // The legs: the middle column below the tip, once for each side.
    let left = rest.len() as u32;
    let right_of = |j: u32| j * row + nx;
    rest.extend((0..tip).map(|j| rest[right_of(j) as usize]).collect::<Vec<_>>());
    for t in &mut triangles {
        let middle = t.iter().map(|&v| rest[v as usize].x).sum::<f64>();
        if middle < 0.0 {
            t.iter_mut().filter(|v| **v % row == nx && **v < tip * row).for_each(|v| *v = left + *v / row);
        }
    }
    let widen = |v: u32, p: &Vector2<f64>| {
        let y = (1.0 + p.y / height) * f64::from(ny) / f64::from(tip);
        let leftwards = v >= left || p.x < 0.0;
        let half = 0.5 * open * (1.0 - y).max(0.0) * if leftwards { -1.0 } else { 1.0 };
        Vector2::new(p.x + half, p.y)
    };
    let rest: Vec<Vector2<f64>> = rest.iter().enumerate().map(|(v, p)| widen(v as u32, p)).collect();
    let mut scene = Scene::new(format!("dart_{nx}x{ny}"), cloth());
    // Bulged a little: what is quite flat does not know which way to give.
    let bulge = |p: &Vector2<f64>| {
        let (x, y) = (2.0 * p.x / (width + open), p.y / height);
        Vector3::new(p.x, p.y, -0.03 * y * (1.0 - x * x))
    };
    let positions: Vec<_> = rest.iter().map(bulge).collect();
    scene.add_panel("front", &rest, &positions, &triangles);
    scene.seams = vec![Seam::new("dart", (0..tip).map(|j| [left + j, right_of(j)]).collect())];
    scene.pinned = (ny * row..(ny + 1) * row).collect();
    scene
}

/// A panel of `nx` by `ny` cells, folded to a knife pleat of `deep` cells in its middle, whose
/// upper third is sewn down; held at its upper edge beside the pleat.
#[must_use]
pub fn pleat(nx: u32, ny: u32, deep: u32) -> Scene {
    let cell = 0.02;
    let (rest, triangles) = panel(nx, ny, cell * f64::from(nx), 0.3);
    let first = nx / 2 - deep;
    let (back, last) = (first + deep, first + 2 * deep);
    let behind = 0.006;
    let fold = |i: u32| {
        let (i, first, back) = (f64::from(i), f64::from(first), f64::from(back));
        let there = (i - first).clamp(0.0, back - first);
        // Each turn lies a layer behind the one before it.
        let layer = |at: f64| (i - at + 0.5).clamp(0.0, 1.0);
        (cell * (i - 2.0 * there), -behind * (layer(first) + layer(back)))
    };
    let place = |v: u32, p: &Vector2<f64>| {
        let (x, z) = fold(v % (nx + 1));
        Vector3::new(x, p.y, z)
    };
    let positions: Vec<_> = rest.iter().enumerate().map(|(v, p)| place(v as u32, p)).collect();
    let mut scene = Scene::new(format!("pleat_{nx}x{ny}"), cloth());
    scene.add_panel("front", &rest, &positions, &triangles);
    let at = |i: u32, j: u32| j * (nx + 1) + i;
    let pairs = (ny - ny / 3..=ny).map(|j| [at(first, j), at(last, j)]).collect();
    scene.seams = vec![Seam { joined: false, ..Seam::new("pleat", pairs) }];
    scene.pinned = (0..first).chain(last + 1..=nx).map(|i| at(i, ny)).collect();
    scene
}

/// A panel of `nx` by `ny` cells and 0.4 m width, held at its upper edge; its lower edge has an
/// elastic band of `ratio` its length.
#[must_use]
pub fn banded(nx: u32, ny: u32, ratio: f64) -> Scene {
    let (rest, triangles) = panel(nx, ny, 0.4, 0.3);
    let wave = |p: &Vector2<f64>| Vector3::new(p.x, p.y, 0.004 * (p.x * 60.0).sin());
    let positions: Vec<_> = rest.iter().map(wave).collect();
    let mut scene = Scene::new(format!("banded_{nx}x{ny}"), cloth());
    scene.add_panel("front", &rest, &positions, &triangles);
    scene.bands = vec![Band { name: "cuff".into(), vertices: (0..=nx).collect(), ratio, stiffness: 20.0 }];
    scene.pinned = (ny * (nx + 1)..(ny + 1) * (nx + 1)).collect();
    scene
}

/// Two square panels of 0.2 m sewn edge to edge, `n` by `n` cells each, the seam pressed to `angle`
/// (radians) between their outsides; the first is held flat, the second is free.
#[must_use]
pub fn folded(n: u32, angle: f64) -> Scene {
    let (rest, triangles) = panel(n, n, 0.2, 0.2);
    let cloth = Fabric { density: 0.05, bending_warp: 2e-3, bending_weft: 2e-3, ..cloth() };
    let mut scene = Scene::new(format!("folded_{n}"), cloth);
    let held = scene.add_panel("held", &rest, &upright(&rest, Vector3::zeros()), &triangles);
    let below =
        scene.add_panel("free", &rest, &upright(&rest, Vector3::new(0.0, -0.21, 0.0)), &triangles).start;
    let pairs = (0..=n).map(|i| [held.start + i, below + n * (n + 1) + i]).collect();
    scene.seams = vec![Seam { fold: Some(angle), ..Seam::new("fold", pairs) }];
    scene.pinned = held.collect();
    scene
}

/// A strip held at its upper edge, to whose lower edge two panels of 0.3 m by 0.2 m are sewn by one
/// seam each: three sheets at one line.
#[must_use]
pub fn three_sheets(nx: u32, ny: u32) -> Scene {
    let (strip, strip_cells) = panel(nx, 4, 0.3, 0.06);
    let (sheet, sheet_cells) = panel(nx, ny, 0.3, 0.2);
    let mut scene = Scene::new(format!("three_sheets_{nx}x{ny}"), cloth());
    let top = scene.add_panel("strip", &strip, &upright(&strip, Vector3::zeros()), &strip_cells).start;
    for (name, z) in [("outer", 0.02), ("inner", -0.02)] {
        let at = upright(&sheet, Vector3::new(0.0, -0.07, z));
        let first = scene.add_panel(name, &sheet, &at, &sheet_cells).start;
        let pairs = (0..=nx).map(|i| [top + i, first + ny * (nx + 1) + i]).collect();
        scene.seams.push(Seam::new(format!("strip and {name}"), pairs));
    }
    scene.pinned = (0..=nx).map(|i| top + 4 * (nx + 1) + i).collect();
    scene
}

/// A panel of `n` by `n` cells and 0.4 m, held at its upper edge, with a pocket of a quarter of its
/// cells sewn onto it along three sides.
#[must_use]
pub fn pocket(n: u32) -> Scene {
    let (rest, triangles) = panel(n, n, 0.4, 0.4);
    let cells = n / 4;
    let size = 0.4 * f64::from(cells) / f64::from(n);
    let (patch, patch_cells) = panel(cells, cells, size, size);
    let mut scene = Scene::new(format!("pocket_{n}"), cloth());
    let base = scene.add_panel("front", &rest, &upright(&rest, Vector3::zeros()), &triangles).start;
    let (left, low) = (n / 2 - cells / 2, n / 4);
    let at = |i: u32, j: u32| base + (low + j) * (n + 1) + left + i;
    let corner = rest[(at(0, cells) - base) as usize];
    let by = Vector3::new(corner.x + 0.5 * size, corner.y, 0.006);
    let first = scene.add_panel("pocket", &patch, &upright(&patch, by), &patch_cells).start;
    let own = |i: u32, j: u32| first + j * (cells + 1) + i;
    // Down one side, along the bottom, up the other.
    let around = (0..cells)
        .map(|k| (0, cells - k))
        .chain((0..cells).map(|k| (k, 0)))
        .chain((0..=cells).map(|k| (cells, k)));
    scene.seams = vec![Seam::new("pocket", around.map(|(i, j)| [at(i, j), own(i, j)]).collect())];
    scene.pinned = (0..=n).map(|i| base + n * (n + 1) + i).collect();
    scene
}
