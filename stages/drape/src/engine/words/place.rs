//! Where on the body a place is, in words.

use super::MessageContext;
use nalgebra::Vector3;
use toile_core::artifact::{Hand, Point3};

/// A place nearer than this to a landmark is described by that landmark, metres.
const AT: f64 = 0.12;

/// Nearer than this to the middle, a place is neither left nor right, before nor behind, metres.
const MIDDLE: f64 = 0.03;

impl MessageContext<'_> {
    /// A place: "at the left armpit, 1.27 m above the floor"; its coordinates where there is no
    /// body.
    pub(super) fn place(&self, at: &Vector3<f64>) -> String {
        let surface = self.scheme.and_then(|s| s.surface());
        let Some(surface) = surface.filter(|s| !s.positions.is_empty()) else {
            // The sum turns minus zero into zero.
            let [x, y, z] = [at.x, at.y, at.z].map(|v| (v * 1e3).round() / 1e3 + 0.0);
            return format!("at ({x:.3}, {y:.3}, {z:.3}) m");
        };
        let span = |k: usize| {
            let values = surface.positions.iter().map(|p| p[k]);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
        };
        let middle = |k: usize| at[k] - f64::midpoint(span(k).0, span(k).1);
        let height = format!("{:.2} m above the floor", (at.y - span(1).0).max(0.0));
        let marks = self.scheme.and_then(|s| s.landmarks());
        let distance = |p: &Point3| (p.coords - at).norm();
        let nearest = marks.and_then(|m| m.iter().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1))));
        if let Some((name, _)) = nearest.filter(|(_, p)| distance(p) < AT) {
            return format!("at {}, {height}", landmark(name));
        }
        // The wearer looks along z, and has the left hand at positive x.
        let side = |v: f64, [less, more]: [&'static str; 2]| match v {
            v if v < -MIDDLE => Some(less),
            v if v > MIDDLE => Some(more),
            _ => None,
        };
        let sides =
            [side(middle(2), ["behind", "in front"]), side(middle(0), ["on the right", "on the left"])];
        let sides: Vec<&str> = sides.into_iter().flatten().collect();
        match sides.is_empty() {
            true => height,
            false => format!("{}, {height}", sides.join(" ")),
        }
    }
}

/// A landmark's name in words: `armpit_left` is the left armpit, `waist_front` the front of the
/// waist.
fn landmark(name: &str) -> String {
    let words = |name: &str| name.replace('_', " ");
    match (Hand::split(name), name.rsplit_once('_')) {
        ((of, Some(hand)), _) => format!("the {hand} {}", words(of)),
        (_, Some((of, side @ ("front" | "back")))) => format!("the {side} of the {}", words(of)),
        _ => format!("the {}", words(name)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn landmarks_have_names_that_people_say() {
        let told = ["armpit_left", "neck_base_front", "waist_back", "crotch"].map(landmark);
        assert_eq!(
            told,
            ["the left armpit", "the front of the neck base", "the back of the waist", "the crotch"]
        );
    }
}
