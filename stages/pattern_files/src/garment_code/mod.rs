//! GarmentCode JSON, `*_specification.json`.
//!
//! The format has no schema; pygarment 2.0 (Korosteleva and Sorkine-Hornung 2023) is its
//! specification. Centimetres, 100 units a metre; control points relative to the chord of their
//! edge; radii of circles in centimetres. [`curves`] makes edges of the format, [`stitches`]
//! stitches, [`json`] the text.
//!
//! Cost: some milliseconds a piece. Limits: the format has no holes, lines inside pieces, notches,
//! grain lines, drill holes, layers and kinds of seams; each is told. A polyline becomes straight
//! edges and cubic curves within 0.025 mm.

mod curve;
mod curves;
mod fit;
mod json;
mod places;
mod pose;
mod stitches;

use crate::error::{WriteError, writable};
use crate::names::{FileNames, PieceNames, unique};
use crate::sidecar;
use crate::written::Written;
use curve::FileCurve;
use json::{File, InOrder, JsonEdge, JsonPanel, Sewn, StitchSide};
use std::collections::BTreeSet;
use toile_core::artifact::{BodyPart, Pattern, Piece, Pose};

/// Readers take a file whose largest piece is not of this size for one in other units, metres.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 0.15..=5.0;

/// A pattern as a file of GarmentCode, with all its seams in the file beside it.
///
/// An edge keeps its name as its label, as a `name` where GarmentCode would refuse two labels in
/// one stitch; `edge_0`, `edge_1`, ... by their place need none. A piece without a place is put
/// beside the others. Numbers are written so that they are read back to the last bit.
///
/// Errors: a pattern that is not sound, that has no pieces, or with a piece beyond
/// [`FARTHEST`](crate::FARTHEST).
pub fn to_json(pattern: &Pattern) -> Result<Written, WriteError> {
    writable(pattern)?;
    let (mut notes, mut warnings) = (left_out(&pattern.pieces), Vec::new());
    let mut drawn: stitches::CurvesOfEdges =
        pattern.pieces.iter().map(|p| curves::curves(&p.outer)).collect();
    let sewn = stitches::stitches(pattern, &mut drawn, &mut warnings);
    let poses = places::poses(&pattern.pieces, &drawn, &sewn, &mut notes);
    let mut names = FileNames::default();
    let mut panels = Vec::with_capacity(pattern.pieces.len());
    for ((p, curves), pose) in pattern.pieces.iter().zip(&drawn).zip(&poses) {
        let (panel, of_piece) = panel(p, curves, pose);
        names.insert(&p.name, of_piece);
        panels.push((p.name.as_str(), panel));
    }
    size(&pattern.pieces, &mut warnings);
    // The panel and its edge that a side of a stitch is, by their numbers.
    let number = |(piece, edge, k): (usize, usize, usize)| {
        (piece, drawn[piece][..edge].iter().map(Vec::len).sum::<usize>() + k)
    };
    labelled_alike(&mut panels, sewn.iter().map(|s| s.sides.map(number)));
    let stitches = sewn.iter().map(|s| {
        let side = |(piece, edge): (usize, usize)| StitchSide { panel: &pattern.pieces[piece].name, edge };
        Sewn::new(s.sides.map(|s| side(number(s))), s.right_wrong)
    });
    let order = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    let text = File::new(InOrder(panels), stitches.collect(), order).text();
    let (seams, mut told) = sidecar::along(pattern, &names);
    warnings.append(&mut told);
    Ok(Written { bytes: text.into_bytes(), seams, notes, warnings })
}

/// Takes the labels from the edges of stitches whose sides are called differently: GarmentCode
/// refuses those.
fn labelled_alike(panels: &mut [(&str, JsonPanel<'_>)], stitches: impl Iterator<Item = [(usize, usize); 2]>) {
    for sides in stitches {
        let [a, b] = sides.map(|(panel, edge)| panels[panel].1.edges[edge].called().map(str::to_owned));
        if a.is_some() && b.is_some() && a != b {
            sides.iter().for_each(|(panel, edge)| panels[*panel].1.edges[*edge].unlabelled());
        }
    }
}

/// What the format has no place for, a sentence for each kind.
fn left_out(pieces: &[Piece]) -> Vec<String> {
    let count = |what: &str, of: fn(&Piece) -> usize| {
        let n: usize = pieces.iter().map(of).sum();
        (n > 0).then(|| format!("{n} {what} are left out: the format has none"))
    };
    let all = [
        count("holes", |p| p.holes.len()),
        count("lines inside pieces", |p| p.lines.len()),
        count("notches", |p| p.notches.len()),
        count("drill holes", |p| p.drill_holes.len()),
        count("grain lines", |p| usize::from(p.grain.is_some())),
        count("layers of pieces", |p| usize::from(p.layer > 0)),
    ];
    all.into_iter().flatten().collect()
}

/// Tells a size that readers take for that of other units.
fn size(pieces: &[Piece], told: &mut Vec<String>) {
    let span = |p: &Piece, of: fn(&toile_core::artifact::Point2) -> f64| {
        let all = || p.outer.corners.iter().map(of);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    let largest = pieces.iter().map(|p| span(p, |c| c.x).max(span(p, |c| c.y))).fold(0.0, f64::max);
    if !PLAUSIBLE.contains(&largest) {
        told.push(format!(
            "the largest piece is {largest:.3} m long: readers that look whether a garment is of its usual size take it for one in other units"
        ));
    }
}

/// A piece as a panel, and the names of its edges in the file.
fn panel<'a>(p: &'a Piece, curves: &[Vec<FileCurve>], pose: &Pose) -> (JsonPanel<'a>, PieceNames) {
    let whole = |e: usize| curves[e].len() == 1;
    // Names of edges that stay whole are kept; those of parts must differ from them.
    let mut taken: BTreeSet<String> =
        (0..curves.len()).filter(|&e| whole(e)).map(|e| p.outer.edges[e].name.clone()).collect();
    let count: usize = curves.iter().map(Vec::len).sum();
    let (mut edges, mut vertices) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut names = PieceNames { piece: p.name.clone(), ..PieceNames::default() };
    for (e, list) in curves.iter().enumerate() {
        let own = &p.outer.edges[e].name;
        let part = |taken: &mut BTreeSet<String>, k: usize| match list.len() {
            1 => own.clone(),
            _ => unique(taken, &format!("{own}_{}", k + 1)),
        };
        let named: Vec<String> = (0..list.len()).map(|k| part(&mut taken, k)).collect();
        for (curve, name) in list.iter().zip(&named) {
            let i = edges.len();
            vertices.push([curve.start.x * json::UNITS, curve.start.y * json::UNITS]);
            let label = (*name != format!("edge_{i}")).then(|| name.clone());
            edges.push(JsonEdge::new([i, (i + 1) % count], curve, label));
        }
        names.edges.insert(own.clone(), named);
    }
    let pose = pose::squared(pose);
    let panel = JsonPanel {
        translation: pose.origin.coords.map(|c| c * json::UNITS).into(),
        rotation: pose::angles(&pose),
        vertices,
        edges,
        label: p.body_part.and_then(word),
    };
    (panel, names)
}

fn word(part: BodyPart) -> Option<&'static str> {
    BodyPart::WORDS.iter().find(|(_, p)| *p == part).map(|(word, _)| *word)
}
