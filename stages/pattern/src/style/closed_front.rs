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
        let with = |edge: &str| outlines.iter().find_map(|(name, o)| Some((name, o, o.edge(edge)?.clone())));
        let (left_name, left, left_neck) = with("neck_left")?;
        let (right_name, right, right_neck) = with("neck_right")?;
        let middle = [left.outer.points[left_neck.end], right.outer.points[right_neck.start]];
        if (middle[0] - middle[1]).norm() > SAME {
            return None;
        }
        let [left_middle, right_middle] = [left.edge("middle_left")?, right.edge("middle_right")?];
        let mut points = walk(left, left_middle.end, left_neck.end);
        let start = walk(left, left_middle.end, left_neck.start).len() - 1;
        let end = points.len() - 1 + walk(right, right_neck.start, right_neck.end).len() - 1;
        points.extend(&walk(right, right_neck.start, right_middle.start)[1..]);
        // The hem's middle is there already.
        points.pop();
        let neck = Edge { name: "neck".into(), start, end, gauge: left_neck.gauge };
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
        let neck = cut.edge_points(cut.edge("neck")?);
        let foot = self.left.1.outer.points[self.left.1.edge("middle_left")?.end];
        let top = self.left.1.outer.points[self.left.1.edge("neck_left")?.end];
        let down = (foot - top).try_normalize(1e-9)?;
        let off = |p: &Point2| (p - top).perp(&down).abs();
        let k = (1..neck.len() - 1).min_by(|a, b| off(&neck[*a]).total_cmp(&off(&neck[*b])))?;
        let middle = neck[k];
        let left = with_end(self.left.1, "neck_left", true, middle);
        let right = with_end(self.right.1, "neck_right", false, middle);
        let left = replaced(&left, left.edge("neck_left")?, &neck[1..k]);
        let right = replaced(&right, right.edge("neck_right")?, &neck[k + 1..neck.len() - 1]);
        Some([(self.left.0.to_owned(), left), (self.right.0.to_owned(), right)])
    }
}

/// The points from one index to another, both included, counter-clockwise.
fn walk(outline: &Outline, from: usize, to: usize) -> Vec<Point2> {
    let n = outline.outer.points.len();
    (0..=(to + n - from) % n).map(|k| outline.outer.points[(from + k) % n]).collect()
}

/// The outline with an edge's end, or its start, elsewhere.
fn with_end(outline: &Outline, edge: &str, at_end: bool, to: Point2) -> Outline {
    let mut moved = outline.clone();
    if let Some(edge) = outline.edge(edge) {
        let at = if at_end { edge.end } else { edge.start };
        moved.outer.points[at] = to;
        if let Some(lies) = moved.lies.get_mut(at) {
            *lies = outline.lying(to);
        }
    }
    moved
}
