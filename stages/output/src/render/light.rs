//! A soft studio light: how much of it reaches every vertex.
//!
//! Each light is a bundle of directions. For each direction the model is drawn into a depth map
//! (Williams, 1978) and every vertex asks whether something stands before it; the share of free
//! directions, weighted by the cosine, is what the light gives: ambient occlusion for a whole
//! sphere of directions, a soft shadow for a narrow cone. So folds and the inside of a hem darken
//! without any noise, and the ambient part serves every view.
//!
//! Cost: one depth-only drawing of the model a direction, one lookup a vertex and direction.
//! Limits: light varies linearly over a triangle; details below [`MAP_PX`]'s resolution are lost.

use super::camera::Projected;
use super::cover::{CoveredTriangle, below};
use rayon::prelude::*;
use toile_core::Cancel;
use toile_core::artifact::{Mesh, Model, Point3, Vector3};

/// Side of a depth map, px: a trade of sharp shadows for time. About 3 mm a pixel on a torso.
const MAP_PX: usize = 384;
/// How finely light is worked out: a trade of smoothness for time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fineness {
    /// Directions of the ambient sphere.
    pub(super) ambient: usize,
    /// Directions of a soft box.
    pub(super) soft_box: usize,
}

/// For finished pictures: no direction shows by itself.
pub(super) const FINE: Fineness = Fineness { ambient: 64, soft_box: 16 };
/// For small pictures: almost three times as fast.
pub(super) const DRAFT: Fineness = Fineness { ambient: 24, soft_box: 6 };

/// For thumbnails.
pub(super) const SKETCH: Fineness = Fineness { ambient: 12, soft_box: 3 };

/// Half angle of the soft box as its sine: the width of its shadows' edges.
const BOX_SPREAD: f64 = 0.22;
/// A vertex looks from this far in front of its face, metres: past the depth map's steps.
const LIFT: f64 = 0.006;
/// Something must be nearer to the light by this to shade, metres.
const BIAS: f64 = 0.004;
/// Around the garment's box, metres: what lies beyond casts no shadow on it worth the resolution.
const REACH: f64 = 0.25;
/// What stands before the sky gives this share of its light back: the inside of a garment is dim,
/// not black.
const BOUNCE: f64 = 0.3;
/// The sky's light at the nadir against that at the zenith: floor and walls give light back.
const NADIR: f64 = 0.45;

/// The garment's neighbourhood in which shadows are looked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShadowRegion {
    centre: Point3,
    radius: f64,
}

impl ShadowRegion {
    /// Around a model's framed part: least and greatest corner.
    pub(super) fn new(lo: Point3, hi: Point3) -> ShadowRegion {
        ShadowRegion { centre: nalgebra::center(&lo, &hi), radius: (hi - lo).norm() / 2.0 + REACH }
    }
}

/// The studio's light from a direction: bright above, dimmer from the floor.
pub(super) fn studio(d: &Vector3) -> f64 {
    NADIR + (1.0 - NADIR) * (d.y + 1.0) / 2.0
}

/// Ambient light on the front and on the back of every vertex, one list a mesh, where so much comes
/// from each direction; once it is to stop, what has been gathered.
pub(super) fn ambient(
    model: &Model,
    region: ShadowRegion,
    fineness: Fineness,
    sky: impl Fn(&Vector3) -> f64 + Sync,
    stop: &Cancel,
) -> Vec<Vec<[f32; 2]>> {
    let sums = gather(model, region, &sphere(fineness.ambient), stop, |map, p, n| {
        let cos = n.dot(&map.towards);
        let free = BOUNCE + (1.0 - BOUNCE) * map.free(p + n * LIFT.copysign(cos));
        let light = cos.abs() * sky(&map.towards) * free;
        if cos < 0.0 { [0.0, 0.0, light, -cos] } else { [light, cos, 0.0, 0.0] }
    });
    let share = |light: f64, all: f64| if all > 0.0 { (light / all) as f32 } else { 1.0 };
    each_vertex(sums, |s| [share(s[0], s[1]), share(s[2], s[3])])
}

/// The share of a soft box around the direction `towards` that every vertex sees from its lit face;
/// once it is to stop, what has been gathered.
pub(super) fn soft_box(
    model: &Model,
    region: ShadowRegion,
    towards: Vector3,
    fineness: Fineness,
    stop: &Cancel,
) -> Vec<Vec<f32>> {
    let sums = gather(model, region, &cone(towards, fineness.soft_box), stop, |map, p, n| {
        [map.free(p + n * LIFT.copysign(n.dot(&towards))), 1.0]
    });
    each_vertex(sums, |s| (s[0] / s[1]) as f32)
}

/// Tasks into which directions are shared out. A fixed number, whatever the threads, so that sums
/// are always made in the same order.
const TASKS: usize = 8;

/// One value for every vertex of every mesh.
type PerVertex<T> = Vec<Vec<T>>;

/// For every vertex the sum over all directions of `light(map, position, normal)`; over fewer once
/// it is to stop.
fn gather<const N: usize>(
    model: &Model,
    region: ShadowRegion,
    directions: &[Vector3],
    stop: &Cancel,
    light: impl Fn(&ShadowMap, Point3, Vector3) -> [f64; N] + Sync,
) -> PerVertex<[f64; N]> {
    let triangles = near_triangles(model, region);
    let zero = || -> PerVertex<[f64; N]> {
        model.meshes.iter().map(|m| vec![[0.0; N]; m.positions.len().min(m.normals.len())]).collect()
    };
    let task = |directions: &[Vector3]| {
        let mut sums = zero();
        for direction in directions.iter().take_while(|_| !stop.is_cancelled()) {
            let map = ShadowMap::new(model, &triangles, region, *direction);
            for (mesh, sums) in model.meshes.iter().zip(&mut sums) {
                for ((p, n), sum) in mesh.positions.iter().zip(&mesh.normals).zip(sums) {
                    add(sum, &light(&map, *p, *n));
                }
            }
        }
        sums
    };
    let size = directions.len().div_ceil(TASKS).max(1);
    let parts: Vec<PerVertex<[f64; N]>> = directions.par_chunks(size).map(task).collect();
    parts.into_iter().fold(zero(), |mut all, part| {
        all.iter_mut().flatten().zip(part.iter().flatten()).for_each(|(sum, part)| add(sum, part));
        all
    })
}

fn add<const N: usize>(sum: &mut [f64; N], part: &[f64; N]) {
    sum.iter_mut().zip(part).for_each(|(s, p)| *s += p);
}

fn each_vertex<A, B>(sums: PerVertex<A>, f: impl Fn(A) -> B + Copy) -> PerVertex<B> {
    sums.into_iter().map(|mesh| mesh.into_iter().map(f).collect()).collect()
}

/// The triangles of each mesh that can cast a shadow in the region.
fn near_triangles(model: &Model, region: ShadowRegion) -> PerVertex<[usize; 3]> {
    let mesh = |m: &Mesh| {
        let near: Vec<bool> =
            m.positions.iter().map(|p| (p - region.centre).norm() <= region.radius).collect();
        let touches = |t: &[usize; 3]| t.iter().all(|&i| i < near.len()) && t.iter().any(|&i| near[i]);
        m.triangles.iter().map(|t| t.map(|i| i as usize)).filter(touches).collect()
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
struct ShadowMap {
    towards: Vector3,
    u: Vector3,
    v: Vector3,
    centre: Point3,
    scale: f64,
    nearest: Vec<f32>,
}

impl ShadowMap {
    fn new(
        model: &Model,
        triangles: &[Vec<[usize; 3]>],
        region: ShadowRegion,
        towards: Vector3,
    ) -> ShadowMap {
        let (u, v) = tangents(towards);
        let scale = MAP_PX as f64 / (2.0 * region.radius);
        let nearest = vec![f32::NEG_INFINITY; MAP_PX * MAP_PX];
        let mut map = ShadowMap { towards, u, v, centre: region.centre, scale, nearest };
        for (mesh, triangles) in model.meshes.iter().zip(triangles) {
            // What is closed hides its far side by its near side, so half of its triangles will do.
            let closed = model.materials.get(mesh.material).is_some_and(|m| !m.double_sided);
            let placed: Vec<Projected> = mesh.positions.iter().map(|p| map.place(p)).collect();
            for t in triangles {
                let Some(patch) = CoveredTriangle::new(t.map(|i| placed[i])) else { continue };
                let turned_away = patch.order == [0, 2, 1];
                if !(closed && turned_away) {
                    map.draw(&patch);
                }
            }
        }
        map
    }

    fn draw(&mut self, patch: &CoveredTriangle) {
        let side = MAP_PX as i64;
        let half = super::cover::STEPS / 2;
        patch.scan(side, 0..side, &[[half, half]], |_, x, y, near| {
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
        let (left, top) = (below(x), below(y));
        let (fx, fy) = (x - left as f64, y - top as f64);
        let open = |dx: i64, dy: i64| {
            let (x, y) = (left + dx, top + dy);
            let inside = (0..MAP_PX as i64).contains(&x) && (0..MAP_PX as i64).contains(&y);
            let lit = !inside || f64::from(self.nearest[y as usize * MAP_PX + x as usize]) < at.near + BIAS;
            f64::from(u8::from(lit))
        };
        let row = |dy: i64| open(0, dy) * (1.0 - fx) + open(1, dy) * fx;
        row(0) * (1.0 - fy) + row(1) * fy
    }
}
