//! Skirts on cones around the legs.
//!
//! Flat before the body and behind it, a wide skirt starts with its side seams metres from their
//! place, arms between them; the panels of a skirt of many stand in a ring as wide as its hem. Here
//! each tier of such pieces is laid on one cone around the body, with its side seams closed: across
//! by the shares of the way from one side seam to the other, down by the distance from its upper
//! edge, as if each piece were a developable patch (a reduced start; Liu et al. 2024). A cone is as
//! wide at its hem as the cloth, but no flatter than [`FLATTEST`], so that it passes below the
//! hands; what is gathered or wider than that starts pressed together. Cost: some milliseconds.
//! Limits: every piece below the waist must be one of a ring of at least two, each sewn on both
//! sides; no trousers, no godets.

use super::PiecePlaces;
use super::legs;
use super::move_input::MoveInput;
use super::tiers::piece_of;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::f64::consts::{PI, TAU};
use toile_core::artifact::{BodyPart, join_pairs};
use toile_core::prelude::*;

/// This start in words.
pub(super) const TOLD: &str = "with its skirts on cones";

/// Greatest way outwards of a cone for its way along the cloth: a steeper one would start in the
/// hands of a body whose arms hang at 45 degrees.
const FLATTEST: f64 = 0.8;
/// The uppermost edge is so far outside of the body's girth, metres.
const OFF_BODY: f64 = 0.03;
/// Seams within a tier join pieces that face different ways by at least this, radians: the panels
/// of a ring of 36 face 10 degrees apart.
const TURNED: f64 = 0.15;

/// A piece of a tier.
struct Patch<'a> {
    name: &'a str,
    panel: &'a Panel,
    /// Which way it faces around the body, radians from forwards to the left.
    faces: f64,
    /// Its vertices on the seams to its neighbours: towards lesser and greater angles.
    sides: [BTreeSet<usize>; 2],
    /// Its vertices on the seam to what is above, or on its free upper edge.
    top: BTreeSet<usize>,
}

/// A vertex that is reached over mesh edges, the nearest first.
struct Reached(f64, usize);

impl PartialEq for Reached {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Reached {}
impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Reached {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

/// The places with every skirt on cones; nothing where the pieces are none of a skirt of rings.
pub(super) fn laid(by: &MoveInput<'_>, places: &PiecePlaces) -> Option<PiecePlaces> {
    let crotch = by.body.landmarks.get("crotch").map(|p| p.y)?;
    let is_leg = |name: &str| by.pattern.piece(name).and_then(|p| p.body_part) == Some(BodyPart::Leg);
    let names: Vec<&str> = places.keys().map(String::as_str).filter(|n| is_leg(n)).collect();
    if names.len() < 2 || legs::any_of_one_leg(places, by.seams, by.offsets, crotch) {
        return None;
    }
    let mut patches = names.iter().map(|n| patch(n, by, places)).collect::<Option<Vec<_>>>()?;
    let number: BTreeMap<&str, usize> = names.iter().zip(0..).map(|(n, k)| (*n, k)).collect();
    let mut group: Vec<u32> = (0..patches.len() as u32).collect();
    let mean_height = |k: usize| {
        let points = &places[names[k]];
        points.iter().map(|p| p.y).sum::<f64>() / points.len().max(1) as f64
    };
    // Each seam lies in a tier, or joins a tier to what is above.
    let mut above: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for [a, b] in by.seams.iter().flat_map(|s| &s.pairs) {
        let (Some((one, i)), Some((other, j))) = (piece_of(*a, by), piece_of(*b, by)) else { continue };
        match (number.get(one), number.get(other)) {
            (Some(&p), Some(&q)) if p == q => {}
            (Some(&p), Some(&q)) if turned(patches[p].faces, patches[q].faces).abs() > TURNED => {
                join_pairs(&mut group, &[[p as u32, q as u32]]);
                for (own, vertex) in [(p, i), (q, j)] {
                    let side = usize::from(across(&patches[own], places, vertex) > 0.0);
                    patches[own].sides[side].insert(vertex);
                }
            }
            (Some(&p), Some(&q)) => {
                let (upper, lower, vertex) =
                    if mean_height(p) > mean_height(q) { (p, q, j) } else { (q, p, i) };
                patches[lower].top.insert(vertex);
                above.entry(lower).or_default().insert(upper);
            }
            (Some(&p), None) => _ = patches[p].top.insert(i),
            (None, Some(&q)) => _ = patches[q].top.insert(j),
            (None, None) => {}
        }
    }
    for patch in &mut patches {
        if patch.top.is_empty() {
            patch.top = free_top(patch, places)?;
        }
    }
    if patches.iter().any(|p| p.sides.iter().any(BTreeSet::is_empty)) {
        return None;
    }
    let mut tiers: Vec<u32> = group.clone();
    tiers.sort_unstable();
    tiers.dedup();
    let members = |tier: u32| (0..patches.len()).filter(|k| group[*k] == tier).collect::<Vec<_>>();
    let top_height = |tier: u32| {
        let tops = members(tier).into_iter().flat_map(|k| {
            let points = &places[names[k]];
            patches[k].top.iter().map(|v| points[*v].y).collect::<Vec<_>>()
        });
        mean(tops)
    };
    tiers.sort_by(|a, b| top_height(*b).total_cmp(&top_height(*a)).then(a.cmp(b)));
    let middle = middle(by.body, top_height(*tiers.first()?));
    // Radius and height of the hem of each tier that is laid.
    let mut hems: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
    let mut out = places.clone();
    for tier in tiers {
        let mine = members(tier);
        if mine.len() < 2 {
            return None;
        }
        let upper = mine.iter().filter_map(|k| above.get(k)).flatten().find_map(|u| hems.get(&group[*u]));
        let [radius, height] = match upper {
            Some(hem) => *hem,
            None => [girth_radius(by.body, middle, top_height(tier))?, top_height(tier)],
        };
        let ring: Vec<&Patch<'_>> = mine.iter().map(|k| &patches[*k]).collect();
        hems.insert(tier, lay(&ring, [radius, height], middle, &mut out));
    }
    Some(out)
}

/// Lays a tier on a cone from that radius and height down; the radius and height of its hem.
fn lay(ring: &[&Patch<'_>], [radius, height]: [f64; 2], middle: Point2, out: &mut PiecePlaces) -> [f64; 2] {
    let down: Vec<Vec<f64>> = ring.iter().map(|p| below(p)).collect();
    let hem = |k: usize| {
        let p = ring[k];
        let is_hem = |v: &usize| !p.top.contains(v) && p.sides.iter().all(|s| !s.contains(v));
        p.panel.boundary.iter().map(|v| *v as usize).filter(is_hem).collect::<BTreeSet<_>>()
    };
    let hems: Vec<BTreeSet<usize>> = (0..ring.len()).map(hem).collect();
    let longest = mean(hems.iter().zip(&down).flat_map(|(h, d)| h.iter().map(move |v| d[*v])));
    let wide: f64 = ring.iter().map(|p| hem_length(p)).sum();
    let lean = ((wide / TAU - radius) / longest.max(1e-6)).clamp(0.0, FLATTEST);
    let upright = (1.0 - lean * lean).sqrt();
    let shares: Vec<f64> = ring.iter().map(|p| length(p.panel, &p.top).max(1e-6)).collect();
    let all: f64 = shares.iter().sum();
    // One after the other, the way that they face; the first with its middle where it faces.
    let mut order: Vec<usize> = (0..ring.len()).collect();
    order.sort_by(|a, b| ring[*a].faces.rem_euclid(TAU).total_cmp(&ring[*b].faces.rem_euclid(TAU)));
    let first = order.first().map_or(0.0, |k| ring[*k].faces - PI * shares[*k] / all);
    let mut from = first;
    for k in order {
        let turn = TAU * shares[k] / all;
        let away = ring[k].sides.each_ref().map(|side| over_edges(ring[k].panel, side));
        let place = |v: usize| {
            let [a, b] = [away[0][v], away[1][v]];
            let angle = from + turn * if a + b > 0.0 { a / (a + b) } else { 0.5 };
            let r = radius + lean * down[k][v];
            let y = height - upright * down[k][v];
            Point3::new(middle.x + r * angle.sin(), y, middle.y + r * angle.cos())
        };
        let points = (0..ring[k].panel.positions.len()).map(place).collect();
        out.insert(ring[k].name.to_owned(), points);
        from += turn;
    }
    [radius + lean * longest, height - upright * longest]
}

/// A piece with the way that it faces; nothing where it lies.
fn patch<'a>(name: &'a str, by: &MoveInput<'a>, places: &PiecePlaces) -> Option<Patch<'a>> {
    let (name, (_, panel)) = by.offsets.get_key_value(name)?;
    let points = places.get(*name)?;
    let normal: Vector3 = panel
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            (b - a).cross(&(c - a))
        })
        .sum();
    let normal = normal.try_normalize(1e-12)?;
    let level = (normal.x * normal.x + normal.z * normal.z).sqrt();
    // Outwards, whichever side is the right one.
    let middle = mean_point(points) - mean_point(&by.body.positions);
    let way = if normal.x * middle.x + normal.z * middle.z < 0.0 { -1.0 } else { 1.0 };
    (level > 0.5).then(|| Patch {
        name,
        panel,
        faces: (way * normal.x).atan2(way * normal.z),
        sides: [BTreeSet::new(), BTreeSet::new()],
        top: BTreeSet::new(),
    })
}

fn mean_point(points: &[Point3]) -> Vector3 {
    points.iter().map(|p| p.coords).sum::<Vector3>() / points.len().max(1) as f64
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (n, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v));
    sum / f64::max(n, 1.0)
}

/// The angle from one direction to another, between -PI and PI.
fn turned(from: f64, to: f64) -> f64 {
    (to - from + PI).rem_euclid(TAU) - PI
}

/// How far a vertex lies from the middle of its piece, towards greater angles.
fn across(patch: &Patch<'_>, places: &PiecePlaces, vertex: usize) -> f64 {
    let points = &places[patch.name];
    let off = points[vertex].coords - mean_point(points);
    off.x * patch.faces.cos() - off.z * patch.faces.sin()
}

/// The free upper edge of a piece: of its outline's edges that are on no seam, the highest.
fn free_top(patch: &Patch<'_>, places: &PiecePlaces) -> Option<BTreeSet<usize>> {
    let points = &places[patch.name];
    let vertices = |e: &PanelEdge| e.vertices.iter().map(|v| *v as usize).collect::<BTreeSet<_>>();
    let is_free = |e: &BTreeSet<usize>| {
        patch.sides.iter().all(|side| e.iter().filter(|v| side.contains(v)).count() <= 1)
    };
    let height = |e: &BTreeSet<usize>| mean(e.iter().map(|v| points[*v].y));
    let free = patch.panel.edges.iter().map(vertices).filter(is_free);
    free.max_by(|a, b| height(a).total_cmp(&height(b)))
}

/// The distance of each vertex from the upper edge, straight over the cloth.
fn below(patch: &Patch<'_>) -> Vec<f64> {
    let at = &patch.panel.positions;
    let top: Vec<Point2> = patch.top.iter().map(|v| at[*v]).collect();
    let nearest = |p: &Point2| top.iter().map(|q| (p - q).norm_squared()).fold(f64::INFINITY, f64::min);
    at.iter().map(|p| nearest(p).sqrt()).collect()
}

/// The distance of each vertex from some of them over the edges of the mesh (Dijkstra 1959).
fn over_edges(panel: &Panel, from: &BTreeSet<usize>) -> Vec<f64> {
    let mut beside = vec![Vec::new(); panel.positions.len()];
    for t in &panel.triangles {
        for k in 0..3 {
            let (a, b) = (t[k] as usize, t[(k + 1) % 3] as usize);
            let long = (panel.positions[a] - panel.positions[b]).norm();
            beside[a].push((b, long));
            beside[b].push((a, long));
        }
    }
    let mut away = vec![f64::INFINITY; panel.positions.len()];
    let mut open: BinaryHeap<Reached> = from.iter().map(|v| Reached(0.0, *v)).collect();
    from.iter().for_each(|v| away[*v] = 0.0);
    while let Some(Reached(way, v)) = open.pop() {
        if way > away[v] {
            continue;
        }
        for (next, long) in &beside[v] {
            if way + long < away[*next] {
                away[*next] = way + long;
                open.push(Reached(way + long, *next));
            }
        }
    }
    away.iter_mut().filter(|w| !w.is_finite()).for_each(|w| *w = 0.0);
    away
}

/// The length of the outline between neighbours that both belong to `of`.
fn length(panel: &Panel, of: &BTreeSet<usize>) -> f64 {
    let outline = &panel.boundary;
    let next = outline.iter().cycle().skip(1);
    let sides = outline.iter().zip(next).map(|(a, b)| (*a as usize, *b as usize));
    let mine = sides.filter(|(a, b)| of.contains(a) && of.contains(b));
    mine.map(|(a, b)| (panel.positions[a] - panel.positions[b]).norm()).sum()
}

/// The length of the outline but for its upper edge and its sides.
fn hem_length(patch: &Patch<'_>) -> f64 {
    let all = patch.panel.boundary.iter().map(|v| *v as usize).collect();
    let sides: f64 = patch.sides.iter().map(|side| length(patch.panel, side)).sum();
    length(patch.panel, &all) - length(patch.panel, &patch.top) - sides
}

/// The radius of a circle around the trunk at a height.
fn girth_radius(body: &Body, middle: Point2, height: f64) -> Option<f64> {
    let loops = toile_body::slice(&body.positions, &body.triangles, height);
    let trunk = loops.iter().find(|l| l.holds(middle))?;
    Some(0.5 * trunk.width() + OFF_BODY)
}

/// The middle of the body at a height, (x, z).
fn middle(body: &Body, height: f64) -> Point2 {
    let loops = toile_body::slice(&body.positions, &body.triangles, height);
    let nearest = loops.iter().min_by(|a, b| a.centre().x.abs().total_cmp(&b.centre().x.abs()));
    nearest.map_or_else(Point2::origin, |l| l.centre())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::place::sew::Offsets;

    const COLUMNS: u32 = 6;
    const ROWS: u32 = 12;

    /// A trapezoid from 60 cm below its upper edge up, of that width above and below.
    fn panel(upper: f64, lower: f64) -> Panel {
        let at = |k: u32| {
            let (column, row) = (f64::from(k % (COLUMNS + 1)), f64::from(k / (COLUMNS + 1)));
            let up = row / f64::from(ROWS);
            let wide = lower + (upper - lower) * up;
            Point2::new(wide * (column / f64::from(COLUMNS) - 0.5), 0.6 * up)
        };
        let index = |column: u32, row: u32| row * (COLUMNS + 1) + column;
        let cell = |k: u32| {
            let (c, r) = (k % COLUMNS, k / COLUMNS);
            let [a, b, d, e] = [index(c, r), index(c + 1, r), index(c + 1, r + 1), index(c, r + 1)];
            [[a, b, d], [a, d, e]]
        };
        let below = (0..COLUMNS).map(|c| index(c, 0));
        let right = (0..ROWS).map(|r| index(COLUMNS, r));
        let above = (1..=COLUMNS).rev().map(|c| index(c, ROWS));
        let left = (1..=ROWS).rev().map(|r| index(0, r));
        let edge = |name: &str, vertices: Vec<u32>| PanelEdge { name: name.into(), vertices };
        Panel {
            positions: (0..(COLUMNS + 1) * (ROWS + 1)).map(at).collect(),
            triangles: (0..COLUMNS * ROWS).flat_map(cell).collect(),
            boundary: below.chain(right).chain(above).chain(left).collect(),
            holes: Vec::new(),
            edges: vec![
                edge("hem", (0..=COLUMNS).map(|c| index(c, 0)).collect()),
                edge("right", (0..=ROWS).map(|r| index(COLUMNS, r)).collect()),
                edge("waist", (0..=COLUMNS).rev().map(|c| index(c, ROWS)).collect()),
                edge("left", (0..=ROWS).rev().map(|r| index(0, r)).collect()),
            ],
            inner: Vec::new(),
            photo_px: Vec::new(),
            outline_area: 1.0,
            outline_length: 1.0,
        }
    }

    /// A skirt of so many panels that stand in a ring one metre away, and how they lie on a cone.
    fn skirt(
        count: usize,
        upper: f64,
        lower: f64,
        part: BodyPart,
    ) -> (Panel, Vec<GarmentSeam>, Option<PiecePlaces>) {
        let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
        let body = toile_fixtures::mannequin(lengths).unwrap();
        let panel = panel(upper, lower);
        let names: Vec<String> = (0..count).map(|k| format!("panel_{k:02}")).collect();
        let own = panel.positions.len();
        let offsets: Offsets<'_> =
            names.iter().zip(0..).map(|(n, k)| (n.as_str(), (own * k, &panel))).collect();
        let stand = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
            let place = |p: &Point2| Point3::new(sin + p.x * cos, p.y + 0.4, cos - p.x * sin);
            panel.positions.iter().map(place).collect()
        };
        let places: PiecePlaces = names.iter().zip(0..).map(|(n, k)| (n.clone(), stand(k))).collect();
        let seam = |k: usize| {
            let next = (k + 1) % count;
            let pair = |r: u32| {
                let [left, right] = [r * (COLUMNS + 1), r * (COLUMNS + 1) + COLUMNS];
                [right + (own * k) as u32, left + (own * next) as u32]
            };
            let pairs = (0..=ROWS).map(pair).collect();
            GarmentSeam { name: format!("side {k}"), kind: SeamKind::Matched, pairs, state: SeamState::Open }
        };
        let seams: Vec<GarmentSeam> = (0..count).map(seam).collect();
        let piece = |n: &String| Piece { name: n.clone(), body_part: Some(part), ..Piece::default() };
        let pattern =
            Pattern { name: "skirt".into(), pieces: names.iter().map(piece).collect(), seams: vec![] };
        let by = MoveInput {
            body: &body,
            pattern: &pattern,
            seams: &seams,
            offsets: &offsets,
            sleeves: None,
            clearance: 0.02,
        };
        let laid = laid(&by, &places);
        drop(offsets);
        (panel.clone(), seams, laid)
    }

    #[test]
    fn the_panels_of_a_ring_lie_side_by_side_on_a_cone_as_wide_as_they_are() {
        let (panel, seams, laid) = skirt(8, 0.12, 0.35, BodyPart::Leg);
        let laid: Vec<Point3> = laid.unwrap().into_values().flatten().collect();
        let gap = |[a, b]: &[u32; 2]| (laid[*a as usize] - laid[*b as usize]).norm();
        let widest = seams.iter().flat_map(|s| &s.pairs).map(gap).fold(0.0, f64::max);
        assert!(widest < 1e-9, "{widest}");
        let highest = laid.iter().map(|p| p.y).fold(0.0, f64::max);
        assert!((highest - 1.0).abs() < 1e-9, "its upper edge is as high as it was: {highest}");
        let edges = panel.triangles.iter().map(|t| [t[0] as usize, t[1] as usize]);
        let strain = |[a, b]: [usize; 2]| {
            (laid[a] - laid[b]).norm() / (panel.positions[a] - panel.positions[b]).norm() - 1.0
        };
        let most = edges.map(|e| strain(e).abs()).fold(0.0, f64::max);
        assert!(most < 0.35, "its waist is a little wider than the cloth: {most}");
    }

    #[test]
    fn a_skirt_wider_than_a_cone_under_the_hands_is_pressed_together() {
        let (_, _, laid) = skirt(8, 0.12, 3.0, BodyPart::Leg);
        let points = laid.unwrap().into_values().flatten();
        let lowest = points.map(|p| p.y).fold(f64::INFINITY, f64::min);
        assert!(lowest < 1.0 - 0.6 * 0.6 + 1e-9, "{lowest}");
    }

    #[test]
    fn what_is_no_skirt_stays() {
        assert!(skirt(8, 0.12, 0.35, BodyPart::Body).2.is_none());
    }
}
