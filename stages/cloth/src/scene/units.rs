//! Finds the unit of a scene's lengths.
//!
//! A scene is in metres. The OBJ of its body may be in another unit: if it is larger than any body,
//! the unit in which it fits the cloth best is used. Other implausible lengths are reported or
//! refused before anything is solved. Cost: O(n).

use super::{Scene, SceneError};
use nalgebra::Vector3;

/// Greatest length of a body or of the cloth, m.
const LONGEST: f64 = 10.0;

/// Least length of a body or a garment in its longest direction, m.
const SHORTEST: f64 = 0.01;

/// Lengths of a body that a unit is found for, m.
const BODIES: [f64; 2] = [0.05, 5.0];

/// Units that are tried, in metres, with their names.
const UNITS: [(f64, &str); 3] = [(0.01, "centimetres"), (0.001, "millimetres"), (0.1, "decimetres")];

/// Greatest ratio of the lengths of the flat cloth and of the cloth at the start, either way.
const REST: f64 = 8.0;

/// Ratio of the length of the cloth to that of its body above which a warning is given.
const CLOTH_TO_BODY: f64 = 5.0;

/// Ratio of the length of the body to that of the cloth above which a warning is given.
const BODY_TO_CLOTH: f64 = 20.0;

/// Converts the body to metres and reports implausible lengths.
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
    if cloth > CLOTH_TO_BODY * long || long > BODY_TO_CLOTH * cloth {
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
