//! Where two sheets differ, first stage first.

use super::{GoldenSheet, SheetMeasure, SheetSection, made_by};

/// One measure, or one whole artifact, that is not as it was.
#[derive(Debug, Clone, PartialEq)]
pub struct GoldenDifference {
    /// The stage's id.
    pub stage: String,
    /// The section's title.
    pub section: String,
    /// One sentence with both values.
    pub message: String,
}

/// Whether a golden was recorded by the arithmetic of this machine: equal arithmetic gives equal
/// bits to equal code.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Arithmetic {
    /// By the same.
    Same,
    /// By another: another processor, or another C library.
    Other,
    /// The golden does not say, or this machine's is not known.
    #[default]
    Unknown,
}

/// What a comparison found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Comparison {
    /// Whose bits the golden has.
    pub arithmetic: Arithmetic,
    /// Differences beyond tolerance, in the order of the pipeline.
    pub differences: Vec<GoldenDifference>,
    /// Titles of the sections whose bits moved within tolerance.
    pub moved: Vec<String>,
    /// The stage from which on bits moved, within tolerance or not: where the cause lies, if the
    /// arithmetic is the same.
    pub moves_from: Option<String>,
    /// Parameters and versions of stages that are not those of the golden, a line each:
    /// `GridMesher: edge "16 mm" -> "12 mm"`.
    pub changes: Vec<String>,
}

impl Comparison {
    /// The first stage that differs.
    pub fn first_stage(&self) -> Option<&str> {
        self.differences.first().map(|d| d.stage.as_str())
    }
}

/// Compares a run with its golden.
pub fn compare(golden: &GoldenSheet, now: &GoldenSheet) -> Comparison {
    let (arithmetic, changes) = (arithmetic(golden, now), made_by::changes(golden, now));
    let mut found = Comparison { arithmetic, changes, ..Comparison::default() };
    for new in &now.sections {
        match golden.sections.iter().find(|old| old.title() == new.title()) {
            Some(old) => compare_sections(old, new, &mut found),
            None => found.differences.push(difference(new, "it is not in the golden sheet".into())),
        }
    }
    for old in &golden.sections {
        if !now.sections.iter().any(|new| new.title() == old.title()) {
            found.differences.push(difference(old, "the pipeline does not make it any more".into()));
        }
    }
    found
}

fn arithmetic(golden: &GoldenSheet, now: &GoldenSheet) -> Arithmetic {
    match (golden.arithmetic.as_str(), now.arithmetic.as_str()) {
        ("", _) | (_, "") => Arithmetic::Unknown,
        (was, is) if was == is => Arithmetic::Same,
        _ => Arithmetic::Other,
    }
}

fn difference(section: &SheetSection, message: String) -> GoldenDifference {
    GoldenDifference { stage: section.stage.clone(), section: section.title(), message }
}

fn compare_sections(old: &SheetSection, new: &SheetSection, found: &mut Comparison) {
    let before = found.differences.len();
    if old.digest != new.digest {
        found.moves_from.get_or_insert_with(|| new.stage.clone());
    }
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
    let surface = surfaces(old, new, found.arithmetic);
    found.differences.extend(surface.map(|m| difference(old, m)));
    if found.differences.len() == before && old.digest != new.digest {
        found.moved.push(new.title());
    }
}

/// Why the surfaces of two sections differ; `None` within tolerance.
fn surfaces(old: &SheetSection, new: &SheetSection, arithmetic: Arithmetic) -> Option<String> {
    match (&old.surface, &new.surface) {
        (Some(was), Some(is)) => was.apart(is, arithmetic),
        (None, Some(_)) => Some("its surface is not in the golden sheet".into()),
        (Some(_), None) => Some("it has no surface any more".into()),
        (None, None) => None,
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
        assert_eq!(found.moves_from.as_deref(), Some("Mesh"));
        let later = against(&GOLDEN.replace("aa", "a0").replace("= 5 ", "= 6 "));
        assert_eq!((later.first_stage(), later.moves_from.as_deref()), (Some("Place"), Some("Mesh")));
    }

    #[test]
    fn a_missing_artifact_and_nan_are_differences() {
        assert_eq!(
            against("[Mesh panel front]\narea = 10 cm2 +- 1\ndigest = aa\n").first_stage(),
            Some("Place")
        );
        let mut nan = parse(GOLDEN).unwrap();
        nan.sections[1].measures[0].value = f64::NAN;
        assert_eq!(compare(&parse(GOLDEN).unwrap(), &nan).first_stage(), Some("Place"));
    }

    #[test]
    fn bits_are_told_to_be_of_another_program_or_of_another_machine() {
        let here = format!("arithmetic = aa11\n{GOLDEN}");
        let on = |golden: &str, now: &str| compare(&parse(golden).unwrap(), &parse(now).unwrap()).arithmetic;
        assert_eq!(on(&here, &here), Arithmetic::Same);
        assert_eq!(on(&here, &here.replace("aa11", "bb22")), Arithmetic::Other);
        assert_eq!(on(GOLDEN, &here), Arithmetic::Unknown);
    }

    #[test]
    fn what_was_made_by_other_parameters_is_told() {
        let with = |edge: &str| format!("stage Mesh = GridMesher 2 (edge:\"{edge}\")\n{GOLDEN}");
        let on = |golden: &str, now: &str| compare(&parse(golden).unwrap(), &parse(now).unwrap()).changes;
        assert_eq!(on(&with("16 mm"), &with("12 mm")), ["Mesh: edge \"16 mm\" -> \"12 mm\""]);
        assert_eq!(on(&with("16 mm"), &with("16 mm")), [""; 0]);
        assert_eq!(on(GOLDEN, &with("16 mm")), [""; 0]);
    }

    const DRAPE: &str = "[StaticEquilibrium garment]\nsurface = 2 places +- 0.2 mm at 95 %, 1 mm at most; elsewhere 3 mm at 95 %, 20 mm at most\npanel front\n\
                         1 2 10 20 30\n3 4 11 20 30\ndigest = bb\n";

    #[test]
    fn a_surface_that_moves_is_a_difference_of_its_stage() {
        let on = |now: &str| compare(&parse(DRAPE).unwrap(), &parse(now).unwrap());
        assert_eq!(
            on(&DRAPE.replace("10 20 30", "10 20 30.15").replace("bb", "cc")).moved,
            ["StaticEquilibrium garment"]
        );
        let found = on(&DRAPE.replace("11 20 30", "11 20 33"));
        assert_eq!(found.first_stage(), Some("StaticEquilibrium"));
        assert_eq!(
            found.differences[0].message,
            "its surface moved by 3.00 mm at 95 % (tolerance 0.2) and by 3.00 mm at most (tolerance 1): \
             panel \"front\" at (3, 4) mm was at (11.0, 20.0, 30.0) mm, is at (11.0, 20.0, 33.0) mm"
        );
        let bare = "[StaticEquilibrium garment]\ndigest = bb\n";
        let blind = compare(&parse(bare).unwrap(), &parse(DRAPE).unwrap());
        assert_eq!(blind.differences[0].message, "its surface is not in the golden sheet");
        let gone = on(bare);
        assert_eq!(gone.differences[0].message, "it has no surface any more");
    }

    #[test]
    fn every_measure_of_a_sheet_can_fail() {
        let golden = parse(GOLDEN).unwrap();
        for s in 0..golden.sections.len() {
            for m in 0..golden.sections[s].measures.len() {
                let mut now = golden.clone();
                let measure = &mut now.sections[s].measures[m];
                measure.value += 1.01 * measure.tolerance + 1e-5;
                assert_eq!(compare(&golden, &now).first_stage(), Some(golden.sections[s].stage.as_str()));
            }
        }
    }
}
