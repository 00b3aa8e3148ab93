//! A soft studio light: how much of it reaches every vertex.
//!
//! Each light is a bundle of directions. For each direction the model is drawn into a depth map
//! (Williams, 1978) and every vertex asks whether something stands before it; the share of free
//! directions, weighted by the cosine, is what the light gives: ambient occlusion for a whole sphere
//! of directions, a soft shadow for a narrow cone. So folds and the inside of a hem darken without
//! any noise, and the ambient part serves every view.
//!
//! Cost: one depth-only drawing of the model a direction, one lookup a vertex and direction.
//! Limits: light varies linearly over a triangle; details below [`MAP_PX`]'s resolution are lost.

use super::camera::Projected;
use super::cover::Patch;
use rayon::prelude::*;
use toile_core::artifact::{Model, Point3, Vector3};

/// Side of a depth map, px: a trade of sharp shadows for time. About 3 mm a pixel on a torso.
const MAP_PX: usize = 384;
/// How finely light is worked out: a trade of smoothness for time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fineness {
    /// Directions of the ambient sphere.
    ambient: usize,
    /// Directions of a soft box.
    soft_box: usize,
}

/// For finished pictures: no direction shows by itself.
pub(super) const FINE: Fineness = Fineness { ambient: 96, soft_box: 20 };
/// For small pictures: four times as fast.
pub(super) const DRAFT: Fineness = Fineness { ambient: 24, soft_box: 6 };

/// Half angle of the soft box as its sine: the width of its shadows' edges.
const BOX_SPREAD: f64 = 0.22;
/// A vertex looks from this far in front of its face, metres: past the depth map's steps.
const LIFT: f64 = 0.006;
/// Something must be nearer to the light by this to shade, metres.
const BIAS: f64 = 0.004;
/// Around the garment's box, metres: what lies beyond casts no shadow on it worth the resolution.
const REACH: f64 = 0.35;
/// The sky's light at the nadir against that at the zenith: floor and walls give light back.
const NADIR: f64 = 0.45;

/// The garment's neighbourhood in which shadows are looked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Region {
    centre: Point3,
    radius: f64,
}

impl Region {
    /// Around a model's framed part: least and greatest corner.
    pub(super) fn new(lo: Point3, hi: Point3) -> Region {
        Region { centre: nalgebra::center(&lo, &hi), radius: (hi - lo).norm() / 2.0 + REACH }
    }
}

/// Ambient light on the front and on the back of every vertex, one list a mesh; 0 to 1.
pub(super) fn ambient(model: &Model, region: Region, fineness: Fineness) -> Vec<Vec<[f32; 2]>> {
    let directions = sphere(fineness.ambient);
    let maps: Vec<DepthMap> = directions.par_iter().map(|d| DepthMap::new(model, region, *d)).collect();
    let sky = |d: &Vector3| NADIR + (1.0 - NADIR) * (d.y + 1.0) / 2.0;
    per_vertex(model, |p, n| {
        let mut sums = [[0.0; 2]; 2];
        for map in &maps {
            let cos = n.dot(&map.towards);
            let side = usize::from(cos < 0.0);
            let light = cos.abs() * map.free(p + n * LIFT.copysign(cos));
            sums[side][0] += light * sky(&map.towards);
            sums[side][1] += cos.abs();
        }
        sums.map(|[light, all]| if all > 0.0 { (light / all) as f32 } else { 1.0 })
    })
}

/// The share of a soft box around the direction `towards` that every vertex sees from its lit face.
pub(super) fn soft_box(model: &Model, region: Region, towards: Vector3, fineness: Fineness) -> Vec<Vec<f32>> {
    let directions = cone(towards, fineness.soft_box);
    let maps: Vec<DepthMap> = directions.par_iter().map(|d| DepthMap::new(model, region, *d)).collect();
    per_vertex(model, |p, n| {
        let lift = n * LIFT.copysign(n.dot(&towards));
        let free: f64 = maps.iter().map(|m| m.free(p + lift)).sum();
        (free / maps.len() as f64) as f32
    })
}

fn per_vertex<T: Send>(model: &Model, f: impl Fn(Point3, Vector3) -> T + Sync) -> Vec<Vec<T>> {
    let mesh = |m: &toile_core::artifact::Mesh| {
        m.positions.par_iter().zip(&m.normals).map(|(p, n)| f(*p, *n)).collect::<Vec<T>>()
    };
    model.meshes.iter().map(mesh).collect()
}

/// Directions spread evenly over the sphere (Fibonacci lattice).
fn sphere(count: usize) -> Vec<Vector3> {
    (0..count)
        .map(|i| {
            let y = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
            let r = (1.0 - y * y).sqrt();
            let (s, c) = (i as f64 * GOLDEN_ANGLE).sin_cos();
            Vector3::new(r * c, y, r * s)
        })
        .collect()
}

/// Directions spread evenly over a cone.
fn cone(axis: Vector3, count: usize) -> Vec<Vector3> {
    let (u, v) = tangents(axis);
    (0..count)
        .map(|i| {
            let r = BOX_SPREAD * ((i as f64 + 0.5) / count as f64).sqrt();
            let (s, c) = (i as f64 * GOLDEN_ANGLE).sin_cos();
            (axis + (u * c + v * s) * r).normalize()
        })
        .collect()
}

/// The angle between neighbours on a sunflower's spiral, radians.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Two unit vectors across a unit vector.
fn tangents(n: Vector3) -> (Vector3, Vector3) {
    let least = if n.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let u = n.cross(&least).normalize();
    (u, n.cross(&u))
}

/// What a distant light sees: for every pixel the height of the nearest surface towards it.
struct DepthMap {
    towards: Vector3,
    u: Vector3,
    v: Vector3,
    centre: Point3,
    scale: f64,
    nearest: Vec<f32>,
}

impl DepthMap {
    fn new(model: &Model, region: Region, towards: Vector3) -> DepthMap {
        let (u, v) = tangents(towards);
        let scale = MAP_PX as f64 / (2.0 * region.radius);
        let nearest = vec![f32::NEG_INFINITY; MAP_PX * MAP_PX];
        let mut map = DepthMap { towards, u, v, centre: region.centre, scale, nearest };
        for mesh in &model.meshes {
            let placed: Vec<Projected> = mesh.positions.iter().map(|p| map.place(p)).collect();
            for t in &mesh.triangles {
                let corner = |i: u32| placed.get(i as usize).copied();
                let [Some(a), Some(b), Some(c)] = t.map(corner) else { continue };
                if let Some(patch) = Patch::new([a, b, c]) {
                    map.draw(&patch);
                }
            }
        }
        map
    }

    fn draw(&mut self, patch: &Patch) {
        let side = MAP_PX as i64;
        let half = super::cover::STEPS / 2;
        patch.scan(side, 0..side, [half, half], |x, y, near| {
            let cell = &mut self.nearest[y * MAP_PX + x];
            *cell = cell.max(near as f32);
        });
    }

    fn place(&self, p: &Point3) -> Projected {
        let d = p - self.centre;
        let middle = MAP_PX as f64 / 2.0;
        let (x, y) = (middle + self.u.dot(&d) * self.scale, middle + self.v.dot(&d) * self.scale);
        Projected { x, y, near: self.towards.dot(&d), inv_w: 1.0 }
    }

    /// 1 where nothing stands between a point and the light, 0 in shadow, between on its border.
    fn free(&self, p: Point3) -> f64 {
        let at = self.place(&p);
        let (x, y) = (at.x - 0.5, at.y - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let open = |dx: i64, dy: i64| {
            let (x, y) = (x.floor() as i64 + dx, y.floor() as i64 + dy);
            let inside = (0..MAP_PX as i64).contains(&x) && (0..MAP_PX as i64).contains(&y);
            let lit = !inside || f64::from(self.nearest[y as usize * MAP_PX + x as usize]) < at.near + BIAS;
            f64::from(u8::from(lit))
        };
        let row = |dy: i64| open(0, dy) * (1.0 - fx) + open(1, dy) * fx;
        row(0) * (1.0 - fy) + row(1) * fy
    }
}
