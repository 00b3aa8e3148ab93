//! Landmarks of any standing body, from its horizontal slices.
//!
//! The fork is where slices stop crossing the middle; the armpits where the trunk's slice suddenly
//! widens by the arms; neck, bust, waist and hip are the extremes of width and girth between them;
//! the shoulder's outer point is where the ridge from the neck turns down into the arm. Elbow and
//! wrist lie at mean shares of the arm (Drillis and Contini, 1966). Cost: some hundred slices.
//! Limit: arms must leave the trunk (A- or T-pose), feet must stand apart.

use crate::measures::landmarks::bisect;
use crate::skin::slice::{SliceLoop, slice, trunk};
use std::collections::BTreeMap;
use toile_core::artifact::{Hand, Landmark, Point3};

/// Slices from sole to crown.
const SLICES: usize = 320;
/// Growth of the trunk's width, over 2 % of the height, that means an arm.
const ARM_JUMP: f64 = 1.22;
/// Elbow and wrist as shares of the way from shoulder to fingertips.
const ARM_SHARES: [(&str, f64); 2] = [("elbow", 0.42), ("wrist", 0.755)];
/// Slope at which the ridge of the shoulder has become the arm: between 20 and 45 degrees.
const RIDGE_SLOPE: f64 = 0.62;

/// Landmarks and girths by their names.
type FoundMeasures = (BTreeMap<String, Landmark>, BTreeMap<String, f64>);

/// Landmarks and girths of a body with its feet at 0 and its middle at x = 0; or the part that was
/// not found.
pub(crate) fn estimate(
    positions: &[Point3],
    triangles: &[[u32; 3]],
    height: f64,
) -> Result<FoundMeasures, &'static str> {
    let survey = Survey::take(positions, triangles, height);
    let crotch = survey.crotch().ok_or("crotch")?;
    let armpit = survey.armpit().ok_or("armpits")?;
    let neck = survey.neck(armpit).ok_or("neck")?;
    let span = |lo: f64, hi: f64| survey.rings.iter().filter(move |r| r.0 >= lo && r.0 <= hi);
    let fullest = |lo: f64, hi: f64| span(lo, hi).max_by(|a, b| a.1.girth.total_cmp(&b.1.girth));
    let bust = fullest(armpit - 0.075 * height, armpit - 0.012 * height).ok_or("bust")?;
    let hip = fullest(crotch + 0.005 * height, crotch + 0.13 * height).ok_or("hip")?;
    let slim = span(hip.0 + 0.04 * height, bust.0 - 0.02 * height);
    let waist = slim.min_by(|a, b| a.1.girth.total_cmp(&b.1.girth)).ok_or("waist")?;

    let mut marks = BTreeMap::new();
    for (name, ring) in [("bust", bust), ("waist", waist), ("hip", hip), ("neck_base", neck)] {
        let (front, back) = ring.1.depths_at(0.0).ok_or(name)?;
        marks.insert(format!("{name}_front"), Point3::new(0.0, ring.0, front));
        marks.insert(format!("{name}_back"), Point3::new(0.0, ring.0, back));
    }
    let (front, back) = survey.whole(crotch).ok_or("crotch")?;
    marks.insert("crotch".into(), Point3::new(0.0, crotch, (front + back) / 2.0));
    for hand in Hand::BOTH {
        for (part, p) in survey.arm(hand, armpit, neck).ok_or("arms")? {
            marks.insert(hand.name(part), p);
        }
    }
    let girths = [("height", height), ("bust", bust.1.girth), ("waist", waist.1.girth), ("hip", hip.1.girth)];
    let mut lengths: BTreeMap<String, f64> = girths.map(|(n, v)| (n.to_owned(), v)).into();
    let [left, right] = Hand::BOTH.map(|hand| marks[&hand.name("shoulder")]);
    lengths.insert("shoulder_width".into(), (left - right).norm());
    Ok((marks, lengths))
}

/// A body with the trunk's slices from bottom to top.
struct Survey<'a> {
    positions: &'a [Point3],
    triangles: &'a [[u32; 3]],
    height: f64,
    rings: Vec<(f64, SliceLoop)>,
}

impl<'a> Survey<'a> {
    fn take(positions: &'a [Point3], triangles: &'a [[u32; 3]], height: f64) -> Self {
        let levels = (SLICES / 4..SLICES).map(|k| height * (k as f64 + 0.5) / SLICES as f64);
        let ring = |y: f64| Some((y, trunk(&slice(positions, triangles, y), 0.0)?.clone()));
        Survey { positions, triangles, height, rings: levels.filter_map(ring).collect() }
    }

    /// Front and back of the trunk in the middle plane.
    fn whole(&self, y: f64) -> Option<(f64, f64)> {
        trunk(&slice(self.positions, self.triangles, y), 0.0)?.depths_at(0.0)
    }

    /// The lowest height, downwards from the waist, whose slice still crosses the middle.
    fn crotch(&self) -> Option<f64> {
        let step = self.height / SLICES as f64;
        let steps = (0..SLICES / 2).map(|k| 0.62 * self.height - step * k as f64);
        let open = steps.take_while(|y| *y > 0.25 * self.height).find(|y| self.whole(*y).is_none())?;
        bisect(open + step, open, |y| self.whole(y).is_some())
    }

    /// The height below which the arms are apart from the trunk.
    fn armpit(&self) -> Option<f64> {
        let ahead = (SLICES / 50).max(1);
        let upper = self.rings.windows(ahead + 1).filter(|w| w[0].0 > 0.62 * self.height);
        let wide = upper.into_iter().find(|w| w[ahead].1.width() > ARM_JUMP * w[0].1.width())?;
        let base = wide[0].1.width();
        wide.iter().take_while(|r| r.1.width() < ARM_JUMP * base).last().map(|r| r.0)
    }

    /// The lowest slice that is hardly wider than the neck's narrowest.
    fn neck(&self, armpit: f64) -> Option<&(f64, SliceLoop)> {
        let upper = || self.rings.iter().filter(|r| r.0 > armpit && r.0 < 0.93 * self.height);
        let narrow = upper().min_by(|a, b| a.1.width().total_cmp(&b.1.width()))?;
        upper().find(|r| r.0 <= narrow.0 && r.1.width() < 1.45 * narrow.1.width())
    }

    /// Neck point, shoulder point, armpit, elbow and wrist of one side.
    fn arm(&self, hand: Hand, armpit: f64, neck: &(f64, SliceLoop)) -> Option<Vec<(&'static str, Point3)>> {
        let ring = |y: f64| self.rings.iter().rfind(|r| r.0 <= y).map(|r| &r.1);
        let below = ring(armpit)?;
        let sign = hand.sign();
        let side = |l: &SliceLoop| l.bounds[usize::from(hand == Hand::Left)];
        let (half, inner) = (side(below).abs(), side(&neck.1).abs());
        let ridge = |x: f64| self.ridge(sign * x, neck.0 + 0.04 * self.height);
        let shoulder = ridge(self.shoulder_x(inner, half, &ridge)?)?;
        let tip =
            self.positions.iter().copied().reduce(|a, b| if b.x * sign > a.x * sign { b } else { a })?;
        let joint = Point3::new(
            shoulder.x - sign * 0.012 * self.height,
            shoulder.y - 0.028 * self.height,
            shoulder.z,
        );
        let mut marks = vec![
            ("neck", ridge(inner * 1.02)?),
            ("shoulder", shoulder),
            ("armpit", Point3::new(side(below), armpit, below.centre().y)),
        ];
        for (name, share) in ARM_SHARES {
            marks.push((name, self.along(&joint, &tip, share)?));
        }
        Some(marks)
    }

    /// Outwards from the neck, the x at which the ridge turns down into the arm; the trunk's side
    /// where it does not turn (arms held level).
    fn shoulder_x(&self, inner: f64, half: f64, ridge: &impl Fn(f64) -> Option<Point3>) -> Option<f64> {
        let step = 0.006 * self.height;
        let mut x = inner.max(0.75 * half);
        while x < 1.3 * half {
            if ridge(x)?.y - ridge(x + step)?.y > RIDGE_SLOPE * step {
                return Some(x);
            }
            x += step / 2.0;
        }
        Some(1.05 * half)
    }

    /// The highest point of the skin below `top` in the plane of a given x.
    fn ridge(&self, x: f64, top: f64) -> Option<Point3> {
        crate::measures::landmarks::ridge(self.positions, self.triangles, x, top)
    }

    /// The middle of the limb at a share of the way from `from` to `to`.
    fn along(&self, from: &Point3, to: &Point3, share: f64) -> Option<Point3> {
        let axis = to - from;
        let near = |p: &&Point3| {
            let t = (**p - from).dot(&axis) / axis.norm_squared();
            let off = (**p - from - axis * t).norm();
            (t - share).abs() < 0.03 && off < 0.09 * self.height
        };
        let (mut lo, mut hi) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        for p in self.positions.iter().filter(near) {
            (lo, hi) = (lo.inf(p), hi.sup(p));
        }
        (lo.x <= hi.x).then(|| nalgebra::center(&lo, &hi))
    }
}
