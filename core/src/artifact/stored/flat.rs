//! Records of what is flat: photos, masks, outlines, panels.

use super::{Reader, Record, Stored};
use crate::artifact::{
    Edge, Gauge, InnerChain, InnerKind, InnerLine, Loop, Mask, Outline, Panel, PanelEdge, Photo, PhotoFrame,
    Point2, Shared,
};
use crate::artifact::{GrayImage, RgbImage};

/// A colour picture as two fields.
pub(super) fn rgb<'a>(record: Record<'a>, pixels: &'a Shared<RgbImage>) -> Record<'a> {
    let (w, h) = pixels.dimensions();
    record.owned("size", [[w, h]]).lent("pixels", 3, pixels.as_raw(), pixels.keeper())
}

fn grey<'a>(record: Record<'a>, pixels: &'a Shared<GrayImage>) -> Record<'a> {
    let (w, h) = pixels.dimensions();
    record.owned("size", [[w, h]]).lent("pixels", 1, pixels.as_raw(), pixels.keeper())
}

impl Photo {
    pub(crate) fn fields(&self) -> Record<'_> {
        rgb(Record::new(), &self.pixels)
            .maybe("alpha", self.alpha.as_ref().map(|a| grey(Record::new(), a)))
            .maybe_number("px_per_metre", self.px_per_metre)
            .maybe_number("garment_width", self.garment_width)
            .flag("mirrored", self.mirrored)
            .maybe_number("joined", (self.joined != 1).then_some(f64::from(self.joined)))
            .text("file", &self.file)
    }
}

impl Stored for Photo {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        Ok(Photo {
            pixels: r.rgb("pixels")?,
            alpha: r.maybe("alpha")?.map(|a| a.grey("pixels")).transpose()?,
            px_per_metre: r.maybe_one("px_per_metre")?,
            garment_width: r.maybe_one("garment_width")?,
            mirrored: r.flag("mirrored")?,
            joined: r.maybe_one::<f64>("joined")?.map_or(1, |n| n as u32),
            file: r.text("file")?,
        })
    }
}

impl Mask {
    pub(crate) fn fields(&self) -> Record<'_> {
        grey(Record::new(), &self.pixels)
    }
}

impl Stored for Mask {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        Ok(Mask { pixels: r.grey("pixels")? })
    }
}

impl Outline {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .records("outer", [loop_fields(&self.outer)])
            .records("holes", self.holes.iter().map(loop_fields))
            .records("edges", self.edges.iter().map(edge_fields))
            .records("inner", self.inner.iter().map(inner_fields))
            .maybe("frame", self.frame.as_ref().map(frame_fields))
            .list("lies", &self.lies)
    }
}

impl Stored for Outline {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        let outer = r.maybe("outer")?.ok_or("the field `outer` is missing")?;
        Ok(Outline {
            outer: loop_of(&outer)?,
            holes: r.records("holes")?.map(|h| loop_of(&h)).collect::<Result<_, _>>()?,
            edges: r.records("edges")?.map(|e| edge_of(&e)).collect::<Result<_, _>>()?,
            inner: r.records("inner")?.map(|l| inner_of(&l)).collect::<Result<_, _>>()?,
            frame: r.maybe("frame")?.map(|f| frame_of(&f)).transpose()?,
            lies: r.find("lies").map_or(Ok(Vec::new()), |_| r.list("lies"))?,
        })
    }
}

fn loop_fields(l: &Loop) -> Record<'_> {
    Record::new().list("points", &l.points).owned("corners", l.corners.iter().map(|c| *c as u64))
}

fn loop_of(r: &Reader<'_>) -> Result<Loop, String> {
    Ok(Loop {
        points: r.list::<Point2>("points")?,
        corners: r.list::<u64>("corners")?.into_iter().map(|c| c as usize).collect(),
    })
}

fn edge_fields(e: &Edge) -> Record<'_> {
    Record::new()
        .text("name", &e.name)
        .count("start", e.start)
        .count("end", e.end)
        .owned("gauge", e.gauge.numbers())
}

fn edge_of(r: &Reader<'_>) -> Result<Edge, String> {
    let gauge = r.list::<f64>("gauge")?;
    Ok(Edge {
        name: r.text("name")?,
        start: r.count("start")?,
        end: r.count("end")?,
        gauge: Gauge::from_numbers(&gauge).ok_or("`gauge` is no gauge of an edge")?,
    })
}

const INNER_KINDS: [(&str, InnerKind); 4] = [
    ("dart", InnerKind::Dart),
    ("pleat", InnerKind::Pleat),
    ("fold", InnerKind::Fold),
    ("placement", InnerKind::Placement),
];

fn inner_fields(l: &InnerLine) -> Record<'_> {
    let record = Record::new()
        .text("name", &l.name)
        .text("kind", word(&INNER_KINDS, &l.kind))
        .list("points", &l.points);
    match &l.gauge {
        Some(gauge) => record.owned("gauge", gauge.numbers()),
        None => record,
    }
}

fn inner_of(r: &Reader<'_>) -> Result<InnerLine, String> {
    let gauge = r.find("gauge").map(|_| {
        Gauge::from_numbers(&r.list::<f64>("gauge")?)
            .ok_or_else(|| "`gauge` is no gauge of a line".to_owned())
    });
    Ok(InnerLine {
        name: r.text("name")?,
        kind: value(&INNER_KINDS, r, "kind")?,
        points: r.list("points")?,
        gauge: gauge.transpose()?,
    })
}

fn frame_fields(f: &PhotoFrame) -> Record<'_> {
    Record::new()
        .owned("origin_px", [f.origin_px])
        .number("px_per_metre", f.px_per_metre)
        .flag("mirrored", f.mirrored)
        .maybe_number("turn", (f.turn != 0.0).then_some(f.turn))
}

fn frame_of(r: &Reader<'_>) -> Result<PhotoFrame, String> {
    Ok(PhotoFrame {
        origin_px: r.one("origin_px")?,
        px_per_metre: r.one("px_per_metre")?,
        mirrored: r.flag("mirrored")?,
        turn: r.maybe_one("turn")?.unwrap_or(0.0),
    })
}

impl Panel {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .list("positions", &self.positions)
            .list("triangles", &self.triangles)
            .list("boundary", &self.boundary)
            .records("holes", self.holes.iter().map(|h| Record::new().list("vertices", h)))
            .records("edges", self.edges.iter().map(chain_fields))
            .records("inner", self.inner.iter().map(inner_chain_fields))
            .list("photo_px", &self.photo_px)
            .number("outline_area", self.outline_area)
            .number("outline_length", self.outline_length)
    }
}

impl Stored for Panel {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        Ok(Panel {
            positions: r.list("positions")?,
            triangles: r.list("triangles")?,
            boundary: r.list("boundary")?,
            holes: r.records("holes")?.map(|h| h.list("vertices")).collect::<Result<_, _>>()?,
            edges: r.records("edges")?.map(|e| chain_of(&e)).collect::<Result<_, _>>()?,
            inner: r.records("inner")?.map(|l| inner_chain_of(&l)).collect::<Result<_, _>>()?,
            photo_px: r.list("photo_px")?,
            outline_area: r.one("outline_area")?,
            outline_length: r.one("outline_length")?,
        })
    }
}

fn chain_fields(e: &PanelEdge) -> Record<'_> {
    Record::new().text("name", &e.name).list("vertices", &e.vertices)
}

fn chain_of(r: &Reader<'_>) -> Result<PanelEdge, String> {
    Ok(PanelEdge { name: r.text("name")?, vertices: r.list("vertices")? })
}

fn inner_chain_fields(l: &InnerChain) -> Record<'_> {
    Record::new()
        .text("name", &l.name)
        .text("kind", word(&INNER_KINDS, &l.kind))
        .list("vertices", &l.vertices)
}

fn inner_chain_of(r: &Reader<'_>) -> Result<InnerChain, String> {
    Ok(InnerChain {
        name: r.text("name")?,
        kind: value(&INNER_KINDS, r, "kind")?,
        vertices: r.list("vertices")?,
    })
}

/// The word for a value of a short list.
pub(super) fn word<T: PartialEq>(words: &[(&'static str, T)], value: &T) -> &'static str {
    words.iter().find(|(_, v)| v == value).map_or("", |(w, _)| w)
}

/// The value for a word of a short list.
pub(super) fn value<T: Copy>(words: &[(&'static str, T)], r: &Reader<'_>, name: &str) -> Result<T, String> {
    let text = r.text(name)?;
    let known = words.iter().find(|(w, _)| *w == text).map(|(_, v)| *v);
    known.ok_or_else(|| format!("`{name}` is \"{text}\", which is not one of its values"))
}
