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
/// Half of the wedge's width at the outline, as a share of the garment's size.
const OPEN: f64 = 0.012;
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
}

/// The outline, opened along all borders that the network sees within it; none where it sees none,
/// or where nothing tells how the outline lies in the photo.
pub(super) fn opened(outline: &Outline, seen: &SeenGarment) -> Option<OpenedOutline> {
    let frame = outline.frame?;
    let mut points = outline.outer.points.clone();
    let size = polygon_area(&points).abs().sqrt();
    let mut what = Vec::new();
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
            // Not past the line: beside the hem all is ground.
            let grid = Grid::over(&points);
            let within = grid.within(&points);
            let is_within = |p: Point2| grid.holding(p).is_some_and(|i| within[i]);
            let is_ground = |p: Point2| is_within(p) && probability(Part::Ground, p) > GROUND;
            points = wedge(&points, &way, OPEN * size, &|p, step| {
                let reach = (WIDEST * size / step.norm().max(f64::MIN_POSITIVE)) as usize;
                (1..=reach).take_while(|k| is_ground(p + step * *k as f64)).count() as f64
            });
            what.push(words);
        }
    }
    let outer = Loop { points, corners: Vec::new() };
    (!what.is_empty()).then(|| OpenedOutline { outline: Outline { outer, ..outline.clone() }, what })
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

/// A closed line, counter-clockwise, led into itself along both sides of a way that ends at it; the
/// sides are so far apart at its end as twice `open`, and meet at its start. `bare` counts the
/// steps from a place of the way to a side over which the wedge widens.
fn wedge(points: &[Point2], way: &[Point2], open: f64, bare: &dyn Fn(Point2, Vector2) -> f64) -> Vec<Point2> {
    let Some(end) = way.last() else { return points.to_vec() };
    let near = |i: usize| (points[i] - end).norm_squared();
    let Some(at) = (0..points.len()).min_by(|a, b| near(*a).total_cmp(&near(*b))) else {
        return points.to_vec();
    };
    let whole = polyline_length(way).max(f64::MIN_POSITIVE);
    let mut along = 0.0;
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for (k, p) in way.iter().enumerate() {
        along += if k > 0 { (p - way[k - 1]).norm() } else { 0.0 };
        let d = way[(k + 1).min(way.len() - 1)] - way[k.saturating_sub(1)];
        let across = Rotation2::new(std::f64::consts::FRAC_PI_2) * d;
        let across = across.try_normalize(1e-12).unwrap_or_default();
        let to = |side: f64| {
            let step = across * (side * STEP * open);
            p + across * (side * open * along / whole) + step * bare(*p, step)
        };
        // Counter-clockwise around the line, the right of the way outwards comes first.
        before.push(to(-1.0));
        after.push(to(1.0));
    }
    // What of the line lies within the wedge's end goes.
    let n = points.len();
    let end_width = |side: &[Point2]| side.last().map_or(0.0, |p| (p - end).norm_squared());
    let [wide_before, wide_after] = [end_width(&before), end_width(&after)];
    let is_within = |i: usize, wide: f64| near(i) < wide;
    let reach =
        |step: usize, wide: f64| (1..n / 4).take_while(|k| is_within((at + k * step) % n, wide)).count();
    let (next, last) = (reach(1, wide_after), reach(n - 1, wide_before));
    let kept = (0..n - next - last - 1).map(|k| points[(at + next + 1 + k) % n]);
    kept.chain(before.into_iter().rev()).chain(after.into_iter().skip(1)).collect()
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

    #[test]
    fn a_wedge_takes_its_own_area_from_the_line_and_no_more() {
        let way: Vec<Point2> = (0..=7).map(|k| Point2::new(0.5, 0.7 - 0.1 * f64::from(k))).collect();
        let opened = wedge(&square(), &way, 0.03, &|_, _| 0.0);
        // A triangle of 6 cm by 70 cm.
        assert!((polygon_area(&opened) - (1.0 - 0.5 * 0.06 * 0.7)).abs() < 2e-3, "{}", polygon_area(&opened));
        let grid = Grid::over(&opened);
        let within = grid.within(&opened);
        let is_in = |x: f64, y: f64| within[grid.holding(Point2::new(x, y)).unwrap()];
        assert!(!is_in(0.5, 0.05) && is_in(0.45, 0.05) && is_in(0.55, 0.05) && is_in(0.5, 0.8));
    }

    #[test]
    fn a_wedge_takes_in_the_ground_beside_it() {
        let way: Vec<Point2> = (0..=7).map(|k| Point2::new(0.5, 0.7 - 0.1 * f64::from(k))).collect();
        // Ground lies to the right of the way, up to 10 cm from it.
        let bare = |_: Point2, step: Vector2| if step.x > 0.0 { 0.1 / step.norm() } else { 0.0 };
        let opened = wedge(&square(), &way, 0.03, &bare);
        let wedge = 0.5 * 0.06 * 0.7 + 0.1 * 0.7;
        assert!((polygon_area(&opened) - (1.0 - wedge)).abs() < 8e-3, "{}", polygon_area(&opened));
    }
}
