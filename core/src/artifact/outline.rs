//! The closed curves that bound a piece of cloth.

use nalgebra::Rotation2;

use super::{
    Artifact, ArtifactType, EdgeRole, Gauge, Hand, Kind, Measures, Point2, polygon_area, polyline_length,
};
use crate::artifact::store::sound::{ensure, finite, positive};

/// A closed polygon, not repeating its first point. The outer loop runs counter-clockwise, holes
/// clockwise (y up).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Loop {
    /// Vertices, metres.
    pub points: Vec<Point2>,
    /// Indices into `points` of the corners, ascending.
    pub corners: Vec<usize>,
}

/// A named stretch of the outer loop, from one corner to the next, counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// A tailor's word: `neck`, `shoulder_left`, `armhole_left`, `side_left`, `hem`, ...
    /// Left and right are the wearer's.
    pub name: String,
    /// Index of its first point in the outer loop.
    pub start: usize,
    /// Index of its last point in the outer loop (that of the next edge's first).
    pub end: usize,
    /// Divisions agreed with the edge it is sewn to.
    pub gauge: Gauge,
}

/// What an inner line is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InnerKind {
    /// A leg of a dart: sewn to its other leg.
    Dart,
    /// A pleat line.
    Pleat,
    /// A fold line.
    Fold,
    /// Where another piece is sewn on.
    Placement,
}

/// A line inside the panel that must lie on mesh edges.
#[derive(Debug, Clone, PartialEq)]
pub struct InnerLine {
    /// Name, for seams.
    pub name: String,
    /// Purpose.
    pub kind: InnerKind,
    /// Vertices from its start, metres.
    pub points: Vec<Point2>,
    /// Divisions agreed with the edge or line it is sewn to; none where it is not sewn, or its
    /// partner is known by its place.
    pub gauge: Option<Gauge>,
}

/// How pattern coordinates map to the photo: turned, then `px = origin + (x, -y) * px_per_metre`, x
/// mirrored where the photo is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhotoFrame {
    /// Pixel coordinates of the pattern's origin.
    pub origin_px: Point2,
    /// Pixels per metre.
    pub px_per_metre: f64,
    /// True where the pattern is the mirror image of the photo.
    pub mirrored: bool,
    /// How far the pattern lies turned in its photo, counter-clockwise, radians; before it is
    /// mirrored.
    pub turn: f64,
}

impl PhotoFrame {
    /// The pixel under a pattern point.
    pub fn to_px(&self, p: Point2) -> Point2 {
        let sign = if self.mirrored { -1.0 } else { 1.0 };
        let p = Rotation2::new(self.turn) * p;
        Point2::new(
            self.origin_px.x + sign * p.x * self.px_per_metre,
            self.origin_px.y - p.y * self.px_per_metre,
        )
    }

    /// The same frame in pixels each of which joins `n` x `n` of these.
    pub fn joined(self, n: u32) -> PhotoFrame {
        if n <= 1 {
            return self;
        }
        let n = f64::from(n);
        let to = |x: f64| (x + 0.5) / n - 0.5;
        PhotoFrame { origin_px: self.origin_px.map(to), px_per_metre: self.px_per_metre / n, ..self }
    }

    /// The same frame in pixels of which `n` x `n` were joined into each of these.
    pub fn parted(self, n: u32) -> PhotoFrame {
        if n <= 1 {
            return self;
        }
        let n = f64::from(n);
        let to = |x: f64| (x + 0.5) * n - 0.5;
        PhotoFrame { origin_px: self.origin_px.map(to), px_per_metre: self.px_per_metre * n, ..self }
    }

    /// The pattern point over a pixel.
    pub fn to_metres(&self, px: Point2) -> Point2 {
        let sign = if self.mirrored { -1.0 } else { 1.0 };
        let turned = Point2::new(
            sign * (px.x - self.origin_px.x) / self.px_per_metre,
            (self.origin_px.y - px.y) / self.px_per_metre,
        );
        Rotation2::new(-self.turn) * turned
    }
}

/// The outline of one panel: outer loop, holes, named edges and inner lines; metres, y up, as seen
/// from outside the wearer.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// The outer boundary, counter-clockwise.
    pub outer: Loop,
    /// Holes, clockwise.
    pub holes: Vec<Loop>,
    /// Named edges, counter-clockwise, covering the outer loop. Empty until a style names them.
    pub edges: Vec<Edge>,
    /// Darts, pleats, folds, lines where other pieces are sewn on.
    pub inner: Vec<InnerLine>,
    /// Where the outline lies in its photo.
    pub frame: Option<PhotoFrame>,
    /// Where each point of `outer` lies in the coordinates of `frame`, metres, for a piece that was
    /// straightened; empty where the photo shows the outline as it is.
    pub lies: Vec<Point2>,
}

impl Outline {
    /// Enclosed area without the holes, square metres.
    pub fn area(&self) -> f64 {
        let holes: f64 = self.holes.iter().map(|h| polygon_area(&h.points).abs()).sum();
        polygon_area(&self.outer.points).abs() - holes
    }

    /// Length of the outer loop, metres.
    pub fn perimeter(&self) -> f64 {
        let p = &self.outer.points;
        let closing = match (p.first(), p.last()) {
            (Some(a), Some(b)) => (a - b).norm(),
            _ => 0.0,
        };
        polyline_length(p) + closing
    }

    /// The points of a named edge, both ends included.
    pub fn edge_points(&self, edge: &Edge) -> Vec<Point2> {
        let n = self.outer.points.len();
        let count = (edge.end + n - edge.start - 1) % n + 1;
        (0..=count).map(|k| self.outer.points[(edge.start + k) % n]).collect()
    }

    /// The edge of that name.
    pub fn edge(&self, name: &str) -> Option<&Edge> {
        self.edges.iter().find(|e| e.name == name)
    }

    /// The edge of that role, on that side of the wearer where the outline has one on each.
    pub fn edge_of(&self, role: EdgeRole, hand: Option<Hand>) -> Option<&Edge> {
        self.edge(&role.name(hand))
    }

    /// The box around the outer loop: least and greatest corner.
    pub fn bounds(&self) -> (Point2, Point2) {
        let mut lo = Point2::new(f64::INFINITY, f64::INFINITY);
        let mut hi = -lo;
        for p in &self.outer.points {
            lo = lo.inf(p);
            hi = hi.sup(p);
        }
        (lo, hi)
    }
}

impl ArtifactType for Outline {
    const KIND: Kind = Kind("outline");
    const IN_SETS: bool = true;
}

impl Artifact for Outline {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let (lo, hi) = self.bounds();
        let mut m = Measures::new();
        m.push("area", self.area() * 1e4, "cm2", 1.0);
        m.push("perimeter", self.perimeter() * 1e2, "cm", 0.2);
        m.push("box_width", (hi.x - lo.x) * 1e3, "mm", 0.5);
        m.push("box_height", (hi.y - lo.y) * 1e3, "mm", 0.5);
        m.count("loops", 1 + self.holes.len()).count("corners", self.outer.corners.len());
        for e in &self.edges {
            let length = polyline_length(&self.edge_points(e));
            m.push(&format!("edge.{}", e.name), length * 1e3, "mm", 0.5);
        }
        m
    }

    fn check(&self) -> Result<(), String> {
        for l in std::iter::once(&self.outer).chain(&self.holes) {
            ensure(l.points.len() >= 3, || format!("a loop has {} points", l.points.len()))?;
            finite("point", l.points.iter().map(|p| &p.coords))?;
            let rising = l.corners.windows(2).all(|c| c[0] < c[1]);
            let last = l.corners.last().is_none_or(|&c| c < l.points.len());
            ensure(rising && last, || "its corners are not in order along the loop".to_owned())?;
        }
        let n = self.outer.points.len();
        for e in &self.edges {
            ensure(e.start < n && e.end < n, || format!("edge \"{}\" ends beyond the loop", e.name))?;
            ensure(e.gauge.is_sound(), || format!("edge \"{}\" has no length to divide", e.name))?;
        }
        for line in &self.inner {
            ensure(line.points.len() >= 2, || format!("inner line \"{}\" has no length", line.name))?;
            finite("inner point", line.points.iter().map(|p| &p.coords))?;
            let sound = line.gauge.is_none_or(|g| g.is_sound());
            ensure(sound, || format!("inner line \"{}\" has no length to divide", line.name))?;
        }
        ensure(self.lies.is_empty() || self.lies.len() == n, || {
            format!("{} of its {n} points are said to lie somewhere", self.lies.len())
        })?;
        finite("place in the photo", self.lies.iter().map(|p| &p.coords))?;
        self.frame.as_ref().map_or(Ok(()), |f| {
            finite("photo origin", [&f.origin_px.coords])?;
            positive("scale", f.px_per_metre)
        })
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        vec![("svg", svg(self).into_bytes())]
    }
}

/// Named edges get alternating colours so that a wrong corner is seen at once.
const EDGE_COLOURS: [&str; 6] = ["#c0392b", "#2471a3", "#1e8449", "#b9770e", "#6c3483", "#117a65"];

/// The outline drawn in millimetres with its corners and its edges, each with its name and an arrow
/// in the direction in which it runs.
fn svg(outline: &Outline) -> String {
    use std::fmt::Write;
    let (lo, hi) = outline.bounds();
    let (w, h) = ((hi.x - lo.x) * 1e3, (hi.y - lo.y) * 1e3);
    let at = |p: &Point2| ((p.x - lo.x) * 1e3, (hi.y - p.y) * 1e3);
    let line = |points: &[Point2]| {
        let mut s = String::new();
        for (i, p) in points.iter().enumerate() {
            let (x, y) = at(p);
            let _ = write!(s, "{}{x:.3},{y:.3}", if i == 0 { "M" } else { "L" });
        }
        s
    };
    let mut s = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-20 -20 {:.1} {:.1}\" width=\"{:.1}mm\" height=\"{:.1}mm\" font-family=\"sans-serif\" font-size=\"14\">\n",
        w + 40.0,
        h + 40.0,
        w + 40.0,
        h + 40.0
    );
    for lp in std::iter::once(&outline.outer).chain(&outline.holes) {
        let _ = writeln!(
            s,
            "<path d=\"{}Z\" fill=\"#f4ecd8\" fill-rule=\"evenodd\" stroke=\"#333\" stroke-width=\"1\"/>",
            line(&lp.points)
        );
        for &c in &lp.corners {
            let (x, y) = at(&lp.points[c]);
            let _ = writeln!(s, "<circle cx=\"{x:.3}\" cy=\"{y:.3}\" r=\"4\" fill=\"#333\"/>");
        }
    }
    for (i, e) in outline.edges.iter().enumerate() {
        let points = outline.edge_points(e);
        let (x, y) = at(&points[points.len() / 2]);
        let colour = EDGE_COLOURS[i % EDGE_COLOURS.len()];
        let _ = writeln!(
            s,
            "<path d=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"3\"/>",
            line(&points)
        );
        let _ = writeln!(
            s,
            "<path d=\"{}Z\" fill=\"{colour}\"/>",
            line(&crate::artifact::sewing::arrow::arrow(&points))
        );
        let _ = writeln!(
            s,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{colour}\" text-anchor=\"middle\">{}</text>",
            e.name
        );
    }
    for l in &outline.inner {
        let _ = writeln!(
            s,
            "<path d=\"{}\" fill=\"none\" stroke=\"#555\" stroke-dasharray=\"6 4\"/>",
            line(&l.points)
        );
    }
    s.push_str("</svg>\n");
    s
}
