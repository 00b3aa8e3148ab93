//! The blocks of a DXF file with what is drawn in them, of the kinds that patterns use.
//!
//! Layers are identified by their numbers (AAMA, ASTM D6673): 1 boundary, 4 notches (and 80 to 83),
//! 6 mirror line, 7 grain, 8 internal lines, 11 cut-outs, 13 drill holes, 14 sew line, 84 the
//! boundary drawn finely. Lines are LINE, POLYLINE and LWPOLYLINE with their bulges, ARC, CIRCLE,
//! ELLIPSE and SPLINE; the names of all other entities are kept, to be reported.

use super::damage::DxfDamage;
use super::spline::Spline;
use super::tags::Tag;
use super::words;
use toile_core::prelude::*;

const MOST_BLOCKS: usize = 20_000;
const MOST_ENTITIES: usize = 400_000;
/// A bulge below this is a straight line.
const STRAIGHT: f64 = 1e-9;
/// How far the curves that stand for an ellipse leave it, as a share of it.
const NEAR: f64 = 1e-9;
/// Kinds that are no line of a piece: what a program measures, notes and shows.
const SILENT: [&str; 4] = ["ATTRIB", "VIEWPORT", "DIMENSION", "LEADER"];

/// A line from curve to curve, in the file's unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stroke {
    pub start: Point2,
    /// Curves that follow each other, each with its end.
    pub parts: Vec<(EdgeCurve, Point2)>,
    /// Whether it says that it is closed; its last part then ends at its start.
    pub closed: bool,
}

impl Stroke {
    fn polyline(points: &[(Point2, f64)], closed: bool) -> Option<Self> {
        let (first, rest) = points.split_first()?;
        let curve = |bulge: f64| match bulge.abs() > STRAIGHT {
            true => EdgeCurve::Arc { bulge },
            false => EdgeCurve::Line,
        };
        let mut parts: Vec<(EdgeCurve, Point2)> =
            points.iter().zip(rest).map(|((_, bulge), (end, _))| (curve(*bulge), *end)).collect();
        if let Some((_, bulge)) = points.last().filter(|(last, _)| closed && *last != first.0) {
            parts.push((curve(*bulge), first.0));
        }
        (!parts.is_empty()).then_some(Stroke { start: first.0, parts, closed })
    }

    pub(super) fn end(&self) -> Point2 {
        self.parts.last().map_or(self.start, |(_, end)| *end)
    }

    /// Whether it is straight from point to point.
    pub(super) fn is_straight(&self) -> bool {
        self.parts.iter().all(|(curve, _)| *curve == EdgeCurve::Line)
    }

    /// Its corners, first and last included.
    pub(super) fn corners(&self) -> Vec<Point2> {
        std::iter::once(self.start).chain(self.parts.iter().map(|(_, end)| *end)).collect()
    }
}

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum EntityShape {
    Text(String),
    Line(Stroke),
    /// A point with the greater of the two depths that notches carry, 0 where there are none.
    Point {
        at: Point2,
        depth: f64,
    },
    /// A block that is placed, with its name and scale.
    Insert {
        block: String,
        at: Point2,
        scale: [f64; 2],
    },
    /// Something of a kind that is not read.
    Other(String),
}

/// An entity with its layer and the line where it begins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entity {
    /// The layer's number; -1 where its name is none.
    pub layer: i32,
    pub layer_name: String,
    pub line: usize,
    pub shape: EntityShape,
}

/// A block, or what stands outside of blocks (without a name).
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Block {
    pub name: String,
    pub line: usize,
    pub entities: Vec<Entity>,
}

/// An old polyline under construction: its layer, line and vertices with their bulges.
struct Polyline {
    layer: (i32, String),
    line: usize,
    closed: bool,
    mirrored: bool,
    mesh: bool,
    points: Vec<(Point2, f64)>,
}

/// The tags of one entity.
struct EntityTags<'a>(&'a [Tag]);

impl EntityTags<'_> {
    fn one(&self, code: i32) -> Option<&Tag> {
        self.0.iter().find(|t| t.code == code)
    }

    fn number(&self, code: i32) -> Result<f64, DxfDamage> {
        self.one(code).map_or(Ok(0.0), Tag::number)
    }

    fn all(&self, code: i32) -> Result<Vec<f64>, DxfDamage> {
        self.0.iter().filter(|t| t.code == code).map(Tag::number).collect()
    }

    fn point(&self, x: i32) -> Result<Point2, DxfDamage> {
        Ok(Point2::new(self.number(x)?, self.number(x + 10)?))
    }

    fn points(&self, x: i32) -> Result<Vec<Point2>, DxfDamage> {
        let (x, y) = (self.all(x)?, self.all(x + 10)?);
        Ok(x.into_iter().zip(y).map(|(x, y)| Point2::new(x, y)).collect())
    }

    fn flags(&self) -> i64 {
        self.one(70).and_then(|t| t.value.trim().parse().ok()).unwrap_or(0)
    }

    fn text(&self, code: i32) -> String {
        self.one(code).map_or_else(String::new, |t| t.value.trim().to_owned())
    }

    fn layer(&self) -> (i32, String) {
        let name = self.text(8);
        (name.parse().unwrap_or(-1), name)
    }

    /// Whether it is drawn as seen from below, its x to the left.
    fn is_mirrored(&self) -> Result<bool, DxfDamage> {
        Ok(self.number(230)? < 0.0)
    }

    /// The points of a LWPOLYLINE with their bulges.
    fn bulged(&self) -> Result<Vec<(Point2, f64)>, DxfDamage> {
        let mut out: Vec<(Point2, f64)> = Vec::new();
        for t in self.0 {
            match (t.code, out.last_mut()) {
                (10, _) => out.push((Point2::new(t.number()?, 0.0), 0.0)),
                (20, Some((p, _))) => p.y = t.number()?,
                (42, Some((_, bulge))) => *bulge = t.number()?,
                _ => {}
            }
        }
        Ok(out)
    }

    /// An arc around a centre; a whole circle where it has no angles.
    fn arc(&self, whole: bool) -> Result<Option<Stroke>, DxfDamage> {
        let (centre, radius) = (self.point(10)?, self.number(40)?);
        let (from, to) = if whole { (0.0, 360.0) } else { (self.number(50)?, self.number(51)?) };
        let turn = if whole { 360.0 } else { (to - from).rem_euclid(360.0) };
        if radius <= 0.0 || turn <= 0.0 {
            return Ok(None);
        }
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            centre + Vector2::new(cos, sin) * radius
        };
        // Of no more than half a circle each.
        let count = if turn > 180.0 { 2 } else { 1 };
        let step = turn / f64::from(count);
        let bulge = (step.to_radians() / 4.0).tan();
        let start = at(from);
        let end = |k: i32| if whole && k == count { start } else { at(from + step * f64::from(k)) };
        let parts = (1..=count).map(|k| (EdgeCurve::Arc { bulge }, end(k))).collect();
        Ok(Some(Stroke { start, parts, closed: whole }))
    }

    fn ellipse(&self) -> Result<Option<Stroke>, DxfDamage> {
        let (centre, major, ratio) = (self.point(10)?, self.point(11)?.coords, self.number(40)?);
        let (from, to) = (self.number(41)?, self.number(42)?);
        let whole = (to - from).abs() < 1e-9 || (to - from - std::f64::consts::TAU).abs() < 1e-9;
        let turn = if whole { std::f64::consts::TAU } else { (to - from).rem_euclid(std::f64::consts::TAU) };
        let long = major.norm();
        if long <= 0.0 || ratio <= 0.0 {
            return Ok(None);
        }
        let arc = kurbo::Arc {
            center: kurbo::Point::new(centre.x, centre.y),
            radii: kurbo::Vec2::new(long, long * ratio),
            start_angle: from,
            sweep_angle: turn,
            x_rotation: major.y.atan2(major.x),
        };
        let p = |q: kurbo::Point| Point2::new(q.x, q.y);
        let (sin, cos) = from.sin_cos();
        let across = Vector2::new(-major.y, major.x) * ratio;
        let start = centre + major * cos + across * sin;
        let mut parts: Vec<(EdgeCurve, Point2)> = arc
            .append_iter(NEAR * long)
            .filter_map(|el| match el {
                kurbo::PathEl::CurveTo(a, b, end) => {
                    Some((EdgeCurve::Cubic { controls: [p(a), p(b)] }, p(end)))
                }
                _ => None,
            })
            .collect();
        if let Some((_, end)) = parts.last_mut().filter(|_| whole) {
            *end = start;
        }
        Ok((!parts.is_empty()).then_some(Stroke { start, parts, closed: whole }))
    }

    fn spline(&self) -> Result<Option<Stroke>, DxfDamage> {
        let degree = self.number(71)?;
        let tangent = |code: i32| {
            let given = self.one(code).is_some();
            Ok::<_, DxfDamage>(if given { Some(self.point(code)?.coords) } else { None })
        };
        let spline = Spline {
            degree: if (1.0..100.0).contains(&degree) { degree as usize } else { 0 },
            knots: self.all(40)?,
            controls: self.points(10)?,
            weights: self.all(41)?,
            fits: self.points(11)?,
            tangents: [tangent(12)?, tangent(13)?],
            closed: self.flags() & 1 != 0,
        };
        let closed = spline.closed;
        Ok(spline.curves().map(|(start, parts)| Stroke { start, parts, closed }))
    }

    /// What an entity of that kind is; none where it is nothing by itself.
    fn shape(&self, kind: &str) -> Result<Option<EntityShape>, DxfDamage> {
        let drawn = |stroke: Option<Stroke>| Ok::<_, DxfDamage>(stroke.map(EntityShape::Line));
        let mirrored = self.is_mirrored()?;
        let own = |stroke: Option<Stroke>| drawn(stroke.map(|s| if mirrored { turned_over(&s) } else { s }));
        match kind {
            "LWPOLYLINE" => own(Stroke::polyline(&self.bulged()?, self.flags() & 1 != 0)),
            "LINE" => drawn(Stroke::polyline(&[(self.point(10)?, 0.0), (self.point(11)?, 0.0)], false)),
            "ARC" => own(self.arc(false)?),
            "CIRCLE" => own(self.arc(true)?),
            "ELLIPSE" => drawn(self.ellipse()?),
            "SPLINE" => Ok(Some(
                self.spline()?.map_or_else(|| EntityShape::Other(kind.to_owned()), EntityShape::Line),
            )),
            "POINT" => {
                let depth = self.number(39)?.abs().max(self.number(30)?.abs());
                Ok(Some(EntityShape::Point { at: self.point(10)?, depth }))
            }
            "TEXT" | "ATTDEF" => Ok(Some(EntityShape::Text(words::line(&self.text(1))))),
            "INSERT" => {
                let scale = |code: i32| self.one(code).map_or(Ok(1.0), Tag::number);
                let at = self.point(10)?;
                Ok(Some(EntityShape::Insert { block: self.text(2), at, scale: [scale(41)?, scale(42)?] }))
            }
            _ if SILENT.contains(&kind) => Ok(None),
            _ => Ok(Some(EntityShape::Other(kind.to_owned()))),
        }
    }

    /// The lines of an MTEXT; what is longer than 250 letters stands in several tags.
    fn lines(&self) -> Vec<String> {
        let parts = self.0.iter().filter(|t| t.code == 3 || t.code == 1);
        words::lines(&parts.map(|t| t.value.as_str()).collect::<String>())
    }
}

/// A line seen from the other side.
fn turned_over(stroke: &Stroke) -> Stroke {
    let to = |p: Point2| Point2::new(-p.x, p.y);
    let part = |(curve, end): &(EdgeCurve, Point2)| (curve.moved(to, true), to(*end));
    Stroke { start: to(stroke.start), parts: stroke.parts.iter().map(part).collect(), closed: stroke.closed }
}

/// The blocks in their order, and what stands outside of them.
pub(super) fn blocks(tags: &[Tag]) -> Result<(Vec<Block>, Block), DxfDamage> {
    let (mut blocks, mut outside) = (Vec::new(), Block::default());
    let mut inside: Option<Block> = None;
    let mut count = 0;
    let mut poly: Option<Polyline> = None;
    let starts: Vec<usize> = (0..tags.len()).filter(|&i| tags[i].code == 0).collect();
    // Tables and objects draw nothing.
    let mut drawn = true;
    for (k, &start) in starts.iter().enumerate() {
        let end = starts.get(k + 1).copied().unwrap_or(tags.len());
        let (head, body) = (&tags[start], EntityTags(&tags[start + 1..end]));
        let mut found: Vec<((i32, String), usize, EntityShape)> = Vec::new();
        match head.value.trim() {
            "SECTION" => drawn = matches!(body.text(2).as_str(), "BLOCKS" | "ENTITIES"),
            "ENDSEC" | "EOF" => drawn = true,
            _ if !drawn => {}
            "BLOCK" => {
                blocks.extend(inside.take());
                inside = Some(Block { name: body.text(2), line: head.line, entities: Vec::new() });
                if blocks.len() > MOST_BLOCKS {
                    return Err(DxfDamage::Many { what: "blocks", count: blocks.len(), most: MOST_BLOCKS });
                }
            }
            "ENDBLK" => blocks.extend(inside.take()),
            "POLYLINE" => {
                poly = Some(Polyline {
                    layer: body.layer(),
                    line: head.line,
                    closed: body.flags() & 1 != 0,
                    mirrored: body.is_mirrored()?,
                    mesh: body.flags() & (16 | 64) != 0,
                    points: Vec::new(),
                });
            }
            "VERTEX" => {
                // Control points of a curve that is drawn by its other points.
                if let Some(poly) = poly.as_mut().filter(|_| body.flags() & 16 == 0) {
                    poly.points.push((body.point(10)?, body.number(42)?));
                }
            }
            "SEQEND" => {
                if let Some(poly) = poly.take() {
                    let stroke = Stroke::polyline(&poly.points, poly.closed).filter(|_| !poly.mesh);
                    let shape = match stroke {
                        Some(s) if poly.mirrored => Some(EntityShape::Line(turned_over(&s))),
                        Some(s) => Some(EntityShape::Line(s)),
                        None if poly.mesh => Some(EntityShape::Other("POLYLINE of a mesh".to_owned())),
                        None => None,
                    };
                    found.extend(shape.map(|shape| (poly.layer, poly.line, shape)));
                }
            }
            "MTEXT" => {
                found.extend(
                    body.lines().into_iter().map(|text| (body.layer(), head.line, EntityShape::Text(text))),
                );
            }
            kind => found.extend(body.shape(kind)?.map(|shape| (body.layer(), head.line, shape))),
        }
        for ((layer, layer_name), line, shape) in found {
            count += 1;
            if count > MOST_ENTITIES {
                return Err(DxfDamage::Many { what: "entities", count, most: MOST_ENTITIES });
            }
            let entity = Entity { layer, layer_name, line, shape };
            inside.as_mut().unwrap_or(&mut outside).entities.push(entity);
        }
    }
    blocks.extend(inside.take());
    Ok((blocks, outside))
}

impl Block {
    /// Whether a program made it to lay out, measure or fill: no piece.
    pub(super) fn is_layout(&self) -> bool {
        let small = self.name.to_ascii_lowercase();
        self.name.starts_with('*') || small.starts_with("$model_space") || small.starts_with("$paper_space")
    }

    /// The value of the first text that begins with that word and a colon, whatever its layer.
    pub(super) fn value(&self, word: &str) -> Option<&str> {
        self.entities.iter().find_map(|e| match &e.shape {
            EntityShape::Text(text) => {
                let (key, value) = text.split_once(':')?;
                key.trim().eq_ignore_ascii_case(word).then(|| value.trim())
            }
            EntityShape::Line(_)
            | EntityShape::Point { .. }
            | EntityShape::Insert { .. }
            | EntityShape::Other(_) => None,
        })
    }

    /// The lines on a layer that have length, with their places in the file.
    pub(super) fn lines(&self, layer: i32) -> impl Iterator<Item = (usize, &Stroke)> {
        self.entities.iter().filter(move |e| e.layer == layer).filter_map(|e| match &e.shape {
            EntityShape::Line(stroke) => Some((e.line, stroke)),
            _ => None,
        })
    }

    /// The points on any of these layers, with their depths; a block that is placed there is a
    /// point.
    pub(super) fn points(&self, layers: &[i32]) -> impl Iterator<Item = (Point2, f64)> {
        self.entities.iter().filter(move |e| layers.contains(&e.layer)).filter_map(|e| match &e.shape {
            EntityShape::Point { at, depth } => Some((*at, *depth)),
            EntityShape::Insert { at, .. } => Some((*at, 0.0)),
            EntityShape::Text(_) | EntityShape::Line(_) | EntityShape::Other(_) => None,
        })
    }
}
