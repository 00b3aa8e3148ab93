//! Lengths that no garment has are those of another unit.
//!
//! A scene is in metres. The OBJ of its body comes from a modelling program and may be in another
//! unit: where it is larger than any body, the unit is taken in which it fits the cloth. What is
//! odd otherwise is told or refused, before anything is solved.

use super::{Scene, SceneError};
use nalgebra::Vector3;

/// No body and no cloth of a garment is longer than this, m.
const LONGEST: f64 = 10.0;

/// What is shorter than this in every direction is no body and no garment, m.
const SHORTEST: f64 = 0.01;

/// Lengths of a body that a unit is found for, m.
const BODIES: [f64; 2] = [0.05, 5.0];

/// Units that are tried, in metres, with their names.
const UNITS: [(f64, &str); 3] = [(0.01, "centimetres"), (0.001, "millimetres"), (0.1, "decimetres")];

/// How many times longer the flat cloth may be than where it starts, and the other way round.
const REST: f64 = 8.0;

/// How many times longer the cloth may be than its body, and the body than the cloth, before that
/// is told.
const BESIDE: (f64, f64) = (5.0, 20.0);

/// Brings the body to metres and tells what is odd.
pub(super) fn settle(scene: &mut Scene, unit: Option<f64>) -> Result<Vec<String>, SceneError> {
    check_rest(scene)?;
    let cloth = longest(scene.triangles.iter().flatten().map(|&v| scene.positions[v as usize]));
    let mut told = Vec::new();
    if cloth < SHORTEST {
        told.push(format!("the cloth is only {cloth:.4} m long: lengths of a scene are in metres"));
    }
    let Some(body) = &mut scene.body else {
        if cloth > LONGEST {
            told.push(format!("the cloth is {cloth:.1} m long: lengths of a scene are in metres"));
        }
        return Ok(told);
    };
    let raw = longest(body.triangles.iter().flatten().map(|&v| body.vertices[v as usize]));
    let unit = match unit {
        Some(unit) => unit,
        None if raw <= LONGEST => 1.0,
        None if cloth > LONGEST => {
            return Err(SceneError::Lengths {
                what: "the cloth would be",
                length: format!("{cloth:.1}"),
                axis: "long and its body longer than 10 m",
                hint: "lengths of a scene are in metres: divide them by 100 where they are centimetres"
                    .into(),
            });
        }
        None => {
            let (unit, name) = found(raw, cloth)?;
            told.push(format!(
                "the body's OBJ is read in {name}, as it would be {raw:.1} m long in metres: it is {:.3} m long",
                raw * unit
            ));
            unit
        }
    };
    if unit != 1.0 {
        body.vertices.iter_mut().for_each(|p| *p *= unit);
    }
    let long = raw * unit;
    if cloth > BESIDE.0 * long || long > BESIDE.1 * cloth {
        told.push(format!(
            "the body is {long:.3} m long and the cloth {cloth:.3} m: if the body's OBJ is in another unit, name it with `units`"
        ));
    }
    Ok(told)
}

/// The unit in which a body fits the cloth best.
fn found(raw: f64, cloth: f64) -> Result<(f64, &'static str), SceneError> {
    let fits = UNITS.into_iter().filter(|(u, _)| (BODIES[0]..=BODIES[1]).contains(&(raw * u)));
    let apart = |u: f64| (raw * u / cloth.max(f64::MIN_POSITIVE)).ln().abs();
    let best = fits.reduce(|a, b| if apart(b.0) < apart(a.0) { b } else { a });
    best.ok_or_else(|| SceneError::Lengths {
        what: "the body would be",
        length: format!("{raw:.1}"),
        axis: "long",
        hint: "scale its OBJ to metres, or name its unit with `units`".into(),
    })
}

/// Refuses flat cloth in another unit than its start.
fn check_rest(scene: &Scene) -> Result<(), SceneError> {
    let mut ratios: Vec<f64> = scene
        .triangles
        .iter()
        .map(|t| {
            let [a, b] = [t[0] as usize, t[1] as usize];
            (scene.rest[a] - scene.rest[b]).norm() / (scene.positions[a] - scene.positions[b]).norm()
        })
        .filter(|r| !r.is_nan())
        .collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let Some(&middle) = ratios.get(ratios.len() / 2) else { return Ok(()) };
    if (1.0 / REST..=REST).contains(&middle) {
        return Ok(());
    }
    let (longer, shorter, times) =
        if middle > 1.0 { ("rest_uv", "positions", middle) } else { ("positions", "rest_uv", 1.0 / middle) };
    Err(SceneError::RestScale { longer, shorter, times: format!("{times:.0}") })
}

/// The longest side of the box around some points.
fn longest(mut points: impl Iterator<Item = Vector3<f64>>) -> f64 {
    let Some(first) = points.next() else { return 0.0 };
    let (low, high) = points.fold((first, first), |(l, h), p| (l.inf(&p), h.sup(&p)));
    (high - low).max()
}
