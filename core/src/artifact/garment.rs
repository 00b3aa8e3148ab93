//! Panels in space, sewn or about to be.

mod motion;

use super::body::{obj_text, vertex_normals};
use super::{Artifact, ArtifactType, Fabric, Kind, Measures, Point2, Point3, SeamKind, Vector3};
use crate::artifact::store::sound::{alike, ensure, finite, indices, length};
pub use motion::RecordedMotion;
use std::ops::Range;
use std::sync::Arc;

/// One panel's share of the garment's vertices and triangles.
#[derive(Debug, Clone)]
pub struct GarmentPanel {
    /// The panel's name; its photo has the same.
    pub name: String,
    /// Its vertices.
    pub vertices: Range<usize>,
    /// Its triangles.
    pub triangles: Range<usize>,
    /// Its boundary, counter-clockwise in the pattern, as garment vertices.
    pub boundary: Vec<u32>,
    /// Pixel coordinates in its photo, one for each of its vertices; empty without a photo.
    pub photo_px: Vec<Point2>,
    /// What it is made of.
    pub fabric: Arc<Fabric>,
    /// Panels of a higher layer are worn outside those of a lower one.
    pub layer: u32,
}

/// How far a seam has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeamState {
    /// Panels apart.
    Open,
    /// Every pair joined into one.
    Closed,
}

/// A seam as vertex pairs.
#[derive(Debug, Clone)]
pub struct GarmentSeam {
    /// Its name, `front.hem + back.hem`.
    pub name: String,
    /// How its sides meet.
    pub kind: SeamKind,
    /// Vertices that end up in one place.
    pub pairs: Vec<[u32; 2]>,
    /// Open or closed.
    pub state: SeamState,
}

/// How friction holds a garment at rest, as the solver left it: another run goes on from it without
/// a slide. Empty where nothing is known.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Held {
    /// How far friction holds each vertex back on the body, metres.
    pub slides: Vec<Vector3>,
    /// Distance at which the body begins to press on each vertex, metres; empty without a body.
    pub offsets: Vec<f64>,
    /// Angles at which friction between yarns holds the folds; empty where there is no such
    /// friction.
    pub folds: Vec<f64>,
    /// The points that meet where cloth lies on cloth.
    pub contacts: Vec<[u32; 4]>,
    /// The solver's own numbers of those contacts, as many for each.
    pub figures: Vec<f64>,
}

/// What the last solver says of its result.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SolveStatus {
    /// Solver steps so far, all solvers together.
    pub steps: usize,
    /// True where every stop rule of the last solver was met.
    pub converged: bool,
    /// Elastic and gravitational energy, J.
    pub energy: f64,
    /// Greatest speed of a vertex at the end, m/s; of a solver that waits for rest, by its way over
    /// the solver's last look.
    pub max_speed: f64,
    /// For each panel the share of it that is still in its place on the body, after all solvers: 1
    /// minus the mean way down of all that it is sewn to, as a share of the height of its tallest
    /// piece. Empty where it was not measured: no body, no weight.
    pub on_body: Vec<f64>,
    /// How friction holds it, for a solver that goes on from there.
    pub held: Held,
}

/// Other places from which the panels of a garment may be sewn.
#[derive(Debug, Clone, PartialEq)]
pub struct GarmentStart {
    /// How this garment was sewn differently, in words that complete "sewn ...": `with the legs
    /// where the file puts them`.
    pub told: String,
    /// Positions of all vertices, metres.
    pub positions: Vec<Point3>,
}

/// Panels lifted into space with their seams.
///
/// Each panel keeps its own vertices, so that rest positions and photo pixels stay one per vertex;
/// vertices that are joined share one position and one representative in `weld`. The default has no
/// panel.
#[derive(Debug, Clone, Default)]
pub struct Garment {
    /// Positions, metres.
    pub positions: Vec<Point3>,
    /// Velocities, m/s.
    pub velocities: Vec<Vector3>,
    /// Flat rest positions, metres, each in its panel's own plane; warp along y, weft along x. All
    /// zero where the flat shape is not known: a garment from a 3D file.
    pub rest: Vec<Point2>,
    /// Triangles, counter-clockwise in `rest` and from outside the wearer.
    pub triangles: Vec<[u32; 3]>,
    /// Panels in order of their vertices.
    pub panels: Vec<GarmentPanel>,
    /// Seams.
    pub seams: Vec<GarmentSeam>,
    /// For every vertex the least vertex it is joined to (itself where it is not joined).
    pub weld: Vec<u32>,
    /// Vertices that stay where they are, ascending: a sheet held at its corners.
    pub pinned: Vec<u32>,
    /// What the last solver says.
    pub status: SolveStatus,
    /// Other places from which it may be sewn, where a placement moved pieces by a rule that may be
    /// wrong; a stage that sews or moves the garment leaves none.
    pub starts: Vec<GarmentStart>,
    /// How it moved while solvers stepped in time; nothing where none was asked to record it.
    pub motion: Option<Arc<RecordedMotion>>,
}

impl Garment {
    /// Panels follow each other and cover every vertex and triangle once.
    fn check_panels(&self) -> Result<(), String> {
        let (mut vertices, mut triangles) = (0, 0);
        for panel in &self.panels {
            let follows = panel.vertices.start == vertices && panel.triangles.start == triangles;
            let forward = panel.vertices.end >= vertices && panel.triangles.end >= triangles;
            ensure(follows && forward, || {
                format!("panel \"{}\" does not follow the one before", panel.name)
            })?;
            (vertices, triangles) = (panel.vertices.end, panel.triangles.end);
            let own = |i: &u32| panel.vertices.contains(&(*i as usize));
            let corners = self.triangles[..panel.triangles.end.min(self.triangles.len())].iter();
            let strange =
                corners.skip(panel.triangles.start).flatten().chain(&panel.boundary).find(|&i| !own(i));
            ensure(strange.is_none(), || format!("panel \"{}\" names another panel's vertex", panel.name))?;
            ensure(panel.triangles.is_empty() || panel.boundary.len() >= 3, || {
                format!("the boundary of panel \"{}\" has {} vertices", panel.name, panel.boundary.len())
            })?;
            if !panel.photo_px.is_empty() {
                length("photo pixels", panel.photo_px.len(), panel.vertices.len())?;
                finite("photo pixel", panel.photo_px.iter().map(|p| &p.coords))?;
            }
            self.check_sides(panel)?;
            panel.fabric.check().map_err(|e| format!("the fabric of panel \"{}\": {e}", panel.name))?;
        }
        let all = vertices == self.positions.len() && triangles == self.triangles.len();
        ensure(all, || "some of it belongs to no panel".to_owned())
    }

    /// Two triangles of a panel that share an edge run along it in opposite ways: both have the
    /// same side up.
    fn check_sides(&self, panel: &GarmentPanel) -> Result<(), String> {
        let first = panel.triangles.start;
        match alike(self.triangles.get(panel.triangles.clone()).unwrap_or_default()) {
            None => Ok(()),
            Some(([one, other], what)) => Err(format!(
                "triangles {} and {} of panel \"{}\" {what}",
                first + one,
                first + other,
                panel.name
            )),
        }
    }

    /// The panel that owns a vertex.
    pub fn panel_of(&self, vertex: usize) -> Option<&GarmentPanel> {
        self.panels.iter().find(|p| p.vertices.contains(&vertex))
    }

    /// Greatest distance between the two vertices of any seam pair, metres.
    pub fn seam_gap_max(&self) -> f64 {
        self.seams
            .iter()
            .flat_map(|s| &s.pairs)
            .map(|&[a, b]| (self.positions[a as usize] - self.positions[b as usize]).norm())
            .fold(0.0, f64::max)
    }

    /// Unique mesh edges, each with its lower vertex first, ascending.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let corner = |t: &[u32; 3], k: usize| {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            [a.min(b), a.max(b)]
        };
        let mut edges: Vec<[u32; 2]> =
            self.triangles.iter().flat_map(|t| (0..3).map(move |k| corner(t, k))).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Area-weighted unit vertex normals, one across joined vertices.
    pub fn vertex_normals(&self) -> Vec<Vector3> {
        let welded: Vec<[u32; 3]> = self.triangles.iter().map(|t| t.map(|i| self.weld[i as usize])).collect();
        let shared = vertex_normals(&self.positions, &welded);
        self.weld.iter().map(|&w| shared[w as usize]).collect()
    }
}

/// The value at a share `q` of an ascending list; 0 for an empty one.
pub fn quantile(ascending: &[f64], q: f64) -> f64 {
    let last = ascending.len().saturating_sub(1) as f64;
    ascending.get((q * last).round() as usize).copied().unwrap_or(0.0)
}

impl ArtifactType for Garment {
    const KIND: Kind = Kind("garment");
    const IN_SETS: bool = false;
}

impl Artifact for Garment {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let strains = self.edge_strains();
        let (mut lo, mut hi) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        for p in &self.positions {
            (lo, hi) = (lo.inf(p), hi.sup(p));
        }
        let (n, area) =
            (self.positions.len() as f64, self.panels.iter().map(|p| self.panel_areas(p).1).sum::<f64>());
        let mut m = Measures::new();
        m.push("vertices", n, "", 0.01 * n).push("triangles", self.triangles.len() as f64, "", 0.02 * n);
        m.push("area", area * 1e4, "cm2", 20.0);
        for (axis, (l, h)) in ["x", "y", "z"].into_iter().zip(lo.iter().zip(hi.iter())) {
            m.push(&format!("min_{axis}"), l * 1e3, "mm", 5.0).push(
                &format!("max_{axis}"),
                h * 1e3,
                "mm",
                5.0,
            );
        }
        m.push("seam_gap_max", self.seam_gap_max() * 1e3, "mm", 1.0);
        m.push("strain_p50", quantile(&strains, 0.5) * 1e2, "%", 0.5);
        m.push("strain_p99", quantile(&strains, 0.99) * 1e2, "%", 1.0);
        m.count("open_seams", self.seams.iter().filter(|s| s.state == SeamState::Open).count());
        m
    }

    fn check(&self) -> Result<(), String> {
        let n = self.positions.len();
        length("velocities", self.velocities.len(), n)?;
        length("rest positions", self.rest.len(), n)?;
        length("welds", self.weld.len(), n)?;
        finite("vertex", self.positions.iter().map(|p| &p.coords))?;
        finite("velocity", &self.velocities)?;
        finite("rest position", self.rest.iter().map(|p| &p.coords))?;
        indices("a triangle", n, self.triangles.iter().flatten())?;
        indices("a seam", n, self.seams.iter().flat_map(|s| s.pairs.iter().flatten()))?;
        self.seams.iter().try_for_each(|s| s.kind.check())?;
        for start in &self.starts {
            length("positions of another start", start.positions.len(), n)?;
            finite("vertex of another start", start.positions.iter().map(|p| &p.coords))?;
        }
        if let Some(motion) = &self.motion {
            motion.check()?;
        }
        indices("a weld", n, self.weld.iter())?;
        indices("a pin", n, self.pinned.iter())?;
        let least = |(i, &w): (usize, &u32)| w as usize <= i && self.weld[w as usize] == w;
        let Held { slides, offsets, .. } = &self.status.held;
        if !slides.is_empty() {
            length("ways slid", slides.len(), n)?;
            finite("way slid", slides)?;
        }
        if !offsets.is_empty() {
            length("distances from the body", offsets.len(), n)?;
        }
        let joined = self.weld.iter().enumerate().all(least);
        ensure(joined, || "a weld is not the least vertex that it is joined to".to_owned())?;
        self.check_panels()
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        vec![("obj", obj_text(&self.positions, &self.triangles))]
    }
}
