//! Cloth that the body stretches.
//!
//! Where cloth lies taut on a body, its strain is the pattern's: it is cut narrower than the body
//! is there. Such cloth is told of, and not held against the solver. A triangle is taut where all
//! of it lies on the body and it is stretched in some direction. So is cloth that spans a hollow of
//! the body, and cloth around it in which the pull fades out: what is stretched by more than its
//! weight could, and hangs together with a triangle on the body through cloth that is stretched so.
//! What of a taut triangle is shorter in another direction, by no more, is drawn so by that stretch
//! (shear, Poisson's ratio), and counts with it. Limit: cloth that friction holds stretched on the
//! body, though the pattern is wide enough, counts too.

use std::collections::BTreeMap;
use toile_core::artifact::{BodyContact, Garment, GarmentPanel, Shortfall, quantile};
use toile_core::prelude::*;

/// How far cloth on the body may be from it, in thicknesses of the collider: contact begins at one,
/// edges over a round body stand off farther.
const ON: f64 = 3.0;

/// Strain from which on cloth is drawn by more than what hangs from it: a metre of cotton poplin
/// stretches by 0.03 % under its weight, of interlock knit by 0.4 % (presets, weft).
const DRAWN: f64 = 0.02;

/// Strain from which on cloth beside drawn cloth counts as drawn with it: a pull fades out over the
/// cloth around it.
const FADES: f64 = 0.005;

/// An edge of a garment.
struct StrainedEdge {
    vertices: [u32; 2],
    /// Strain, positive where it is longer than it was cut.
    strain: f64,
    /// Whether the body stretches the cloth there.
    taut: bool,
}

/// The edges of a garment, and how far the body stretches each triangle.
pub struct Tight {
    edges: Vec<StrainedEdge>,
    /// By the vertices of the taut triangles: the greatest stretch, as a strain.
    taut: BTreeMap<[u32; 3], f64>,
}

impl Tight {
    /// Of a garment on a collider's body; nothing is taut without one.
    pub fn of(garment: &Garment, collider: Option<&Collider>) -> Self {
        let on = on_body(garment, collider);
        let strains: Vec<f64> = garment.stretches().into_iter().map(|s| s - 1.0).collect();
        let is_taut = taut_triangles(garment, &on, &strains);
        let all = garment.triangles.iter().copied().zip(strains).zip(is_taut);
        let taut: BTreeMap<[u32; 3], f64> = all.filter_map(|(of, is_taut)| is_taut.then_some(of)).collect();
        let mut most = BTreeMap::new();
        for (t, stretch) in &taut {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let of = most.entry([a.min(b), a.max(b)]).or_insert(0.0f64);
                *of = of.max(*stretch);
            }
        }
        let edge = |(vertices, flat): ([u32; 2], f64)| {
            let strain = length(garment, vertices) / flat - 1.0;
            StrainedEdge { vertices, strain, taut: most.get(&vertices).is_some_and(|s| strain.abs() <= *s) }
        };
        Self { edges: garment.flat_lengths().into_iter().map(edge).collect(), taut }
    }

    /// Whether the body stretches a triangle with these vertices, as far as its area tells: it is
    /// stretched in both directions by no more than its greatest stretch, or drawn smaller by it.
    pub fn stretches_triangle(&self, vertices: &[u32; 3], flat: f64, now: f64) -> bool {
        let within = |s: &f64| now / flat <= (1.0 + s).powi(2) && now / flat >= 1.0 - s;
        self.taut.get(vertices).is_some_and(within)
    }

    /// Whether the body stretches the cloth at an edge.
    pub fn stretches_edge(&self, [a, b]: [u32; 2]) -> bool {
        let key = [a.min(b), a.max(b)];
        self.edges.binary_search_by_key(&key, |e| e.vertices).is_ok_and(|k| self.edges[k].taut)
    }

    /// The 99th percentile of the strain of the edges where the cloth is taut.
    pub fn taut(&self) -> f64 {
        p99(self.edges.iter().filter(|e| e.taut).map(|e| e.strain))
    }

    /// The 99th percentile of the strain of all edges, where those that are taut have none.
    pub fn rest(&self) -> f64 {
        p99(self.edges.iter().map(|e| if e.taut { 0.0 } else { e.strain }))
    }

    /// The panel that the body stretches most, and by how much (99th percentile of its taut edges).
    pub fn tightest<'g>(&self, garment: &'g Garment) -> Option<(&'g str, f64)> {
        let of = |p: &'g GarmentPanel| {
            let mine = |e: &&StrainedEdge| e.taut && p.vertices.contains(&(e.vertices[0] as usize));
            (p.name.as_str(), p99(self.edges.iter().filter(mine).map(|e| e.strain)))
        };
        garment.panels.iter().map(of).reduce(|a, b| if b.1 > a.1 { b } else { a })
    }

    /// What a user is told of cloth that is taut: a warning from a strain of `from` on, a limit
    /// that is missed from `limit` on.
    pub(super) fn judge(&self, garment: &Garment, from: f64, limit: f64, cx: &Context) -> Option<Shortfall> {
        let (name, strain) = self.tightest(garment).filter(|(_, strain)| *strain > from.min(limit))?;
        let percent = |share: f64| format!("{:.1} %", share * 1e2);
        let what = format!("the body stretches panel \"{name}\" by up to {}", percent(strain));
        if strain <= limit {
            cx.warn(format!("{what}: it is cut narrower than the body is there"));
            return None;
        }
        let message = format!(
            "{what}, the limit is {}: cut it wider, or take a body of the pattern's measures",
            percent(limit)
        );
        Some(Shortfall { code: ErrorCode::StaticEquilibrium, message })
    }
}

/// Which triangles the body stretches: stretched ones that lie on it, and drawn ones that hang
/// together with it.
fn taut_triangles(garment: &Garment, on: &[bool], strains: &[f64]) -> Vec<bool> {
    let on = |v: &u32| on[*v as usize];
    let lies = |(t, s): (&[u32; 3], &f64)| *s > 0.0 && t.iter().all(on) || *s > DRAWN && t.iter().any(on);
    let mut taut: Vec<bool> = garment.triangles.iter().zip(strains).map(lies).collect();
    let beside = neighbours(garment);
    let mut open: Vec<usize> = (0..taut.len()).filter(|&t| taut[t] && strains[t] > DRAWN).collect();
    while let Some(t) = open.pop() {
        for &next in &beside[t] {
            if !taut[next] && strains[next] > FADES {
                taut[next] = true;
                open.push(next);
            }
        }
    }
    taut
}

/// For every triangle those that share an edge with it, across seams as well.
fn neighbours(garment: &Garment) -> Vec<Vec<usize>> {
    let mut point: Vec<u32> = (0..garment.positions.len() as u32).collect();
    for pair in garment.seams.iter().flat_map(|s| &s.pairs) {
        let least = pair.iter().map(|&v| point[v as usize]).min();
        pair.iter().for_each(|&v| point[v as usize] = least.unwrap_or(v));
    }
    let mut sides = Vec::with_capacity(3 * garment.triangles.len());
    for (t, v) in garment.triangles.iter().enumerate() {
        let v = v.map(|v| point[v as usize]);
        sides.extend((0..3).map(|k| (v[k].min(v[(k + 1) % 3]), v[k].max(v[(k + 1) % 3]), t)));
    }
    sides.sort_unstable();
    let mut beside = vec![Vec::new(); garment.triangles.len()];
    for of in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        for (a, b) in of.iter().flat_map(|a| of.iter().map(move |b| (a.2, b.2))).filter(|(a, b)| a != b) {
            beside[a].push(b);
        }
    }
    beside
}

/// Which vertices lie on the body.
fn on_body(garment: &Garment, collider: Option<&Collider>) -> Vec<bool> {
    let mut on = vec![false; garment.positions.len()];
    if let Some(collider) = collider {
        let mut contacts: Vec<BodyContact> = Vec::new();
        let reach = ON * collider.scheme.card().thickness;
        collider.scheme.body_contacts(&garment.positions, reach, &mut contacts);
        contacts.iter().for_each(|c| on[c.vertex as usize] = true);
    }
    on
}

fn p99(strains: impl Iterator<Item = f64>) -> f64 {
    let mut strains: Vec<f64> = strains.map(f64::abs).collect();
    strains.sort_by(f64::total_cmp);
    quantile(&strains, 0.99)
}

fn length(garment: &Garment, [a, b]: [u32; 2]) -> f64 {
    (garment.positions[a as usize] - garment.positions[b as usize]).norm()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use toile_fixtures::cloth::{Capsules, ClothGrid, garment, plain};

    /// A sheet of 20 cm, stretched along x and a little narrower, so high above a round beam of 1 m
    /// radius that it lies on its top.
    fn sheet(stretch: f64, height: f64) -> (Garment, Collider) {
        let flat = |x: f64, y: f64| Point2::new(0.2 * x, 0.2 * y);
        let grid = ClothGrid { columns: 8, rows: 8, flat, lift: |p| Point3::new(p.x, 0.0, p.y) };
        let mut sheet = garment(&[("front", &grid)], &plain(500.0, 50.0, 1e-5));
        for p in &mut sheet.positions {
            let (x, z) = ((p.x - 0.1) * (1.0 + stretch), (p.z - 0.1) * (1.0 - 0.5 * stretch));
            *p = Point3::new(x, (1.0 - z * z).sqrt() + height, z);
        }
        let beam = Capsules::new(&[([-5.0, 0.0, 0.0], [5.0, 0.0, 0.0], 1.0)]);
        (sheet, beam.collider())
    }

    #[test]
    fn what_the_body_stretches_is_not_held_against_the_solver() {
        let (sheet, collider) = sheet(0.08, 1e-3);
        let tight = Tight::of(&sheet, Some(&collider));
        assert!((tight.taut() - 0.08).abs() < 0.01, "{}", tight.taut());
        assert!(tight.rest() < 1e-3, "{}", tight.rest());
    }

    #[test]
    fn cloth_that_hangs_free_is_the_solvers() {
        let (sheet, collider) = sheet(0.08, 0.02);
        for tight in [Tight::of(&sheet, Some(&collider)), Tight::of(&sheet, None)] {
            assert_eq!(tight.taut(), 0.0);
            assert!((tight.rest() - 0.08).abs() < 0.01, "{}", tight.rest());
        }
    }

    #[test]
    fn cloth_that_spans_a_hollow_between_two_places_of_the_body_is_stretched_by_it() {
        let (mut sheet, _) = sheet(0.08, 0.0);
        let row = |y: f64| Point3::new(0.1, y, 0.0);
        // Two thin bars under the two ends, along z.
        let ends =
            sheet.positions.iter().map(|p| p.x).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        for p in &mut sheet.positions {
            p.y = 1.0;
        }
        let bar = |x: f64| ([x, row(0.979).y, -5.0], [x, row(0.979).y, 5.0], 0.02);
        let both = Capsules::new(&[bar(ends.0), bar(ends.1)]);
        let tight = Tight::of(&sheet, Some(&both.collider()));
        assert!(tight.rest() < 1e-3, "{}", tight.rest());
        assert!((tight.taut() - 0.08).abs() < 0.01, "{}", tight.taut());
    }

    #[test]
    fn cloth_stretched_in_both_directions_by_the_body_counts_as_it_was_cut() {
        let (mut sheet, collider) = sheet(0.08, 1e-3);
        for p in &mut sheet.positions {
            p.z *= 1.1;
            p.y = (1.0 - p.z * p.z).sqrt() + 1e-3;
        }
        let tight = Tight::of(&sheet, Some(&collider));
        let counted =
            sheet.panel_areas_but(&sheet.panels[0], |t, flat, now| tight.stretches_triangle(t, flat, now));
        assert!((counted.1 / counted.0 - 1.0).abs() < 2e-3, "{counted:?}");
    }

    #[test]
    fn cloth_pressed_together_on_the_body_is_the_solvers() {
        let (sheet, collider) = sheet(-0.08, 1e-3);
        let tight = Tight::of(&sheet, Some(&collider));
        assert!(tight.rest() > 0.05, "{}", tight.rest());
    }

    #[test]
    fn a_garment_too_small_is_refused_in_words_and_a_close_one_is_told() {
        let judge = |stretch, limit| {
            let (sheet, collider) = sheet(stretch, 1e-3);
            let cx = Context::quiet();
            let missed = Tight::of(&sheet, Some(&collider)).judge(&sheet, 0.05, limit, &cx);
            (missed.map(|s| s.message), cx.take_remarks().warnings)
        };
        assert_eq!(judge(0.04, 0.25), (None, vec![]));
        let told =
            "the body stretches panel \"front\" by up to 8.0 %: it is cut narrower than the body is there";
        assert_eq!(judge(0.08, 0.25), (None, vec![told.to_owned()]));
        let refused = "the body stretches panel \"front\" by up to 30.0 %, the limit is 25.0 %: cut it wider, or take a body of the \
                       pattern's measures";
        assert_eq!(judge(0.3, 0.25), (Some(refused.to_owned()), vec![]));
    }
}
