//! What every pattern must be, whichever reader made it: numbers finite, names unique, seams along
//! edges that there are.

use super::super::SeamKind;
use super::{EdgeCurve, Pattern, PatternLoop, PatternSeam, Piece, Pose};
use crate::artifact::store::sound::{Sound, ensure, finite, finite_figure};
use std::collections::BTreeSet;

/// An arc of a greater bulge is a whole circle but for a few thousandths of a degree.
const LARGEST_BULGE: f64 = 1e5;
/// Directions are of length 1 and at right angles to this.
const SQUARE: f64 = 1e-6;

pub(super) fn check(pattern: &Pattern) -> Sound {
    let mut names = BTreeSet::new();
    for p in &pattern.pieces {
        ensure(!p.name.is_empty(), || "a piece has no name".to_owned())?;
        ensure(names.insert(p.name.as_str()), || format!("two pieces are called \"{}\"", p.name))?;
        piece(p).map_err(|what| format!("piece \"{}\": {what}", p.name))?;
    }
    pattern
        .seams
        .iter()
        .try_for_each(|s| seam(s, pattern).map_err(|what| format!("seam \"{}\": {what}", s.name)))
}

fn piece(p: &Piece) -> Sound {
    the_loop(&p.outer)?;
    let area = |l: &PatternLoop| super::super::polygon_area(&l.points().0);
    ensure(area(&p.outer) > 0.0, || "its outer loop does not run counter-clockwise".to_owned())?;
    for hole in &p.holes {
        the_loop(hole)?;
        ensure(area(hole) < 0.0, || "a hole does not run clockwise".to_owned())?;
    }
    let mut names = BTreeSet::new();
    let edges = p.outer.edges.iter().chain(p.holes.iter().flat_map(|h| &h.edges)).map(|e| &e.name);
    for name in edges.chain(p.lines.iter().map(|l| &l.name)) {
        ensure(!name.is_empty(), || "an edge has no name".to_owned())?;
        ensure(names.insert(name), || format!("two of its edges and lines are called \"{name}\""))?;
    }
    for line in &p.lines {
        ensure(line.points.len() >= 2, || format!("inner line \"{}\" has no length", line.name))?;
        finite("inner point", line.points.iter().map(|q| &q.coords))?;
        let length = super::super::polyline_length(&line.points);
        ensure(length > 0.0, || format!("inner line \"{}\" has no length", line.name))?;
    }
    for n in &p.notches {
        let edge = p.edge_number(&n.edge).map(|k| p.outer.path(k));
        let edge = edge.ok_or_else(|| format!("a notch stands on \"{}\", which is no edge", n.edge))?;
        let on = n.along >= 0.0 && n.along <= edge.length() * (1.0 + 1e-9);
        ensure(on, || format!("a notch stands {} m along \"{}\", beyond its ends", n.along, n.edge))?;
        finite_figure("depth of a notch", n.depth)?;
    }
    finite("drill hole", p.drill_holes.iter().map(|q| &q.coords))?;
    if let Some(grain) = &p.grain {
        finite("grain point", grain.iter().map(|q| &q.coords))?;
        let d = grain[1] - grain[0];
        let up = d.y > 0.0 && d.x.abs() <= SQUARE * d.y;
        ensure(up, || "its grain line does not run up along y".to_owned())?;
    }
    p.pose.as_ref().map_or(Ok(()), pose)
}

fn the_loop(l: &PatternLoop) -> Sound {
    let (n, e) = (l.corners.len(), l.edges.len());
    ensure(n == e && n >= 2, || format!("a loop has {n} corners and {e} edges"))?;
    finite("corner", l.corners.iter().map(|p| &p.coords))?;
    for (k, edge) in l.edges.iter().enumerate() {
        finite("control point", edge.curve.points().iter().map(|p| &p.coords))
            .and_then(|()| match edge.curve {
                EdgeCurve::Arc { bulge } => {
                    ensure(bulge.abs() <= LARGEST_BULGE, || format!("the bulge is {bulge}"))
                }
                _ => Ok(()),
            })
            .and_then(|()| ensure(l.path(k).length() > 0.0, || "it has no length".to_owned()))
            .map_err(|what| format!("edge \"{}\": {what}", edge.name))?;
    }
    Ok(())
}

fn pose(p: &Pose) -> Sound {
    finite("origin of its pose", [&p.origin.coords])?;
    finite("axis of its pose", [&p.across, &p.along])?;
    let unit = |v: &super::super::Vector3| (v.norm() - 1.0).abs() <= SQUARE;
    let square = unit(&p.across) && unit(&p.along) && p.across.dot(&p.along).abs() <= SQUARE;
    ensure(square, || "the axes of its pose are not of length 1 and at right angles".to_owned())
}

fn seam(s: &PatternSeam, pattern: &Pattern) -> Sound {
    s.kind.check()?;
    let least = if matches!(s.kind, SeamKind::Elastic { .. }) { 1 } else { 2 };
    ensure(s.sides.len() >= least, || format!("it has {} sides, {least} are the least", s.sides.len()))?;
    ensure(s.sides.iter().all(|side| !side.is_empty()), || "a side of it has no edge".to_owned())?;
    for u in s.sides.iter().flatten() {
        let piece = pattern.piece(&u.edge.panel);
        let piece = piece.ok_or_else(|| format!("there is no piece \"{}\"", u.edge.panel))?;
        let known = piece.edge_number(&u.edge.edge).is_some() || piece.line(&u.edge.edge).is_some();
        ensure(known, || {
            format!("piece \"{}\" has no outer edge or line \"{}\"", u.edge.panel, u.edge.edge)
        })?;
    }
    Ok(())
}
