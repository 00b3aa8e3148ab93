//! The values that formulas name: measurements, increments, lengths and angles of the draft.
//!
//! Method: an increment is worked out when it is first needed, so that one may name what is drawn
//! before its first use. Lengths and angles between points are those of any two that are drawn.
//! Every fault is kept once; who needs what failed gets its number. Cost: a name is looked up in
//! logarithmic time.

use super::super::fault::{SeamlyFault, ToolPlace};
use super::super::formula::Formula;
use super::super::measure::{MeasurementTable, UnknownMeasure};
use super::super::plane::angle;
use super::super::source::short;
use kurbo::Point;
use std::collections::BTreeMap;

/// Increments that need each other in a row.
const LONGEST_CHAIN: usize = 100;
/// Names that are kept to find the one that may be meant.
const MOST_KNOWN: usize = 400;

/// What failed, by the number of the fault that is its cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Failed(pub(crate) usize);

/// An increment, and its value once it is known.
#[derive(Debug)]
struct Increment {
    formula: String,
    place: ToolPlace,
    value: Option<Result<f64, Failed>>,
}

/// A formula of a tool, for messages.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a> {
    pub(crate) place: &'a ToolPlace,
    pub(crate) attribute: &'a str,
    pub(crate) formula: &'a str,
}

/// All values, and the faults that were met.
#[derive(Debug, Default)]
pub(crate) struct DraftValues {
    measurements: Option<MeasurementTable>,
    increments: BTreeMap<String, Increment>,
    /// Lengths and angles of curves.
    curves: BTreeMap<String, f64>,
    points: BTreeMap<String, Point>,
    /// The length of what is cut just now.
    pub(crate) current: Option<f64>,
    /// Points and names that there would be if nothing had failed.
    failed: BTreeMap<String, Failed>,
    pub(crate) faults: Vec<SeamlyFault>,
}

impl DraftValues {
    /// Those of a body.
    pub(crate) fn of(measurements: Option<MeasurementTable>) -> Self {
        DraftValues { measurements, ..DraftValues::default() }
    }

    /// Keeps a fault.
    pub(crate) fn fail(&mut self, fault: SeamlyFault) -> Failed {
        self.faults.push(fault);
        Failed(self.faults.len() - 1)
    }

    /// An increment; the first of a name counts.
    pub(crate) fn increment(&mut self, name: &str, formula: &str, place: ToolPlace) {
        let one = Increment { formula: formula.to_owned(), place, value: None };
        self.increments.entry(name.to_owned()).or_insert(one);
    }

    /// A length or an angle of a curve.
    pub(crate) fn set(&mut self, name: String, value: f64) {
        self.curves.insert(name, value);
    }

    /// A point that is drawn.
    pub(crate) fn set_point(&mut self, name: &str, at: Point) {
        if !name.is_empty() {
            self.points.insert(name.to_owned(), at);
        }
    }

    /// The name of the point that lies there, if there is one.
    pub(crate) fn point_at(&self, at: Point, near: f64) -> Option<&str> {
        let far = |p: &Point| (*p - at).hypot();
        let all = self.points.iter().filter(|(_, p)| far(p) <= near);
        all.min_by(|a, b| far(a.1).total_cmp(&far(b.1))).map(|(name, _)| name.as_str())
    }

    /// A point or a curve that could not be drawn.
    pub(crate) fn lose(&mut self, name: &str, why: Failed) {
        if !name.is_empty() {
            self.failed.entry(name.to_owned()).or_insert(why);
        }
    }

    /// The value of a formula.
    pub(crate) fn value(&mut self, asked: Asked<'_>) -> Result<f64, Failed> {
        self.worked_out(asked, &mut Vec::new())
    }

    fn worked_out(&mut self, asked: Asked<'_>, needed: &mut Vec<String>) -> Result<f64, Failed> {
        let (place, attribute, text) = (asked.place, asked.attribute, asked.formula);
        let formula = Formula::parse(text).map_err(|e| {
            self.fail(SeamlyFault::Formula {
                place: place.clone(),
                attribute: attribute.to_owned(),
                formula: short(text),
                at: e.at,
                what: e.what,
            })
        })?;
        let value = formula.value(|name| self.named(name, asked, needed))?;
        if value.is_finite() {
            return Ok(value);
        }
        let (place, attribute) = (place.clone(), attribute.to_owned());
        Err(self.fail(SeamlyFault::Infinite { place, attribute, formula: short(text) }))
    }

    fn named(&mut self, name: &str, asked: Asked<'_>, needed: &mut Vec<String>) -> Result<f64, Failed> {
        if let Some(value) = self.drawn(name) {
            return Ok(value);
        }
        if self.increments.contains_key(name) {
            return self.of_increment(name, asked, needed);
        }
        if let Some(why) = self.lost(name) {
            return Err(why);
        }
        let measured = self.measurements.as_mut().map(|m| m.value(name));
        let fault = match measured {
            Some(Ok(value)) => return Ok(value),
            Some(Err(UnknownMeasure::Ring(names))) => {
                SeamlyFault::Cycle { place: asked.place.clone(), names }
            }
            Some(Err(UnknownMeasure::Wrong { name, what })) => {
                SeamlyFault::Measurement { place: asked.place.clone(), name, what }
            }
            Some(Err(UnknownMeasure::None)) | None => self.unknown(name, asked),
        };
        let why = self.fail(fault);
        self.lose(name, why);
        Err(why)
    }

    /// The value of an increment, worked out at its first use.
    fn of_increment(
        &mut self,
        name: &str,
        asked: Asked<'_>,
        needed: &mut Vec<String>,
    ) -> Result<f64, Failed> {
        let Some(increment) = self.increments.get(name) else { return Ok(0.0) };
        if let Some(value) = increment.value {
            return value;
        }
        let from = needed.iter().position(|n| n == name);
        if from.is_some() || needed.len() >= LONGEST_CHAIN {
            let names = needed[from.unwrap_or(0)..].iter().cloned().chain([name.to_owned()]).collect();
            return Err(self.fail(SeamlyFault::Cycle { place: asked.place.clone(), names }));
        }
        let (formula, place) = (increment.formula.clone(), increment.place.clone());
        needed.push(name.to_owned());
        let own = Asked { place: &place, attribute: "formula", formula: &formula };
        let value = self.worked_out(own, needed);
        needed.pop();
        if let Some(increment) = self.increments.get_mut(name) {
            increment.value = Some(value);
        }
        value
    }

    /// What is drawn: curves, and lengths and angles between points.
    fn drawn(&self, name: &str) -> Option<f64> {
        if name == "CurrentLength" {
            return self.current;
        }
        if let Some(value) = self.curves.get(name) {
            return Some(*value);
        }
        if let Some([a, b]) = name.strip_prefix("Line_").and_then(|both| self.pair(both)) {
            return Some((b - a).hypot());
        }
        let [a, b] = name.strip_prefix("AngleLine_").and_then(|both| self.pair(both))?;
        Some(angle(b - a))
    }

    /// The two points of a line; their own names may have an underscore.
    fn pair(&self, both: &str) -> Option<[Point; 2]> {
        both.match_indices('_')
            .find_map(|(k, _)| Some([*self.points.get(&both[..k])?, *self.points.get(&both[k + 1..])?]))
    }

    /// Why there is none of that name, where something failed that it is made of.
    fn lost(&self, name: &str) -> Option<Failed> {
        let whole = self.failed.get(name);
        let parts = || name.split('_').filter_map(|part| self.failed.get(part)).next();
        whole.or_else(parts).copied()
    }

    fn unknown(&self, name: &str, asked: Asked<'_>) -> SeamlyFault {
        let what = kind(name);
        let known: Vec<String> = match what {
            "increment" => self.increments.keys().take(MOST_KNOWN).cloned().collect(),
            "measurement" => {
                self.measurements.iter().flat_map(MeasurementTable::names).take(MOST_KNOWN).cloned().collect()
            }
            _ => self.curves.keys().take(MOST_KNOWN).cloned().collect(),
        };
        SeamlyFault::Unknown {
            place: asked.place.clone(),
            attribute: asked.attribute.to_owned(),
            formula: short(asked.formula),
            what,
            name: short(name),
            measured: self.measurements.is_some(),
            known,
        }
    }
}

/// What a name is for by how it begins.
fn kind(name: &str) -> &'static str {
    const LENGTHS: [&str; 8] =
        ["Line_", "Spl_", "SplPath_", "Arc_", "ElArc_", "C1Length", "C2Length", "CurrentLength"];
    const ANGLES: [&str; 4] = ["AngleLine_", "Angle1", "Angle2", "RotationElArc_"];
    let begins = |all: &[&str]| all.iter().any(|start| name.starts_with(start));
    match name {
        n if n.starts_with('#') => "increment",
        _ if begins(&LENGTHS) => "length",
        _ if begins(&ANGLES) => "angle",
        n if n.starts_with("Radius") => "radius",
        _ => "measurement",
    }
}
