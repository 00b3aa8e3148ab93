//! Garments and bodies for tests: grids of cloth and an analytic body.

use std::sync::Arc;
use toile_core::prelude::*;

/// A body of capsules: segments with a radius.
#[derive(Debug, Clone)]
pub(crate) struct Capsules {
    pub(crate) parts: Vec<(Point3, Point3, f64)>,
    pub(crate) card: ColliderCard,
}

impl Capsules {
    pub(crate) fn new(parts: &[([f64; 3], [f64; 3], f64)]) -> Self {
        let parts = parts.iter().map(|&(a, b, r)| (Point3::from(a), Point3::from(b), r)).collect();
        let card = ColliderCard {
            thickness: 1.5e-3,
            friction: 0.3,
            restitution: 0.0,
            self_collision: false,
            penalty: None,
        };
        Capsules { parts, card }
    }

    /// Shoulders, chest and neck.
    pub(crate) fn torso() -> Self {
        Capsules::new(&[
            ([-0.14, 1.38, 0.0], [0.14, 1.38, 0.0], 0.06),
            ([-0.06, 0.80, 0.0], [-0.06, 1.30, 0.0], 0.11),
            ([0.06, 0.80, 0.0], [0.06, 1.30, 0.0], 0.11),
            ([0.0, 1.40, 0.0], [0.0, 1.60, 0.0], 0.055),
        ])
    }

    pub(crate) fn distance(&self, p: &Point3) -> (f64, Vector3) {
        let one = |&(a, b, r): &(Point3, Point3, f64)| {
            let (ab, ap) = (b - a, p - a);
            let t = (ap.dot(&ab) / ab.norm_squared().max(1e-30)).clamp(0.0, 1.0);
            let out = ap - ab * t;
            (out.norm() - r, out.try_normalize(1e-12).unwrap_or_else(Vector3::y))
        };
        self.parts.iter().map(one).fold((f64::INFINITY, Vector3::y()), |a, b| if b.0 < a.0 { b } else { a })
    }

    pub(crate) fn collider(self) -> Collider {
        Collider { scheme: Arc::new(self), signature: "capsules".into() }
    }
}

impl Collide for Capsules {
    fn card(&self) -> ColliderCard {
        self.card
    }

    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        for (i, p) in positions.iter().enumerate() {
            let (distance, normal) = self.distance(p);
            if distance < reach {
                out.push(BodyContact { vertex: i as u32, point: p - normal * distance, normal, distance });
            }
        }
    }

    fn body_hits(&self, _: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        self.body_contacts(to, 0.0, out);
    }

    fn self_contacts(&self, _: &[Point3], _: &[[u32; 3]], _: f64, _: &mut Vec<SelfContact>) {}

    fn conservative_bounds(&self, x: &[Point3], _: &[[u32; 3]], reach: f64) -> Vec<f64> {
        vec![reach; x.len()]
    }

    fn self_crossings(&self, _: &[Point3], _: &[[u32; 3]]) -> Vec<[u32; 2]> {
        Vec::new()
    }
}

/// A plain fabric: straight curves, light, no friction of its own.
pub(crate) fn plain(stretch: f64, shear: f64, bending: f64) -> Arc<Fabric> {
    Arc::new(Fabric {
        name: "plain".into(),
        area_density: 0.12,
        warp: Curve::linear(stretch),
        weft: Curve::linear(stretch),
        shear: Curve::linear(shear),
        bending_warp: bending,
        bending_weft: bending,
        bending_friction_warp: 0.0,
        bending_friction_weft: 0.0,
        thickness: 3e-4,
        friction: 0.3,
        damping: 0.0,
        source: "made up".into(),
    })
}

/// A flat grid of `columns x rows` cells, its vertices placed by `flat`, lifted by `lift`.
pub(crate) struct Grid {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) flat: fn(f64, f64) -> Point2,
    pub(crate) lift: fn(Point2) -> Point3,
}

impl Grid {
    pub(crate) fn at(&self, column: usize, row: usize) -> u32 {
        (row * (self.columns + 1) + column) as u32
    }

    fn triangles(&self) -> Vec<[u32; 3]> {
        let cell = |(r, c): (usize, usize)| {
            let [a, b, d, e] = [self.at(c, r), self.at(c + 1, r), self.at(c, r + 1), self.at(c + 1, r + 1)];
            if (r + c) % 2 == 0 { [[a, b, e], [a, e, d]] } else { [[a, b, d], [b, e, d]] }
        };
        (0..self.rows).flat_map(|r| (0..self.columns).map(move |c| (r, c))).flat_map(cell).collect()
    }

    /// The boundary, counter-clockwise from the lower left corner.
    pub(crate) fn boundary(&self) -> Vec<u32> {
        let (c, r) = (self.columns, self.rows);
        let bottom = (0..c).map(|i| self.at(i, 0));
        let right = (0..r).map(|j| self.at(c, j));
        let top = (1..=c).rev().map(|i| self.at(i, r));
        bottom.chain(right).chain(top).chain((1..=r).rev().map(|j| self.at(0, j))).collect()
    }
}

/// A garment of grids, not yet sewn.
pub(crate) fn garment(grids: &[(&str, &Grid)], fabric: &Arc<Fabric>) -> Garment {
    let mut g = Garment {
        positions: Vec::new(),
        velocities: Vec::new(),
        rest: Vec::new(),
        triangles: Vec::new(),
        panels: Vec::new(),
        seams: Vec::new(),
        weld: Vec::new(),
        pinned: Vec::new(),
        status: SolveStatus::default(),
    };
    for (name, grid) in grids {
        let (v, t) = (g.positions.len(), g.triangles.len());
        for r in 0..=grid.rows {
            for c in 0..=grid.columns {
                let flat = (grid.flat)(c as f64 / grid.columns as f64, r as f64 / grid.rows as f64);
                g.rest.push(flat);
                g.positions.push((grid.lift)(flat));
            }
        }
        g.triangles.extend(grid.triangles().iter().map(|t| t.map(|i| i + v as u32)));
        g.panels.push(GarmentPanel {
            name: (*name).into(),
            vertices: v..g.positions.len(),
            triangles: t..g.triangles.len(),
            boundary: grid.boundary().iter().map(|i| i + v as u32).collect(),
            photo_px: Vec::new(),
            fabric: fabric.clone(),
        });
    }
    g.velocities = vec![Vector3::zeros(); g.positions.len()];
    g.weld = (0..g.positions.len() as u32).collect();
    g
}

pub(crate) const VEST_COLUMNS: usize = 36;
pub(crate) const VEST_ROWS: usize = 46;
/// Rows of the side seam, and columns of each shoulder.
const SIDE_ROWS: usize = 30;
const SHOULDER_COLUMNS: usize = 9;

/// A vest's panel: 50 cm wide at the hem, armholes cut in, a round neck, sloping shoulders.
fn vest_flat(u: f64, v: f64) -> Point2 {
    let s = 2.0 * u - 1.0;
    let armhole = ((v - 0.64) / 0.12).clamp(0.0, 1.0);
    let width = 0.25 - 0.08 * armhole * armhole * (3.0 - 2.0 * armhole);
    let neck = (1.0 - (s.abs() / 0.5).powi(2)).max(0.0);
    let top = 0.60 - 0.06 * (s.abs() - 0.5).max(0.0) - 0.08 * neck;
    Point2::new(s * width, v * top)
}

fn vest_front(p: Point2) -> Point3 {
    Point3::new(p.x, p.y + 0.91, 0.14)
}

fn vest_back(p: Point2) -> Point3 {
    Point3::new(-p.x, p.y + 0.91, -0.14)
}

/// A sleeveless vest: two panels before and behind the torso, side and shoulder seams.
pub(crate) fn vest(fabric: &Arc<Fabric>) -> Garment {
    let (columns, rows) = (VEST_COLUMNS, VEST_ROWS);
    let front = Grid { columns, rows, flat: vest_flat, lift: vest_front };
    let back = Grid { columns, rows, flat: vest_flat, lift: vest_back };
    let mut g = garment(&[("front", &front), ("back", &back)], fabric);
    let shift = g.panels[1].vertices.start as u32;
    let mut sew = |name: &str, pairs: Vec<[u32; 2]>| {
        let pairs = pairs.iter().map(|p| [p[0], p[1] + shift]).collect();
        let (name, kind, state) = (format!("front.{name} + back.{name}"), SeamKind::Matched, SeamState::Open);
        g.seams.push(GarmentSeam { name, kind, pairs, state });
    };
    let pair = |c: usize, r: usize| [front.at(c, r), front.at(columns - c, r)];
    sew("side_left", (0..=SIDE_ROWS).map(|r| pair(columns, r)).collect());
    sew("side_right", (0..=SIDE_ROWS).map(|r| pair(0, r)).collect());
    sew("shoulder_left", (columns - SHOULDER_COLUMNS..=columns).map(|c| pair(c, rows)).collect());
    sew("shoulder_right", (0..=SHOULDER_COLUMNS).map(|c| pair(c, rows)).collect());
    g
}

/// A rectangle `width x height` with cells of `edge`, in the plane z = 0, its top at y = 0.
pub(crate) fn hanging(width: f64, height: f64, edge: f64, fabric: &Arc<Fabric>) -> (Garment, Vec<usize>) {
    let (columns, rows) = ((width / edge).round() as usize, (height / edge).round() as usize);
    let grid = Grid { columns, rows, flat: |u, v| Point2::new(u, v), lift: |p| Point3::new(p.x, p.y, 0.0) };
    let mut g = garment(&[("strip", &grid)], fabric);
    for i in 0..g.rest.len() {
        let p = Point2::new(g.rest[i].x * width, (g.rest[i].y - 1.0) * height);
        g.rest[i] = p;
        g.positions[i] = Point3::new(p.x, p.y, 0.0);
    }
    (g, (0..=columns).map(|c| grid.at(c, rows) as usize).collect())
}
