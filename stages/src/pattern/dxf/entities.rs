//! The blocks of a DXF file with what is drawn in them, of the few kinds that patterns use.
//!
//! Layers are told by their numbers (AAMA, ASTM D6673): 1 boundary, 4 notches (and 80 to 83), 6 mirror line, 7 grain, 8
//! internal lines, 11 cut-outs, 13 drill holes, 14 sew line, 84 the boundary drawn finely.

use super::damage::Damage;
use super::tags::Tag;
use toile_core::artifact::Point2;

const MOST_BLOCKS: usize = 20_000;
const MOST_ENTITIES: usize = 400_000;

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    Text(Point2, String),
    /// A line from point to point, closed where its flag says.
    Line {
        points: Vec<Point2>,
        closed: bool,
    },
    /// A point with the two depths that notches carry, 0 where there are none.
    Point {
        at: Point2,
        depth: f64,
    },
}

/// An entity with its layer and the line where it begins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entity {
    pub layer: i32,
    pub line: usize,
    pub shape: Shape,
}

/// A block, or what stands outside of blocks (without a name).
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Block {
    pub name: String,
    pub line: usize,
    pub entities: Vec<Entity>,
}

/// The blocks in their order, and what stands outside of them.
pub(super) fn blocks(tags: &[Tag]) -> Result<(Vec<Block>, Block), Damage> {
    let (mut blocks, mut outside) = (Vec::new(), Block::default());
    let mut inside: Option<Block> = None;
    let mut count = 0;
    let mut poly: Option<(i32, usize, bool, Vec<Point2>)> = None;
    let starts: Vec<usize> = (0..tags.len()).filter(|&i| tags[i].code == 0).collect();
    for (k, &start) in starts.iter().enumerate() {
        let end = starts.get(k + 1).copied().unwrap_or(tags.len());
        let (head, body) = (&tags[start], &tags[start + 1..end]);
        let one = |code: i32| body.iter().find(|t| t.code == code);
        let number = |code: i32| one(code).map_or(Ok(0.0), Tag::number);
        let layer = || one(8).and_then(|t| t.value.trim().parse::<i32>().ok()).unwrap_or(-1);
        let at = |x: i32| Ok::<_, Damage>(Point2::new(number(x)?, number(x + 10)?));
        let flag =
            |bit: i64| one(70).and_then(|t| t.value.trim().parse::<i64>().ok()).unwrap_or(0) & bit != 0;
        let shape = match head.value.trim() {
            "BLOCK" => {
                blocks.extend(inside.take());
                let name = one(2).map_or_else(String::new, |t| t.value.trim().to_owned());
                inside = Some(Block { name, line: head.line, entities: Vec::new() });
                if blocks.len() > MOST_BLOCKS {
                    return Err(Damage::Many { what: "blocks", count: blocks.len(), most: MOST_BLOCKS });
                }
                None
            }
            "ENDBLK" => {
                blocks.extend(inside.take());
                None
            }
            "POLYLINE" => {
                poly = Some((layer(), head.line, flag(1), Vec::new()));
                None
            }
            "VERTEX" => {
                if let Some((_, _, _, points)) = &mut poly {
                    points.push(at(10)?);
                }
                None
            }
            "SEQEND" => {
                poly.take().map(|(layer, line, closed, points)| (layer, line, Shape::Line { points, closed }))
            }
            "LWPOLYLINE" => {
                let x = body.iter().filter(|t| t.code == 10);
                let y = body.iter().filter(|t| t.code == 20);
                let points = x.zip(y).map(|(x, y)| Ok(Point2::new(x.number()?, y.number()?)));
                let points = points.collect::<Result<Vec<_>, Damage>>()?;
                Some((layer(), head.line, Shape::Line { points, closed: flag(1) }))
            }
            "LINE" => {
                Some((layer(), head.line, Shape::Line { points: vec![at(10)?, at(11)?], closed: false }))
            }
            "POINT" => {
                let depth = number(39)?.abs().max(number(30)?.abs());
                Some((layer(), head.line, Shape::Point { at: at(10)?, depth }))
            }
            "TEXT" => {
                let text = one(1).map_or_else(String::new, |t| t.value.trim().to_owned());
                Some((layer(), head.line, Shape::Text(at(10)?, text)))
            }
            _ => None,
        };
        if let Some((layer, line, shape)) = shape {
            count += 1;
            if count > MOST_ENTITIES {
                return Err(Damage::Many { what: "entities", count, most: MOST_ENTITIES });
            }
            inside.as_mut().unwrap_or(&mut outside).entities.push(Entity { layer, line, shape });
        }
    }
    blocks.extend(inside.take());
    Ok((blocks, outside))
}

impl Block {
    /// The value of the first text that begins with that word and a colon, whatever its layer.
    pub(super) fn value(&self, word: &str) -> Option<&str> {
        self.entities.iter().find_map(|e| match &e.shape {
            Shape::Text(_, text) => {
                let (key, value) = text.split_once(':')?;
                key.trim().eq_ignore_ascii_case(word).then(|| value.trim())
            }
            Shape::Line { .. } | Shape::Point { .. } => None,
        })
    }

    /// The lines on a layer that have length, with their places in the file.
    pub(super) fn lines(&self, layer: i32) -> impl Iterator<Item = (usize, &[Point2], bool)> {
        self.entities.iter().filter(move |e| e.layer == layer).filter_map(|e| match &e.shape {
            Shape::Line { points, closed } if points.len() >= 2 => Some((e.line, &points[..], *closed)),
            _ => None,
        })
    }

    /// The points on any of these layers, with their depths.
    pub(super) fn points(&self, layers: &[i32]) -> impl Iterator<Item = (Point2, f64)> {
        self.entities.iter().filter(move |e| layers.contains(&e.layer)).filter_map(|e| match e.shape {
            Shape::Point { at, depth } => Some((at, depth)),
            Shape::Text(..) | Shape::Line { .. } => None,
        })
    }
}
