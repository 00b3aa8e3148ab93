//! The edges of a piece as the curves of the format, cut where seams need it.

use super::curve::FileCurve;
use super::fit::fitted;
use crate::flatten::flatten;
use crate::parts::{EdgePart, parts};
use toile_core::artifact::{EdgeCurve, PatternLoop};

/// A polyline becomes curves that leave it by no more than this, metres.
const FIT: f64 = 2.5e-5;
/// A chord of less than this share of its edge is too short to give control points relative to it.
const SHORT: f64 = 1e-4;
/// And one of less than this, metres: readers leave it out.
const NOTHING: f64 = 1e-8;

/// For each edge of a loop the curves that it becomes.
pub(super) fn curves(l: &PatternLoop) -> Vec<Vec<FileCurve>> {
    let mut out = vec![Vec::new(); l.edges.len()];
    for part in parts(l, |chord, length| chord <= NOTHING || chord <= SHORT * length) {
        out[part.edge].extend(one(part));
    }
    out
}

fn one(part: EdgePart) -> Vec<FileCurve> {
    let EdgePart { start, end, curve, .. } = part;
    match &curve {
        EdgeCurve::Polyline { .. } => fitted(&flatten(start, end, &curve, FIT), FIT),
        EdgeCurve::Arc { bulge } if bulge.abs() < 1e-12 => {
            vec![FileCurve { start, end, shape: EdgeCurve::Line }]
        }
        EdgeCurve::Line | EdgeCurve::Quadratic { .. } | EdgeCurve::Cubic { .. } | EdgeCurve::Arc { .. } => {
            vec![FileCurve { start, end, shape: curve }]
        }
    }
}
