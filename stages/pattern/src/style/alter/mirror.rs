//! Mirror images of pieces: another one, or one that is there already.

use super::names::{self, other_side};
use super::shown::Showing;
use crate::pattern::copies::mirrored;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::prelude::*;

/// Adds the mirror image of a piece under a name, or makes the piece of that name the mirror image.
pub(super) fn mirror(
    piece: &str,
    name: &str,
    pattern: &mut Pattern,
    showing: &mut Showing,
    cx: &Context,
) -> Result<(), StageError> {
    let from = names::piece(pattern, piece)?;
    if name.is_empty() || name.contains('.') {
        return Err(StageError::invalid(format!("\"{name}\" is no name for a piece"))
            .hint(format!("take one without a full stop, such as \"{piece}_mirrored\"")));
    }
    let image = renamed(mirrored(&pattern.pieces[from]));
    match pattern.pieces.iter().position(|p| p.name == name) {
        None => {
            let pose = image.pose.map(across_the_body);
            cx.note(format!("\"{name}\" is the mirror image of \"{piece}\"; `Sew` sews it to other pieces"));
            pattern.pieces.insert(from + 1, Piece { name: name.to_owned(), pose, ..image });
        }
        Some(to) => {
            let made = in_place_of(&pattern.pieces[to], image, piece)?;
            needed(pattern, name, &made)?;
            pattern.pieces[to] = made;
        }
    }
    sew_within(piece, name, pattern);
    showing.mirror(piece, name);
    Ok(())
}

/// Left and right exchanged in the names of its edges and lines.
fn renamed(mut image: Piece) -> Piece {
    let edges = image.outer.edges.iter_mut().chain(image.holes.iter_mut().flat_map(|h| &mut h.edges));
    edges.for_each(|e| e.name = other_side(&e.name));
    image.lines.iter_mut().for_each(|l| l.name = other_side(&l.name));
    image.notches.iter_mut().for_each(|n| n.edge = other_side(&n.edge));
    image
}

/// The place on the other side of the body, with the outside out.
fn across_the_body(pose: Pose) -> Pose {
    let flip = |v: Vector3| Vector3::new(-v.x, v.y, v.z);
    Pose {
        origin: Point3::from(flip(pose.origin.coords)),
        across: -flip(pose.across),
        along: flip(pose.along),
    }
}

/// The mirror image of `piece` with the name and at the place of another, about whose middle it
/// lies.
fn in_place_of(other: &Piece, image: Piece, piece: &str) -> Result<Piece, StageError> {
    let edges = |p: &Piece| p.outer.edges.iter().map(|e| e.name.clone()).collect::<BTreeSet<_>>();
    let (is, was) = (edges(&image), edges(other));
    if is != was {
        let list = |names: &BTreeSet<String>| names.iter().cloned().collect::<Vec<_>>().join(", ");
        return Err(StageError::invalid(format!(
            "\"{}\" cannot become the mirror image of \"{piece}\": they have other edges",
            other.name
        ))
        .hint(format!(
            "its edges are {}, those of the mirror image {}; under a new name it is a new piece",
            list(&was),
            list(&is)
        )));
    }
    let by = middle(&other.outer) - middle(&image.outer);
    let first = other.outer.edges.first().map(|e| e.name.clone()).unwrap_or_default();
    let mut made = shifted(image, by);
    let turn = made.edge_number(&first).unwrap_or(0);
    made.outer.edges.rotate_left(turn);
    made.outer.corners.rotate_left(turn);
    Ok(Piece {
        name: other.name.clone(),
        pose: other.pose,
        body_part: other.body_part,
        layer: other.layer,
        ..made
    })
}

/// The middle of the area of a loop.
fn middle(l: &PatternLoop) -> Point2 {
    let points = l.points().0;
    let Some(first) = points.first().copied() else { return Point2::origin() };
    let (mut sum, mut area) = (Vector2::zeros(), 0.0);
    for w in points.windows(2) {
        let (a, b) = (w[0] - first, w[1] - first);
        let twice = a.perp(&b);
        sum += (a + b) * (twice / 3.0);
        area += twice;
    }
    if area.abs() > 0.0 { first + sum / area } else { first }
}

fn shifted(mut piece: Piece, by: Vector2) -> Piece {
    for l in std::iter::once(&mut piece.outer).chain(&mut piece.holes) {
        l.corners.iter_mut().for_each(|c| *c += by);
        l.edges.iter_mut().for_each(|e| e.curve = e.curve.moved(|p| p + by, false));
    }
    piece.lines.iter_mut().flat_map(|l| &mut l.points).for_each(|p| *p += by);
    piece.drill_holes.iter_mut().for_each(|p| *p += by);
    piece.grain = piece.grain.map(|g| g.map(|p| p + by));
    piece
}

/// Refuses a mirror image that lacks a line which a seam of the piece runs along.
fn needed(pattern: &Pattern, name: &str, made: &Piece) -> Result<(), StageError> {
    let uses = pattern.seams.iter().flat_map(|s| s.sides.iter().flatten());
    let lacks = |u: &&EdgeUse| u.edge.panel == name && made.path(&u.edge.edge).is_none();
    match uses.into_iter().find(lacks) {
        Some(u) => Err(StageError::invalid(format!("the mirror image lacks \"{}\", which is sewn", u.edge))
            .hint(format!("open its seam before: Unsew(edge: \"{}\")", u.edge))),
        None => Ok(()),
    }
}

/// The seams within a piece, as of its darts, are sewn in its mirror image, too.
fn sew_within(piece: &str, name: &str, pattern: &mut Pattern) {
    if piece == name {
        return;
    }
    let lines: BTreeMap<&str, &Piece> = pattern.pieces.iter().map(|p| (p.name.as_str(), p)).collect();
    let is_line = |edge: &str| lines.get(piece).is_some_and(|p| p.edge_number(edge).is_none());
    let edges = |s: &PatternSeam| s.sides.iter().flatten().map(|u| u.edge.clone()).collect::<BTreeSet<_>>();
    let sewn: Vec<BTreeSet<EdgeRef>> = pattern.seams.iter().map(edges).collect();
    let within = pattern.seams.iter().filter(|s| s.sides.iter().flatten().all(|u| u.edge.panel == piece));
    let image = |s: &PatternSeam| PatternSeam {
        name: format!("{} of {name}", s.name),
        kind: s.kind,
        sides: s
            .sides
            .iter()
            .map(|side| {
                // Edges run the other way in a mirror, lines do not.
                let of = |u: &EdgeUse| EdgeUse {
                    edge: EdgeRef { panel: name.to_owned(), edge: other_side(&u.edge.edge) },
                    reversed: u.reversed == is_line(&u.edge.edge),
                };
                side.iter().map(of).collect()
            })
            .collect(),
    };
    let added: Vec<PatternSeam> = within.map(image).filter(|s| !sewn.contains(&edges(s))).collect();
    pattern.seams.extend(added);
}
