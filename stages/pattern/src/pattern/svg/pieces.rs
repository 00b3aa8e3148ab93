//! Pieces of what is drawn: which line is an outline, what belongs to it, how often it is cut.
//!
//! Method: a group that FreeSewing calls a part is a piece. Elsewhere a closed line is one: alone
//! in its group under the group's name, else under its own. A line called a seam or an outline goes
//! before others; of lines within each other the outermost is the outline ([`nested`]). Lines that
//! meet end to end are chained where a group has no closed one. Marks belong to the piece of their
//! group, else to the piece that they lie on. What is left out is reported with its place. Cost:
//! shapes times pieces. Limits: a piece is larger than [`LEAST`].

use super::super::chain::{JOINT, chained};
use super::super::copies::{MOST_COPIES, copies};
use super::super::marks::{hole, notched};
use super::super::side::{NotSimple, Side, check_simple, counter_clockwise, pattern_loop, points, split};
use super::super::unfold::{Fold, distinct, image_word, open_ring};
use super::damage::{SvgDamage, SvgPlace};
use super::drawing::{Drawing, DrawnShape, Name};
use super::nested;
use super::outlined::Outlined;
use super::path::Line;
use super::role::{Role, cut};
use super::source::place;
use std::collections::BTreeMap;
use toile_core::Remarks;
use toile_core::prelude::*;

/// No smaller closed line is a piece, square metres.
const LEAST: f64 = 4e-4;
/// Marks lie on a piece, or this near, metres.
const NEAR: f64 = 0.015;
/// Pieces of a garment.
const MOST_PIECES: usize = 500;
/// Shapes that are looked at to find them.
const MOST_OUTLINES: usize = 1_000;
/// Curves shorter than this are none, metres.
const POINT: f64 = 1e-7;
/// Greatest number of places of left-out lines that are reported one by one.
const MOST_TOLD: usize = 4;
/// Left-out lines shorter than this are not reported, metres.
const SHORT: f64 = 0.01;
/// A grain line this near to the horizontal says itself which end is up, as the sine of its angle.
const LEVEL: f64 = 0.02;

/// The pieces of a drawing; what was found and left out is reported.
///
/// Errors: all that is wrong with them.
pub(super) fn pieces(
    d: &Drawing<'_>,
    by_word: bool,
    told: &mut Remarks,
) -> Result<Vec<Piece>, Vec<SvgDamage>> {
    let outlines = outlines(d, told).map_err(|damage| vec![damage])?;
    if outlines.is_empty() {
        return Err(vec![match (d.shapes.is_empty(), d.pictures > 0, d.texts.is_empty()) {
            (true, true, _) => SvgDamage::PictureAlone,
            (true, false, false) => SvgDamage::TextAlone,
            _ => SvgDamage::NoPieces,
        }]);
    }
    if d.pictures > 0 {
        told.warnings.push(format!("{} pictures of pixels are left out", d.pictures));
    }
    let names = named(d, &outlines);
    let owners = Owners::of(d, &outlines);
    let lost = d.shapes.iter().filter(|s| is_mark(s.role) && owners.of_shape(s).is_none());
    left_out("marks lie on no piece", lost, told);
    let (mut out, mut faults, mut clockwise) = (Vec::new(), Vec::new(), 0);
    for (k, outline) in outlines.iter().enumerate() {
        let mine: Vec<&DrawnShape<'_>> = d.shapes.iter().filter(|s| owners.of_shape(s) == Some(k)).collect();
        let drawn = Drawn { name: &names[k], place: place(outline.shape.node) };
        clockwise += usize::from(outline.closed && polygon_area(&outline.polygon) < 0.0);
        let piece = match drawn.piece(outline, &mine, told) {
            Ok(piece) => piece,
            Err(damage) => {
                faults.push(damage);
                continue;
            }
        };
        let texts = d.texts.iter().filter(|t| owners.at(t.group, t.at) == Some(k));
        let (plain, turned) =
            texts.filter_map(|t| cut(&t.text, by_word, MOST_COPIES)).next().unwrap_or((1, 0));
        out.extend(copies(piece, plain, turned, told));
        if out.len() > MOST_PIECES {
            return Err(vec![SvgDamage::Many { what: "pieces", most: MOST_PIECES }]);
        }
    }
    if clockwise > 0 {
        told.notes.push(format!(
            "{clockwise} pieces are drawn clockwise: their edges run counter-clockwise all the same, as the arrows in their pictures show"
        ));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    if out.is_empty() { Err(vec![SvgDamage::NoPieces]) } else { Ok(out) }
}

/// Reports what is left out, and where it is in the file.
fn left_out<'d, 't: 'd>(why: &str, shapes: impl Iterator<Item = &'d DrawnShape<'t>>, told: &mut Remarks) {
    let places: Vec<&DrawnShape<'_>> = shapes.collect();
    if !places.is_empty() {
        let first: Vec<String> = places.iter().take(MOST_TOLD).map(|s| place(s.node).to_string()).collect();
        let more = places.len().saturating_sub(MOST_TOLD);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        told.warnings.push(format!("{} {why}: left out ({}{more})", places.len(), first.join(", ")));
    }
}

fn is_mark(role: Option<Role>) -> bool {
    match role {
        Some(Role::Grain { .. } | Role::Fold | Role::Notch | Role::Drill | Role::Hole | Role::Mark) => true,
        Some(Role::Outline | Role::Allowance | Role::Nothing | Role::Dimension) | None => false,
    }
}

/// The nearest group around an element that is more than the role of its lines.
fn owner(d: &Drawing<'_>, mut group: usize) -> usize {
    while let Some(parent) = d.groups[group].parent.filter(|_| d.groups[group].role) {
        group = parent;
    }
    group
}

/// The part of FreeSewing around a group.
fn part(d: &Drawing<'_>, mut group: usize) -> Option<usize> {
    loop {
        if d.groups[group].part.is_some() {
            return Some(group);
        }
        group = d.groups[group].parent?;
    }
}

/// One outline a piece, in the order of the file.
fn outlines<'d, 't>(d: &'d Drawing<'t>, told: &mut Remarks) -> Result<Vec<Outlined<'d, 't>>, SvgDamage> {
    let freesewing = d.groups.iter().any(|g| g.part.is_some());
    let home = |s: &DrawnShape<'_>| if freesewing { part(d, s.group) } else { Some(owner(d, s.group)) };
    let mut groups: BTreeMap<usize, Vec<&'d DrawnShape<'t>>> = BTreeMap::new();
    for s in d.shapes.iter().filter(|s| matches!(s.role, None | Some(Role::Outline))) {
        if let Some(group) = home(s) {
            groups.entry(group).or_default().push(s);
        }
    }
    let folds = d.shapes.iter().filter(|s| matches!(s.role, Some(Role::Fold | Role::Grain { fold: true })));
    let folded: Vec<usize> = folds.filter_map(home).collect();
    let mut found: Vec<Outlined<'d, 't>> = Vec::new();
    let (mut small, mut inner, mut loose, mut frames) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (group, shapes) in &groups {
        let all = shapes.iter().flat_map(|s| closed(s));
        let (mut closed, tiny): (Vec<Outlined<'_, '_>>, Vec<_>) = all.partition(|o| o.area >= LEAST);
        small.extend(tiny.iter().map(|o| o.shape));
        if closed.len() > MOST_OUTLINES {
            return Err(SvgDamage::Many { what: "closed lines", most: MOST_OUTLINES });
        }
        if closed.is_empty() {
            found.extend(open(shapes, folded.contains(group)));
            continue;
        }
        if closed.iter().any(Outlined::says) {
            closed.retain(Outlined::says);
        } else {
            loose.extend(shapes.iter().filter(|s| is_loose(s)).copied());
        }
        let is_sheet = *group == 0 || d.groups[*group].layer;
        let chosen = match freesewing {
            true => nested::largest(closed),
            false => nested::outermost(closed, is_sheet),
        };
        found.extend(chosen.pieces);
        inner.extend(chosen.within.iter().map(|o| o.shape));
        frames.extend(chosen.frames.iter().map(|o| o.shape));
        if found.len() > MOST_OUTLINES {
            return Err(SvgDamage::Many { what: "closed lines", most: MOST_OUTLINES });
        }
    }
    let around = around_others(d, &found);
    frames.extend(around.iter().map(|k| found[*k].shape));
    left_out("closed lines are too small for pieces", small.into_iter(), told);
    left_out(
        "closed lines lie on a piece of their group and are not called anything",
        inner.into_iter(),
        told,
    );
    left_out("open lines belong to no outline and are not called anything", loose.into_iter(), told);
    left_out("closed lines around other pieces are taken for frames", frames.into_iter(), told);
    let mut k = 0;
    found.retain(|_| {
        k += 1;
        !around.contains(&(k - 1))
    });
    Ok(found)
}

/// Whether a shape has open lines alone, of some length.
fn is_loose(shape: &DrawnShape<'_>) -> bool {
    let open = |l: &Line| !l.closed && (l.end() - l.start).norm() > JOINT;
    let length = |l: &Line| Side { name: String::new(), start: l.start, parts: l.parts.clone() }.length();
    shape.lines.iter().all(open) && shape.lines.iter().map(length).sum::<f64>() > SHORT
}

/// The closed lines of a shape that may be outlines, the largest first; those that lie within one
/// are its holes.
fn closed<'d, 't>(shape: &'d DrawnShape<'t>) -> Vec<Outlined<'d, 't>> {
    let ends = |l: &&Line| l.closed || (l.end() - l.start).norm() <= JOINT;
    let mut loops: Vec<(f64, Vec<Side>, Vec<Point2>)> = Vec::new();
    for line in shape.lines.iter().filter(ends) {
        let sides = split(line.start, &around(line));
        if sides.len() >= 2 {
            let polygon = points(&sides);
            loops.push((polygon_area(&polygon).abs(), sides, polygon));
        }
    }
    loops.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut out: Vec<Outlined<'d, 't>> = Vec::new();
    for (area, sides, polygon) in loops {
        match out.iter_mut().find(|o| o.has(polygon[0])) {
            Some(around) if area > 1e-6 => around.holes.push(polygon),
            Some(_) => {}
            None => out.push(Outlined { shape, sides, closed: true, holes: Vec::new(), polygon, area }),
        }
    }
    out
}

/// The curves of a closed line that have a length; a line from its end to its start where there is
/// a gap.
fn around(line: &Line) -> Vec<(EdgeCurve, Point2)> {
    let mut parts = drawn(line);
    let gap = (line.end() - line.start).norm();
    match parts.last_mut() {
        Some((_, end)) if gap <= JOINT => *end = line.start,
        Some(_) => parts.push((EdgeCurve::Line, line.start)),
        None => {}
    }
    parts
}

/// The curves of a line that have a length.
fn drawn(line: &Line) -> Vec<(EdgeCurve, Point2)> {
    let mut parts: Vec<(EdgeCurve, Point2)> = Vec::new();
    let mut from = line.start;
    for (curve, end) in &line.parts {
        if EdgePath::new(from, *end, curve).length() > POINT {
            parts.push((curve.clone(), *end));
            from = *end;
        }
    }
    parts
}

/// What an element of one line is called by its author, if that serves as the name of an edge.
fn own_name(shape: &DrawnShape<'_>) -> Option<String> {
    let name =
        shape.name.as_ref().filter(|n| !n.generated && !n.text.contains('.') && shape.lines.len() == 1);
    name.map(|n| n.text.clone())
}

/// The lines of a group that may be chained to one outline: those that are called so, else those
/// that are called nothing. A fold may be the one that is missing.
fn open<'d, 't>(shapes: &[&'d DrawnShape<'t>], folded: bool) -> Option<Outlined<'d, 't>> {
    let says = shapes.iter().any(|s| s.role == Some(Role::Outline));
    let mine = || shapes.iter().filter(move |s| !says || s.role == Some(Role::Outline));
    let mut sides = Vec::new();
    for shape in mine() {
        for line in &shape.lines {
            let name = own_name(shape).unwrap_or_else(|| format!("edge_{}", sides.len()));
            let parts = drawn(line);
            if !parts.is_empty() {
                sides.push(Side { name, start: line.start, parts });
            }
        }
    }
    let first = *mine().next()?;
    let polygon = points(&sides);
    let area = polygon_area(&polygon).abs();
    // Lines that enclose nothing are a drawing of something else.
    (sides.len() + usize::from(says || folded) >= 2 && area >= LEAST).then_some(Outlined {
        shape: first,
        sides,
        closed: false,
        holes: Vec::new(),
        polygon,
        area,
    })
}

/// The numbers of outlines that only go around those of other groups.
fn around_others(d: &Drawing<'_>, all: &[Outlined<'_, '_>]) -> Vec<usize> {
    let frame = |i: &usize| {
        let a = &all[*i];
        let around = |b: &Outlined<'_, '_>| {
            owner(d, a.shape.group) != owner(d, b.shape.group) && a.area > b.area && a.has(b.polygon[0])
        };
        !a.says() && all.iter().any(around)
    };
    (0..all.len()).filter(frame).collect()
}

/// The name of each piece: of its group where that holds no other, else of its line.
fn named(d: &Drawing<'_>, outlines: &[Outlined<'_, '_>]) -> Vec<String> {
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    let one = |(k, o): (usize, &Outlined<'_, '_>)| {
        let own = part(d, o.shape.group).unwrap_or_else(|| owner(d, o.shape.group));
        let group = &d.groups[own];
        let alone = outlines.iter().filter(|p| owner(d, p.shape.group) == own).count() == 1;
        let (a, b) = (group.name.as_ref().filter(|_| alone), o.shape.name.as_ref());
        let order: [Option<&Name>; 2] = if group.layer { [b, a] } else { [a, b] };
        let told = order.iter().flatten().find(|n| !n.generated).or_else(|| order.iter().flatten().next());
        let name = group.part.clone().or_else(|| told.map(|n| n.text.clone()));
        // A point in a name would end it where seams name an edge.
        let name = name.unwrap_or_else(|| format!("piece_{}", k + 1)).replace('.', "_");
        let again = taken.entry(name.clone()).or_default();
        *again += 1;
        if *again == 1 { name } else { format!("{name}_{again}") }
    };
    outlines.iter().enumerate().map(one).collect()
}

/// Which piece what is drawn belongs to.
struct Owners<'d, 't> {
    d: &'d Drawing<'t>,
    outlines: &'d [Outlined<'d, 't>],
    /// The piece of each group that has one alone.
    of_group: BTreeMap<usize, usize>,
}

impl<'d, 't> Owners<'d, 't> {
    fn of(d: &'d Drawing<'t>, outlines: &'d [Outlined<'d, 't>]) -> Self {
        let mut all: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (k, o) in outlines.iter().enumerate() {
            let group = part(d, o.shape.group).unwrap_or_else(|| owner(d, o.shape.group));
            all.entry(group).or_default().push(k);
        }
        let alone =
            all.into_iter().filter(|(group, k)| k.len() == 1 && *group != 0 && !d.groups[*group].layer);
        Owners { d, outlines, of_group: alone.map(|(group, k)| (group, k[0])).collect() }
    }

    fn of_shape(&self, s: &DrawnShape<'_>) -> Option<usize> {
        self.at(s.group, middle(s))
    }

    fn at(&self, mut group: usize, p: Point2) -> Option<usize> {
        loop {
            if let Some(&k) = self.of_group.get(&group) {
                return Some(k);
            }
            match self.d.groups[group].parent {
                Some(parent) => group = parent,
                None => break,
            }
        }
        let on = (0..self.outlines.len()).filter(|&k| self.outlines[k].has(p));
        let least = on.min_by(|&i, &j| self.outlines[i].area.total_cmp(&self.outlines[j].area));
        least.or_else(|| {
            let far = |k: usize| {
                self.outlines[k].polygon.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min)
            };
            let near = (0..self.outlines.len()).map(|k| (far(k), k)).min_by(|a, b| a.0.total_cmp(&b.0));
            near.filter(|(far, _)| *far <= NEAR).map(|(_, k)| k)
        })
    }
}

/// The middle of the box around a shape.
fn middle(s: &DrawnShape<'_>) -> Point2 {
    let points =
        || s.lines.iter().flat_map(|l| std::iter::once(l.start).chain(l.parts.iter().map(|(_, end)| *end)));
    let first = points().next().unwrap_or_else(Point2::origin);
    let (lo, hi) = points().fold((first, first), |(lo, hi), p| (lo.inf(&p), hi.sup(&p)));
    nalgebra::center(&lo, &hi)
}

/// From where to where a line runs: between the ends of an open one, along the longest way through
/// a closed one.
fn ends(line: &Line) -> (Point2, Point2) {
    if !line.closed && (line.end() - line.start).norm() > JOINT {
        return (line.start, line.end());
    }
    let points: Vec<Point2> =
        std::iter::once(line.start).chain(line.parts.iter().map(|(_, end)| *end)).take(200).collect();
    let pairs = points.iter().flat_map(|a| points.iter().map(move |b| (*a, *b)));
    let far = |(a, b): &(Point2, Point2)| (b - a).norm();
    pairs.max_by(|x, y| far(x).total_cmp(&far(y))).unwrap_or((line.start, line.start))
}

/// A piece under construction, for errors.
struct Drawn<'a> {
    name: &'a str,
    place: SvgPlace,
}

impl Drawn<'_> {
    fn fault(&self, what: &'static str) -> SvgDamage {
        SvgDamage::Piece { piece: self.name.to_owned(), place: self.place.clone(), what }
    }

    fn no_fold(&self, place: SvgPlace) -> SvgDamage {
        SvgDamage::Fold { piece: self.name.to_owned(), place }
    }

    fn piece(
        &self,
        outline: &Outlined<'_, '_>,
        mine: &[&DrawnShape<'_>],
        told: &mut Remarks,
    ) -> Result<Piece, SvgDamage> {
        let folds = self.folds(mine)?;
        let mut sides = self.closed(outline, folds.first().map(|(fold, _)| fold), told)?;
        if let Some((_, at)) = folds.iter().find(|(fold, _)| !fold.holds(&sides)) {
            return Err(self.no_fold(at.clone()));
        }
        let grain = longest(mine, |role| matches!(role, Role::Grain { .. })).map(|(line, _)| ends(line));
        let turn = turn(grain);
        let up = move |p: Point2| Point2::new(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y);
        sides = sides.iter().map(|s| s.moved(up, false)).collect();
        let mut marks = Marks::of(outline, mine, up);
        for (k, (fold, at)) in folds.iter().enumerate() {
            let word = image_word(k);
            let turned = Fold::through(up(fold.at), up(fold.at + fold.way));
            let turned = turned.ok_or_else(|| self.no_fold(at.clone()))?;
            let unfolded = turned.unfolded(&sides, &word).ok_or_else(|| self.no_fold(at.clone()))?;
            sides = unfolded.sides;
            marks.unfold(&turned, &word);
            told.warnings.extend(unfolded.open.iter().map(|pair| open_ring(self.name, pair)));
        }
        match folds.len() {
            0 => {}
            1 => told.notes.push(format!("piece \"{}\" is unfolded at its fold", self.name)),
            n => told.notes.push(format!("piece \"{}\" is unfolded at its {n} folds", self.name)),
        }
        let sides = counter_clockwise(sides);
        self.simple(&sides, turn)?;
        let outer = pattern_loop(&sides);
        Ok(Piece {
            name: self.name.to_owned(),
            notches: notched(&outer, &marks.notches),
            outer,
            holes: marks.holes.into_iter().enumerate().map(|(k, corners)| hole(k, corners)).collect(),
            lines: marks.lines,
            drill_holes: marks.drills,
            grain: grain.and_then(|(a, b)| upright(up(a), up(b))),
            ..Piece::default()
        })
    }

    /// The lines at which the piece is cut on the fold, the longest first, and where they stand in
    /// the file.
    fn folds(&self, mine: &[&DrawnShape<'_>]) -> Result<Vec<(Fold, SvgPlace)>, SvgDamage> {
        let is_fold = |s: &&&DrawnShape<'_>| matches!(s.role, Some(Role::Fold | Role::Grain { fold: true }));
        let lines = mine.iter().filter(is_fold).flat_map(|s| s.lines.iter().map(move |l| (ends(l), *s)));
        let mut lines: Vec<((Point2, Point2), &DrawnShape<'_>)> =
            lines.filter(|((a, b), _)| (b - a).norm() > 1e-4).collect();
        lines.sort_by(|((a, b), _), ((c, d), _)| (d - c).norm().total_cmp(&(b - a).norm()));
        let fold = |((a, b), shape): ((Point2, Point2), &DrawnShape<'_>)| {
            let at = place(shape.node);
            Fold::through(a, b).map(|fold| (fold, at.clone())).ok_or_else(|| self.no_fold(at))
        };
        let all: Vec<(Fold, SvgPlace)> = lines.into_iter().map(fold).collect::<Result<_, _>>()?;
        Ok(distinct(all))
    }

    /// The outline as a loop.
    fn closed(
        &self,
        outline: &Outlined<'_, '_>,
        fold: Option<&Fold>,
        told: &mut Remarks,
    ) -> Result<Vec<Side>, SvgDamage> {
        if outline.closed {
            return Ok(outline.sides.clone());
        }
        let mut sides = outline.sides.clone();
        // A piece that is cut on the fold may be drawn without the line along the fold.
        if let (Some(fold), [side]) = (fold, &sides[..])
            && fold.has(side.start)
            && fold.has(side.end())
        {
            let mut parts = side.parts.clone();
            parts.push((EdgeCurve::Line, side.start));
            return Ok(split(side.start, &parts));
        }
        if let Some(fold) = fold {
            sides.extend(missing(fold, &sides));
        }
        let page = |p: Point2| (p.x * 1e3, -p.y * 1e3);
        let sides = chained(sides, self.name, told).map_err(|gap| SvgDamage::Open {
            piece: self.name.to_owned(),
            place: self.place.clone(),
            gap_mm: gap.wide * 1e3,
            x: page(gap.at).0,
            y: page(gap.at).1,
        })?;
        if sides.len() < 2 { Err(self.fault("its outline is one open line")) } else { Ok(sides) }
    }

    fn simple(&self, sides: &[Side], turn: Vector2) -> Result<(), SvgDamage> {
        check_simple(sides, LEAST, turn).map_err(|e| match e {
            NotSimple::NoArea => self.fault("it encloses no area"),
            NotSimple::Crosses(p) => {
                let (piece, place) = (self.name.to_owned(), self.place.clone());
                SvgDamage::Crosses { piece, place, x: p.x * 1e3, y: -p.y * 1e3 }
            }
        })
    }
}

/// The edge on the fold that open lines leave out.
fn missing(fold: &Fold, sides: &[Side]) -> Option<Side> {
    let ends = || sides.iter().flat_map(|s| [s.start, s.end()]);
    let met = |p: &Point2| ends().filter(|q| (q - p).norm() <= JOINT).count() > 1;
    let free: Vec<Point2> = ends().filter(|p| fold.has(*p) && !met(p)).collect();
    match free[..] {
        [a, b] => Some(Side::polyline("fold".into(), &[a, b])),
        _ => None,
    }
}

/// The longest line of some role, and its shape.
fn longest<'d, 't>(
    mine: &[&'d DrawnShape<'t>],
    is: impl Fn(Role) -> bool,
) -> Option<(&'d Line, &'d DrawnShape<'t>)> {
    let of_role = mine.iter().filter(|s| s.role.is_some_and(&is));
    let lines = of_role.flat_map(|s| s.lines.iter().map(move |l| (l, *s)));
    let long = |line: &Line| {
        let (a, b) = ends(line);
        (b - a).norm()
    };
    lines.filter(|(l, _)| long(l) > 1e-4).max_by(|a, b| long(a.0).total_cmp(&long(b.0)))
}

/// Sine and cosine by which the grain is turned up: by the lesser angle, as it is drawn where it
/// lies level.
fn turn(grain: Option<(Point2, Point2)>) -> Vector2 {
    let way = grain.and_then(|(a, b)| (b - a).try_normalize(1e-9));
    let upwards = way.map(|d| if d.y < -LEVEL { -d } else { d });
    upwards.map_or_else(Vector2::x, |d| Vector2::new(d.y, d.x))
}

/// A grain line as a piece keeps it: from its foot straight up.
fn upright(a: Point2, b: Point2) -> Option<[Point2; 2]> {
    let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
    (high.y - low.y > 1e-6).then(|| [low, Point2::new(low.x, high.y)])
}

/// What is drawn on a piece beside its outline.
struct Marks {
    notches: Vec<(Point2, f64)>,
    drills: Vec<Point2>,
    holes: Vec<Vec<Point2>>,
    lines: Vec<PieceLine>,
}

impl Marks {
    fn of(
        outline: &Outlined<'_, '_>,
        mine: &[&DrawnShape<'_>],
        up: impl Fn(Point2) -> Point2 + Copy,
    ) -> Self {
        let with = |role: Role| mine.iter().filter(move |s| s.role == Some(role));
        let at = |s: &&&DrawnShape<'_>| up(middle(s));
        let drawn_in = outline.holes.iter().map(|h| h.iter().map(|p| up(*p)).collect());
        let around = |s: &&DrawnShape<'_>| {
            let polygon = |o: Outlined<'_, '_>| o.polygon.iter().map(|p| up(*p)).collect::<Vec<_>>();
            closed(s).into_iter().map(polygon).collect::<Vec<_>>()
        };
        let polygons = with(Role::Hole).flat_map(around).filter(|p| polygon_area(p).abs() > 1e-6);
        let own_lines = with(Role::Mark).flat_map(|s| s.lines.iter().map(move |l| (own_name(s), l)));
        let lines = own_lines.filter_map(|(name, l)| {
            let side = Side { name: String::new(), start: l.start, parts: drawn(l) }.moved(up, false);
            (side.length() > 1e-4).then(|| (name, side.points()))
        });
        let lines: Vec<(Option<String>, Vec<Point2>)> = lines.collect();
        // A name serves if no other line or edge of the piece has it.
        let is_own = |name: &String| {
            lines.iter().filter(|l| l.0.as_ref() == Some(name)).count() == 1
                && outline.sides.iter().all(|s| s.name != *name)
                && !["edge_", "line_", "hole_"].iter().any(|start| name.starts_with(start))
        };
        let line = |(k, (name, points)): (usize, &(Option<String>, Vec<Point2>))| PieceLine {
            name: name.clone().filter(is_own).unwrap_or_else(|| format!("line_{k}")),
            purpose: LinePurpose::Mark,
            points: points.clone(),
        };
        Marks {
            notches: with(Role::Notch).map(|s| (at(&s), 0.0)).collect(),
            drills: with(Role::Drill).map(|s| at(&s)).collect(),
            holes: polygons.chain(drawn_in).collect(),
            lines: lines.iter().enumerate().map(line).collect(),
        }
    }

    /// Adds the image of each.
    fn unfold(&mut self, fold: &Fold, word: &str) {
        let to = |p: &Point2| fold.mirror(*p);
        self.notches.extend(self.notches.clone().iter().map(|(p, d)| (to(p), *d)));
        self.drills.extend(self.drills.clone().iter().map(to));
        self.holes.extend(self.holes.clone().iter().map(|h| h.iter().map(to).collect()));
        let image = |l: &PieceLine| PieceLine {
            name: format!("{}{word}", l.name),
            points: l.points.iter().map(to).collect(),
            ..l.clone()
        };
        self.lines.extend(self.lines.clone().iter().map(image));
    }
}
