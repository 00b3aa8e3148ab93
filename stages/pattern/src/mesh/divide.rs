//! Divides an outline and its inner lines into the segments that every mesh must contain.
//!
//! Method: each named edge is cut into `gauge.divisions(h)` parts of equal arc length, which is the
//! contract by which two edges that are sewn together get equal vertex counts. A stretch without a
//! name (an outline that no style has named, a hole) runs from corner to corner, or all the way
//! round, and is cut ever finer until its chords stay within half of [`CHORD_TOLERANCE`]. Corners
//! inside a stretch and the feet of inner lines are kept as vertices: the division nearest to each
//! slides onto it, so that the count stays. Cost: linear in the points of the outline, times the
//! number of inner lines' ends. Limits: the count of a named edge is never changed, so an outline
//! rougher than its gauge says leaves the tolerance; [`Division::deviation`] says by how much.

use super::check::show;
use super::crossing::first_crossing;
use super::layout::{Layout, Line, SNAP, Stretch};
use super::polyline::{even, fine_enough, finer, place};
use toile_core::StageError;
use toile_core::prelude::*;

/// The segments that a mesh of an outline must contain.
#[derive(Debug, Clone, Default)]
pub(crate) struct Division {
    /// Vertices on the outline, then those on inner lines alone.
    pub points: Vec<Point2>,
    /// The outer loop, then the holes.
    pub loops: Vec<Vec<u32>>,
    /// Named edges as chains.
    pub edges: Vec<PanelEdge>,
    /// Inner lines as chains.
    pub chains: Vec<InnerChain>,
    /// The farthest that a chord leaves the true outline, metres.
    pub deviation: f64,
    /// The edge (or `the outline`) where it does.
    pub deviates: String,
    /// The first vertices of the stretches, ascending, and whether each has no name.
    pub stretches: Vec<(u32, bool)>,
}

impl Division {
    /// Segments of the loops.
    pub(crate) fn loop_segments(&self) -> Vec<[u32; 2]> {
        let closed = |l: &Vec<u32>| {
            let n = l.len();
            (0..n).map(|k| [l[k], l[(k + 1) % n]]).collect::<Vec<_>>()
        };
        self.loops.iter().flat_map(closed).collect()
    }

    /// Segments of the inner lines.
    pub(crate) fn chain_segments(&self) -> Vec<[u32; 2]> {
        self.chains.iter().flat_map(|c| c.vertices.windows(2).map(|w| [w[0], w[1]])).collect()
    }

    /// Segments of loops and inner lines.
    pub(crate) fn segments(&self) -> Vec<[u32; 2]> {
        [self.loop_segments(), self.chain_segments()].concat()
    }
}

/// Into what parts every stretch and inner line is cut: ascending shares of its length in any unit,
/// from 0, both ends included.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cuts {
    /// For each stretch, loop by loop.
    pub stretches: Vec<Vec<f64>>,
    /// For each inner line.
    pub lines: Vec<Vec<f64>>,
}

impl Cuts {
    /// Equal parts for a target edge length `h` (metres): as many as its gauge says on a named
    /// edge, else as many as keep the chords true.
    pub(crate) fn even(layout: &Layout<'_>, h: f64) -> Result<Self, StageError> {
        let own: Vec<usize> = layout
            .lines
            .iter()
            .map(|l| match l.inner.gauge {
                Some(gauge) => gauge.divisions(h).max(1 + l.marks.len()),
                None => fine_enough(&l.path, &l.marks, 1 + l.marks.len(), h),
            })
            .collect();
        // The two legs of a dart end on one point and are sewn to each other, so they get the count
        // of the longer.
        let count = |i: usize| layout.legs(i).into_iter().map(|j| own[j]).fold(own[i], usize::max);
        Ok(Cuts {
            stretches: layout
                .stretches()
                .map(|s| Ok(even(parts(s, h)?)))
                .collect::<Result<_, StageError>>()?,
            lines: (0..own.len()).map(|i| even(count(i))).collect(),
        })
    }

    /// Every part of the k-th stretch cut into `times[k]`, if it has no name; the counts of named
    /// edges are agreed upon.
    pub(crate) fn finer(&self, layout: &Layout<'_>, times: &[usize]) -> Self {
        let stretches = self.stretches.iter().zip(layout.stretches()).zip(times);
        let cut = |((shares, s), &times): ((&Vec<f64>, &Stretch<'_>), &usize)| match s.name {
            None => finer(shares, times),
            Some(_) => shares.clone(),
        };
        Cuts { stretches: stretches.map(cut).collect(), lines: self.lines.clone() }
    }
}

/// How many parts a stretch gets.
fn parts(s: &Stretch<'_>, h: f64) -> Result<usize, StageError> {
    let n = match s.gauge {
        Some(gauge) => gauge.divisions(h),
        None => fine_enough(&s.line, &s.marks, s.least(), h),
    };
    if n < s.marks.len() + 1 {
        let name = s.name.unwrap_or("outline");
        return Err(StageError::invalid(format!(
            "edge \"{name}\" is divided into {n} at an edge of {}, too few for its corners and inner lines",
            show(h)
        ))
        .hint("use a smaller edge")
        .at("edge"));
    }
    Ok(n)
}

/// Divides an outline as the cuts say; `h` is the edge length that a fault names, metres.
pub(crate) fn divide(layout: &Layout<'_>, cuts: &Cuts, h: f64) -> Result<Division, StageError> {
    let mut division = Division { deviates: "the outline".into(), ..Division::default() };
    let mut shares = cuts.stretches.iter();
    for stretches in &layout.loops {
        add_loop(&mut division, stretches, shares.by_ref());
    }
    for (line, shares) in layout.lines.iter().zip(&cuts.lines) {
        add_line(&mut division, line, shares, layout.h);
    }
    check_division(&division, h)?;
    Ok(division)
}

fn add_loop<'s>(
    division: &mut Division,
    stretches: &[Stretch<'_>],
    shares: impl Iterator<Item = &'s Vec<f64>>,
) {
    let first = division.points.len() as u32;
    let mut vertices: Vec<u32> = Vec::new();
    let mut chains = Vec::new();
    for (s, shares) in stretches.iter().zip(shares) {
        let start = division.points.len() as u32;
        division.stretches.push((start, s.name.is_none()));
        let arcs = place(s.line.length(), shares, &s.marks);
        let deviation = s.line.deviation(&arcs);
        if deviation > division.deviation {
            division.deviation = deviation;
            division.deviates = s.name.map_or("the outline".into(), |n| format!("edge \"{n}\""));
        }
        division.points.extend(arcs[..arcs.len() - 1].iter().map(|&a| s.line.at(a)));
        let end = division.points.len() as u32;
        vertices.extend(start..end);
        chains.extend(s.name.map(|name| (name, start, end)));
    }
    let close = |v: u32| if v as usize == division.points.len() { first } else { v };
    let edge = |(name, start, end): (&str, u32, u32)| PanelEdge {
        name: name.to_owned(),
        vertices: (start..=end).map(close).collect(),
    };
    division.edges.extend(chains.into_iter().map(edge));
    division.loops.push(vertices);
}

fn add_line(division: &mut Division, line: &Line<'_>, shares: &[f64], h: f64) {
    let arcs = place(line.path.length(), shares, &line.marks);
    let last = arcs.len() - 1;
    let mut vertices = Vec::with_capacity(arcs.len());
    for (k, &arc) in arcs.iter().enumerate() {
        let p = line.path.at(arc);
        let joint = k == 0 || k == last || line.marks.contains(&arc);
        let reach = if joint { SNAP * h } else { 0.0 };
        let known = division.points.iter().position(|q| (q - p).norm() <= reach);
        vertices.push(known.unwrap_or(division.points.len()) as u32);
        if known.is_none() {
            division.points.push(p);
        }
    }
    let inner = line.inner;
    division.chains.push(InnerChain { name: inner.name.clone(), kind: inner.kind, vertices });
}

fn check_division(division: &Division, h: f64) -> Result<(), StageError> {
    let segments = division.segments();
    let Some([_, j]) = first_crossing(&division.points, &segments) else { return Ok(()) };
    let on_loops = division.loop_segments().len();
    let p = division.points[segments[j][0] as usize];
    let place = format!("near ({:.1}, {:.1}) mm", p.x * 1e3, p.y * 1e3);
    let error = |text: String| StageError::new(ErrorCode::DegenerateTriangles, text);
    match j.checked_sub(on_loops) {
        None => Err(error(format!("at an edge of {} the divided outline crosses itself {place}", show(h)))
            .hint("use a smaller edge")
            .at("edge")),
        Some(k) => {
            let mut before = 0;
            let owner = division.chains.iter().find(|c| {
                before += c.vertices.len() - 1;
                k < before
            });
            let name = owner.map_or("", |c| c.name.as_str());
            Err(error(format!("inner line \"{name}\" crosses the outline or another line {place}"))
                .hint("inner lines may meet the outline and each other at their ends only"))
        }
    }
}
