//! What is printed on the cloth: stripes and motifs as signed distances, so that their rims are
//! soft by the width of a pixel and not stepped.

use crate::colour::{LinearColour, blend, smoothstep, srgb};
use crate::garment::{PlanePoint, distance};

/// Half the width over which the rim of a print fades, mm: ink soaks into the yarn.
const RIM: f64 = 0.35;

/// Paints `ink` over `under` where the signed distance `d` (mm, negative inside) says so.
fn paint(under: LinearColour, ink: LinearColour, d: f64) -> LinearColour {
    blend(ink, under, smoothstep(-RIM, RIM, d))
}

/// Nothing.
pub(crate) fn plain(base: LinearColour, _: PlanePoint) -> LinearColour {
    base
}

/// Two bands above a skirt's hem, which is 9 mm lower in the middle.
pub(crate) fn border(base: LinearColour, p: PlanePoint) -> LinearColour {
    let high = p[1] - 9.0 * (p[0] / 312.0).powi(2);
    let cloth = paint(base, srgb(196, 168, 112), (high - 78.0).abs() - 14.0);
    paint(cloth, srgb(150, 70, 52), (high - 108.0).abs() - 4.0)
}

/// A band down the middle, 32 mm wide, with its buttons.
pub(crate) fn placket(base: LinearColour, p: PlanePoint) -> LinearColour {
    let edge = (p[0] + 16.0).abs() - 0.7;
    let stitches = (p[0].abs() - 11.0).abs() - 0.35;
    let row = ((p[1] - 40.0) / 84.0).round();
    let button = distance(p, [0.0, 40.0 + 84.0 * row]) - 5.5;
    let hole = distance([p[0].abs(), p[1]], [1.6, 40.0 + 84.0 * row]) - 0.8;
    let cloth = paint(paint(base, srgb(52, 72, 104), edge), srgb(98, 120, 152), stitches);
    paint(paint(cloth, srgb(226, 218, 200), button), srgb(90, 84, 76), hole)
}

/// Edges of six pleats, from a waist of 366 mm down to a hem of 624, and the shade beside each.
pub(crate) fn pleats(base: LinearColour, p: PlanePoint) -> LinearColour {
    let wide = 312.0 - (p[1] - 9.0) / 543.0 * 129.0;
    let share = (p[0] / wide + 1.0) * 3.0 - 0.5;
    let off = (share - share.round()) * wide / 3.0;
    let shade = blend(srgb(40, 30, 44), base, 1.0 - 0.5 * smoothstep(14.0, 0.0, off.abs()));
    let shaded = if off > 0.0 { shade } else { base };
    paint(shaded, srgb(30, 22, 34), off.abs() - 0.6)
}

/// Dots in rows.
pub(crate) fn dots(base: LinearColour, p: PlanePoint) -> LinearColour {
    let row = (p[1] / 34.0).round();
    let shift = if row.rem_euclid(2.0) < 0.5 { 0.0 } else { 20.0 };
    let x = (p[0] - shift) / 40.0;
    let c = [(x - x.round()) * 40.0, p[1] - row * 34.0];
    paint(base, srgb(214, 196, 150), c[0].hypot(c[1]) - 6.5)
}

/// Navy with bands that run on from front to back at the side seams, and a star in a ring.
pub(crate) fn vest_front(base: LinearColour, p: PlanePoint) -> LinearColour {
    let cloth = vest_bands(base, p);
    let ink = srgb(186, 76, 50);
    let c = [p[0], p[1] - 388.0];
    let ring = (c[0].hypot(c[1]) - 66.0).abs() - 4.5;
    paint(cloth, ink, ring.min(star(c, 48.0)))
}

/// The same bands; a number as on a team's shirt.
pub(crate) fn vest_back(base: LinearColour, p: PlanePoint) -> LinearColour {
    let cloth = vest_bands(base, p);
    let ink = srgb(178, 70, 46);
    let seven = stroke(p, &[[-92.0, 478.0], [-22.0, 478.0], [-60.0, 350.0]]);
    let two = stroke(p, &arc([57.0, 443.0], 35.0, 165.0, -35.0))
        .min(stroke(p, &[[85.7, 422.9], [22.0, 350.0], [94.0, 350.0]]));
    paint(cloth, ink, seven.min(two) - 9.5)
}

fn vest_bands(base: LinearColour, p: PlanePoint) -> LinearColour {
    let mut cloth = base;
    let blue = srgb(76, 104, 136);
    for centre in [62.0, 116.0, 170.0, 224.0, 278.0] {
        cloth = paint(cloth, blue, (p[1] - centre).abs() - 9.0);
        cloth = paint(cloth, srgb(168, 70, 48), (p[1] - centre - 17.0).abs() - 2.0);
    }
    cloth
}

/// Forest green with a sun over mountains, and a band across both sleeves.
pub(crate) fn tshirt_front(base: LinearColour, p: PlanePoint) -> LinearColour {
    let cloth = sleeve_bands(base, p);
    let c = [p[0], p[1] - 395.0];
    let frame = boxed(c, [104.0, 84.0], 10.0);
    let sky = blend(srgb(116, 68, 78), srgb(150, 74, 54), smoothstep(60.0, -40.0, c[1]));
    let sun = distance(c, [26.0, 14.0]) - 30.0;
    let far = ridge(c, &[[-120.0, -40.0], [-48.0, 34.0], [-6.0, -6.0], [40.0, 12.0], [120.0, -46.0]]);
    let near = ridge(c, &[[-120.0, -78.0], [-30.0, -30.0], [10.0, -52.0], [64.0, -8.0], [120.0, -60.0]]);
    let mut picture = paint(sky, srgb(196, 96, 44), sun);
    picture = paint(picture, srgb(70, 62, 84), far);
    picture = paint(picture, srgb(30, 34, 46), near);
    blend(picture, cloth, smoothstep(-RIM, RIM, frame))
}

/// Three long waves and a compass rose.
pub(crate) fn tshirt_back(base: LinearColour, p: PlanePoint) -> LinearColour {
    let mut cloth = sleeve_bands(base, p);
    for (k, ink) in [srgb(96, 120, 116), srgb(120, 96, 70), srgb(150, 74, 54)].into_iter().enumerate() {
        let wave = 196.0 + 46.0 * k as f64 + 15.0 * (p[0] / 38.0 + k as f64).sin();
        // Dividing by the slope's length makes the line as wide on its flanks as at its crests.
        let slope = 15.0 / 38.0 * (p[0] / 38.0 + k as f64).cos();
        cloth = paint(cloth, ink, (p[1] - wave).abs() / slope.hypot(1.0) - 6.0);
    }
    let c = [p[0], p[1] - 460.0];
    let turned = [(c[0] - c[1]) / 2f64.sqrt(), (c[0] + c[1]) / 2f64.sqrt()];
    let rose = diamond(c, 62.0).min(diamond([c[1], c[0]], 62.0));
    let small = diamond(turned, 34.0).min(diamond([turned[1], turned[0]], 34.0));
    paint(paint(cloth, srgb(110, 96, 74), small), srgb(158, 72, 52), rose)
}

fn sleeve_bands(base: LinearColour, p: PlanePoint) -> LinearColour {
    // Parallel to the cuff, which runs from (317, 334) to (380, 525); the line would meet the
    // sides.
    let from_cuff = ((380.0 - p[0].abs()) * 191.0 + (p[1] - 525.0) * 63.0) / 191f64.hypot(63.0);
    let ink = srgb(108, 116, 96);
    let on = |centre: f64, half: f64| (from_cuff - centre).abs() - half;
    if p[0].abs() < 262.0 {
        return base;
    }
    paint(base, ink, on(46.0, 6.0).min(on(62.0, 2.0)))
}

/// A five-pointed star of outer radius `r`, its first point up.
fn star(p: PlanePoint, r: f64) -> f64 {
    let sector = std::f64::consts::TAU / 5.0;
    let angle = p[0].atan2(p[1]);
    let folded = (angle - (angle / sector).round() * sector).abs();
    let length = p[0].hypot(p[1]);
    let q = [length * folded.sin(), length * folded.cos()];
    // The straight rim from the point (0, r) to the notch.
    let notch = [r * 0.42 * (sector / 2.0).sin(), r * 0.42 * (sector / 2.0).cos()];
    let (u, v) = ([notch[0], notch[1] - r], [q[0], q[1] - r]);
    (u[0] * v[1] - u[1] * v[0]) / u[0].hypot(u[1])
}

/// A slim rhombus, `r` tall.
fn diamond(p: PlanePoint, r: f64) -> f64 {
    let (half, tall) = (r * 0.2, r);
    (p[0].abs() * tall + p[1].abs() * half - half * tall) / half.hypot(tall)
}

/// A box with round corners.
fn boxed(p: PlanePoint, half: PlanePoint, radius: f64) -> f64 {
    let q = [0, 1].map(|k| p[k].abs() - half[k] + radius);
    q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0) - radius
}

/// Below a mountain's crest; the height difference stands in for the distance.
fn ridge(p: PlanePoint, crest: &[PlanePoint]) -> f64 {
    let height = crest
        .windows(2)
        .find(|w| p[0] < w[1][0])
        .map_or(-1e3, |w| w[0][1] + (p[0] - w[0][0]) / (w[1][0] - w[0][0]) * (w[1][1] - w[0][1]));
    (p[1] - height) * 0.75
}

/// Distance to a polyline.
fn stroke(p: PlanePoint, line: &[PlanePoint]) -> f64 {
    let to = |w: &[PlanePoint]| {
        let (u, v) = ([w[1][0] - w[0][0], w[1][1] - w[0][1]], [p[0] - w[0][0], p[1] - w[0][1]]);
        let t = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
        distance(v, [u[0] * t, u[1] * t])
    };
    line.windows(2).map(to).fold(f64::INFINITY, f64::min)
}

/// A circular arc as a polyline, degrees.
fn arc(centre: PlanePoint, r: f64, from: f64, to: f64) -> Vec<PlanePoint> {
    let at = |k: u32| (from + (to - from) * f64::from(k) / 24.0).to_radians();
    (0..=24).map(|k| [centre[0] + r * at(k).cos(), centre[1] + r * at(k).sin()]).collect()
}
