//! A front that is cut in two halves, taken as one for a while: its neckline crosses both.
//!
//! Both halves lie in the same coordinates, and their edges `neck_left` and `neck_right` meet in
//! the middle.

use super::replaced::replaced;
use toile_core::prelude::*;

/// Ends of both necks nearer than this are one point, metres.
const SAME: f64 = 1e-6;

/// The halves and the front that they make.
pub(super) struct ClosedFront<'a> {
    left: (&'a str, &'a Outline),
    right: (&'a str, &'a Outline),
    /// The front's outline, whose only named edge is `neck`.
    pub(super) whole: Outline,
}

impl<'a> ClosedFront<'a> {
    /// The halves among these outlines.
    pub(super) fn among(outlines: &'a Set<Outline>) -> Option<Self> {
        let with = |hand| outlines.iter().find_map(|(name, o)| Some((name, o, neck(o, hand)?.clone())));
        let (left_name, left, left_neck) = with(Hand::Left)?;
        let (right_name, right, right_neck) = with(Hand::Right)?;
        let middle = [left.outer.points[left_neck.end], right.outer.points[right_neck.start]];
        if (middle[0] - middle[1]).norm() > SAME {
            return None;
        }
        let [left_middle, right_middle] = [middle_of(left, Hand::Left)?, middle_of(right, Hand::Right)?];
        let mut points = walk(left, left_middle.end, left_neck.end);
        let start = walk(left, left_middle.end, left_neck.start).len() - 1;
        let end = points.len() - 1 + walk(right, right_neck.start, right_neck.end).len() - 1;
        points.extend(&walk(right, right_neck.start, right_middle.start)[1..]);
        // The hem's middle is there already.
        points.pop();
        let neck = Edge { name: EdgeRole::Neck.name(None), start, end, gauge: left_neck.gauge };
        let whole = Outline {
            outer: Loop { points, corners: Vec::new() },
            holes: Vec::new(),
            edges: vec![neck],
            inner: Vec::new(),
            frame: left.frame,
            lies: Vec::new(),
        };
        Some(ClosedFront { left: (left_name, left), right: (right_name, right), whole })
    }

    /// Whether this is the name of one of the halves.
    pub(super) fn is_half(&self, name: &str) -> bool {
        [self.left.0, self.right.0].contains(&name)
    }

    /// Both halves with the neckline of `cut`, which is `whole` with another one.
    pub(super) fn halved(&self, cut: &Outline) -> Option<[(String, Outline); 2]> {
        let line = cut.edge_points(cut.edge_of(EdgeRole::Neck, None)?);
        let foot = self.left.1.outer.points[middle_of(self.left.1, Hand::Left)?.end];
        let top = self.left.1.outer.points[neck(self.left.1, Hand::Left)?.end];
        let down = (foot - top).try_normalize(1e-9)?;
        let off = |p: &Point2| (p - top).perp(&down).abs();
        let k = (1..line.len() - 1).min_by(|a, b| off(&line[*a]).total_cmp(&off(&line[*b])))?;
        let left = meeting(self.left.1, Hand::Left, line[k]);
        let right = meeting(self.right.1, Hand::Right, line[k]);
        let left = replaced(&left, neck(&left, Hand::Left)?, &line[1..k]);
        let right = replaced(&right, neck(&right, Hand::Right)?, &line[k + 1..line.len() - 1]);
        Some([(self.left.0.to_owned(), left), (self.right.0.to_owned(), right)])
    }
}

/// The points from one index to another, both included, counter-clockwise.
fn walk(outline: &Outline, from: usize, to: usize) -> Vec<Point2> {
    let n = outline.outer.points.len();
    (0..=(to + n - from) % n).map(|k| outline.outer.points[(from + k) % n]).collect()
}

/// The neck of a half.
fn neck(half: &Outline, hand: Hand) -> Option<&Edge> {
    half.edge_of(EdgeRole::Neck, Some(hand))
}

/// The edge at which a half is closed.
fn middle_of(half: &Outline, hand: Hand) -> Option<&Edge> {
    half.edge_of(EdgeRole::Middle, Some(hand))
}

/// A half whose neck meets that of the other there.
fn meeting(outline: &Outline, hand: Hand, to: Point2) -> Outline {
    let mut moved = outline.clone();
    if let Some(neck) = neck(outline, hand) {
        let at = if hand == Hand::Left { neck.end } else { neck.start };
        moved.outer.points[at] = to;
        if let Some(lies) = moved.lies.get_mut(at) {
            *lies = outline.lying(to);
        }
    }
    moved
}
