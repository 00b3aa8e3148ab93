//! `BodyObj`: a body from a Wavefront OBJ file.
//!
//! The mesh is read and mended as the engine does it for scenes, the largest piece is kept, turned
//! outwards, upright and scaled; landmarks and girths are estimated from its slices. Cost: some
//! hundred slices.

use crate::measures::estimate::estimate;
use crate::skin::topology::SkinMesh;
use crate::skin::topology::{MeshTopology, VertexSets};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use toile_core::prelude::*;
use toile_geometry::obj;
use toile_geometry::obj::OBJ_HINT;

/// Heights of people, metres.
pub const HUMAN_HEIGHTS: RangeInclusive<f64> = 0.5..=2.5;

/// A body whose feet and middle are nearer to the origin than this in every direction stays where
/// it is, metres.
const AT_ORIGIN: f64 = 0.05;

/// The unit of a file's numbers.
#[choice]
#[derive(Copy, Eq)]
pub enum Units {
    /// The one in which the body is as tall as a person.
    Guess,
    /// Metres.
    Metres,
    /// Decimetres.
    Decimetres,
    /// Centimetres.
    Centimetres,
    /// Millimetres.
    Millimetres,
    /// Inches.
    Inches,
}

impl Units {
    /// Metres of the unit; none where it is to be guessed.
    pub fn metres(self) -> Option<f64> {
        match self {
            Units::Guess => None,
            Units::Metres => Some(1.0),
            Units::Decimetres => Some(0.1),
            Units::Centimetres => Some(0.01),
            Units::Millimetres => Some(0.001),
            Units::Inches => Some(0.0254),
        }
    }
}

/// The axis that points up in a file.
#[choice]
#[derive(Copy, Eq)]
pub enum Up {
    /// Y, as in most modelling programs.
    Y,
    /// Z, as in CAD and scanners.
    Z,
}

/// Reads the body from a Wavefront OBJ file.
///
/// The body must be closed, stand upright with its feet apart and hold its arms away from the
/// trunk. Landmarks are estimated from its shape; `turn` brings its face to the front (+Z).
#[stage(
    role = Body,
    source = "shares of the arm: Drillis and Contini, 1966",
    version = 3,
    example = "BodyObj(file: \"body.obj\", up: Z)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct BodyObj {
    /// The file, relative to the pipeline.
    #[param(default = String::new())]
    file: String,
    /// The unit of its numbers.
    #[param(default = Units::Guess)]
    units: Units,
    /// The axis that points up.
    #[param(default = Up::Y)]
    up: Up,
    /// Turn about the vertical, counter-clockwise from above, after which the body faces +Z.
    #[param(default = 0.0, min = -360.0, max = 360.0, unit = "deg")]
    turn: f64,
}

#[stage]
impl BodyObj {
    pub(crate) fn run(&self, cx: &Context) -> Result<Body, StageError> {
        let mesh = self.read(cx)?;
        cx.check()?;
        let (mesh, repairs) = obj::repair(mesh);
        if let Some(what) = repairs.words() {
            cx.warn(format!("\"{}\" was repaired: {what}", self.file));
        }
        self.body((mesh.vertices.into_iter().map(Point3::from).collect(), mesh.triangles), cx)
    }

    /// Whether the file is there and can be read.
    pub(crate) fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        self.read(placed.cx).map_err(|e| e.at("file")).err().into_iter().collect()
    }
}

impl BodyObj {
    /// The mesh of the file, as it stands there.
    fn read(&self, cx: &Context) -> Result<obj::Mesh, StageError> {
        self.named()?;
        let bytes = cx.read(&self.file)?;
        let bad = |what: String| {
            StageError::new(ErrorCode::PatternLoading, format!("\"{}\": {what}", self.file)).at("file")
        };
        if let Some(format) = obj::other_format(&bytes) {
            let hint = "export the body as OBJ from the program that made it, and name that file";
            return Err(bad(format!("it is {format}, which is not read as a body")).hint(hint));
        }
        obj::parse(&bytes).map_err(|e| match (&e, obj::without_faces(&bytes)) {
            (obj::ObjError::NoFaces, Some(holds)) => {
                bad(format!("the OBJ holds {holds}")).hint("export the body as a mesh with faces")
            }
            _ => bad(e.to_string()).hint(OBJ_HINT),
        })
    }

    fn named(&self) -> Result<(), StageError> {
        if self.file.is_empty() {
            let e = StageError::new(ErrorCode::InvalidParameter, "no file is named to read the body from");
            return Err(e.hint("write `file: \"body.obj\"`").at("file"));
        }
        Ok(())
    }

    /// A body from the file's vertices and triangles.
    fn body(&self, (points, triangles): SkinMesh, cx: &Context) -> Result<Body, StageError> {
        let (pieces, points, triangles) = largest_piece(&points, &triangles);
        if pieces > 1 {
            cx.warn(format!("the body's file holds {pieces} pieces; the largest is taken"));
        }
        closed(&MeshTopology::of(points.len(), &triangles), &points)?;
        let mut points: Vec<Point3> = points.iter().map(|p| self.upright(p)).collect();
        let height = self.stand(&mut points)?;
        let triangles = turned_outwards(&points, triangles);
        cx.check()?;
        let (landmarks, measurements) = estimate(&points, &triangles, height).map_err(|part| {
            StageError::invalid(format!("the body's {part} cannot be found from its shape"))
                .hint("it must stand upright and face +Z, arms away from the trunk, feet apart; see `up` and `turn`")
        })?;
        Ok(Body { positions: points, triangles, landmarks, measurements })
    }

    fn upright(&self, p: &Point3) -> Point3 {
        let p = match self.up {
            Up::Y => *p,
            Up::Z => Point3::new(p.x, p.z, -p.y),
        };
        let (sin, cos) = self.turn.to_radians().sin_cos();
        Point3::new(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin)
    }

    /// Scales to metres and puts the feet to 0 and the middle to x = 0 and z = 0, unless it stands
    /// there already; returns the height.
    fn stand(&self, points: &mut [Point3]) -> Result<f64, StageError> {
        let (mut lo, mut hi) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        for p in points.iter() {
            (lo, hi) = (lo.inf(p), hi.sup(p));
        }
        let unit = self.unit(hi.y - lo.y)?;
        let base = Point3::new((lo.x + hi.x) / 2.0, lo.y, (lo.z + hi.z) / 2.0);
        // Patterns and other files may count on the place of a body that stands there already.
        let base = if base.coords.amax() * unit < AT_ORIGIN { Point3::origin() } else { base };
        points.iter_mut().for_each(|p| *p = Point3::from((*p - base) * unit));
        Ok((hi.y - lo.y) * unit)
    }

    /// Metres of the file's unit.
    fn unit(&self, tall: f64) -> Result<f64, StageError> {
        let fits = |u: &f64| HUMAN_HEIGHTS.contains(&(tall * u));
        let units = self.units.metres().map_or_else(|| vec![1.0, 0.01, 0.001, 0.1], |u| vec![u]);
        units.iter().copied().find(|u| fits(u)).ok_or_else(|| {
            let as_said = units.first().map_or(tall, |u| tall * u);
            StageError::invalid(format!("the body would be {as_said:.3} m tall"))
                .hint(format!(
                    "people are {} to {} m tall; check `units` and `up`",
                    HUMAN_HEIGHTS.start(),
                    HUMAN_HEIGHTS.end()
                ))
                .at("units")
        })
    }
}

/// The body of a mesh that stands upright, y up, metres: where it stands, faced outwards, with the
/// landmarks and girths that follow from its shape; without any where they cannot be found, such as
/// with arms that lie on the trunk, which the second value names.
///
/// # Errors
/// The mesh is not closed, or its triangles are not turned alike.
pub fn body_of_mesh(
    points: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
) -> Result<(Body, Option<&'static str>), StageError> {
    closed(&MeshTopology::of(points.len(), &triangles), &points)?;
    let triangles = turned_outwards(&points, triangles);
    let (mut lo, mut hi) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
    points.iter().for_each(|p| (lo, hi) = (lo.inf(p), hi.sup(p)));
    let base = Vector3::new((lo.x + hi.x) / 2.0, lo.y, (lo.z + hi.z) / 2.0);
    let centred: Vec<Point3> = points.iter().map(|p| p - base).collect();
    let found = estimate(&centred, &triangles, hi.y - lo.y);
    let missing = found.as_ref().err().copied();
    let (marks, measurements) = found.unwrap_or_default();
    let landmarks = marks.into_iter().map(|(name, p)| (name, p + base)).collect();
    Ok((Body { positions: points, triangles, landmarks, measurements }, missing))
}

/// Refuses a mesh with holes or turned triangles.
fn closed(t: &MeshTopology, points: &[Point3]) -> Result<(), StageError> {
    let place = |edge: Option<[u32; 2]>| {
        let end = |v: u32| {
            let p = points[v as usize];
            format!("({}, {}, {})", p.x, p.y, p.z)
        };
        edge.map_or(String::new(), |[a, b]| format!(", the first from {} to {} of the file", end(a), end(b)))
    };
    if t.open > 0 {
        let message = format!("the body is not closed: {} edges are open{}", t.open, place(t.first_open));
        return Err(StageError::invalid(message)
            .hint("fill its holes in the program that made it; cloth would fall through them"));
    }
    if t.faulty > 0 {
        let message = format!(
            "the body's triangles are not turned alike or meet wrongly at {} edges{}",
            t.faulty,
            place(t.first_faulty)
        );
        return Err(
            StageError::invalid(message).hint("make its normals consistent in the program that made it")
        );
    }
    Ok(())
}

/// The piece with the most triangles, without unused vertices, and the number of pieces.
fn largest_piece(points: &[Point3], triangles: &[[u32; 3]]) -> (usize, Vec<Point3>, Vec<[u32; 3]>) {
    let mut pieces = VertexSets::new(points.len());
    for t in triangles {
        pieces.join(t[0], t[1]);
        pieces.join(t[0], t[2]);
    }
    let mut sizes: BTreeMap<u32, usize> = BTreeMap::new();
    triangles.iter().for_each(|t| *sizes.entry(pieces.root(t[0])).or_default() += 1);
    let largest =
        sizes.iter().max_by_key(|(root, size)| (**size, std::cmp::Reverse(**root))).map(|(r, _)| *r);
    let mut map = BTreeMap::new();
    let mut kept = Vec::new();
    let mut own = |v: u32| {
        *map.entry(v).or_insert_with(|| {
            kept.push(points[v as usize]);
            kept.len() as u32 - 1
        })
    };
    let mine = triangles.iter().filter(|t| Some(pieces.root(t[0])) == largest);
    let triangles = mine.map(|t| t.map(&mut own)).collect();
    (sizes.len(), kept, triangles)
}

/// Turns all triangles where they enclose a negative volume.
fn turned_outwards(points: &[Point3], mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let six = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| points[i as usize].coords);
        a.dot(&b.cross(&c))
    };
    if triangles.iter().map(six).sum::<f64>() < 0.0 {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    triangles
}
