//! Flat pieces as a sewing pattern: edges from corner to corner, seams as chains of them, grain and
//! place on the body.
//!
//! Every boundary loop is cut at its corners and where seams begin and end; so each edge lies in
//! one seam or in none. An edge of which all vertices lie on a line is a line, others keep all
//! their vertices. Cost: linear in the boundary.

use super::sheet::GarmentPieces;
use nalgebra::Matrix2x3;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::prelude::*;
use toile_flatten::care::boundary_chains;
use toile_flatten::islands::{Chain, SurfacePiece, SurfaceSeam};

/// A boundary vertex is a corner if its angle differs by more than this from a straight line,
/// degrees.
pub(super) const CORNER: f64 = 30.0;
/// Points that are nearer than this share of an edge's length to its chord are on it.
const STRAIGHT: f64 = 1e-6;
/// The part of a piece's height that its grain line takes, around its middle.
const GRAIN: f64 = 0.5;

/// An edge of a piece: its loop, its number there, and its vertices along the boundary.
struct DrawnEdge {
    of_loop: usize,
    chain: Vec<u32>,
}

/// What the pieces of a pattern have beside their outlines.
pub(super) struct PatternDrawing<'a> {
    pub(super) sheet: &'a GarmentPieces,
    /// A flat place for each vertex of each piece.
    pub(super) flat: &'a [Vec<Point2>],
    /// The garment that the pieces come from.
    pub(super) garment: &'a Garment,
    /// The pattern that the garment was sewn from, if there was one.
    pub(super) sewn: Option<&'a Pattern>,
    /// Darts that are proposed, by piece: their vertices from the boundary to the tip.
    pub(super) proposed: &'a [Vec<Vec<u32>>],
    pub(super) name: String,
}

impl PatternDrawing<'_> {
    /// The pattern, and what it could not hold.
    pub(super) fn pattern(&self) -> (Pattern, Vec<String>) {
        let seams = &self.sheet.pieces.seams;
        let pieces = &self.sheet.pieces.pieces;
        let sides: Vec<Vec<DrawnEdge>> = (0..pieces.len()).map(|i| self.sides(i)).collect();
        let lookups: Vec<BTreeMap<u32, usize>> = sides.iter().map(|s| starts(s)).collect();
        let known = self.sheet.known_seams(self.garment);
        let names = self.edge_names(&sides, &lookups, &known);
        let mut notes = Vec::new();
        let mut drawn = Vec::with_capacity(pieces.len());
        for (i, sides) in sides.iter().enumerate() {
            drawn.push(self.piece(i, sides, &names[i], &mut notes));
        }
        let mut made = Vec::with_capacity(seams.len());
        let mut taken = BTreeSet::new();
        for (k, seam) in seams.iter().enumerate() {
            let chains = [(&seam.a, false), (&seam.b, true)];
            let uses = chains.map(|(c, against)| uses(c, against, &lookups[c.piece], &sides[c.piece]));
            if uses.iter().flatten().any(|u| u.is_none()) {
                let [a, b] = [&seam.a, &seam.b].map(|c| self.sheet.names[c.piece].as_str());
                notes.push(format!(
                    "a seam of \"{a}\" and \"{b}\" runs along a hole and is left out of the pattern"
                ));
                continue;
            }
            let panel = |c: &Chain| self.sheet.names[c.piece].clone();
            let side = |c: &Chain, uses: &[Option<(usize, bool)>]| {
                let of = |&(edge, reversed): &(usize, bool)| EdgeUse {
                    edge: EdgeRef { panel: panel(c), edge: names[c.piece][edge].clone() },
                    reversed,
                };
                uses.iter().flatten().map(of).collect::<Vec<_>>()
            };
            let sides = vec![side(&seam.a, &uses[0]), side(&seam.b, &uses[1])];
            made.push(PatternSeam {
                name: self.seam_name(k, &sides, &mut taken),
                kind: self.seam_kind(seam, known[k]),
                sides,
            });
        }
        (Pattern { name: self.name.clone(), pieces: drawn, seams: made }, notes)
    }

    /// The edges of a piece.
    fn sides(&self, i: usize) -> Vec<DrawnEdge> {
        let surface = &self.sheet.pieces.pieces[i].surface;
        let of_piece = |s: &SurfaceSeam| {
            [s.a.clone(), s.b.clone()].into_iter().filter(|c| c.piece == i).collect::<Vec<_>>()
        };
        let chains = self.sheet.pieces.seams.iter().flat_map(of_piece);
        let mut ends: Vec<u32> =
            chains.flat_map(|c| [c.vertices[0], c.vertices[c.vertices.len() - 1]]).collect();
        // A loop without a corner needs two.
        let corners = boundary_chains(surface, &self.flat[i], &ends, CORNER.to_radians());
        for chain in corners.iter().filter(|c| c[0] == c[c.len() - 1]) {
            ends.extend([chain[0], chain[chain.len() / 2]]);
        }
        let chains = boundary_chains(surface, &self.flat[i], &ends, CORNER.to_radians());
        let mut loop_of = BTreeMap::new();
        for (k, l) in surface.loops().iter().enumerate() {
            l.iter().for_each(|v| {
                loop_of.insert(*v, k);
            });
        }
        let side =
            |chain: Vec<u32>| DrawnEdge { of_loop: loop_of.get(&chain[0]).copied().unwrap_or(0), chain };
        chains.into_iter().map(side).collect()
    }

    /// Names of edges by piece: what the seams of the garment call them, else numbers.
    fn edge_names(
        &self,
        sides: &[Vec<DrawnEdge>],
        lookups: &[BTreeMap<u32, usize>],
        known: &[Option<usize>],
    ) -> Vec<Vec<String>> {
        let mut names: Vec<Vec<Option<String>>> = sides.iter().map(|s| vec![None; s.len()]).collect();
        for (seam, known) in self.sheet.pieces.seams.iter().zip(known) {
            let Some(name) = known.and_then(|k| self.garment.seams.get(k)).map(|s| s.name.as_str()) else {
                continue;
            };
            for (c, against) in [(&seam.a, false), (&seam.b, true)] {
                let called =
                    edge_called(name, &self.garment.panels[self.sheet.panels[c.piece]].name, against);
                for (edge, _) in uses(c, against, &lookups[c.piece], &sides[c.piece]).into_iter().flatten() {
                    names[c.piece][edge] = names[c.piece][edge].take().or_else(|| called.clone());
                }
            }
        }
        let finish = |list: Vec<Option<String>>| {
            let all: Vec<String> = list
                .into_iter()
                .enumerate()
                .map(|(k, n)| n.unwrap_or_else(|| format!("edge_{}", k + 1)))
                .collect();
            super::sheet::unlike(all.iter().map(String::as_str))
        };
        names.into_iter().map(finish).collect()
    }

    fn piece(&self, i: usize, sides: &[DrawnEdge], names: &[String], notes: &mut Vec<String>) -> Piece {
        let surface = &self.sheet.pieces.pieces[i];
        let flat = &self.flat[i];
        let name = &self.sheet.names[i];
        let mut loops: BTreeMap<usize, PatternLoop> = BTreeMap::new();
        for (side, name) in sides.iter().zip(names) {
            let l = loops.entry(side.of_loop).or_default();
            l.corners.push(flat[side.chain[0] as usize]);
            l.edges.push(PieceEdge { name: name.clone(), curve: curve(&side.chain, flat) });
        }
        let outer = loops.remove(&0).unwrap_or_default();
        if surface.surface.loops().len() > 1 {
            let n = surface.surface.loops().len() - 1;
            notes.push(format!(
                "piece \"{name}\" has {n} holes: a tube that no seam opens is laid flat as a ring"
            ));
        }
        let proposed = self.proposed.get(i).map_or(&[][..], Vec::as_slice);
        let line = |(k, path): (usize, &Vec<u32>)| PieceLine {
            name: format!("proposed_dart_{}", k + 1),
            purpose: LinePurpose::Mark,
            points: path.iter().map(|&v| flat[v as usize]).collect(),
        };
        let before = self.sewn.and_then(|p| p.piece(&self.garment.panels[self.sheet.panels[i]].name));
        Piece {
            name: name.clone(),
            outer,
            holes: loops.into_values().collect(),
            lines: proposed.iter().enumerate().map(line).collect(),
            grain: grain(flat),
            body_part: before.and_then(|b| b.body_part),
            layer: before.map_or(0, |b| b.layer),
            pose: pose(surface, flat),
            ..Piece::default()
        }
    }

    fn seam_name(&self, k: usize, sides: &[Vec<EdgeUse>], taken: &mut BTreeSet<String>) -> String {
        let side = |uses: &Vec<EdgeUse>| {
            uses.first().map_or_else(String::new, |u| format!("{}.{}", u.edge.panel, u.edge.edge))
        };
        let name = sides.iter().map(side).collect::<Vec<_>>().join(" + ");
        if taken.insert(name.clone()) { name } else { format!("{name} ({})", k + 1) }
    }

    /// The legs of a dart meet in its tip; other seams are what the garment calls them, if their
    /// sides came out alike.
    fn seam_kind(&self, seam: &SurfaceSeam, known: Option<usize>) -> SeamKind {
        let tip = seam.a.vertices.last() == seam.b.vertices.last()
            || seam.a.vertices.first() == seam.b.vertices.first();
        if seam.a.piece == seam.b.piece && tip {
            return SeamKind::Dart;
        }
        match known.and_then(|k| self.garment.seams.get(k)).map(|s| s.kind) {
            Some(kind @ (SeamKind::Gathered | SeamKind::Elastic { .. } | SeamKind::Folded { .. })) => kind,
            _ => SeamKind::Matched,
        }
    }
}

/// For each vertex at which a step along the outer boundary begins, the number of its edge.
fn starts(sides: &[DrawnEdge]) -> BTreeMap<u32, usize> {
    let outer = sides.iter().enumerate().filter(|(_, s)| s.of_loop == 0);
    outer.flat_map(|(k, s)| s.chain[..s.chain.len() - 1].iter().map(move |v| (*v, k))).collect()
}

/// The edges that a chain runs along, in its order, and whether from end to start; none for one
/// along a hole.
fn uses(
    chain: &Chain,
    against: bool,
    starts: &BTreeMap<u32, usize>,
    sides: &[DrawnEdge],
) -> Vec<Option<(usize, bool)>> {
    let mut list: Vec<Option<(usize, bool)>> = Vec::new();
    for step in chain.vertices.windows(2) {
        let edge = starts.get(&step[usize::from(against)]).map(|&k| (k, against));
        // An edge that comes again after a whole turn is a new link.
        let again = list.last() == Some(&edge) && !begins(edge, step, against, sides);
        if !again {
            list.push(edge);
        }
    }
    list
}

/// Whether a step is the first of its edge.
fn begins(edge: Option<(usize, bool)>, step: &[u32], against: bool, sides: &[DrawnEdge]) -> bool {
    let Some((k, _)) = edge else { return false };
    let chain = &sides[k].chain;
    let first = if against { chain[chain.len() - 1] } else { chain[0] };
    step[0] == first
}

/// What a seam's name such as `front.side_left + back.side_right` calls the edge of a panel.
fn edge_called(seam: &str, panel: &str, second: bool) -> Option<String> {
    let mut parts: Vec<&str> = seam.split(" + ").collect();
    if second {
        parts.reverse();
    }
    let edge = parts.into_iter().find_map(|p| p.trim().strip_prefix(panel)?.strip_prefix('.'))?;
    (!edge.is_empty()).then(|| edge.to_owned())
}

/// The curve of a chain of flat vertices.
fn curve(chain: &[u32], flat: &[Point2]) -> EdgeCurve {
    let points: Vec<Point2> = chain.iter().map(|&v| flat[v as usize]).collect();
    let (a, b) = (points[0], points[points.len() - 1]);
    let along = b - a;
    let length = along.norm();
    let on_line = |p: &Point2| length > 0.0 && along.perp(&(p - a)).abs() <= STRAIGHT * length * length;
    if points.iter().all(on_line) && polyline_length(&points) <= length * (1.0 + STRAIGHT) {
        return EdgeCurve::Line;
    }
    EdgeCurve::Polyline { points: points[1..points.len() - 1].to_vec() }
}

/// A line along y through the middle of the piece's box.
fn grain(flat: &[Point2]) -> Option<[Point2; 2]> {
    let first = flat.first()?;
    let (lo, hi) = flat.iter().fold((*first, *first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    let (middle, half) = (nalgebra::center(&lo, &hi), (hi.y - lo.y) * GRAIN / 2.0);
    (half > 0.0).then(|| [Point2::new(middle.x, middle.y - half), Point2::new(middle.x, middle.y + half)])
}

/// The place of a flat piece in space that is nearest to where the piece lies on the garment
/// (Kabsch 1976).
fn pose(piece: &SurfacePiece, flat: &[Point2]) -> Option<Pose> {
    let places = piece.surface.positions();
    let n = places.len() as f64;
    let middle2 = flat.iter().fold(Vector2::zeros(), |s, p| s + p.coords) / n;
    let middle3 = places.iter().fold(Vector3::zeros(), |s, p| s + p.coords) / n;
    let spread = flat.iter().zip(places).fold(Matrix2x3::zeros(), |sum, (q, p)| {
        sum + (q.coords - middle2) * (p.coords - middle3).transpose()
    });
    let svd = spread.svd(true, true);
    let turn = svd.u? * svd.v_t?;
    let across = turn.row(0).transpose().try_normalize(0.5)?;
    let along = turn.row(1).transpose();
    let along = (along - across * along.dot(&across)).try_normalize(0.5)?;
    let origin = Point3::from(middle3 - across * middle2.x - along * middle2.y);
    Some(Pose { origin, across, along })
}
