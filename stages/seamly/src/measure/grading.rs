//! Measurements of several sizes: how a base value grows with the size and the height.
//!
//! Method: the value is that of the base, and a growth for every step from it. SeamlyMe and the
//! older Tape know size and height, with steps of 2 and 6 cm; the newer Tape has up to three
//! dimensions, each with its base, its step and its bounds.

use super::super::fault::SeamlyFault;
use super::super::source::{attribute, children};
use super::super::unit::LengthUnit;
use roxmltree::Node;

/// The size that is asked for, in the unit of the measurements.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Grade {
    /// The size, half the girth of the bust in most tables; none for the file's own.
    pub size: Option<f64>,
    /// The height of the body; none for the file's own.
    pub height: Option<f64>,
    /// The size and the height that the pattern was left at, in its own unit; they are taken where
    /// none is asked for and the measurements have them.
    pub kept: [Option<f64>; 2],
}

/// A direction in which measurements grow.
#[derive(Debug, Clone)]
struct Dimension {
    /// As `Grade` and formulas call it.
    name: &'static str,
    /// The attribute that says the growth by a step.
    growth: &'static str,
    base: f64,
    step: f64,
    least: f64,
    most: f64,
    chosen: f64,
}

/// How the measurements of a file grow.
#[derive(Debug, Clone)]
pub(super) struct Grading(Vec<Dimension>);

fn figure(node: Node<'_, '_>, name: &str) -> Option<f64> {
    attribute(node, name)?.parse::<f64>().ok().filter(|v| v.is_finite())
}

impl Grading {
    /// None where the file is of one size.
    pub(super) fn of(
        root: Node<'_, '_>,
        unit: LengthUnit,
        asked: Grade,
        notes: &mut Vec<String>,
    ) -> Result<Option<Self>, SeamlyFault> {
        let mut all = dimensions(root);
        if all.is_empty() {
            all = size_and_height(root, unit);
        }
        for (what, value) in [("size", asked.size), ("height", asked.height)] {
            let Some(value) = value else { continue };
            let Some(found) = all.iter_mut().find(|d| d.name == what) else {
                return Err(SeamlyFault::OneSize { what });
            };
            if !(found.least..=found.most).contains(&value) {
                let (least, most) = (found.least, found.most);
                return Err(SeamlyFault::Size { what, asked: value, least, most });
            }
            found.chosen = value;
        }
        for (what, kept, own) in
            [("size", asked.kept[0], asked.size), ("height", asked.kept[1], asked.height)]
        {
            let found = all.iter_mut().find(|d| d.name == what);
            if let (Some(found), Some(kept), None) = (found, kept, own)
                && (found.least..=found.most).contains(&kept)
            {
                found.chosen = kept;
            }
        }
        if all.is_empty() {
            return Ok(None);
        }
        let told: Vec<String> = all.iter().map(|d| format!("{} {}", d.name, d.chosen)).collect();
        notes.push(format!("the measurements are those of {}", told.join(", ")));
        Ok(Some(Grading(all)))
    }

    /// The value of a measurement, as a formula; none where its base or its growth is no number.
    pub(super) fn value(&self, m: Node<'_, '_>) -> Option<String> {
        let mut value = figure(m, "base")?;
        for d in self.0.iter().filter(|d| d.step > 0.0 && attribute(m, d.growth).is_some()) {
            value += (d.chosen - d.base) / d.step * figure(m, d.growth)?;
        }
        Some(format!("{}", value + self.correction(m)))
    }

    /// What is added for the size itself.
    fn correction(&self, m: Node<'_, '_>) -> f64 {
        let here: Vec<f64> = self.0.iter().map(|d| d.chosen).collect();
        let is_here = |n: &Node<'_, '_>| {
            let at = attribute(*n, "coordinates").unwrap_or("");
            let at: Vec<f64> = at.split(';').filter_map(|v| v.trim().parse().ok()).collect();
            at.len() >= here.len() && at.iter().zip(&here).all(|(a, b)| (a - b).abs() < 1e-9)
        };
        let listed = children(m, &["corrections"]).flat_map(|n| children(n, &["correction"]));
        listed.filter(is_here).filter_map(|n| figure(n, "correction")).sum()
    }

    /// The dimensions as variables.
    pub(super) fn names(&self) -> impl Iterator<Item = (&'static str, f64)> {
        self.0.iter().map(|d| (d.name, d.chosen))
    }
}

/// The dimensions of a newer file.
fn dimensions(root: Node<'_, '_>) -> Vec<Dimension> {
    let mut all = Vec::new();
    let listed = children(root, &["dimensions"]).flat_map(|n| children(n, &["dimension"]));
    for (node, growth) in listed.zip(["shiftA", "shiftB", "shiftC"]) {
        let name = match attribute(node, "type") {
            Some("x") => "height",
            Some("y") => "size",
            Some("w") => "waist",
            _ => "hip",
        };
        let base = figure(node, "base").unwrap_or(0.0);
        let least = figure(node, "min").unwrap_or(base);
        let most = figure(node, "max").unwrap_or(base).max(least);
        let step = figure(node, "step").unwrap_or(0.0);
        all.push(Dimension { name, growth, base, step, least, most, chosen: base });
    }
    all
}

/// Size and height of SeamlyMe and of the older Tape.
fn size_and_height(root: Node<'_, '_>, unit: LengthUnit) -> Vec<Dimension> {
    let cm = LengthUnit::Centimetre.in_units_of(unit);
    let one = |tag: &'static [&'static str], growth, step: f64, [least, most]: [f64; 2]| {
        let base = children(root, tag).next().and_then(|n| figure(n, "base"))?;
        let (step, least, most) = (step * cm, (least * cm).min(base), (most * cm).max(base));
        Some(Dimension { name: tag[0], growth, base, step, least, most, chosen: base })
    };
    let size = one(&["size"], "size_increase", 2.0, [22.0, 72.0]);
    let height = one(&["height"], "height_increase", 6.0, [50.0, 200.0]);
    size.into_iter().chain(height).collect()
}
