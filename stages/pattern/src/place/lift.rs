//! Flat panels into space: where a pattern point lies before or behind the body.
//!
//! Every panel is carried as a stiff board, or wrapped around an upright profile. The profile is a
//! curve z(x), the same at every height, which is followed by arc length: both lifts are isometric.

use super::depth::DepthMap;
use toile_core::prelude::*;

/// How panels start.
#[choice]
#[derive(Copy)]
pub enum Lift {
    /// Stiff boards: the front at one depth before the body, the back at another behind it.
    Flat,
    /// Bent around the body's shadow from above, so that the sides come near each other.
    Wrap,
}

/// Half-width of the strip around a panel in which the body must be cleared, metres.
const MARGIN: f64 = 0.01;

/// A panel's place before it gets its depth: pattern coordinates to (x, y), seen from outside.
///
/// Both frames have y up; `x` of the board is world x before the body and its mirror behind.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Board {
    /// Pattern point that lies on the landmark.
    pub anchor: Point2,
    /// The landmark on the board.
    pub at: Point2,
    /// Angle by which the pattern is turned about the anchor, radians.
    pub turn: f64,
    /// 1 before the body, -1 behind it.
    pub side: f64,
}

impl Board {
    /// The board of a panel; `raise` lifts it above its landmark.
    pub(crate) fn new(place: &PanelPlacement, body: &Body, raise: f64) -> Result<Self, StageError> {
        let side = if place.behind { -1.0 } else { 1.0 };
        let mark = landmark(body, place.landmark, place.behind)?;
        Ok(Board {
            anchor: place.anchor,
            at: Point2::new(side * mark.x, mark.y + raise),
            turn: side * limb_turn(body, place.limb)?,
            side,
        })
    }

    /// A pattern point on the board.
    pub(crate) fn lay(&self, p: Point2) -> Point2 {
        self.at + nalgebra::Rotation2::new(self.turn) * (p - self.anchor)
    }
}

/// A landmark by its name, or by its name on the panel's side of the body (`neck_base` is
/// `neck_base_front` for a front panel).
pub(crate) fn landmark(body: &Body, name: &str, behind: bool) -> Result<Landmark, StageError> {
    let sided = format!("{name}_{}", if behind { "back" } else { "front" });
    body.landmarks.get(name).or_else(|| body.landmarks.get(&sided)).copied().ok_or_else(|| {
        let known = body.landmarks.keys().cloned().collect::<Vec<_>>().join(", ");
        StageError::invalid(format!("the body has no landmark \"{name}\", where a panel is to be placed"))
            .hint(if known.is_empty() {
                "the body has no landmarks".into()
            } else {
                format!("it has {known}")
            })
    })
}

/// Panels of an arm hang along the arm: the angle from straight down to the arm's line.
fn limb_turn(body: &Body, limb: Limb) -> Result<f64, StageError> {
    let side = match limb {
        Limb::Torso | Limb::Legs => return Ok(0.0),
        Limb::LeftArm => "left",
        Limb::RightArm => "right",
    };
    let shoulder = landmark(body, &format!("shoulder_{side}"), false)?;
    let wrist = landmark(body, &format!("wrist_{side}"), false)?;
    Ok((wrist.x - shoulder.x).atan2(shoulder.y - wrist.y))
}

/// A curve of the board plane seen from above: points (x, depth) with rising x, followed by arc
/// length from the body's middle, x = 0; flat beyond its ends.
#[derive(Debug, Clone)]
pub(crate) struct Profile {
    points: Vec<Point2>,
    arcs: Vec<f64>,
}

impl Profile {
    fn new(points: Vec<Point2>) -> Self {
        let mut arcs = vec![0.0];
        for w in points.windows(2) {
            arcs.push(arcs[arcs.len() - 1] + (w[1] - w[0]).norm());
        }
        let mut profile = Profile { points, arcs };
        let middle = profile.arc_at(0.0);
        profile.arcs.iter_mut().for_each(|a| *a -= middle);
        profile
    }

    fn arc_at(&self, x: f64) -> f64 {
        let i = self.points.partition_point(|p| p.x <= x).clamp(1, self.points.len() - 1);
        let (a, b) = (self.points[i - 1], self.points[i]);
        self.arcs[i - 1] + (self.arcs[i] - self.arcs[i - 1]) * (x - a.x) / (b.x - a.x)
    }

    /// The (x, depth) at an arc.
    pub(crate) fn at(&self, arc: f64) -> Point2 {
        let last = self.points.len() - 1;
        if arc <= self.arcs[0] {
            return self.points[0] + Vector2::new(arc - self.arcs[0], 0.0);
        }
        if arc >= self.arcs[last] {
            return self.points[last] + Vector2::new(arc - self.arcs[last], 0.0);
        }
        let i = self.arcs.partition_point(|&a| a <= arc).clamp(1, last);
        let t = (arc - self.arcs[i - 1]) / (self.arcs[i] - self.arcs[i - 1]);
        self.points[i - 1] + (self.points[i] - self.points[i - 1]) * t
    }
}

/// The profile on which a laid panel clears the body by `ease`.
pub(crate) fn profile(lift: Lift, laid: &[Point2], board: &Board, body: &Body, ease: f64) -> Profile {
    let (mut lo, mut hi) =
        (Point2::new(f64::INFINITY, f64::INFINITY), Point2::new(-f64::INFINITY, -f64::INFINITY));
    for p in laid {
        (lo, hi) = (lo.inf(p), hi.sup(p));
    }
    let shadow = |p: &Point3| Point2::new(board.side * p.x, board.side * p.z);
    let near = |p: &&Point3| {
        let x = board.side * p.x;
        p.y >= lo.y - MARGIN && p.y <= hi.y + MARGIN && x >= lo.x - MARGIN && x <= hi.x + MARGIN
    };
    let body: Vec<Point2> = body.positions.iter().filter(near).map(shadow).collect();
    let ends = [lo.x - MARGIN, hi.x + MARGIN];
    let points = match lift {
        Lift::Flat => {
            let depth = body.iter().map(|p| p.y).fold(0.0, f64::max) + ease;
            ends.map(|x| Point2::new(x, depth)).to_vec()
        }
        Lift::Wrap => {
            let ground = ends.map(|x| Point2::new(x, 0.0));
            let mut hull = upper_hull(body.into_iter().chain(ground).collect());
            hull.iter_mut().for_each(|p| p.y += ease);
            hull
        }
    };
    Profile::new(points)
}

/// The upper convex hull, by rising x.
fn upper_hull(mut points: Vec<Point2>) -> Vec<Point2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(b.y.total_cmp(&a.y)));
    points.dedup_by(|b, a| b.x - a.x < 1e-9);
    let mut hull: Vec<Point2> = Vec::new();
    for p in points {
        while let [.., a, b] = hull[..] {
            if (b - a).perp(&(p - a)) < 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    }
    hull
}

/// Pattern points in space.
pub(crate) fn lift(laid: &[Point2], board: &Board, profile: &Profile) -> Vec<Point3> {
    let place = |p: &Point2| {
        let at = profile.at(p.x);
        Point3::new(board.side * at.x, p.y, board.side * at.y)
    };
    laid.iter().map(place).collect()
}

/// How deep the deepest of a panel's vertices lies behind the skin on the panel's own side; 0 where
/// all are outside.
pub(crate) fn depth_inside(placed: &[Point3], side: f64, depths: &DepthMap) -> f64 {
    let depth = |p: &Point3| {
        let (lo, hi) = depths.span(p.x, p.y)?;
        Some(if side > 0.0 { hi - p.z } else { p.z - lo })
    };
    placed.iter().filter_map(depth).fold(0.0, f64::max)
}
