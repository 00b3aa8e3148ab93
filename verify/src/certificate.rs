//! What is written: `certificate.json`, and its words for people.

use crate::compare::GarmentDifference;
use crate::judge::{FigureCheck, Judgement, Verdict, coordinates};
use crate::rest::RestFigures;
use crate::seams::SeamGap;
use crate::strain::PanelStrain;
use serde::Serialize;
use std::collections::BTreeMap;
use toile_core::artifact::{Digest, GirthFigures, Point3};

/// The version of the schema.
const VERSION: u32 = 2;

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputFile {
    /// What it was read as: `garment`, `body`, `pattern`, `seams`, `flat` or `compared`.
    pub role: &'static str,
    /// Its path as it was named.
    pub file: String,
    /// BLAKE3 of its bytes.
    pub digest: Digest,
    /// Its length.
    pub bytes: usize,
}

impl InputFile {
    /// Of a file's bytes.
    #[must_use]
    pub fn of(role: &'static str, file: &str, bytes: &[u8]) -> Self {
        Self { role, file: file.to_owned(), digest: Digest::of(bytes), bytes: bytes.len() }
    }
}

/// What is written of a garment.
#[derive(Debug, Clone, Serialize)]
pub struct Certificate {
    certificate: u32,
    /// `holds` or `fails`.
    pub verdict: Verdict,
    inputs: Vec<InputFile>,
    vertices: usize,
    triangles: usize,
    /// The checks.
    pub checks: Vec<FigureCheck>,
    panels: BTreeMap<String, PanelStrain>,
    seams: Vec<SeamGap>,
    unmeasured_seams: BTreeMap<String, String>,
    girths: BTreeMap<String, GirthFigures>,
    #[serde(skip_serializing_if = "Option::is_none")]
    girths_not_judged: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rest: Option<RestFigures>,
    #[serde(skip_serializing_if = "Option::is_none")]
    compared: Option<Compared>,
    notes: Vec<String>,
}

/// The second garment.
#[derive(Debug, Clone, Serialize)]
pub struct Compared {
    /// `holds` or `fails`, by its own checks.
    pub verdict: Verdict,
    /// Its checks.
    pub checks: Vec<FigureCheck>,
    /// Between the two.
    pub difference: GarmentDifference,
}

impl Certificate {
    /// The verdict of a judgement; a second garment that is compared must hold as well.
    #[must_use]
    pub fn new(
        inputs: Vec<InputFile>,
        found: Judgement,
        compared: Option<Compared>,
        notes: Vec<String>,
    ) -> Self {
        let verdict = verdict(&found, compared.as_ref());
        Self {
            certificate: VERSION,
            verdict,
            inputs,
            vertices: found.vertices,
            triangles: found.triangles,
            checks: found.checks,
            panels: found.panels,
            seams: found.gaps.seams,
            unmeasured_seams: found.gaps.unmeasured.into_iter().collect(),
            girths: found.girths,
            girths_not_judged: found.no_girths,
            rest: found.rest,
            compared,
            notes,
        }
    }

    /// Whether everything holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.verdict == Verdict::Holds
    }

    /// A line for each check, the girths and the difference, and one for the whole.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let mut lines: Vec<String> = self.checks.iter().map(line).collect();
        for (level, g) in &self.girths {
            let [cloth, body, ease] = [g.cloth_m, g.body_m, g.cloth_m - g.body_m].map(|m| m * 100.0);
            lines.push(format!(
                "told        {level}: {cloth:.1} cm of cloth around {body:.1} cm, ease {ease:.1} cm"
            ));
        }
        if let Some(why) = &self.girths_not_judged {
            lines.push(format!("not judged  ease: {why}"));
        }
        for (name, why) in &self.unmeasured_seams {
            lines.push(format!("not judged  seam \"{name}\": {why}"));
        }
        if let Some(compared) = &self.compared {
            lines.extend(compared.words());
        }
        let count = |v: Verdict| self.checks.iter().filter(|c| c.verdict == v).count();
        lines.push(format!(
            "{}: {} triangles, {} checks hold, {} fail, {} are not judged",
            if self.holds() { "holds" } else { "fails" },
            self.triangles,
            count(Verdict::Holds),
            count(Verdict::Fails),
            count(Verdict::NotJudged)
        ));
        lines
    }
}

fn verdict(found: &Judgement, compared: Option<&Compared>) -> Verdict {
    match found.holds() && compared.is_none_or(|c| c.verdict == Verdict::Holds) {
        true => Verdict::Holds,
        false => Verdict::Fails,
    }
}

impl Compared {
    /// Of the second garment's judgement.
    #[must_use]
    pub fn new(found: Judgement, difference: GarmentDifference) -> Self {
        Self { verdict: verdict(&found, None), checks: found.checks, difference }
    }

    fn words(&self) -> Vec<String> {
        let failing = self.checks.iter().filter(|c| c.verdict == Verdict::Fails);
        let mut lines: Vec<String> = failing.map(|c| format!("{} (compared)", line(c))).collect();
        let only = |names: &[String], which: &str| {
            names
                .iter()
                .map(|n| format!("told        panel \"{n}\" is in the {which} garment alone"))
                .collect::<Vec<_>>()
        };
        lines.extend(only(&self.difference.only_first, "first"));
        lines.extend(only(&self.difference.only_second, "second"));
        if let Some((name, d)) = self.difference.worst() {
            lines.push(format!(
                "told        difference: up to {} in panel \"{name}\" at {}",
                millimetres(d.max_m),
                coordinates(&Point3::from(d.at))
            ));
        }
        lines
    }
}

fn millimetres(m: f64) -> String {
    format!("{:.3} mm", m * 1e3)
}

fn line(c: &FigureCheck) -> String {
    let shown = |value: f64| match c.unit {
        "m" => millimetres(value),
        "1" => format!("{:.2} %", value * 1e2),
        unit => format!("{value} {unit}"),
    };
    let (word, figure) = match c.verdict {
        Verdict::NotJudged => return format!("not judged  {}: {}", c.name, c.words),
        Verdict::Holds => ("holds", c.value.map_or(String::new(), shown)),
        Verdict::Fails => ("fails", c.value.map_or(String::new(), shown)),
    };
    let place = if c.words.is_empty() { String::new() } else { format!("; {}", c.words) };
    format!("{word:<11} {}: {figure}, the limit is {}{place}", c.name, shown(c.limit))
}
