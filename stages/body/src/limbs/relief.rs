//! The relief of the skin: bones, muscles and hollows as [bumps](crate::limbs::bump).

use crate::limbs::bump::Bump;
use crate::shape::{FigureShape, level};
use crate::{limbs::arm, limbs::leg};
use toile_core::artifact::{Point3, Vector3};

/// All bumps of a figure's left half and its middle.
pub(crate) fn relief(shape: &FigureShape) -> Vec<Bump> {
    let mut bumps = torso(shape);
    bumps.extend(head(shape));
    bumps.extend(limbs(shape));
    bumps
}

/// Ends as (side, level, front), metres on the adult; radii and height likewise.
type BumpRow = ([f64; 3], [f64; 3], [f64; 3], f64);

fn torso(shape: &FigureShape) -> Vec<Bump> {
    let (bones, form) = (shape.form.relief, shape.form);
    let half = 0.193;
    let rows: [BumpRow; 11] = [
        // Collarbones, the hollows above them, the notch between.
        ([0.030, 0.941, 0.05], [0.82 * half, 0.948, 0.03], [0.030, 0.019, 0.06], 0.0065 * bones),
        ([0.070, 0.964, 0.04], [0.105, 0.960, 0.03], [0.040, 0.026, 0.050], -0.006 * bones),
        ([0.0, 0.948, 0.05], [0.0, 0.953, 0.05], [0.032, 0.030, 0.06], -0.003 * bones),
        // Breastbone and the line of the belly.
        ([0.0, 0.830, 0.10], [0.0, 0.910, 0.07], [0.045, 0.050, 0.06], -0.003 * bones),
        ([0.0, 0.700, 0.10], [0.0, 0.780, 0.10], [0.040, 0.050, 0.05], -0.002 * bones),
        // Muscles of the chest.
        ([0.050, 0.856, 0.10], [0.090, 0.868, 0.09], [0.075, 0.070, 0.07], form.chest),
        // Shoulder blades and the groove of the spine.
        ([0.072, 0.842, -0.10], [0.092, 0.890, -0.09], [0.062, 0.068, 0.07], 0.0090 * bones),
        ([0.0, 0.690, -0.08], [0.0, 0.900, -0.10], [0.045, 0.070, 0.06], -0.006 * bones),
        // Belly, cleft of the seat, the small of the back.
        ([0.0, 0.645, 0.10], [0.0, 0.670, 0.10], [0.110, 0.100, 0.07], form.belly),
        ([0.0, 0.545, -0.11], [0.0, 0.590, -0.12], [0.034, 0.060, 0.07], -0.007),
        ([0.0, 0.655, -0.09], [0.0, 0.665, -0.09], [0.070, 0.060, 0.06], -0.002),
    ];
    rows.iter().map(|r| on_trunk(shape, r)).collect()
}

/// Widths and depths go with the trunk's girth at the level.
fn on_trunk(shape: &FigureShape, (from, to, radii, height): &BumpRow) -> Bump {
    let [hip, waist, bust] = shape.aims.trunk;
    let scale = |l: f64| {
        let along = (l - level::HIP) / (level::WAIST - level::HIP);
        let up = ((l - level::WAIST) / (level::BUST - level::WAIST)).clamp(0.0, 1.0);
        hip + (waist - hip) * along.clamp(0.0, 1.0) + (bust - waist) * up
    };
    let side = |l: f64| if l > 0.93 { shape.size.shoulder_width / 0.386 } else { scale(l) };
    let at = |p: &[f64; 3]| Point3::new(p[0] * side(p[1]), shape.y(p[1]), p[2] * scale(p[1]));
    let k = scale(from[1]);
    let radii = [radii[0] * side(from[1]), radii[1] * shape.stature, radii[2] * k];
    Bump::new([at(from), at(to)], radii, height * shape.stature)
}

fn head(shape: &FigureShape) -> Vec<Bump> {
    let h = shape.head;
    let rows: [BumpRow; 5] = [
        // The nose's ridge and tip, the hollows of the eyes, the brows.
        ([0.0, 0.112, 0.086], [0.0, 0.146, 0.094], [0.019, 0.026, 0.038], 0.012),
        ([0.0, 0.144, 0.098], [0.0, 0.147, 0.098], [0.022, 0.020, 0.034], 0.006),
        ([0.030, 0.116, 0.085], [0.038, 0.116, 0.078], [0.030, 0.026, 0.045], -0.0055),
        // Cheekbones, the mouth and the hollow above the chin.
        ([0.042, 0.142, 0.070], [0.050, 0.136, 0.055], [0.030, 0.028, 0.040], 0.003),
        ([0.0, 0.174, 0.086], [0.010, 0.174, 0.084], [0.026, 0.018, 0.035], 0.0012),
    ];
    let bump = |(from, to, radii, height): &BumpRow| {
        let at = |p: &[f64; 3]| shape.of_head(p[0], p[1], p[2]);
        Bump::new([at(from), at(to)], radii.map(|r| r * h), height * h)
    };
    rows.iter().map(bump).collect()
}

fn limbs(shape: &FigureShape) -> Vec<Bump> {
    let (s, r) = (shape.stature, shape.build(shape.hip()));
    let bones = shape.form.relief.max(0.7) * s;
    let [_, elbow, _] = arm::axis(shape);
    let [hip, ankle] = leg::axis(shape);
    let knee = hip + (ankle - hip) * ((hip.y - shape.y(0.327)) / (hip.y - ankle.y));
    let around = |p: Point3, dx: f64, dy: f64, dz: f64, radii: [f64; 3], height: f64| {
        let at = p + Vector3::new(dx * r, dy * s, dz * r);
        Bump::new([at; 2], radii.map(|v| v * r), height * bones)
    };
    vec![
        around(knee, 0.0, 0.004, 0.058, [0.042, 0.052, 0.050], 0.005),
        around(knee, 0.0, 0.0, -0.048, [0.036, 0.065, 0.045], -0.0035),
        around(ankle, -0.030, 0.004, 0.002, [0.022, 0.026, 0.026], 0.005),
        around(ankle, 0.030, -0.006, -0.004, [0.022, 0.026, 0.026], 0.005),
        around(elbow, 0.0, 0.0, -0.036, [0.034, 0.034, 0.034], 0.004),
    ]
}
