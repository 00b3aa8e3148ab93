//! Meshes of a rectangle for the tests: two kinds of grid, equilateral rows, and an irregular
//! Delaunay mesh.

use nalgebra::Vector2;
use spade::{DelaunayTriangulation, Point2, Triangulation};

use super::Model;
use crate::error::ClothError;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use crate::scene::Scene;
use toile_geometry::Vec3;

/// Rounds of moving irregular points to the middle of their surroundings.
const SMOOTHING: usize = 40;

/// How a rectangle is cut into triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// Squares, every diagonal the same way.
    OneDiagonal,
    /// Squares, diagonals alternating.
    Alternating,
    /// Rows of equilateral triangles.
    Equilateral,
    /// Random points, smoothed, Delaunay; by seed.
    Irregular(u64),
}

impl Layout {
    /// The four layouts of the tests.
    pub const ALL: [Self; 4] = [Self::OneDiagonal, Self::Alternating, Self::Equilateral, Self::Irregular(1)];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::OneDiagonal => "one diagonal",
            Self::Alternating => "alternating",
            Self::Equilateral => "equilateral",
            Self::Irregular(_) => "irregular",
        }
    }

    /// The name, with the seed of an irregular mesh.
    #[must_use]
    pub fn label(self) -> String {
        match self {
            Self::Irregular(seed) => format!("irregular {seed}"),
            _ => self.name().into(),
        }
    }

    /// Whether garments are cut into such meshes: hinges cannot be right on grids, so limits bind
    /// on these only.
    #[must_use]
    pub fn is_for_garments(self) -> bool {
        matches!(self, Self::Equilateral | Self::Irregular(_))
    }
}

/// A meshed rectangle.
#[derive(Debug, Clone)]
pub struct Rectangle {
    /// Rest coordinates, m: 0..width by 0..length.
    pub uv: Vec<Vector2<f64>>,
    /// Counter-clockwise triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Extent in x and y, m.
    pub size: Vector2<f64>,
}

impl Rectangle {
    /// Meshes `width` x `length` with edges of about `length / along`.
    #[must_use]
    pub fn new(layout: Layout, width: f64, length: f64, along: usize) -> Self {
        let size = Vector2::new(width, length);
        let across = ((width * along as f64 / length).round() as usize).max(1);
        let (uv, triangles) = match layout {
            Layout::OneDiagonal => grid(size, across, along, |_, _| true),
            Layout::Alternating => grid(size, across, along, |i, j| (i + j) % 2 == 0),
            Layout::Equilateral => equilateral(size, across, along),
            Layout::Irregular(seed) => irregular(size, across, along, seed),
        };
        Self { uv, triangles, size }
    }

    /// As a sheet of this density.
    ///
    /// # Errors
    /// See [`Sheet::flat`].
    pub fn sheet(&self, density: f64) -> Result<Sheet, ClothError> {
        Sheet::flat(&self.uv, &self.triangles, density)
    }

    /// As a scene without body and without self-contact, with the pins and the gravity of a model.
    #[must_use]
    pub fn scene(&self, fabric: &Fabric, model: &Model, start: &[Vec3]) -> Scene {
        let mut scene = Scene::new("rectangle", fabric.clone());
        scene.add_panel("sheet", &self.uv, start, &self.triangles);
        scene.pinned = (0..start.len() as u32).filter(|&v| model.fixed[v as usize]).collect();
        scene.phases.iter_mut().for_each(|p| p.gravity = model.gravity);
        scene.self_collision = false;
        scene
    }

    /// Whether vertex `v` lies on the lower (y = 0) edge.
    #[must_use]
    pub fn at_bottom(&self, v: usize) -> bool {
        self.uv[v].y < 1e-9 * self.size.y
    }

    /// Whether vertex `v` lies on the upper edge.
    #[must_use]
    pub fn at_top(&self, v: usize) -> bool {
        self.uv[v].y > self.size.y * (1.0 - 1e-9)
    }

    /// Whether vertex `v` lies on any edge.
    #[must_use]
    pub fn on_border(&self, v: usize) -> bool {
        let x = self.uv[v].x;
        self.at_bottom(v) || self.at_top(v) || x < 1e-9 * self.size.x || x > self.size.x * (1.0 - 1e-9)
    }
}

/// A disc of this radius about the origin in rings, ring k of 6 k vertices on the k-th multiple of
/// `radius / rings`.
#[must_use]
pub fn disc(radius: f64, rings: usize) -> (Vec<Vector2<f64>>, Vec<[u32; 3]>) {
    let mut uv = vec![Vector2::zeros()];
    for ring in 1..=rings {
        let (r, count) = (radius * ring as f64 / rings as f64, 6 * ring);
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
        uv.extend((0..count).map(|k| Vector2::new(r * angle(k).cos(), r * angle(k).sin())));
    }
    let triangles = delaunay(&uv);
    (uv, triangles)
}

type FlatMesh = (Vec<Vector2<f64>>, Vec<[u32; 3]>);

fn grid(size: Vector2<f64>, nx: usize, ny: usize, rising: impl Fn(usize, usize) -> bool) -> FlatMesh {
    let at = |i: usize, j: usize| Vector2::new(size.x * i as f64 / nx as f64, size.y * j as f64 / ny as f64);
    let uv = (0..=ny).flat_map(|j| (0..=nx).map(move |i| (i, j))).map(|(i, j)| at(i, j)).collect();
    let mut triangles = Vec::with_capacity(2 * nx * ny);
    for (j, i) in (0..ny).flat_map(|j| (0..nx).map(move |i| (j, i))) {
        let a = (j * (nx + 1) + i) as u32;
        let [b, c, d] = [a + 1, a + nx as u32 + 2, a + nx as u32 + 1];
        triangles.extend(if rising(i, j) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
    (uv, triangles)
}

fn equilateral(size: Vector2<f64>, nx: usize, ny: usize) -> FlatMesh {
    let (nx, rows) = nearly_equilateral(size, nx, ny);
    let step = size.x / nx as f64;
    let mut uv = Vec::new();
    for j in 0..=rows {
        let y = size.y * j as f64 / rows as f64;
        if j % 2 == 0 {
            uv.extend((0..=nx).map(|i| Vector2::new(step * i as f64, y)));
        } else {
            uv.push(Vector2::new(0.0, y));
            uv.extend((0..nx).map(|i| Vector2::new(step * (i as f64 + 0.5), y)));
            uv.push(Vector2::new(size.x, y));
        }
    }
    let triangles = delaunay(&uv);
    (uv, triangles)
}

/// About `nx` columns, a little more rather than less, and an even number of rows whose triangles
/// are closest to equilateral.
fn nearly_equilateral(size: Vector2<f64>, nx: usize, ny: usize) -> (usize, usize) {
    let misfit = |n: usize| {
        let wanted = size.y / (size.x / n as f64 * 0.75_f64.sqrt());
        let rows = 2 * ((0.5 * wanted).round() as usize).max(1);
        ((wanted / rows as f64).ln().abs(), n, rows)
    };
    let nominal = nx.max(1).min(8 * ny);
    let near = (nominal - (nominal / 20).max(1)).max(1)..=nominal + (nominal / 10).max(1);
    near.map(misfit).min_by(|a, b| a.0.total_cmp(&b.0)).map_or((nominal, 2 * ny), |m| (m.1, m.2))
}

fn irregular(size: Vector2<f64>, nx: usize, ny: usize, seed: u64) -> FlatMesh {
    let mut uv: Vec<Vector2<f64>> = Vec::new();
    for i in 0..nx {
        let t = size.x * i as f64 / nx as f64;
        uv.extend([Vector2::new(t, 0.0), Vector2::new(size.x - t, size.y)]);
    }
    for j in 0..ny {
        let t = size.y * j as f64 / ny as f64;
        uv.extend([Vector2::new(size.x, t), Vector2::new(0.0, size.y - t)]);
    }
    let held = uv.len();
    let wanted = (1.155 * (nx * ny) as f64) as usize;
    let inset = Vector2::new(0.5 * size.x / nx as f64, 0.5 * size.y / ny as f64);
    let mut random = Random(seed);
    for _ in 0..wanted.saturating_sub(held / 2) {
        let r = Vector2::new(random.next(), random.next());
        uv.push(inset + r.component_mul(&(size - 2.0 * inset)));
    }
    for _ in 0..SMOOTHING {
        let triangles = delaunay(&uv);
        let (mut sum, mut weight) = (vec![Vector2::zeros(); uv.len()], vec![0.0; uv.len()]);
        for t in &triangles {
            let [a, b, c] = t.map(|v| uv[v as usize]);
            let area = (b - a).perp(&(c - a));
            for &v in t {
                sum[v as usize] += (a + b + c) * (area / 3.0);
                weight[v as usize] += area;
            }
        }
        (held..uv.len()).for_each(|v| uv[v] = sum[v] / weight[v]);
    }
    let triangles = delaunay(&uv);
    (uv, triangles)
}

/// Delaunay triangles of points in convex position overall; flat slivers along the border are left
/// out.
fn delaunay(uv: &[Vector2<f64>]) -> Vec<[u32; 3]> {
    let points: Vec<Point2<f64>> = uv.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let Ok(mesh) = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(points) else { return Vec::new() };
    let corners = |f: spade::handles::FaceHandle<'_, spade::handles::InnerTag, _, _, _, _>| {
        f.vertices().map(|v| v.index() as u32)
    };
    let mut triangles: Vec<[u32; 3]> = mesh.inner_faces().map(corners).collect();
    triangles.retain(|t| crate::mesh::quality(&t.map(|v| uv[v as usize])) > 1e-6);
    triangles.sort_unstable();
    triangles
}

/// SplitMix64: the same numbers everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
