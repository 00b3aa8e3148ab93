//! Where two sheets differ, first stage first.

use super::{Section, Sheet, SheetMeasure};

/// One measure, or one whole artifact, that is not as it was.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The stage's id.
    pub stage: String,
    /// The section's title.
    pub section: String,
    /// One sentence with both values.
    pub message: String,
}

/// What a comparison found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Comparison {
    /// Differences beyond tolerance, in the order of the pipeline.
    pub differences: Vec<Difference>,
    /// Titles of the sections whose bits moved within tolerance.
    pub moved: Vec<String>,
}

impl Comparison {
    /// The first stage that differs.
    pub fn first_stage(&self) -> Option<&str> {
        self.differences.first().map(|d| d.stage.as_str())
    }
}

/// Compares a run with its golden.
pub fn compare(golden: &Sheet, now: &Sheet) -> Comparison {
    let mut found = Comparison::default();
    for new in &now.0 {
        match golden.0.iter().find(|old| old.title() == new.title()) {
            Some(old) => compare_sections(old, new, &mut found),
            None => found.differences.push(difference(new, "it is not in the golden sheet".into())),
        }
    }
    for old in &golden.0 {
        if !now.0.iter().any(|new| new.title() == old.title()) {
            found.differences.push(difference(old, "the pipeline does not make it any more".into()));
        }
    }
    found
}

fn difference(section: &Section, message: String) -> Difference {
    Difference { stage: section.stage.clone(), section: section.title(), message }
}

fn compare_sections(old: &Section, new: &Section, found: &mut Comparison) {
    let before = found.differences.len();
    for was in &old.measures {
        match new.measures.iter().find(|m| m.name == was.name) {
            None => found.differences.push(difference(old, format!("{} is no longer measured", was.name))),
            Some(is) => found.differences.extend(apart(was, is).map(|m| difference(old, m))),
        }
    }
    for is in &new.measures {
        if !old.measures.iter().any(|m| m.name == is.name) {
            found.differences.push(difference(new, format!("{} is not in the golden sheet", is.name)));
        }
    }
    if found.differences.len() == before && old.digest != new.digest {
        found.moved.push(new.title());
    }
}

/// Half a unit of the last place that a sheet shows.
const SHEET_ROUNDING: f64 = 5e-7;

/// Why two values of a measure differ; `None` within tolerance. NaN differs from everything.
fn apart(was: &SheetMeasure, is: &SheetMeasure) -> Option<String> {
    let off = (was.value - is.value).abs();
    let near = off <= was.tolerance + SHEET_ROUNDING && was.unit == is.unit;
    let unit = if is.unit.is_empty() { String::new() } else { format!(" {}", is.unit) };
    (!near).then(|| {
        format!("{} was {}, is {:.6}{unit} (tolerance {})", was.name, was.value, is.value, was.tolerance)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::parse;
    use super::*;

    const GOLDEN: &str = "[Mesh panel front]\narea = 10 cm2 +- 1\ndigest = aa\n[Place garment]\nvertices = 5 +- 0\ndigest = bb\n";

    fn against(now: &str) -> Comparison {
        compare(&parse(GOLDEN).unwrap(), &parse(now).unwrap())
    }

    #[test]
    fn equal_sheets_agree() {
        assert_eq!(against(GOLDEN), Comparison::default());
    }

    #[test]
    fn the_first_stage_that_differs_is_named() {
        let found = against(&GOLDEN.replace("= 10 ", "= 12 ").replace("= 5 ", "= 6 "));
        assert_eq!(found.first_stage(), Some("Mesh"));
        assert_eq!(found.differences[0].message, "area was 10, is 12.000000 cm2 (tolerance 1)");
        assert_eq!(found.differences.len(), 2);
    }

    #[test]
    fn bits_that_move_within_tolerance_are_a_remark() {
        let found = against(&GOLDEN.replace("aa", "a0").replace("= 10 ", "= 10.5 "));
        assert!(found.differences.is_empty());
        assert_eq!(found.moved, ["Mesh panel front"]);
    }

    #[test]
    fn a_missing_artifact_and_nan_are_differences() {
        assert_eq!(
            against("[Mesh panel front]\narea = 10 cm2 +- 1\ndigest = aa\n").first_stage(),
            Some("Place")
        );
        assert_eq!(against(&GOLDEN.replace("= 5 ", "= NaN ")).first_stage(), Some("Place"));
    }

    #[test]
    fn every_measure_of_a_sheet_can_fail() {
        let golden = parse(GOLDEN).unwrap();
        for s in 0..golden.0.len() {
            for m in 0..golden.0[s].measures.len() {
                let mut now = golden.clone();
                let measure = &mut now.0[s].measures[m];
                measure.value += 1.01 * measure.tolerance + 1e-5;
                assert_eq!(compare(&golden, &now).first_stage(), Some(golden.0[s].stage.as_str()));
            }
        }
    }
}
