//! What a garment is sewn on: its body, drawn in towards its own middle, which then grows to its
//! full size.
//!
//! Pieces of a pattern stand flat before and behind a body: arms and shoulders are between edges
//! that a seam is to bring together. Around a thin figure of the same height and pose nothing is in
//! the way; what is sewn there goes round the limbs that it shall go round, and the figure grows
//! into it.
//!
//! Method: each vertex moves along its normal by a share of the radius of the largest ball inside
//! the body that touches it there (the medial axis, Blum 1967), and down by as much, so that
//! shoulders and arms stand lower, inside their own shape; the ways are smoothed over the mesh.
//! Cost: seven distances a vertex. Limit: the thin figure may cross itself between fingers.

use crate::skin::topology::neighbours;
use rayon::prelude::*;
use toile_cloth::contact::body::Body as Solid;
use toile_core::prelude::*;

/// Radius of the least ball that is looked for, metres.
const LEAST_RADIUS: f64 = 0.0;
/// Radius of the largest ball that is looked for, metres.
const LARGEST_RADIUS: f64 = 0.12;
/// How often the stretch between least and largest radius is halved.
const HALVINGS: usize = 6;

/// The share of its radius that the middle of a ball must be inside the body: bumps count as
/// nothing.
const FITS: f64 = 0.8;

/// The farthest that a vertex moves down, as a radius, metres: a head would go down into a hood's
/// neck.
const LOWEST: f64 = 0.06;

/// Rounds in which ways are smoothed over the mesh.
const SMOOTHING: usize = 40;

/// The share of the radius by which the figure is thinner at first.
const THINNER: f64 = 0.6;
/// Steps in which the figure grows to its full size.
const STEPS: usize = 8;

/// What the garment is sewn on, one after the other, before the body itself comes: points, of the
/// same triangles as the body's.
pub fn grown(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<Vec<Point3>> {
    let ways = inwards(positions, triangles);
    let of = |k: usize| {
        let by = THINNER * k as f64 / STEPS as f64;
        positions.iter().zip(&ways).map(|(p, w)| p + w * by).collect()
    };
    (1..=STEPS).rev().map(of).collect()
}

/// The way from each vertex to the middle of its ball, smoothed.
fn inwards(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<Vector3> {
    let solid = Solid::new(positions.iter().map(|p| p.coords).collect(), triangles);
    let normals = normals(positions, triangles);
    let mut ways: Vec<Vector3> =
        positions.par_iter().zip(&normals).map(|(p, n)| way(ball(&solid, p, n), n)).collect();
    let beside = neighbours(positions.len(), triangles);
    for _ in 0..SMOOTHING {
        ways = (0..ways.len())
            .into_par_iter()
            .map(|v| {
                let around = &beside[v];
                let sum: Vector3 = around.iter().map(|w| ways[*w as usize]).sum();
                if around.is_empty() { ways[v] } else { 0.5 * ways[v] + 0.5 * sum / around.len() as f64 }
            })
            .collect();
    }
    ways
}

/// The way of a vertex with such a normal, whose ball has such a radius.
fn way(radius: f64, n: &Vector3) -> Vector3 {
    -n * radius - Vector3::y() * radius.min(LOWEST)
}

/// The radius of the largest ball inside the body that touches it about at `p`, where its normal is
/// `n`.
fn ball(solid: &Solid, p: &Point3, n: &Vector3) -> f64 {
    let (mut least, mut most) = (LEAST_RADIUS, LARGEST_RADIUS);
    let fits = |radius: f64| {
        solid
            .nearest(&(p.coords - n * radius), f64::INFINITY)
            .is_some_and(|near| -near.distance > FITS * radius)
    };
    if fits(most) {
        return most;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (least + most);
        if fits(middle) { least = middle } else { most = middle }
    }
    least
}

fn normals(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<Vector3> {
    let mut normals = vec![Vector3::zeros(); positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|v| positions[v as usize]);
        let n = (b - a).cross(&(c - a));
        t.iter().for_each(|&v| normals[v as usize] += n);
    }
    normals.iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vector3::zeros)).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn mannequin() -> Body {
        let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
        crate::tests::mannequin(lengths).unwrap()
    }

    fn volume(body: &Body, positions: &[Point3]) -> f64 {
        Body { positions: positions.to_vec(), ..body.clone() }.volume()
    }

    #[test]
    fn the_ball_of_a_round_limb_has_its_radius_whatever_its_bumps() {
        let ring = |k: usize, bump: f64| {
            let (turn, row) = ((k % 24) as f64 * std::f64::consts::TAU / 24.0, k / 24);
            let radius = 0.05 + if k.is_multiple_of(7) { bump } else { 0.0 };
            Point3::new(radius * turn.cos(), 0.01 * row as f64, radius * turn.sin())
        };
        let side = |k: u32| {
            let next = k / 24 * 24 + (k + 1) % 24;
            [[k, k + 24, next], [next, k + 24, next + 24]]
        };
        let triangles: Vec<[u32; 3]> = (0..24 * 39).flat_map(side).collect();
        for bump in [0.0, 1e-3] {
            let points: Vec<Point3> = (0..24 * 40).map(|k| ring(k, bump)).collect();
            let solid = Solid::new(points.iter().map(|p| p.coords).collect(), &triangles);
            let p = points[24 * 20 + 3];
            let found = ball(&solid, &p, &Vector3::new(p.x, 0.0, p.z).normalize());
            assert!((found / 0.05 - 1.0).abs() < 0.15, "{found}");
        }
    }

    #[test]
    fn a_mannequin_is_thin_at_first_and_grows_to_its_size_without_leaving_it() {
        let body = mannequin();
        let steps = grown(&body.positions, &body.triangles);
        assert_eq!(steps.len(), STEPS);
        let volumes: Vec<f64> = steps.iter().map(|s| volume(&body, s) / body.volume()).collect();
        assert!((0.1..0.5).contains(&volumes[0]), "{volumes:?}");
        assert!(volumes.windows(2).all(|v| v[0] < v[1]) && *volumes.last().unwrap() < 0.95, "{volumes:?}");
        // Shoulders stand lower, arms inside their own shape: hardly a vertex leaves the body.
        let solid = Solid::new(body.positions.iter().map(|p| p.coords).collect(), &body.triangles);
        let out =
            steps[0].iter().filter(|p| solid.nearest(&p.coords, f64::INFINITY).unwrap().distance > 5e-3);
        let share = out.count() as f64 / steps[0].len() as f64;
        assert!(share < 0.1, "{share}");
        let shoulder = body.landmarks["shoulder_left"];
        let top = |points: &[Point3]| {
            let near = |p: &&Point3| (p.x - shoulder.x).abs() < 0.02;
            points.iter().filter(near).map(|p| p.y).fold(0.0, f64::max)
        };
        assert!(top(&body.positions) - top(&steps[0]) > 0.03);
    }

    #[test]
    fn no_step_of_growing_is_longer_than_cloth_is_sought_in() {
        let body = mannequin();
        let steps = grown(&body.positions, &body.triangles);
        let ends = steps.iter().skip(1).chain([&body.positions]);
        for (from, to) in steps.iter().zip(ends) {
            let way = from.iter().zip(to).map(|(a, b)| (b - a).norm()).fold(0.0, f64::max);
            assert!(way < 0.02, "{way}");
        }
    }
}
