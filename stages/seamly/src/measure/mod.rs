//! Measurements of a body from a file of SeamlyMe (`smis`, `smms`) or Tape (`vit`, `vst`).
//!
//! A measurement of one person is a number or a formula of others; those of several sizes are
//! graded ([`grading`]). Formulas are worked out when their measurement is needed, so that a fault
//! in one that the pattern does not need is no fault. Cost: linear.

mod grading;
#[cfg(test)]
mod tests;

pub use grading::Grade;

use super::fault::SeamlyFault;
use super::formula::Formula;
use super::source::{attribute, children, says, short, text, tree, words};
use super::unit::LengthUnit;
use grading::Grading;
use std::collections::BTreeMap;

/// Measurements that need each other in a row.
const LONGEST_CHAIN: usize = 100;
/// Elements that a file begins with.
const ROOTS: [&str; 4] = ["vit", "smis", "vst", "smms"];

/// Why a measurement has no value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum UnknownMeasure {
    /// There is none of that name.
    None,
    /// These need each other in a ring.
    Ring(Vec<String>),
    /// Its formula is wrong.
    Wrong { name: String, what: String },
}

/// What a file says of one measurement.
#[derive(Debug, Clone)]
struct MeasureEntry {
    formula: String,
    /// Whether it is a length, which has a unit; angles have none.
    is_length: bool,
    value: Option<f64>,
}

/// The measurements of a file, in the unit of the pattern that they are for.
#[derive(Debug, Clone, Default)]
pub struct MeasurementTable {
    entries: BTreeMap<String, MeasureEntry>,
    /// How many of the pattern's units one of the file is.
    scale: f64,
    /// What is told of the file.
    pub(crate) notes: Vec<String>,
}

impl MeasurementTable {
    /// Reads a file for a pattern in that unit.
    pub fn read(bytes: &[u8], grade: Grade, unit: LengthUnit) -> Result<Self, SeamlyFault> {
        let tree = tree(text(bytes)?)?;
        let root = tree.root_element();
        let tag = root.tag_name().name();
        if !ROOTS.contains(&tag) {
            return Err(SeamlyFault::Root { tag: short(tag), expected: "smis, smms, vit or vst" });
        }
        let measured = children(root, &["body-measurements"]).next();
        let all: Vec<_> = measured.iter().flat_map(|n| children(*n, &["m"])).collect();
        if all.is_empty() && measured.is_none() && root.children().any(|n| n.has_attribute("value")) {
            let version = words(root, "version").unwrap_or_else(|| "0.2".into());
            return Err(SeamlyFault::OldMeasurements { version: short(&version) });
        }
        let own = LengthUnit::of(root)?;
        let kept = grade.kept.map(|v| v.map(|v| v * unit.in_units_of(own)));
        let grade = Grade { kept, ..grade };
        let mut table = MeasurementTable { scale: own.in_units_of(unit), ..MeasurementTable::default() };
        let grading = Grading::of(root, own, grade, &mut table.notes)?;
        let mut left_out = Vec::new();
        for m in all {
            let formula = match &grading {
                Some(grading) => grading.value(m),
                None => attribute(m, "value").map(str::to_owned),
            };
            let Some(name) = attribute(m, "name") else { continue };
            let Some(formula) = formula else {
                // One without a value was not taken, as most are.
                if attribute(m, "base").is_some() {
                    left_out.push(format!("\"{}\"", short(name)));
                }
                continue;
            };
            let is_length = says(m, "specialUnits") != Some(true);
            table.entries.insert(name.to_owned(), MeasureEntry { formula, is_length, value: None });
        }
        if !left_out.is_empty() {
            table.notes.push(format!(
                "measurements whose base or growth is no number are left out: {}",
                left_out.join(", ")
            ));
        }
        for (name, value) in grading.iter().flat_map(Grading::names) {
            let entry = MeasureEntry { formula: value.to_string(), is_length: true, value: None };
            table.entries.entry(name.to_owned()).or_insert(entry);
        }
        Ok(table)
    }

    /// Names that there are.
    pub(crate) fn names(&self) -> impl Iterator<Item = &String> {
        self.entries.keys()
    }

    /// The value of a measurement, in the pattern's unit.
    pub(crate) fn value(&mut self, name: &str) -> Result<f64, UnknownMeasure> {
        let value = self.own(name, &mut Vec::new())?;
        let is_length = self.entries.get(name).is_none_or(|e| e.is_length);
        Ok(if is_length { value * self.scale } else { value })
    }

    /// In the file's unit; `needed` are the measurements that need it, the first first.
    fn own(&mut self, name: &str, needed: &mut Vec<String>) -> Result<f64, UnknownMeasure> {
        let entry = self.entries.get(name).ok_or(UnknownMeasure::None)?;
        if let Some(value) = entry.value {
            return Ok(value);
        }
        let wrong = |what: String| UnknownMeasure::Wrong { name: name.to_owned(), what };
        if let Some(k) = needed.iter().position(|n| n == name) {
            let ring = needed[k..].iter().cloned().chain([name.to_owned()]);
            return Err(UnknownMeasure::Ring(ring.collect()));
        }
        if needed.len() >= LONGEST_CHAIN {
            return Err(wrong(format!("more than {LONGEST_CHAIN} measurements need each other in a row")));
        }
        let text = entry.formula.clone();
        let formula = Formula::parse(&text)
            .map_err(|e| wrong(format!("{} at character {} of \"{}\"", e.what, e.at, short(&text))))?;
        needed.push(name.to_owned());
        let value = formula.value(|other| match self.own(other, needed) {
            Err(UnknownMeasure::None) => {
                Err(wrong(format!("there is no measurement \"{}\" for \"{}\"", short(other), short(&text))))
            }
            found => found,
        });
        needed.pop();
        let value = value?;
        if !value.is_finite() {
            return Err(wrong(format!("\"{}\" has no finite value", short(&text))));
        }
        if let Some(entry) = self.entries.get_mut(name) {
            entry.value = Some(value);
        }
        Ok(value)
    }
}
