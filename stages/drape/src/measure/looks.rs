//! What a person would look at twice on a garment that keeps its limits.
//!
//! Four signs, reported as warnings: a seam that stands out as a fin (both pieces lie back to back
//! along it), a shoulder seam that stands off the body, a hem that hangs lower on one side, and a
//! photo that is drawn out. None of them is a fault of the solver; they come from the pattern, the
//! pose or the photo. Cost: one pass over seams, triangles and the lowest rim.

use std::collections::BTreeMap;
use toile_core::artifact::{BodyContact, quantile};
use toile_core::prelude::*;

/// Two triangles at a seam lie back to back where they are folded by more than this, degrees.
const FOLDED: f64 = 135.0;
/// A fin is at least so long, metres.
const FIN: f64 = 0.08;
/// A shoulder seam stands off where its cloth is farther from the body than this at one place in
/// twenty, metres.
const OFF: f64 = 0.035;
/// Cloth farther from the body than this is not looked at, metres.
const REACH: f64 = 0.2;
/// A hem hangs unevenly from this difference on, metres.
const UNEVEN: f64 = 0.03;
/// A photo is drawn out where a triangle has so many times less of it than most.
const DRAWN: f64 = 4.0;
/// Over more than this share of a panel's area.
const DRAWN_SHARE: f64 = 0.02;

/// Warns of what looks wrong.
pub(super) fn tell(garment: &Garment, collider: Option<&Collider>, cx: &Context) {
    fins(garment).chain(shoulders(garment, collider)).chain(hem(garment)).chain(drawn_out(garment)).for_each(
        |what| {
            cx.warn(what);
        },
    );
}

fn cm(m: f64) -> String {
    format!("{:.0} cm", m * 1e2)
}

/// Seams along which both pieces lie back to back.
fn fins(garment: &Garment) -> impl Iterator<Item = String> + '_ {
    let weld = |i: u32| garment.weld[i as usize];
    let at = |i: u32| garment.positions[i as usize];
    // Of every welded edge: the normal of each triangle that has it.
    let mut normals: BTreeMap<[u32; 2], Vec<Vector3>> = BTreeMap::new();
    for t in &garment.triangles {
        let normal = (at(t[1]) - at(t[0])).cross(&(at(t[2]) - at(t[0])));
        let Some(normal) = normal.try_normalize(0.0) else { continue };
        for k in 0..3 {
            let [a, b] = [weld(t[k]), weld(t[(k + 1) % 3])];
            normals.entry([a.min(b), a.max(b)]).or_default().push(normal);
        }
    }
    let folded = FOLDED.to_radians().cos();
    garment.seams.iter().filter(|s| s.kind == SeamKind::Matched).filter_map(move |seam| {
        let edge = |w: &[[u32; 2]]| {
            let [a, b] = [weld(w[0][0]), weld(w[1][0])];
            let sides = normals.get(&[a.min(b), a.max(b)])?;
            let is_fin = matches!(sides[..], [m, n] if m.dot(&n) < folded);
            is_fin.then(|| (garment.positions[a as usize] - garment.positions[b as usize]).norm())
        };
        let long: f64 = seam.pairs.windows(2).filter_map(edge).sum();
        (long > FIN).then(|| {
            format!(
                "the seam \"{}\" stands out as a fin over {}: its cloth is wider there than the body, or the pose spreads it",
                seam.name,
                cm(long)
            )
        })
    })
}

/// Shoulder seams that stand off the body.
fn shoulders<'a>(garment: &'a Garment, collider: Option<&'a Collider>) -> impl Iterator<Item = String> + 'a {
    let all = garment.seams.iter().filter(|s| s.name.contains(EdgeRole::Shoulder.word()));
    all.filter_map(move |seam| {
        let points: Vec<Point3> =
            seam.pairs.iter().map(|pair| garment.positions[pair[0] as usize]).collect();
        let mut contacts: Vec<BodyContact> = Vec::new();
        collider?.scheme.body_contacts(&points, REACH, &mut contacts);
        let mut away: Vec<f64> = contacts.iter().map(|c| c.distance).collect();
        away.sort_by(f64::total_cmp);
        let far = quantile(&away, 0.95);
        (!away.is_empty() && far > OFF).then(|| {
            format!(
                "the seam \"{}\" stands {} off the shoulder: the garment's shoulder is longer or less sloped than the body's",
                seam.name,
                cm(far)
            )
        })
    })
}

/// The lowest rim, where it hangs lower on the left or on the right.
fn hem(garment: &Garment) -> Option<String> {
    let mut count: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for t in &garment.triangles {
        let w = t.map(|i| garment.weld[i as usize]);
        for k in 0..3 {
            let [a, b] = [w[k], w[(k + 1) % 3]];
            *count.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for [a, b] in count.into_iter().filter(|(_, n)| *n == 1).map(|(e, _)| e) {
        next.entry(a).or_default().push(b);
        next.entry(b).or_default().push(a);
    }
    let rims = rims(&next);
    let mean = |rim: &Vec<u32>, of: fn(&Point3) -> f64| {
        rim.iter().map(|i| of(&garment.positions[*i as usize])).sum::<f64>() / rim.len() as f64
    };
    let lowest = rims.iter().min_by(|a, b| mean(a, |p| p.y).total_cmp(&mean(b, |p| p.y)))?;
    let middle = mean(lowest, |p| p.x);
    let points = lowest.iter().map(|i| garment.positions[*i as usize]);
    let widest = points.clone().map(|p| (p.x - middle).abs()).fold(0.0, f64::max);
    let side = |hand: Hand| {
        // The outer half of each side.
        let mine = points.clone().filter(|p| hand.sign() * (p.x - middle) > 0.5 * widest).map(|p| p.y);
        let (n, sum) = mine.fold((0.0, 0.0), |(n, sum), y| (n + 1.0, sum + y));
        (n > 0.0).then(|| sum / n)
    };
    // A rim to one side of the body, as a cuff or a trouser leg, has no two sides of a garment.
    let other = rims.iter().filter(|r| !std::ptr::eq(*r, lowest)).map(|r| mean(r, |p| p.y));
    let is_alone = other.fold(f64::INFINITY, f64::min) > mean(lowest, |p| p.y) + UNEVEN;
    let off = side(Hand::Left)? - side(Hand::Right)?;
    let high = Hand::of(off);
    let low = high.other();
    (is_alone && off.abs() > UNEVEN)
        .then(|| format!("the hem hangs {} lower on the wearer's {low} than on the {high}", cm(off.abs())))
}

/// The closed rims of a mesh, by the neighbours of their vertices.
fn rims(next: &BTreeMap<u32, Vec<u32>>) -> Vec<Vec<u32>> {
    let mut seen = std::collections::BTreeSet::new();
    let mut all = Vec::new();
    for start in next.keys() {
        let (mut rim, mut open) = (Vec::new(), vec![*start]);
        while let Some(v) = open.pop() {
            if seen.insert(v) {
                rim.push(v);
                open.extend(next.get(&v).into_iter().flatten());
            }
        }
        if !rim.is_empty() {
            all.push(rim);
        }
    }
    all
}

/// Panels over which the photo is drawn out.
fn drawn_out(garment: &Garment) -> impl Iterator<Item = String> + '_ {
    garment.panels.iter().filter(|p| p.photo_px.len() == p.vertices.len()).filter_map(|panel| {
        let first = panel.vertices.start as u32;
        let area = |[a, b, c]: [Point2; 3]| 0.5 * (b - a).perp(&(c - a)).abs();
        let each = |t: &[u32; 3]| {
            let flat = area(t.map(|i| garment.rest[i as usize]));
            let shown = area(t.map(|i| panel.photo_px[(i - first) as usize]));
            (flat, shown / flat.max(f64::MIN_POSITIVE))
        };
        let all: Vec<(f64, f64)> = garment.triangles[panel.triangles.clone()].iter().map(each).collect();
        let mut density: Vec<f64> = all.iter().map(|(_, d)| *d).collect();
        density.sort_by(f64::total_cmp);
        let least = quantile(&density, 0.5) / DRAWN;
        let whole: f64 = all.iter().map(|(a, _)| a).sum();
        let thin: f64 = all.iter().filter(|(_, d)| *d < least).map(|(a, _)| a).sum();
        (thin > DRAWN_SHARE * whole).then(|| {
            format!(
                "over {:.0} % of panel \"{}\" the photo is drawn out: the garment lay folded there, or the pattern differs from it",
                1e2 * thin / whole,
                panel.name
            )
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_fixtures::cloth::Capsules;
    use toile_fixtures::photographed;

    fn told(garment: &Garment) -> Vec<String> {
        fins(garment).chain(hem(garment)).chain(drawn_out(garment)).collect()
    }

    #[test]
    fn of_an_even_garment_nothing_is_told() {
        assert!(told(&photographed::garment(8)).is_empty(), "{:?}", told(&photographed::garment(8)));
    }

    #[test]
    fn a_hem_that_hangs_lower_on_one_side_is_told() {
        let mut garment = photographed::garment(8);
        garment.positions.iter_mut().for_each(|p| p.y += 0.2 * p.x);
        let told = told(&garment);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(
            told[0].starts_with("the hem hangs ")
                && told[0].ends_with(" on the wearer's right than on the left")
        );
    }

    #[test]
    fn a_shoulder_seam_is_told_where_it_stands_off_the_body() {
        let mut garment = photographed::garment(8);
        garment.seams[0].name = "shoulder_left".into();
        let over = |x: f64, radius: f64| {
            let beam = Capsules::new(&[([x, 0.0, 0.0], [x, 2.0, 0.0], radius)]);
            shoulders(&garment, Some(&beam.collider())).collect::<Vec<_>>()
        };
        assert_eq!(
            over(0.0, 0.05),
            [
                "the seam \"shoulder_left\" stands 13 cm off the shoulder: the garment's shoulder is longer or less sloped than the body's"
            ]
        );
        // The seam lies on this one.
        assert!(over(0.165, 0.03).is_empty());
    }

    #[test]
    fn a_side_pressed_flat_is_a_fin() {
        let mut garment = photographed::garment(8);
        // Front and back lie on each other, a millimetre apart.
        garment.positions.iter_mut().for_each(|p| p.z *= 0.001);
        let told = told(&garment);
        assert_eq!(told.len(), 2, "{told:?}");
        assert_eq!(
            told[0],
            "the seam \"front.side_left + back.side_left\" stands out as a fin over 60 cm: its cloth is wider there than the body, or the pose spreads it"
        );
    }

    #[test]
    fn a_photo_drawn_over_a_fold_is_told() {
        let mut garment = photographed::garment(8);
        let count = garment.panels[0].photo_px.len();
        // The lowest row of cells shows a tenth of what the others show.
        for k in 0..9 {
            let above = garment.panels[0].photo_px[k + 9].y;
            let px = &mut garment.panels[0].photo_px[k];
            px.y = above + 0.1 * (px.y - above);
        }
        assert_eq!(count, 81);
        let told = told(&garment);
        assert_eq!(
            told,
            [
                "over 13 % of panel \"front\" the photo is drawn out: the garment lay folded there, or the pattern differs from it"
            ]
        );
    }
}
