//! Paths of a draft as sides, in metres.

use super::super::side::Side;
use toile_core::prelude::*;
use toile_seamly::{DraftArc, DraftStroke, DraftedPath};

/// Arcs that turn by more are halved, degrees: an edge turns by less than a whole circle.
const WIDEST: f64 = 270.0;

/// A path as one side.
pub(super) fn side(path: &DraftedPath, metres: f64) -> Side {
    let at = |p: [f64; 2]| Point2::new(p[0] * metres, p[1] * metres);
    let mut parts = Vec::new();
    for part in &path.parts {
        let end = at([part.end.x, part.end.y]);
        match part.stroke {
            None => parts.push((EdgeCurve::Line, end)),
            Some(DraftStroke::Cubic(c)) => {
                let controls = [c.p1, c.p2].map(|p| at([p.x, p.y]));
                parts.push((EdgeCurve::Cubic { controls }, end));
            }
            Some(DraftStroke::Arc(arc)) => {
                for half in narrow(arc) {
                    let last = half.at(1.0);
                    let bulge = (half.sweep.to_radians() / 4.0).tan();
                    parts.push((EdgeCurve::Arc { bulge }, at([last.x, last.y])));
                }
                if let Some((_, last)) = parts.last_mut() {
                    *last = end;
                }
            }
        }
    }
    Side { name: String::new(), start: at([path.start.x, path.start.y]), parts }
}

fn narrow(arc: DraftArc) -> Vec<DraftArc> {
    if arc.sweep.abs() <= WIDEST {
        return vec![arc];
    }
    let half = arc.sweep / 2.0;
    vec![DraftArc { sweep: half, ..arc }, DraftArc { start: arc.start + half, sweep: half, ..arc }]
}

/// The name of the point of a path that lies nearest to a place, if one lies there.
pub(super) fn label(path: &DraftedPath, metres: f64, at: Point2) -> &str {
    let mut from = path.start;
    for part in &path.parts {
        if (Point2::new(from.x * metres, from.y * metres) - at).norm() <= 1e-6 && !part.from.is_empty() {
            return &part.from;
        }
        from = part.end;
    }
    ""
}
