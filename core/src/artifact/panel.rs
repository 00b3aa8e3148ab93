//! A meshed piece of flat cloth.

use super::{Artifact, ArtifactType, InnerKind, Kind, Measures, Point2, polygon_area};
use crate::artifact::store::sound::{alike, ensure, finite, finite_figure, indices, length};

/// A named stretch of the panel's boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelEdge {
    /// The outline edge's name.
    pub name: String,
    /// Vertices from its start to its end, both included, counter-clockwise.
    pub vertices: Vec<u32>,
}

/// An inner line as a chain of mesh edges.
#[derive(Debug, Clone, PartialEq)]
pub struct InnerChain {
    /// The inner line's name.
    pub name: String,
    /// Its purpose.
    pub kind: InnerKind,
    /// Vertices from its start to its end.
    pub vertices: Vec<u32>,
}

/// A triangle mesh in the plane, counter-clockwise triangles; metres; the grain (warp) runs
/// along y, the weft along x.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Vertices, metres.
    pub positions: Vec<Point2>,
    /// Counter-clockwise triangles.
    pub triangles: Vec<[u32; 3]>,
    /// The outer boundary, counter-clockwise, not repeating its first vertex.
    pub boundary: Vec<u32>,
    /// Boundaries of holes, clockwise.
    pub holes: Vec<Vec<u32>>,
    /// Named edges, counter-clockwise.
    pub edges: Vec<PanelEdge>,
    /// Darts, pleats, folds on mesh edges.
    pub inner: Vec<InnerChain>,
    /// Pixel coordinates of every vertex in the panel's photo; empty where there is none.
    pub photo_px: Vec<Point2>,
    /// Area of the true outline, square metres, against which the mesh is judged.
    pub outline_area: f64,
    /// Length of the true outer outline, metres.
    pub outline_length: f64,
}

impl Panel {
    /// Area of the mesh, square metres.
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|t| self.triangle_area(*t)).sum()
    }

    /// Signed area of a triangle.
    pub fn triangle_area(&self, t: [u32; 3]) -> f64 {
        let [a, b, c] = t.map(|i| self.positions[i as usize]);
        (b - a).perp(&(c - a)) / 2.0
    }

    /// Length of the outer boundary, metres.
    pub fn boundary_length(&self) -> f64 {
        let n = self.boundary.len();
        let at = |k: usize| self.positions[self.boundary[k % n] as usize];
        (0..n).map(|k| (at(k + 1) - at(k)).norm()).sum()
    }

    /// The least angle of any triangle, degrees; 180 for an empty mesh.
    pub fn least_angle(&self) -> f64 {
        self.triangles.iter().map(|t| self.triangle_least_angle(*t)).fold(180.0, f64::min)
    }

    /// The least angle of one triangle, degrees.
    pub fn triangle_least_angle(&self, t: [u32; 3]) -> f64 {
        let p = t.map(|i| self.positions[i as usize]);
        (0..3)
            .map(|k| {
                let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                u.perp(&v).abs().atan2(u.dot(&v)).to_degrees()
            })
            .fold(180.0, f64::min)
    }

    /// Root mean square of the edges' lengths, each counted for each of its triangles, metres; 0
    /// for an empty mesh.
    pub fn edge_rms(&self) -> f64 {
        let square = |t: &[u32; 3]| -> f64 {
            let p = t.map(|i| self.positions[i as usize]);
            (0..3).map(|k| (p[(k + 1) % 3] - p[k]).norm_squared()).sum()
        };
        let sum: f64 = self.triangles.iter().map(square).sum();
        (sum / (3 * self.triangles.len()).max(1) as f64).sqrt()
    }

    /// The edge of that name.
    pub fn edge(&self, name: &str) -> Option<&PanelEdge> {
        self.edges.iter().find(|e| e.name == name)
    }

    /// No triangle lies with its back up. One without area lies neither way, and rounding may turn
    /// it.
    fn check_sides(&self) -> Result<(), String> {
        let turned = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| self.positions[i as usize]);
            let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
            self.triangle_area(*t) < -1e-9 * longest
        };
        match self.triangles.iter().position(turned) {
            Some(i) => Err(format!("triangle {i} is turned over: its vertices run clockwise")),
            None => match alike(&self.triangles) {
                Some(([one, other], what)) => Err(format!("triangles {one} and {other} {what}")),
                None => Ok(()),
            },
        }
    }

    fn bounds(&self) -> (Point2, Point2) {
        let mut lo = Point2::new(f64::INFINITY, f64::INFINITY);
        let mut hi = -lo;
        for p in &self.positions {
            lo = lo.inf(p);
            hi = hi.sup(p);
        }
        (lo, hi)
    }
}

impl ArtifactType for Panel {
    const KIND: Kind = Kind("panel");
    const IN_SETS: bool = true;
}

impl Artifact for Panel {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let (lo, hi) = self.bounds();
        let outline: Vec<Point2> = self.boundary.iter().map(|&i| self.positions[i as usize]).collect();
        let n = self.triangles.len();
        let mut m = Measures::new();
        // A mesh may gain or lose a few triangles when the outline moves by a tenth of a
        // millimetre.
        m.push("vertices", self.positions.len() as f64, "", 0.01 * self.positions.len() as f64);
        m.push("triangles", n as f64, "", 0.01 * n as f64);
        m.push("area", self.area() * 1e4, "cm2", 1.0);
        m.push("boundary_area", polygon_area(&outline) * 1e4, "cm2", 1.0);
        m.push("perimeter", self.boundary_length() * 1e2, "cm", 0.2);
        m.push("box_width", (hi.x - lo.x) * 1e3, "mm", 0.5);
        m.push("box_height", (hi.y - lo.y) * 1e3, "mm", 0.5);
        m.count("boundary_loops", 1 + self.holes.len());
        m.push("least_angle", self.least_angle(), "deg", 2.0);
        // How the vertices lie within the outline, which the other measures hardly show: a mesher's
        // or a smoother's own work.
        m.push("edge_rms", self.edge_rms() * 1e3, "mm", 0.001);
        m
    }

    fn check(&self) -> Result<(), String> {
        let n = self.positions.len();
        finite("vertex", self.positions.iter().map(|p| &p.coords))?;
        indices("a triangle", n, self.triangles.iter().flatten())?;
        self.check_sides()?;
        ensure(self.triangles.is_empty() || self.boundary.len() >= 3, || {
            format!("its boundary has {} vertices", self.boundary.len())
        })?;
        indices("the boundary", n, self.boundary.iter().chain(self.holes.iter().flatten()))?;
        let short = self.edges.iter().find(|e| e.vertices.len() < 2);
        ensure(short.is_none(), || "a named edge has fewer than two vertices".to_owned())?;
        indices("an edge", n, self.edges.iter().flat_map(|e| &e.vertices))?;
        indices("an inner line", n, self.inner.iter().flat_map(|c| &c.vertices))?;
        if !self.photo_px.is_empty() {
            length("photo pixels", self.photo_px.len(), n)?;
            finite("photo pixel", self.photo_px.iter().map(|p| &p.coords))?;
        }
        finite_figure("outline's area", self.outline_area)?;
        finite_figure("outline's length", self.outline_length)
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        use std::fmt::Write;
        let mut s = String::from("# a flat panel, metres\n");
        for p in &self.positions {
            let _ = writeln!(s, "v {} {} 0", p.x, p.y);
        }
        for t in &self.triangles {
            let _ = writeln!(s, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
        }
        vec![("obj", s.into_bytes())]
    }
}
