//! Records of patterns.

use super::flat::{value, word};
use super::plan::{edge_fields, edge_of, kind_fields, kind_of};
use super::{Reader, Record, Stored};
use crate::artifact::pattern::{
    BodyPart, EdgeCurve, EdgeUse, LinePurpose, Notch, Pattern, PatternLoop, PatternSeam, Piece, PieceEdge,
    PieceLine, Pose,
};
use crate::artifact::{EdgeRef, Point2};

impl Pattern {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .text("name", &self.name)
            .records("pieces", self.pieces.iter().map(piece_fields))
            .records("seams", self.seams.iter().map(seam_fields))
    }
}

impl Stored for Pattern {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        Ok(Pattern {
            name: r.text("name")?,
            pieces: r.records("pieces")?.map(|p| piece_of(&p)).collect::<Result<_, _>>()?,
            seams: r.records("seams")?.map(|s| seam_of(&s)).collect::<Result<_, _>>()?,
        })
    }
}

fn piece_fields(p: &Piece) -> Record<'_> {
    let record = Record::new()
        .text("name", &p.name)
        .records("outer", [loop_fields(&p.outer)])
        .records("holes", p.holes.iter().map(loop_fields))
        .records("lines", p.lines.iter().map(line_fields))
        .records("notches", p.notches.iter().map(notch_fields))
        .list("drill_holes", &p.drill_holes)
        .count("layer", p.layer as usize)
        .maybe("pose", p.pose.as_ref().map(pose_fields));
    let record = match &p.grain {
        Some(grain) => record.list("grain", grain),
        None => record,
    };
    match &p.body_part {
        Some(part) => record.text("body_part", word(&BodyPart::WORDS, part)),
        None => record,
    }
}

fn piece_of(r: &Reader<'_>) -> Result<Piece, String> {
    let outer = r.maybe("outer")?.ok_or("the field `outer` is missing")?;
    let grain = r.find("grain").map(|_| match r.list::<Point2>("grain")?[..] {
        [a, b] => Ok([a, b]),
        ref other => Err(format!("`grain` has {} points, 2 are wanted", other.len())),
    });
    Ok(Piece {
        name: r.text("name")?,
        outer: loop_of(&outer)?,
        holes: r.records("holes")?.map(|h| loop_of(&h)).collect::<Result<_, _>>()?,
        lines: r.records("lines")?.map(|l| line_of(&l)).collect::<Result<_, _>>()?,
        notches: r.records("notches")?.map(|n| notch_of(&n)).collect::<Result<_, _>>()?,
        drill_holes: r.list("drill_holes")?,
        grain: grain.transpose()?,
        body_part: r.find("body_part").map(|_| value(&BodyPart::WORDS, r, "body_part")).transpose()?,
        pose: r.maybe("pose")?.map(|p| pose_of(&p)).transpose()?,
        layer: u32::try_from(r.count("layer")?).map_err(|_| "`layer` is too great".to_owned())?,
    })
}

fn loop_fields(l: &PatternLoop) -> Record<'_> {
    Record::new().list("corners", &l.corners).records("edges", l.edges.iter().map(piece_edge_fields))
}

fn loop_of(r: &Reader<'_>) -> Result<PatternLoop, String> {
    Ok(PatternLoop {
        corners: r.list("corners")?,
        edges: r.records("edges")?.map(|e| piece_edge_of(&e)).collect::<Result<_, _>>()?,
    })
}

fn piece_edge_fields(e: &PieceEdge) -> Record<'_> {
    let record = Record::new().text("name", &e.name).text("curve", e.curve.word());
    match &e.curve {
        EdgeCurve::Line => record,
        EdgeCurve::Quadratic { control } => record.owned("points", [*control]),
        EdgeCurve::Cubic { controls } => record.list("points", controls),
        EdgeCurve::Arc { bulge } => record.number("bulge", *bulge),
        EdgeCurve::Polyline { points } => record.list("points", points),
    }
}

fn piece_edge_of(r: &Reader<'_>) -> Result<PieceEdge, String> {
    let points = || r.list::<Point2>("points");
    let wrong = |wanted: usize, found: usize| format!("`points` has {found} points, {wanted} are wanted");
    let curve = match r.text("curve")?.as_str() {
        "line" => EdgeCurve::Line,
        "arc" => EdgeCurve::Arc { bulge: r.one("bulge")? },
        "polyline" => EdgeCurve::Polyline { points: points()? },
        "quadratic" => match points()?[..] {
            [control] => EdgeCurve::Quadratic { control },
            ref other => return Err(wrong(1, other.len())),
        },
        "cubic" => match points()?[..] {
            [a, b] => EdgeCurve::Cubic { controls: [a, b] },
            ref other => return Err(wrong(2, other.len())),
        },
        other => return Err(format!("`curve` is \"{other}\", which is not one of its values")),
    };
    Ok(PieceEdge { name: r.text("name")?, curve })
}

fn line_fields(l: &PieceLine) -> Record<'_> {
    Record::new()
        .text("name", &l.name)
        .text("purpose", word(&LinePurpose::WORDS, &l.purpose))
        .list("points", &l.points)
}

fn line_of(r: &Reader<'_>) -> Result<PieceLine, String> {
    let purpose = value(&LinePurpose::WORDS, r, "purpose")?;
    Ok(PieceLine { name: r.text("name")?, purpose, points: r.list("points")? })
}

fn notch_fields(n: &Notch) -> Record<'_> {
    Record::new().text("edge", &n.edge).number("along", n.along).number("depth", n.depth)
}

fn notch_of(r: &Reader<'_>) -> Result<Notch, String> {
    Ok(Notch { edge: r.text("edge")?, along: r.one("along")?, depth: r.one("depth")? })
}

fn pose_fields(p: &Pose) -> Record<'_> {
    Record::new().owned("origin", [p.origin]).owned("across", [p.across]).owned("along", [p.along])
}

fn pose_of(r: &Reader<'_>) -> Result<Pose, String> {
    Ok(Pose { origin: r.one("origin")?, across: r.one("across")?, along: r.one("along")? })
}

fn seam_fields(s: &PatternSeam) -> Record<'_> {
    kind_fields(Record::new().text("name", &s.name), s.kind)
        .records("sides", s.sides.iter().map(|side| side_fields(side)))
}

fn side_fields(side: &[EdgeUse]) -> Record<'_> {
    Record::new().records("uses", side.iter().map(use_fields))
}

fn seam_of(r: &Reader<'_>) -> Result<PatternSeam, String> {
    let side = |s: Reader<'_>| s.records("uses")?.map(|u| use_of(&u)).collect::<Result<Vec<_>, String>>();
    Ok(PatternSeam {
        name: r.text("name")?,
        kind: kind_of(r)?,
        sides: r.records("sides")?.map(side).collect::<Result<_, _>>()?,
    })
}

fn use_fields(u: &EdgeUse) -> Record<'_> {
    edge_fields(&u.edge).flag("reversed", u.reversed)
}

fn use_of(r: &Reader<'_>) -> Result<EdgeUse, String> {
    let edge: EdgeRef = edge_of(r)?;
    Ok(EdgeUse { edge, reversed: r.flag("reversed")? })
}
