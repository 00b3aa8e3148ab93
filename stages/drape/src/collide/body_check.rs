//! Whether a mesh can be a body: inside and outside must be told apart everywhere.
//!
//! Finite vertices, triangles with area, every edge shared by exactly two triangles that run
//! through it in opposite directions, every piece facing outwards. Each fault is reported with its
//! count, edges with the place of the first. O(n log n).

use toile_core::artifact::{Body, Point3};
use toile_core::{ErrorCode, StageError};
use toile_geometry::components::{groups, links};
use toile_geometry::obj::is_flat;

/// Errs with the first kind of fault and how often it occurs.
pub fn check_body(body: &Body) -> Result<(), StageError> {
    check_numbers(body)?;
    check_triangles(body)?;
    check_closed(body)?;
    check_outward(body)
}

fn check_numbers(body: &Body) -> Result<(), StageError> {
    let finite = |p: &&Point3| p.iter().all(|x| x.is_finite());
    let bad = body.positions.len() - body.positions.iter().filter(finite).count();
    match bad {
        0 => Ok(()),
        _ => Err(StageError::invalid(format!("the body has {} not finite", vertices_that_are(bad)))
            .hint("the file is damaged, or a size of the body is zero")),
    }
}

fn check_triangles(body: &Body) -> Result<(), StageError> {
    if body.triangles.is_empty() {
        return Err(StageError::invalid("the body has no triangles").hint("give a closed triangle mesh"));
    }
    let missing = |t: &&[u32; 3]| t.iter().any(|&i| i as usize >= body.positions.len());
    let bad = body.triangles.iter().filter(missing).count();
    if bad > 0 {
        let text = format!("the body has {} of vertices that do not exist", triangles(bad));
        return Err(StageError::invalid(text).hint("the file is damaged"));
    }
    match body.triangles.iter().filter(|t| is_flat(t.map(|i| body.positions[i as usize].coords))).count() {
        0 => Ok(()),
        bad => Err(StageError::new(
            ErrorCode::DegenerateTriangles,
            format!("the body has {} without area", triangles(bad)),
        )
        .hint("merge vertices that lie on each other and remove what collapses")),
    }
}

/// The directed edges of the triangles, each as (lower, higher, runs downwards, triangle), sorted.
fn edges(body: &Body) -> Vec<(u32, u32, bool, u32)> {
    let directed = |(t, nodes): (usize, &[u32; 3])| {
        let nodes = *nodes;
        (0..3).map(move |k| {
            let (i, j) = (nodes[k], nodes[(k + 1) % 3]);
            (i.min(j), i.max(j), i > j, t as u32)
        })
    };
    let mut edges: Vec<_> = body.triangles.iter().enumerate().flat_map(directed).collect();
    edges.sort_unstable();
    edges
}

fn check_closed(body: &Body) -> Result<(), StageError> {
    let edges = edges(body);
    let (mut open, mut crowded, mut turned) = (0, 0, 0);
    let mut first = None;
    for uses in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        match uses {
            [_] => open += 1,
            [a, b] if a.2 != b.2 => continue,
            [_, _] => turned += 1,
            _ => crowded += 1,
        }
        first = first.or(Some([uses[0].0, uses[0].1]));
    }
    let mut faults = Vec::new();
    let mut tell = |n: usize, one: &str, many: &str| match n {
        0 => {}
        1 => faults.push(format!("1 {one}")),
        n => faults.push(format!("{n} {many}")),
    };
    tell(open, "boundary edge", "boundary edges");
    tell(crowded, "edge with more than two triangles", "edges with more than two triangles");
    tell(turned, "edge whose triangles face opposite ways", "edges whose triangles face opposite ways");
    let Some([a, b]) = first else { return Ok(()) };
    let end = |v: u32| {
        let p = body.positions[v as usize];
        format!("({:.3}, {:.3}, {:.3})", p.x, p.y, p.z)
    };
    let text = format!(
        "the body is not closed: it has {}, the first from {} to {} m",
        faults.join(", "),
        end(a),
        end(b)
    );
    Err(StageError::invalid(text)
        .hint("merge vertices that lie on each other, fill the holes and turn all triangles outwards"))
}

fn check_outward(body: &Body) -> Result<(), StageError> {
    let volumes = piece_volumes(body);
    match volumes.iter().filter(|v| **v <= 0.0).count() {
        0 => Ok(()),
        _ if volumes.len() == 1 => {
            Err(StageError::invalid("the body is inside out: its triangles face inwards").hint(TURN))
        }
        n => {
            let text = format!("the body is inside out: {n} of its {} pieces face inwards", volumes.len());
            Err(StageError::invalid(text).hint(TURN))
        }
    }
}

const TURN: &str = "list each triangle's corners counter-clockwise as seen from outside";

/// The enclosed volume of each connected piece, seen from its first corner so that a body far from
/// the origin keeps its digits.
fn piece_volumes(body: &Body) -> Vec<f64> {
    let (piece, count) = groups(body.positions.len(), links(&body.triangles));
    let mut volumes = vec![0.0; count];
    let mut origins: Vec<Option<Point3>> = vec![None; volumes.len()];
    for t in &body.triangles {
        let k = piece[t[0] as usize] as usize;
        let corners = t.map(|i| body.positions[i as usize]);
        let origin = *origins[k].get_or_insert(corners[0]);
        let [a, b, c] = corners.map(|p| p - origin);
        volumes[k] += a.dot(&b.cross(&c)) / 6.0;
    }
    // A vertex of no triangle is no piece.
    volumes.into_iter().zip(origins).filter_map(|(v, origin)| origin.map(|_| v)).collect()
}

fn triangles(n: usize) -> String {
    if n == 1 { "1 triangle".into() } else { format!("{n} triangles") }
}

fn vertices_that_are(n: usize) -> String {
    if n == 1 { "1 vertex that is".into() } else { format!("{n} vertices that are") }
}

#[cfg(test)]
mod tests;
