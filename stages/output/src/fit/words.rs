//! Where a garment is too tight, in words.

use super::load::ClothLoad;
use std::collections::BTreeMap;
use toile_core::artifact::{Body, Garment, Hand, Point3};

/// What is nearer than this to the line of an arm's joints lies on the arm, metres.
const ARM: f64 = 0.09;

/// A part of the body on which the cloth presses too hard.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TightPlace {
    /// `front of the hip`.
    pub place: String,
    /// Square metres above the limit.
    pub area: f64,
    /// The greatest pressure there, Pa.
    pub pressure: f64,
}

impl TightPlace {
    /// For the user; `comfort` in kPa.
    pub(super) fn sentence(&self, comfort: f64) -> String {
        format!(
            "it is tight at the {}: up to {:.1} kPa on {:.0} cm2, and from {comfort} kPa on people call it tight; let it out there, or take a \
             larger size",
            self.place,
            self.pressure * 1e-3,
            self.area * 1e4
        )
    }
}

/// Parts of the body that more than `over` square metres of cloth press with more than `limit`, Pa;
/// the tightest first.
pub(super) fn tight(
    garment: &Garment,
    body: Option<&Body>,
    load: &ClothLoad,
    limit: f64,
    over: f64,
) -> Vec<TightPlace> {
    let mut places: BTreeMap<String, TightPlace> = BTreeMap::new();
    for (i, p) in garment.positions.iter().enumerate() {
        let Some(pressure) = load.pressure[i].filter(|p| *p > limit) else { continue };
        // A joined vertex counts once.
        if garment.weld[i] as usize != i {
            continue;
        }
        let place = body.map_or_else(|| "body".to_owned(), |b| part(b, p));
        let entry = places.entry(place.clone()).or_insert(TightPlace { place, area: 0.0, pressure: 0.0 });
        entry.area += load.area[i];
        entry.pressure = entry.pressure.max(pressure);
    }
    let mut all: Vec<TightPlace> = places.into_values().filter(|t| t.area > over).collect();
    all.sort_by(|a, b| b.pressure.total_cmp(&a.pressure).then_with(|| a.place.cmp(&b.place)));
    all
}

/// The part of a body that a place is nearest to: `left upper arm`, `front of the hip`.
fn part(body: &Body, p: &Point3) -> String {
    let mark = |name: &str| body.landmarks.get(name).copied();
    let bones = [("shoulder", "elbow", "upper arm"), ("elbow", "wrist", "forearm")];
    for hand in Hand::BOTH {
        for (from, to, name) in bones {
            let ends = (body.landmark(from, hand), body.landmark(to, hand));
            let (Some(a), Some(b)) = ends else { continue };
            let (along, beyond) = (b - a, body.landmark("armpit", hand).map_or(0.0, |q| q.x.abs()));
            let share = (p - a).dot(&along) / along.norm_squared().max(1e-12);
            let off = (p - (a + along * share.clamp(0.0, 1.0))).norm();
            if off < ARM && share < 1.05 && p.x.abs() > beyond {
                return format!("{hand} {name}");
            }
        }
    }
    let levels = ["neck_base", "bust", "waist", "hip"];
    let near =
        levels.iter().filter_map(|l| Some((l, mark(&format!("{l}_front"))?, mark(&format!("{l}_back"))?)));
    let near = near.min_by(|a, b| (a.1.y - p.y).abs().total_cmp(&(b.1.y - p.y).abs()));
    let Some((level, front, back)) = near else { return "body".to_owned() };
    let (middle, half) = ((front.z + back.z) / 2.0, ((front.z - back.z) / 2.0).max(1e-6));
    let hand = Hand::of(p.x - front.x);
    if mark("crotch").is_some_and(|c| p.y < c.y) {
        return format!("{hand} thigh");
    }
    let level = level.replace("neck_base", "neck");
    match (p.z - middle) / half {
        z if z > 0.5 => format!("front of the {level}"),
        z if z < -0.5 => format!("back of the {level}"),
        _ => format!("{hand} side of the {level}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_says_where_how_much_and_what_to_do() {
        let tight = TightPlace { place: "front of the hip".into(), area: 0.0042, pressure: 7140.0 };
        assert_eq!(
            tight.sentence(5.9),
            "it is tight at the front of the hip: up to 7.1 kPa on 42 cm2, and from 5.9 kPa on people call it tight; let it out there, or take \
             a larger size"
        );
    }

    #[test]
    fn places_have_the_names_of_the_part_and_side_that_they_are_on() {
        let body = toile_core::testkit::dress::body();
        let at = |x, y, z| part(&body, &Point3::new(x, y, z));
        assert_eq!(at(0.0, 0.86, 0.115), "front of the hip");
        assert_eq!(at(0.0, 1.24, -0.115), "back of the bust");
        assert_eq!(at(-0.13, 1.05, 0.0), "right side of the waist");
        assert_eq!(at(0.19, 1.25, 0.0), "left upper arm");
        assert_eq!(at(0.1, 0.6, 0.0), "left thigh");
    }
}
