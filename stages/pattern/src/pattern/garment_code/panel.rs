//! A panel of the file as a piece of the pattern.
//!
//! Method: the edges are put in a loop by their vertices; a tiny gap is closed; the loop becomes
//! metres. A loop that runs clockwise is seen from inside the wearer: its x is mirrored and its
//! pose accordingly, so that every piece is seen from outside. Rotation and translation are `Rz Ry
//! Rx (x, y, 0) + translation`. Limits: edges must stand in the file in the order of the loop; some
//! may run against it.

use super::damage::SpecificationDamage;
use super::read::{RawCurve, RawEdge, RawPanel};
use crate::mesh::crossing::first_crossing;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::Remarks;
use toile_core::prelude::*;

/// A gap between edges of up to this is closed, metres.
const HAIR: f64 = 5e-3;
/// Such a gap is closed only if it is at most this share of both edges.
const HAIR_SHARE: f64 = 0.25;
/// A shorter edge has no length, metres.
const SPECK: f64 = 1e-4;
/// A control point lies no farther from its edge than so many times the edge's length; in 55 files
/// of GarmentCode 2 is the most.
const OVERSHOOT: f64 = 10.0;
/// A panel of less area is none, square metres.
const LEAST_AREA: f64 = 1e-7;

/// A piece, and where each edge of the file is in it.
#[derive(Debug)]
pub(super) struct Made {
    pub piece: Piece,
    /// For each edge of the file, where it has length: the number of the piece's edge, and whether
    /// that runs the other way.
    pub edges: Vec<Option<(usize, bool)>>,
    /// Start and end of each edge of the file, in space, metres.
    pub ends: Vec<[Point3; 2]>,
}

/// How the file's numbers become metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// Metres in a unit.
    pub unit: f64,
    /// Whether control points are in the panel's coordinates.
    pub absolute: bool,
}

/// An edge of the file as it lies in the loop.
#[derive(Debug, Clone, Copy)]
struct Link {
    edge: usize,
    flipped: bool,
    /// Its ends in the order of the loop, the file's units.
    start: Point2,
    end: Point2,
}

/// Makes the piece; `stitched` are the edges that stitches name. Repairs are reported.
///
/// Errors: all that is wrong with its edges; else that it crosses itself.
pub(super) fn made(
    raw: &RawPanel,
    stitched: &BTreeSet<usize>,
    scale: Scale,
    told: &mut Remarks,
) -> Result<Made, Vec<SpecificationDamage>> {
    let links = chained(raw, stitched, scale.unit, told)?;
    let faults: Vec<SpecificationDamage> =
        links.iter().filter_map(|l| drawable(raw, l, scale).err()).collect();
    if !faults.is_empty() {
        return Err(faults);
    }
    let names = edge_names(raw);
    let corners: Vec<Point2> = links.iter().map(|l| l.start * scale.unit).collect();
    let edges =
        links.iter().map(|l| PieceEdge { name: names[l.edge].clone(), curve: curve(raw, l, scale, told) });
    let outer = PatternLoop { edges: edges.collect(), corners };
    let points = simple(raw, &links, &outer, scale.unit).map_err(|damage| vec![damage])?;
    let area = polygon_area(&points);
    if area.abs() < LEAST_AREA {
        return Err(vec![SpecificationDamage::NoArea { panel: raw.name.clone() }]);
    }
    let inside_out = area < 0.0;
    let mut edges = vec![None; raw.edges.len()];
    for (k, l) in links.iter().enumerate() {
        edges[l.edge] = Some((k, l.flipped));
    }
    let pose = pose(raw, scale.unit);
    let ends = raw.edges.iter().map(|e| e.ends.map(|v| pose.at(raw.vertices[v] * scale.unit))).collect();
    let piece = Piece {
        name: raw.name.clone(),
        outer: if inside_out { mirrored(&outer) } else { outer },
        body_part: body_part(raw, told),
        pose: Some(if inside_out { Pose { across: -pose.across, ..pose } } else { pose }),
        ..Piece::default()
    };
    Ok(Made { piece, edges, ends })
}

/// The edges that have length as one closed loop.
fn chained(
    raw: &RawPanel,
    stitched: &BTreeSet<usize>,
    unit: f64,
    told: &mut Remarks,
) -> Result<Vec<Link>, Vec<SpecificationDamage>> {
    let ends = |e: &RawEdge| e.ends.map(|v| raw.vertices[v]);
    let (mut kept, mut faults) = (Vec::new(), Vec::new());
    for (i, e) in raw.edges.iter().enumerate() {
        let [a, b] = ends(e);
        match (b - a).norm() * unit > SPECK {
            true => kept.push(i),
            false if stitched.contains(&i) => {
                faults.push(SpecificationDamage::NoLength { panel: raw.name.clone(), edge: i });
            }
            false => {
                told.warnings.push(format!("edge {i} of panel \"{}\" has no length: left out", raw.name))
            }
        }
    }
    if kept.len() < 2 {
        faults.push(SpecificationDamage::FewEdges { panel: raw.name.clone(), edges: kept.len() });
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let ends: Vec<[Point2; 2]> = kept.iter().map(|&i| ends(&raw.edges[i])).collect();
    let gap = |p: Point2, q: Point2| (p - q).norm() * unit;
    // The first edge runs as it stands unless only its start meets the second.
    let meets = |p: Point2| gap(p, ends[1][0]).min(gap(p, ends[1][1]));
    let first_flipped = kept.len() > 2 && meets(ends[0][0]) + 1e-9 < meets(ends[0][1]).min(1e-6);
    let mut links: Vec<Link> = Vec::with_capacity(kept.len());
    for (k, &edge) in kept.iter().enumerate() {
        let [a, b] = ends[k];
        let flipped = match links.last() {
            None => first_flipped,
            Some(before) => gap(before.end, b) + 1e-9 < gap(before.end, a) && gap(before.end, b) <= HAIR,
        };
        let (start, end) = if flipped { (b, a) } else { (a, b) };
        links.push(Link { edge, flipped, start, end });
    }
    let n = links.len();
    for k in 0..n {
        let (here, next) = (links[k], links[(k + 1) % n]);
        let open = gap(here.end, next.start);
        let shortest = gap(here.start, here.end).min(gap(next.start, next.end));
        if open > HAIR || open > HAIR_SHARE * shortest {
            let (panel, gap_mm) = (raw.name.clone(), open * 1e3);
            faults.push(SpecificationDamage::Open { panel, edge: here.edge, next: next.edge, gap_mm });
        } else if open > 0.0 {
            links[(k + 1) % n].start = here.end;
            let level = if open > SPECK { &mut told.warnings } else { &mut told.notes };
            level.push(format!(
                "the loop of panel \"{}\" was open by {:.3} mm between edges {} and {}: closed",
                raw.name,
                open * 1e3,
                here.edge,
                next.edge
            ));
        }
    }
    if faults.is_empty() { Ok(links) } else { Err(faults) }
}

/// A name for each edge of the file: its label, numbered where several have it, or its number.
fn edge_names(raw: &RawPanel) -> Vec<String> {
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    raw.edges.iter().filter_map(|e| e.label.as_deref()).for_each(|l| *count.entry(l).or_default() += 1);
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let mut taken: BTreeSet<String> = BTreeSet::new();
    let mut names = Vec::with_capacity(raw.edges.len());
    for (i, e) in raw.edges.iter().enumerate() {
        let mut name = match e.label.as_deref() {
            None => format!("edge_{i}"),
            Some(label) if count.get(label) == Some(&1) => label.to_owned(),
            Some(label) => {
                let k = seen.entry(label).or_default();
                *k += 1;
                format!("{label}_{k}")
            }
        };
        while !taken.insert(name.clone()) {
            name.push('\'');
        }
        names.push(name);
    }
    names
}

/// A curve that a person may have meant.
fn drawable(raw: &RawPanel, link: &Link, scale: Scale) -> Result<(), SpecificationDamage> {
    let (panel, edge) = (raw.name.clone(), link.edge);
    let chord = (link.end - link.start).norm();
    let ends = raw.edges[link.edge].ends.map(|v| raw.vertices[v]);
    // In lengths of the edge, from the nearer of its ends.
    let away = |c: &Point2| match scale.absolute {
        true => ends.iter().map(|e| (c - e).norm()).fold(f64::INFINITY, f64::min) / chord,
        false => c.coords.norm().min((c - Point2::new(1.0, 0.0)).norm()),
    };
    let farthest = |c: &[Point2]| c.iter().map(away).fold(0.0, f64::max);
    let times = match &raw.edges[link.edge].curve {
        RawCurve::Line => 0.0,
        RawCurve::Quadratic(c) => farthest(c),
        RawCurve::Cubic(c) => farthest(c),
        RawCurve::Circle { radius, .. } if *radius <= 0.0 => {
            return Err(SpecificationDamage::Radius { panel, edge, radius: *radius });
        }
        RawCurve::Circle { .. } => 0.0,
    };
    if times > OVERSHOOT { Err(SpecificationDamage::Overshoot { panel, edge, times }) } else { Ok(()) }
}

/// The curve of a link in the direction of the loop, metres.
fn curve(raw: &RawPanel, link: &Link, scale: Scale, told: &mut Remarks) -> EdgeCurve {
    let (start, end) = if link.flipped { (link.end, link.start) } else { (link.start, link.end) };
    let chord = end - start;
    let across = Vector2::new(-chord.y, chord.x);
    let at = |c: Point2| match scale.absolute {
        true => c * scale.unit,
        false => (start + chord * c.x + across * c.y) * scale.unit,
    };
    let forward = match raw.edges[link.edge].curve {
        RawCurve::Line => EdgeCurve::Line,
        RawCurve::Quadratic([c]) => EdgeCurve::Quadratic { control: at(c) },
        RawCurve::Cubic(c) => EdgeCurve::Cubic { controls: c.map(at) },
        RawCurve::Circle { radius, large, right } => {
            let (chord, radius) = (chord.norm() * scale.unit, radius.abs() * scale.unit);
            if radius < chord / 2.0 * (1.0 - 1e-6) {
                told.warnings.push(format!(
                    "edge {} of panel \"{}\" is an arc of radius {:.2} mm over {:.2} mm: taken as a half circle",
                    link.edge,
                    raw.name,
                    radius * 1e3,
                    chord * 1e3
                ));
            }
            EdgeCurve::Arc { bulge: EdgeCurve::bulge(chord, radius, large, right) }
        }
    };
    if link.flipped { forward.turned() } else { forward }
}

/// The loop as points, none of whose segments meet but at their ends.
fn simple(
    raw: &RawPanel,
    links: &[Link],
    outer: &PatternLoop,
    unit: f64,
) -> Result<Vec<Point2>, SpecificationDamage> {
    let (points, starts) = outer.points();
    let n = points.len() as u32;
    let segments: Vec<[u32; 2]> = (0..n).map(|i| [i, (i + 1) % n]).collect();
    let Some(pair) = first_crossing(&points, &segments) else { return Ok(points) };
    let [edge, other] = pair.map(|s| links[starts.partition_point(|&c| c <= s) - 1].edge);
    let near = points[pair[1]] / unit;
    Err(SpecificationDamage::Crosses { panel: raw.name.clone(), edge, other, x: near.x, y: near.y })
}

/// The loop seen from the other side: x mirrored, which makes a clockwise one counter-clockwise.
pub(super) fn mirrored(l: &PatternLoop) -> PatternLoop {
    let to = |p: Point2| Point2::new(-p.x, p.y);
    let edge = |e: &PieceEdge| PieceEdge { name: e.name.clone(), curve: e.curve.moved(to, true) };
    PatternLoop {
        corners: l.corners.iter().map(|p| to(*p)).collect(),
        edges: l.edges.iter().map(edge).collect(),
    }
}

/// Whether several panels all stand at the same place, turned the same way: their places were never
/// set.
pub(super) fn at_one_place(panels: &[RawPanel]) -> bool {
    let same = |[a, b]: &[RawPanel; 2]| a.translation == b.translation && a.rotation == b.rotation;
    panels.len() > 1 && panels.array_windows().all(same)
}

/// The place of the file's own flat coordinates.
fn pose(raw: &RawPanel, unit: f64) -> Pose {
    let [x, y, z] = [raw.rotation.x, raw.rotation.y, raw.rotation.z].map(f64::to_radians);
    let turn = nalgebra::Rotation3::from_euler_angles(x, y, z);
    Pose {
        origin: Point3::from(raw.translation * unit),
        across: turn * Vector3::x(),
        along: turn * Vector3::y(),
    }
}

fn body_part(raw: &RawPanel, told: &mut Remarks) -> Option<BodyPart> {
    let label = raw.label.as_deref()?;
    let found = BodyPart::WORDS.iter().find(|(word, _)| *word == label).map(|(_, part)| *part);
    if found.is_none() {
        told.notes
            .push(format!("panel \"{}\" has the label \"{label}\", which is no part of the body", raw.name));
    }
    found
}
