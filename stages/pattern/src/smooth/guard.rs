//! What a smoother must not break: triangles, outline, lengths.
//!
//! Method: vertices move all at once; those of triangles that would turn over or lose their angle
//! go back, and again, until none does. Outline vertices move along the outline's normal only,
//! within a share of the outline's tolerance, and each stretch's moves are scaled back until its
//! length survives.

use super::topology::{Stretch, Topology};
use nalgebra::Matrix2;
use toile_core::artifact::{CHORD_TOLERANCE, Panel, Point2, Vector2, polyline_length};
use toile_core::{Context, StageError};

/// A triangle's least angle may fall, but not below this (degrees) unless it was there before.
const ANGLE_FLOOR: f64 = 20.0;

/// An outline vertex may leave its place by this share of its sides. The mesher's chords use half
/// of the outline's tolerance; this is less than the other half.
const OUTLINE_REACH: f64 = 0.4 * CHORD_TOLERANCE;

/// The length of every stretch of the outline changes by at most this share, half of what is
/// promised for named edges.
const LENGTH_TOLERANCE: f64 = 5e-4;

/// Positions of smoothed vertices after one step, before they are checked.
pub(crate) trait Step {
    /// The displacement of an inner vertex.
    fn inner(&self, topology: &Topology, points: &[Point2], v: usize) -> Vector2;
    /// How far the `k`-th vertex of a stretch moves along the normal (to the right of the
    /// stretch's direction, which is outward), metres.
    fn outline(&self, stretch: &Stretch, points: &[Point2], k: usize) -> f64;
}

/// Runs the steps over a panel, round after round.
pub(crate) fn smooth(
    panel: &Panel,
    rounds: usize,
    steps: &[&dyn Step],
    cx: &Context,
) -> Result<Panel, StageError> {
    let topology = Topology::new(panel);
    let mut points = panel.positions.clone();
    for round in 0..rounds {
        cx.check()?;
        cx.progress(round as f64 / rounds as f64, format!("round {} of {rounds}", round + 1));
        for step in steps {
            let wanted = take_step(*step, panel, &topology, &points);
            points = step_back(&panel.triangles, &points, wanted);
        }
    }
    let smoothed = moved(panel, points);
    let moves = smoothed.positions.iter().zip(&panel.positions).map(|(a, b)| (a - b).norm());
    cx.figure("largest_move", moves.fold(0.0, f64::max) * 1e3, "mm");
    cx.figure("least_angle", smoothed.least_angle(), "deg");
    Ok(smoothed)
}

fn take_step(step: &dyn Step, panel: &Panel, topology: &Topology, points: &[Point2]) -> Vec<Point2> {
    let mut wanted = points.to_vec();
    for v in (0..points.len()).filter(|&v| topology.inner[v]) {
        wanted[v] += step.inner(topology, points, v);
    }
    for stretch in &topology.stretches {
        let displaced = outline_step(step, panel, stretch, points);
        for (k, p) in displaced {
            wanted[stretch.vertices[k] as usize] = p;
        }
    }
    wanted
}

/// The new places of a stretch's vertices but its pinned ends.
fn outline_step(
    step: &dyn Step,
    panel: &Panel,
    stretch: &Stretch,
    points: &[Point2],
) -> Vec<(usize, Point2)> {
    let n = stretch.vertices.len();
    let range = if stretch.closed { 0..n } else { 1..n.saturating_sub(1) };
    let place = |k: usize| {
        let v = stretch.vertices[k] as usize;
        let home = panel.positions[v];
        let (a, b) = (stretch.at(k, -1), stretch.at(k, 1));
        let (Some(a), Some(b)) = (a, b) else { return (k, home) };
        let (a, b) = (panel.positions[a as usize], panel.positions[b as usize]);
        let along = b - a;
        let normal = Vector2::new(along.y, -along.x).try_normalize(0.0).unwrap_or_else(Vector2::zeros);
        let reach = OUTLINE_REACH * (a - home).norm().min((b - home).norm());
        let so_far = (points[v] - home).dot(&normal);
        (k, home + normal * (so_far + step.outline(stretch, points, k)).clamp(-reach, reach))
    };
    scaled_to_length(panel, stretch, range.map(place).collect())
}

/// Draws the places back towards home until the stretch has kept its length.
fn scaled_to_length(panel: &Panel, stretch: &Stretch, places: Vec<(usize, Point2)>) -> Vec<(usize, Point2)> {
    let home = |k: usize| panel.positions[stretch.vertices[k] as usize];
    let length = |share: f64| {
        let mut line: Vec<Point2> = (0..stretch.vertices.len()).map(home).collect();
        places.iter().for_each(|&(k, p)| line[k] += (p - home(k)) * share);
        if stretch.closed {
            line.push(line[0]);
        }
        polyline_length(&line)
    };
    let goal = length(0.0);
    let mut share = 1.0;
    while (length(share) - goal).abs() > LENGTH_TOLERANCE * goal && share > 1e-3 {
        share *= 0.5;
    }
    let share = if share > 1e-3 { share } else { 0.0 };
    places.iter().map(|&(k, p)| (k, home(k) + (p - home(k)) * share)).collect()
}

/// The smoothed positions, but the old ones around triangles that would become worse.
fn step_back(triangles: &[[u32; 3]], old: &[Point2], mut wanted: Vec<Point2>) -> Vec<Point2> {
    let floor = ANGLE_FLOOR.to_radians();
    let before: Vec<f64> = triangles.iter().map(|t| angle(old, t).min(floor)).collect();
    let mut todo: Vec<usize> = (0..triangles.len()).collect();
    while !todo.is_empty() {
        let mut back = Vec::new();
        for &t in &todo {
            let moved = triangles[t].iter().any(|&v| wanted[v as usize] != old[v as usize]);
            if moved && angle(&wanted, &triangles[t]) < before[t] {
                back.extend(triangles[t]);
            }
        }
        back.iter().for_each(|&v: &u32| wanted[v as usize] = old[v as usize]);
        todo = match back.is_empty() {
            true => Vec::new(),
            false => (0..triangles.len()).collect(),
        };
    }
    wanted
}

fn angle(points: &[Point2], t: &[u32; 3]) -> f64 {
    let [a, b, c] = t.map(|v| points[v as usize]);
    crate::mesh::least_angle(a, b, c)
}

/// The panel with its vertices moved; the photo goes with them.
fn moved(panel: &Panel, points: Vec<Point2>) -> Panel {
    let mut photo_px = panel.photo_px.clone();
    if photo_px.len() == points.len() {
        let to_px = photo_map(panel);
        for ((px, new), old) in photo_px.iter_mut().zip(&points).zip(&panel.positions) {
            *px += to_px * (new - old);
        }
    }
    Panel { positions: points, photo_px, ..panel.clone() }
}

/// A panel whose axes are those of its photo, to this share, is moved along them exactly.
const STRAIGHT: f64 = 1e-9;

/// How a way on the panel becomes one in the photo, pixels per metre: the least-squares map of all
/// vertices, since a panel may lie turned.
fn photo_map(panel: &Panel) -> Matrix2<f64> {
    let mean = |points: &[Point2]| points.iter().map(|p| p.coords).sum::<Vector2>() / points.len() as f64;
    let (flat, px) = (mean(&panel.positions), mean(&panel.photo_px));
    let (mut spread, mut both) = (Matrix2::zeros(), Matrix2::zeros());
    for (p, q) in panel.positions.iter().zip(&panel.photo_px) {
        let (p, q) = (p.coords - flat, q.coords - px);
        spread += p * p.transpose();
        both += q * p.transpose();
    }
    match spread.try_inverse().map(|i| both * i) {
        Some(m) if m[(0, 1)].abs().max(m[(1, 0)].abs()) > STRAIGHT * m.norm() => m,
        _ => Matrix2::from_diagonal(&photo_scale(panel)),
    }
}

/// Pixels per metre along x and y, with sign, from the two vertices farthest apart in each.
fn photo_scale(panel: &Panel) -> Vector2 {
    let along = |axis: usize| {
        let by = |a: &usize, b: &usize| panel.positions[*a][axis].total_cmp(&panel.positions[*b][axis]);
        let (low, high) = ((0..panel.positions.len()).min_by(by), (0..panel.positions.len()).max_by(by));
        let (Some(low), Some(high)) = (low, high) else { return 0.0 };
        let size = panel.positions[high][axis] - panel.positions[low][axis];
        if size > 0.0 { (panel.photo_px[high][axis] - panel.photo_px[low][axis]) / size } else { 0.0 }
    };
    Vector2::new(along(0), along(1))
}
