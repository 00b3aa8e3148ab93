//! An outline opened between a limb and what it touches: a sleeve that lies beside the body, legs
//! that lie together.
//!
//! People lay sleeves along the sides and legs beside each other; the outline then shows no armpit
//! and no fork, and no template with sleeves or legs can be laid over it. The network sees where
//! one part ends and the next begins. From the armpit, or the fork, to the outline the way is
//! sought that runs best along the border of both parts, or over ground: the shortest way over a
//! grid whose cells cost less the likelier the border is (Dijkstra 1959, used for borders as by
//! Mortensen and Barrett 1995). The outline is led along both sides of it, as a wedge that is
//! closed at the armpit.
//!
//! Cost: some 20 ms. Limits: the border is as true as the network; what a limb covers stays hidden.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use nalgebra::Rotation2;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use toile_core::prelude::*;
use toile_recognise::{Landmark, Lie, Limb, Part, SeenGarment};

/// Cells along the longer side of the outline.
const CELLS: f64 = 160.0;
/// What a cell on the border of both parts costs, where one far from it costs 1 more.
const FLOOR: f64 = 0.01;
/// A way that is shorter than this share of the garment's size opens nothing.
const LEAST: f64 = 0.05;
/// How likely a place must be ground for the wedge to take it in, and how far it reaches to each
/// side at most, as a share of the garment's size.
const GROUND: f64 = 0.5;
const WIDEST: f64 = 0.25;
/// From this probability on a place is surely ground, and the least patch of it, as a share of the
/// garment's area.
const SURE: f64 = 0.9;
const LEAST_PATCH: f64 = 0.004;
/// Half of the wedge's width at the outline, and how far it leads beyond it, as a share of the
/// garment's size.
const OPEN: f64 = 0.012;
const BEYOND: f64 = 0.15;
/// What is left must be more than this share of the outline's area.
const MOST: f64 = 0.6;
/// How likely a limb must be there and not folded away.
const LIES: f64 = 0.5;
/// The step by which ground beside the way is looked for, as a share of [`OPEN`].
const STEP: f64 = 0.5;
/// Cells of the way that are joined to one straight piece.
const JOINED: usize = 5;

/// A border between two parts.
struct PartBorder {
    /// The limb that lies against something.
    limb: Limb,
    /// It, and what it touches.
    parts: [Part; 2],
    /// Where their border begins inside the garment, and from where it leads away: above the armpit
    /// it is the armhole, up to the shoulder.
    from: Landmark,
    away: &'static [Landmark],
    words: &'static str,
}

const BORDERS: [PartBorder; 3] = [
    PartBorder {
        limb: Limb::SleeveLeft,
        parts: [Part::SleeveLeft, Part::Body],
        from: Landmark::ArmpitLeft,
        away: &[Landmark::ShoulderLeft],
        words: "the left sleeve and the body",
    },
    PartBorder {
        limb: Limb::SleeveRight,
        parts: [Part::SleeveRight, Part::Body],
        from: Landmark::ArmpitRight,
        away: &[Landmark::ShoulderRight],
        words: "the right sleeve and the body",
    },
    PartBorder {
        limb: Limb::LegLeft,
        parts: [Part::LegLeft, Part::LegRight],
        from: Landmark::Fork,
        away: &[Landmark::WaistLeft, Landmark::WaistRight],
        words: "both legs",
    },
];

/// An outline that was opened, and what was taken apart in it.
pub(super) struct OpenedOutline {
    pub outline: Outline,
    pub what: Vec<&'static str>,
    /// How many sleeves were.
    pub sleeves: usize,
    /// The share of the outline's area, before, that is surely ground.
    pub ground: f64,
}

/// The outline, opened along all borders that the network sees within it; none where it sees none,
/// or where nothing tells how the outline lies in the photo.
pub(super) fn opened(outline: &Outline, seen: &SeenGarment) -> Option<OpenedOutline> {
    let frame = outline.frame?;
    let mut points = outline.outer.points.clone();
    let size = polygon_area(&points).abs().sqrt();
    let (mut what, mut sleeves) = (Vec::new(), 0);
    let bare = |points: &[Point2]| {
        ground(points, LEAST_PATCH * size * size, |p| {
            let px = frame.to_px(p);
            seen.probability(Part::Ground, px.x, px.y)
        })
    };
    let area = |cells: &[[Point2; 4]]| cells.iter().map(|c| polygon_area(c)).sum::<f64>();
    let ground = area(&bare(&points)) / (size * size).max(f64::MIN_POSITIVE);
    let place = |landmark: &Landmark| seen.landmark(*landmark).map(|l| frame.to_metres(l.place));
    let probability = |part: Part, p: Point2| {
        let px = frame.to_px(p);
        seen.probability(part, px.x, px.y)
    };
    for PartBorder { limb, parts: [one, other], from, away, words } in BORDERS {
        let is_there = |lie: &Lie| !matches!(lie, Lie::Absent | Lie::Folded);
        let there: f64 = seen.limb(limb).iter().filter(|(lie, _)| is_there(lie)).map(|l| l.1).sum();
        let Some(from) = place(&from).filter(|_| there >= LIES) else { continue };
        let away: Vec<Point2> = away.iter().filter_map(place).collect();
        let Some(away) = away.iter().map(|p| p - from).reduce(|a, b| a + b) else { continue };
        // A strip of ground between both that the mask holds is no less a border.
        let border = |p: Point2| {
            let [a, b, ground] = [one, other, Part::Ground].map(|part| probability(part, p));
            ((p - from).dot(&away) <= 0.0).then_some(4.0 * (a + 0.5 * ground) * (b + 0.5 * ground))
        };
        let Some(way) = way(&points, from, border) else { continue };
        if polyline_length(&way) >= LEAST * size {
            let grid = Grid::over(&points);
            let within = grid.within(&points);
            let is_within = |p: Point2| grid.holding(p).is_some_and(|i| within[i]);
            let is_ground = |p: Point2| probability(Part::Ground, p) > GROUND;
            let wedge = Wedge { open: OPEN * size, widest: WIDEST * size, beyond: BEYOND * size };
            let Some(opened) = parted(&points, &wedge.along(&way, &is_within, &is_ground)) else { continue };
            points = opened;
            what.push(words);
            sleeves += usize::from(matches!(limb, Limb::SleeveLeft | Limb::SleeveRight));
        }
    }
    let left = bare(&points);
    if let Some(opened) = (!left.is_empty()).then(|| parted(&points, &left)).flatten() {
        points = opened;
        what.push("the garment and the ground");
    }
    let outer = Loop { points, corners: Vec::new() };
    (!what.is_empty()).then(|| OpenedOutline {
        outline: Outline { outer, ..outline.clone() },
        what,
        sleeves,
        ground,
    })
}

/// The cells within a closed line that are surely ground, of patches of that area at least; each is
/// a quadrilateral, counter-clockwise.
fn ground(points: &[Point2], least: f64, probability: impl Fn(Point2) -> f64) -> Vec<[Point2; 4]> {
    let grid = Grid::over(points);
    let within = grid.within(points);
    let mut bare: Vec<bool> =
        (0..within.len()).map(|i| within[i] && probability(grid.middle(i)) > SURE).collect();
    let mut found = Vec::new();
    for i in 0..bare.len() {
        let mut patch = Vec::new();
        let mut open = if std::mem::take(&mut bare[i]) { vec![i] } else { Vec::new() };
        while let Some(k) = open.pop() {
            patch.push(k);
            open.extend(grid.around(k).filter(|(next, _)| std::mem::take(&mut bare[*next])).map(|n| n.0));
        }
        if patch.len() as f64 * grid.cell * grid.cell >= least {
            found.extend(patch.into_iter().map(|k| grid.square(k)));
        }
    }
    found
}

/// A grid of cells over an outline.
struct Grid {
    low: Point2,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    fn over(points: &[Point2]) -> Self {
        let far = Point2::new(f64::INFINITY, f64::INFINITY);
        let (low, high) = points.iter().fold((far, -far), |(low, high), p| (low.inf(p), high.sup(p)));
        let cell = ((high - low).max() / CELLS).max(f64::MIN_POSITIVE);
        let count = |length: f64| (length / cell) as usize + 3;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        // One row of cells lies outside on each side.
        Grid { low: low - Vector2::repeat(cell), cell, columns, rows }
    }

    fn middle(&self, i: usize) -> Point2 {
        let at = Vector2::new((i % self.columns) as f64 + 0.5, (i / self.columns) as f64 + 0.5);
        self.low + at * self.cell
    }

    /// The corners of a cell, counter-clockwise.
    fn square(&self, i: usize) -> [Point2; 4] {
        let half = 0.5 * self.cell;
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| self.middle(i) + Vector2::new(x, y) * half)
    }

    fn holding(&self, p: Point2) -> Option<usize> {
        let at = (p - self.low) / self.cell;
        let is_in = at.x >= 0.0 && at.y >= 0.0 && at.x < self.columns as f64 && at.y < self.rows as f64;
        is_in.then(|| at.y as usize * self.columns + at.x as usize)
    }

    /// Which cells lie within a closed line, by the crossings of their rows.
    fn within(&self, points: &[Point2]) -> Vec<bool> {
        let mut within = vec![false; self.columns * self.rows];
        for row in 0..self.rows {
            let y = self.middle(row * self.columns).y;
            let sides = (0..points.len()).map(|i| (points[i], points[(i + 1) % points.len()]));
            let mut xs: Vec<f64> = sides
                .filter(|(a, b)| (a.y > y) != (b.y > y))
                .map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
                .collect();
            xs.sort_by(f64::total_cmp);
            for column in 0..self.columns {
                let i = row * self.columns + column;
                within[i] = xs.partition_point(|x| *x < self.middle(i).x) % 2 == 1;
            }
        }
        within
    }

    /// The cells around one with their distances, cells.
    fn around(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (x, y) = ((i % self.columns) as isize, (i / self.columns) as isize);
        let steps = (-1..=1).flat_map(|dy: isize| (-1..=1).map(move |dx: isize| (dx, dy)));
        steps.filter(|step| *step != (0, 0)).filter_map(move |(dx, dy)| {
            let (u, v) = (x + dx, y + dy);
            let is_in = u >= 0 && v >= 0 && u < self.columns as isize && v < self.rows as isize;
            is_in.then(|| (v as usize * self.columns + u as usize, ((dx * dx + dy * dy) as f64).sqrt()))
        })
    }
}

/// The way from a place within a closed line to the line that runs best along a border, of which
/// `border` gives how likely it is at a place, nothing where no way leads; none from a place that
/// is not within the line.
fn way(points: &[Point2], from: Point2, border: impl Fn(Point2) -> Option<f64>) -> Option<Vec<Point2>> {
    let grid = Grid::over(points);
    let within = grid.within(points);
    let start = grid.holding(from).filter(|i| within[*i])?;
    // Thousandths of a cell, so that sums are exact and ties fall alike everywhere.
    let price = |i: usize| match i == start {
        true => Some(0.0),
        false => border(grid.middle(i)).map(|b| 1000.0 * (FLOOR + 1.0 - b.clamp(0.0, 1.0))),
    };
    let mut best = vec![(u64::MAX, start); within.len()];
    let mut open = BinaryHeap::from([Reverse((0_u64, start))]);
    best[start].0 = 0;
    let mut end = None;
    while let Some(Reverse((cost, i))) = open.pop() {
        if !within[i] {
            end = Some(i);
            break;
        }
        if cost > best[i].0 {
            continue;
        }
        let Some(here) = price(i) else { continue };
        for (next, length) in grid.around(i) {
            let new = cost + (length * here) as u64;
            if new < best[next].0 {
                best[next] = (new, i);
                open.push(Reverse((new, next)));
            }
        }
    }
    let back = std::iter::successors(end, |i| (*i != start).then(|| best[*i].1));
    let mut cells: Vec<usize> = back.collect();
    cells.reverse();
    let last = cells.len().checked_sub(1)?;
    let kept = |(k, i): (usize, &usize)| (k % JOINED == 0 || k == last).then(|| grid.middle(*i));
    Some(cells.iter().enumerate().filter_map(kept).collect())
}

/// What is cut out along a way.
struct Wedge {
    /// Half of its width at the end of the way; it is closed at the start.
    open: f64,
    /// How far it widens to each side at most.
    widest: f64,
    /// How far it leads beyond the end.
    beyond: f64,
}

impl Wedge {
    /// Its quadrilaterals, counter-clockwise. To each side it widens over all that is bare: ground,
    /// and what does not lie within the line.
    fn along(
        &self,
        way: &[Point2],
        is_within: &dyn Fn(Point2) -> bool,
        is_ground: &dyn Fn(Point2) -> bool,
    ) -> Vec<[Point2; 4]> {
        let is_bare = |p: Point2| !is_within(p) || is_ground(p);
        let mut way = way.to_vec();
        let along = polyline_length(&way).max(f64::MIN_POSITIVE);
        if let [.., before, end] = way[..] {
            let step = (end - before).try_normalize(1e-12).unwrap_or_default() * self.open;
            let steps = (1..=(self.beyond / self.open) as usize).map(|k| end + step * k as f64);
            way.extend(steps.take_while(|p| is_bare(*p)));
        }
        let mut gone = 0.0;
        // A place, the direction to its left, and how far the wedge reaches to both sides.
        let mut across = |k: usize| {
            let (p, last) = (way[k], way.len() - 1);
            gone += if k > 0 { (p - way[k - 1]).norm() } else { 0.0 };
            let d = way[(k + 1).min(last)] - way[k.saturating_sub(1)];
            let left = Rotation2::new(std::f64::consts::FRAC_PI_2) * d;
            let left = left.try_normalize(1e-12).unwrap_or_default();
            let (start, step) = (self.open * (gone / along).min(1.0), STEP * self.open);
            let reach = |side: f64| {
                let place = |k: usize| p + left * (side * (start + step * k as f64));
                let bare = (0..(self.widest / step) as usize).take_while(|k| is_bare(place(k + 1)));
                side * (start + step * bare.count() as f64)
            };
            (p, left, [reach(1.0), reach(-1.0)])
        };
        let places: Vec<_> = (0..way.len()).map(&mut across).collect();
        let quads = places.windows(2).map(|w| {
            let ((p, p_left, reach), (q, q_left, next)) = (w[0], w[1]);
            // What is bare beyond the line tells nothing of the last stretch within it.
            let next = if is_within(p) && !is_within(q) { reach } else { next };
            [p + p_left * reach[0], p + p_left * reach[1], q + q_left * next[1], q + q_left * next[0]]
        });
        quads.map(|q| if polygon_area(&q) < 0.0 { [q[3], q[2], q[1], q[0]] } else { q }).collect()
    }
}

/// A closed line without some quadrilaterals, counter-clockwise; none where they part it, or take
/// most of it.
fn parted(points: &[Point2], without: &[[Point2; 4]]) -> Option<Vec<Point2>> {
    let line: Vec<[f64; 2]> = points.iter().map(|p| [p.x, p.y]).collect();
    let without: Vec<Vec<[f64; 2]>> = without.iter().map(|q| q.map(|p| [p.x, p.y]).to_vec()).collect();
    let left = line.overlay(&without, OverlayRule::Difference, FillRule::NonZero);
    let outer = left.into_iter().filter_map(|shape| shape.into_iter().next());
    let closed = outer.map(|line| line.into_iter().map(Point2::from).collect::<Vec<Point2>>());
    let area = |line: &[Point2]| polygon_area(line).abs();
    let mut largest = closed.max_by(|a, b| area(a).total_cmp(&area(b)))?;
    if polygon_area(&largest) < 0.0 {
        largest.reverse();
    }
    (area(&largest) > MOST * area(points)).then_some(largest)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// A square of 1 m, counter-clockwise, with points every centimetre.
    fn square() -> Vec<Point2> {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point2::new(x, y));
        let side = |k: usize| {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            (0..100).map(move |i| a + (b - a) * (f64::from(i) / 100.0))
        };
        (0..4).flat_map(side).collect()
    }

    /// Where the border of two parts stands upright.
    fn upright(x: f64) -> impl Fn(Point2) -> Option<f64> {
        move |p| Some(if (p.x - x).abs() < 0.02 { 1.0 } else { 0.0 })
    }

    #[test]
    fn the_way_follows_a_border_though_another_side_is_nearer() {
        let way = way(&square(), Point2::new(0.2, 0.4), upright(0.2)).unwrap();
        assert!(way.iter().all(|p| (p.x - 0.2).abs() < 0.03), "{way:?}");
        assert!(way.last().unwrap().y < 0.01 && way[0].y > 0.39, "{way:?}");
    }

    #[test]
    fn no_way_leads_where_it_may_not() {
        let border = |p: Point2| (p.y > 0.65).then(|| upright(0.2)(p)).flatten();
        let way = way(&square(), Point2::new(0.2, 0.7), border).unwrap();
        assert!(way.iter().all(|p| p.y > 0.64) && way.last().unwrap().y > 0.99, "{way:?}");
    }

    #[test]
    fn no_way_begins_outside() {
        assert_eq!(way(&square(), Point2::new(1.5, 0.5), upright(0.5)), None);
        assert_eq!(way(&square(), Point2::new(90.0, 0.5), upright(0.5)), None);
    }

    /// The square of 1 m without a wedge along a way that ends at its lower side.
    fn opened(is_ground: &dyn Fn(Point2) -> bool) -> Vec<Point2> {
        let way: Vec<Point2> = (0..=7).map(|k| Point2::new(0.5, 0.7 - 0.1 * f64::from(k))).collect();
        let wedge = Wedge { open: 0.03, widest: 0.25, beyond: 0.15 };
        parted(&square(), &wedge.along(&way, &|p| p.y > 0.0, is_ground)).unwrap()
    }

    #[test]
    fn a_wedge_takes_its_own_area_from_the_line_and_no_more() {
        let opened = opened(&|_| false);
        // A triangle of 6 cm by 70 cm.
        assert!((polygon_area(&opened) - (1.0 - 0.5 * 0.06 * 0.7)).abs() < 2e-3, "{}", polygon_area(&opened));
        let grid = Grid::over(&opened);
        let within = grid.within(&opened);
        let is_in = |x: f64, y: f64| within[grid.holding(Point2::new(x, y)).unwrap()];
        assert!(!is_in(0.5, 0.05) && is_in(0.45, 0.05) && is_in(0.55, 0.05) && is_in(0.5, 0.8));
    }

    #[test]
    fn a_wedge_takes_in_the_ground_beside_it_down_to_the_line() {
        // Ground lies between 0.5 and 0.6, up to the fork.
        let opened = opened(&|p| p.x > 0.5 && p.x < 0.6 && p.y < 0.7);
        let ground = 0.1 * 0.7 + 0.5 * 0.03 * 0.7;
        assert!((polygon_area(&opened) - (1.0 - ground)).abs() < 1.5e-2, "{}", polygon_area(&opened));
        let least = opened.iter().filter(|p| p.x > 0.52 && p.x < 0.58).map(|p| p.y).fold(1.0, f64::min);
        assert!(least > 0.6, "the ground's lower edge is left at {least}");
    }

    #[test]
    fn a_line_of_which_little_would_be_left_is_not_opened() {
        let all = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.7], [0.0, 0.7]].map(|[x, y]| Point2::new(x, y));
        assert_eq!(parted(&square(), &[all]), None);
    }
}
