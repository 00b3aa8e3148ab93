//! Scenes of what is worn: a sleeve around an arm, a skirt over a skirt.

use super::{cloth, lathe, patch, ring, tube};
use crate::scene::{Scene, SceneBody, Seam};
use nalgebra::{Rotation3, Vector2, Vector3};

/// Length of an arm from shoulder to hand, m.
const ARM: f64 = 0.60;

/// Radius of an arm at the hand and at the shoulder, m.
const ARM_RADII: [f64; 2] = [0.032, 0.056];

/// An arm that hangs down at 60 degrees from the vertical, and two panels of `nx` by `ny` cells 0.1
/// m above and below it, to be sewn at their long sides into a sleeve. Three vertices above the
/// shoulder are held, as the rest of a shirt would.
#[must_use]
pub fn sleeve(nx: u32, ny: u32) -> Scene {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 60.0_f64.to_radians());
    let (length, cuff, head, apart) = (0.42, 0.14, 0.20, 0.1);
    let (points, triangles) = patch(nx, ny);
    let rest: Vec<Vector2<f64>> = points
        .iter()
        .map(|p| Vector2::new((p.x - 0.5) * (cuff + (head - cuff) * p.y), p.y * length))
        .collect();
    let place = |side: f64| {
        let at = |p: &Vector2<f64>| turn * Vector3::new(side * apart, p.y - length, -side * p.x);
        rest.iter().map(at).collect::<Vec<_>>()
    };
    let mut scene = Scene::new(format!("sleeve_{nx}x{ny}"), cloth());
    let upper = scene.add_panel("upper", &rest, &place(1.0), &triangles).start;
    let lower = scene.add_panel("lower", &rest, &place(-1.0), &triangles).start;
    let column = |first: u32, i: u32| (0..=ny).map(move |j| first + j * (nx + 1) + i);
    let sew = |name: &str, a: u32, b: u32| {
        Seam::new(name, column(upper, a).zip(column(lower, b)).map(|(a, b)| [a, b]).collect())
    };
    scene.seams = vec![sew("front", 0, nx), sew("back", nx, 0)];
    let (vertices, faces) = arm(48, 60);
    scene.body = Some(SceneBody::new(vertices.iter().map(|p| turn * p).collect(), faces, 0.4));
    let middle = upper + ny * (nx + 1) + nx / 2;
    scene.pinned = vec![middle - 1, middle, middle + 1];
    // Held where the sleeve's head lies on the shoulder.
    for (k, &v) in scene.pinned.iter().enumerate() {
        let across = (k as f64 - 1.0) * head / f64::from(nx);
        scene.positions[v as usize] = turn * Vector3::new(ARM_RADII[1] + 0.004, 0.0, -across);
    }
    scene
}

/// An arm along y from the hand to the shoulder at the origin, where it goes on a little.
fn arm(around: u32, rings: u32) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let (low, high) = (-ARM, 0.1);
    let row = |k: u32| {
        let share = f64::from(k) / f64::from(rings - 1);
        let y = low + (high - low) * share;
        // An elbow, so that the arm is curved along as well.
        let radius = ARM_RADII[0]
            + (ARM_RADII[1] - ARM_RADII[0]) * share
            + 0.006 * (-((y + 0.3) / 0.06_f64).powi(2)).exp();
        ring(radius, radius, y, around)
    };
    let rows: Vec<_> = (0..rings).map(row).collect();
    lathe(&rows, Vector3::new(0.0, low - 0.02, 0.0), Vector3::new(0.0, high + 0.02, 0.0))
}

/// The skirt of [`tube`], and over it a wider and shorter one of other cells, of layer 1.
#[must_use]
pub fn layered(nx: u32, ny: u32) -> Scene {
    let (mut scene, over) = (tube(nx, ny), tube(nx - 1, ny - 2));
    let (wider, shorter) = (1.15, 0.8);
    let first = scene.rest.len() as u32;
    for panel in &over.panels {
        let rest: Vec<Vector2<f64>> = over.rest[panel.vertices.clone()]
            .iter()
            .map(|p| Vector2::new(p.x * wider, p.y * shorter))
            .collect();
        // Its waist at the height of the other's, its panels farther out.
        let waist = scene.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let out = |p: &Vector3<f64>| Vector3::new(p.x * wider, waist + (p.y - waist) * shorter, p.z * 1.4);
        let positions: Vec<_> = over.positions[panel.vertices.clone()].iter().map(out).collect();
        let own = panel.vertices.start as u32;
        let triangles: Vec<_> =
            over.triangles[panel.triangles.clone()].iter().map(|t| t.map(|v| v - own)).collect();
        scene.add_panel(format!("over_{}", panel.name), &rest, &positions, &triangles);
        scene.panels.last_mut().into_iter().for_each(|p| p.layer = 1);
    }
    let sewn = |s: &Seam| {
        Seam::new(format!("over_{}", s.name), s.pairs.iter().map(|p| p.map(|v| v + first)).collect())
    };
    scene.seams.extend(over.seams.iter().map(sewn));
    scene.name = format!("layered_{nx}x{ny}");
    scene
}
