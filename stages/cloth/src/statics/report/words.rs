//! Places in a garment, in words: panels by their names, positions in metres.

use crate::scene::Scene;
use nalgebra::Vector3;

/// The name of a panel, counted from 1, or of a vertex without a panel for 0.
pub(crate) fn panel(scene: &Scene, number: u32) -> String {
    let panel = (number as usize).checked_sub(1).and_then(|k| scene.panels.get(k));
    panel.map_or_else(|| "cloth of no panel".into(), |p| format!("panel '{}'", p.name))
}

/// Two panels as the subject of a sentence about each other, with its verb: "panels 'a' and 'b'
/// cross each other", "panel 'a' crosses itself".
pub(crate) fn both(panels: &[String; 2], many: &str, one: &str) -> String {
    let [a, b] = panels;
    match (a == b, a.strip_prefix("panel "), b.strip_prefix("panel ")) {
        (true, ..) => format!("{a} {one} itself"),
        (_, Some(a), Some(b)) => format!("panels {a} and {b} {many} each other"),
        _ => format!("{a} and {b} {many} each other"),
    }
}

/// A place, to the millimetre.
pub(crate) fn place(at: &Vector3<f64>) -> String {
    // The sum turns minus zero into zero.
    let [x, y, z] = [at.x, at.y, at.z].map(|v| (v * 1e3).round() / 1e3 + 0.0);
    format!("({x:.3}, {y:.3}, {z:.3}) m")
}

/// Names in quotes, the last one joined by "and".
pub(crate) fn list(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|n| format!("'{n}'")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_and_places_are_told_in_words() {
        let [a, b] = ["panel 'front'", "panel 'back'"].map(String::from);
        let none = "cloth of no panel".to_owned();
        assert_eq!(both(&[a.clone(), b], "cross", "crosses"), "panels 'front' and 'back' cross each other");
        assert_eq!(both(&[a.clone(), a.clone()], "cross", "crosses"), "panel 'front' crosses itself");
        assert_eq!(
            both(&[a, none], "cross", "crosses"),
            "panel 'front' and cloth of no panel cross each other"
        );
        assert_eq!(place(&Vector3::new(-0.0001, 1.2, 0.0456)), "(0.000, 1.200, 0.046) m");
        let names =
            |n: usize| list(&["a", "b", "c"][..n].iter().map(ToString::to_string).collect::<Vec<_>>());
        assert_eq!([names(1), names(2), names(3)], ["'a'", "'a' and 'b'", "'a', 'b' and 'c'"]);
    }
}
