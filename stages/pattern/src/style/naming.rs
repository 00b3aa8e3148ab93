//! From landmarks to named edges: what all upper-body styles share.

use super::neck::neck_points;
use super::shape::{Bend, MAX_TILT, Path, Shape};
use toile_core::prelude::*;

/// Tilts above which the user is told, and warned, degrees: the grain is then off by as much.
const TILT_TOLD: f64 = 4.0;
const TILT_WARNING: f64 = 8.0;
/// Greatest mean distance between the outline and its mirror image, as a share of its size.
const MAX_ASYMMETRY: f64 = 0.06;
/// Narrowest neck opening, and greatest, as a share of the garment's width.
const NECK_WIDTH: [f64; 2] = [0.08, 0.75];
/// The lower border may rise in its middle by this share of the garment's height; trousers rise by
/// more.
const MAX_NOTCH: f64 = 0.2;
/// How far the middle of a neckline may stand above the neck points, as a share of the height: the
/// collar of a back that shows.
const MAX_COLLAR: f64 = 0.08;

/// Landmarks of one half, from the hem upwards: each with the edge that starts there.
pub(super) type Half = Vec<(&'static str, usize)>;

/// How a style finds the landmarks between hem and neck on the half at positive u; the reason if it
/// cannot.
pub(super) type FindHalf = fn(&Shape, Path) -> Result<Half, String>;

/// Names the edges of one panel's outline. Into how many parts they are divided is found where they
/// are sewn.
pub(super) fn name_edges(
    panel: &str,
    style: &str,
    outline: &Outline,
    find: FindHalf,
    cx: &Context,
) -> Result<Outline, StageError> {
    let refuse = |reason: String| {
        StageError::invalid(format!("\"{panel}\" does not look like {style}: {reason}"))
            .hint("choose the style that fits the garment, and lay it flat with its neck towards the photo's upper border")
    };
    let shape = Shape::new(outline).ok_or_else(|| refuse("it has no area".into()))?;
    let corners = landmarks(&shape, find).map_err(refuse)?;
    if shape.tilt.abs() > TILT_TOLD {
        let text = format!(
            "\"{panel}\" lies {:.0} degrees askew in its photo; it is sewn as it lies, so its grain is off by as much",
            shape.tilt.abs()
        );
        if shape.tilt.abs() > TILT_WARNING { cx.warn(text) } else { cx.note(text) }
    }
    let (plus, minus) = if is_back(panel) { ("right", "left") } else { ("left", "right") };
    let mut named = outline.clone();
    named.edges = corners.edges(plus, minus);
    named.outer.corners.extend(named.edges.iter().map(|e| e.start));
    named.outer.corners.sort_unstable();
    named.outer.corners.dedup();
    Ok(named)
}

/// The names of all edges of a panel whose halves have these, from the hem upwards.
pub(super) fn edge_names(half: &[&str]) -> Vec<String> {
    let both = half.iter().flat_map(|name| ["left", "right"].map(|side| format!("{name}_{side}")));
    both.chain(["neck".to_owned(), "hem".to_owned()]).collect()
}

/// True for panels that lie behind the body.
pub(super) fn is_back(panel: &str) -> bool {
    panel.to_lowercase().contains("back")
}

/// Landmarks of both halves, in the outline's own indices, and its neck points.
struct Landmarks {
    plus: Half,
    minus: Half,
    necks: [usize; 2],
}

impl Landmarks {
    /// Edges counter-clockwise from the hem's corner at positive u.
    fn edges(&self, plus: &str, minus: &str) -> Vec<Edge> {
        let mut starts: Vec<(String, usize)> =
            self.plus.iter().map(|(name, i)| (format!("{name}_{plus}"), *i)).collect();
        starts.push(("neck".into(), self.necks[0]));
        // Downwards an edge starts at its upper landmark.
        let upper = self.minus.iter().skip(1).map(|l| l.1).chain([self.necks[1]]);
        let down: Vec<_> =
            self.minus.iter().zip(upper).map(|(l, i)| (format!("{}_{minus}", l.0), i)).collect();
        starts.extend(down.into_iter().rev());
        starts.push(("hem".into(), self.minus[0].1));
        let gauge = Gauge::default();
        let n = starts.len();
        (0..n)
            .map(|k| Edge {
                name: starts[k].0.clone(),
                start: starts[k].1,
                end: starts[(k + 1) % n].1,
                gauge,
            })
            .collect()
    }
}

fn landmarks(shape: &Shape, find: FindHalf) -> Result<Landmarks, String> {
    if shape.asymmetry > MAX_ASYMMETRY {
        return Err(format!(
            "its left and right halves differ by {:.0} % of its size on average, with its axis up to {MAX_TILT:.0} degrees askew",
            100.0 * shape.asymmetry
        ));
    }
    let notch = shape.middle(false).map_or(0.0, |v| v - shape.bounds[0].y) / shape.height();
    if notch > MAX_NOTCH {
        return Err(format!(
            "its lower border rises by {:.0} % of its height in the middle, like a pair of trousers",
            100.0 * notch
        ));
    }
    let mirror = shape.mirror();
    let [neck, other] = neck_points(shape, &mirror).ok_or("it has no shoulders beside a neck")?;
    let [plus, minus] = [half(shape, neck, find)?, half(&mirror, other, find)?];
    check_neck(shape, shape.at(plus.1), mirror.at(minus.1))?;
    let own = |s: &Shape, h: Half| h.into_iter().map(|(name, i)| (name, s.index(i))).collect();
    Ok(Landmarks {
        necks: [shape.index(plus.1), mirror.index(minus.1)],
        plus: own(shape, plus.0),
        minus: own(&mirror, minus.0),
    })
}

/// Landmarks of the half at positive u, and its neck point.
fn half(shape: &Shape, neck: usize, find: FindHalf) -> Result<(Half, usize), String> {
    let hem = shape.extreme_right(Vector2::new(1.0, -1.3)).ok_or("it has no right half")?;
    let path = Path { from: hem, to: neck };
    let half = find(shape, path)?;
    // Counter-clockwise order: each landmark lies between its neighbours.
    let mut order: Vec<usize> = half.iter().map(|h| h.1).collect();
    order.push(neck);
    let in_order = order.windows(2).all(|w| w[0] != w[1] && shape.holds(Path { from: w[0], to: neck }, w[1]));
    if in_order { Ok((half, neck)) } else { Err("its corners are not in their usual order".into()) }
}

fn check_neck(shape: &Shape, plus: Point2, minus_mirrored: Point2) -> Result<(), String> {
    let width = (plus.x + minus_mirrored.x) / shape.width();
    let percent = |x: f64| format!("{:.0} %", 100.0 * x);
    if !(NECK_WIDTH[0]..=NECK_WIDTH[1]).contains(&width) {
        return Err(format!(
            "its neck opening is {} of its width; {} to {} is usual",
            percent(width),
            percent(NECK_WIDTH[0]),
            percent(NECK_WIDTH[1])
        ));
    }
    let height = (plus.y + minus_mirrored.y) / 2.0;
    let rise = (shape.middle(true).unwrap_or(height) - height) / shape.height();
    if rise > MAX_COLLAR {
        return Err(format!(
            "its upper border rises by {} of its height between the shoulders",
            percent(rise)
        ));
    }
    Ok(())
}

/// Heights at which armpits lie, as shares of the garment's.
const ARMPIT: [f64; 2] = [0.3, 0.9];

/// Refuses armpits at a height where no arm is.
pub(super) fn check_armpit(shape: &Shape, armpit: usize) -> Result<(), String> {
    let height = (shape.at(armpit).y - shape.bounds[0].y) / shape.height();
    if (ARMPIT[0]..=ARMPIT[1]).contains(&height) {
        return Ok(());
    }
    Err(format!(
        "its armpits would lie at {:.0} % of its height; {:.0} % to {:.0} % is usual",
        100.0 * height,
        100.0 * ARMPIT[0],
        100.0 * ARMPIT[1]
    ))
}

/// The corner bend of seams that stick out.
pub(super) const OUT: Bend = Bend::Convex;
/// The corner bend of seams that go in.
pub(super) const IN: Bend = Bend::Concave;
