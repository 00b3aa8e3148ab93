//! Named qualities of a pipeline, measured: for each error the quickest setting of the front that
//! is proved to keep it.
//!
//! One measurement serves all of them. A quality says what its proof found: the worst of a fresh
//! run and of moved starts, the processor time of the fresh run, and the day.

#[cfg(test)]
mod tests;

use crate::record::{Clock, Machine};
use crate::tune::{Prover, SettingProof, Wish, overrides, refusal};
use std::str::FromStr;
use toile_core::{ErrorCode, Length, StageError};
use toile_pipeline::{Basis, Quality, fill_qualities, load, without_qualities};

/// A quality that is asked for: `Draft=10 mm`.
#[derive(Debug, Clone, PartialEq)]
pub struct AskedQuality {
    /// Its name.
    pub name: String,
    /// The error that it keeps.
    pub max_error: Length,
}

impl FromStr for AskedQuality {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let no_quality = || format!("`{text}` is no quality; write NAME=LENGTH, like `Draft=10 mm`");
        let (name, length) = text.split_once('=').ok_or_else(no_quality)?;
        if !Quality::is_name(name.trim()) {
            return Err(no_quality());
        }
        let max_error: Length = length.trim().parse()?;
        match max_error.metres() > 0.0 {
            true => Ok(AskedQuality { name: name.trim().to_owned(), max_error }),
            false => Err(format!("`{}` is not above zero", length.trim())),
        }
    }
}

impl AskedQuality {
    /// What is asked of its setting.
    pub fn wish(&self) -> Wish {
        Wish { max_error_mm: Some(millimetres(self.max_error)), max_time_s: None }
    }
}

/// Without the digits that a change of unit leaves behind.
fn millimetres(length: Length) -> f64 {
    (length.metres() * 1e12).round() / 1e9
}

/// What came of the qualities that were asked for.
#[derive(Debug, Default)]
pub struct Proved {
    /// Those that are kept, with their proofs.
    pub kept: Vec<(AskedQuality, SettingProof)>,
    /// Those that no setting keeps, with the reason.
    pub refused: Vec<(AskedQuality, StageError)>,
}

/// Proves a setting for each of the qualities, in their order.
///
/// Errors: the reference does not run; stopped by the user.
pub fn prove(
    prover: &Prover<'_>,
    asked: &[AskedQuality],
    tell: &mut dyn FnMut(String),
) -> Result<Proved, StageError> {
    let mut proved = Proved::default();
    let mut open = Vec::new();
    for asked in asked {
        match refusal(prover.trade, &asked.wish()) {
            Some(why) => proved.refused.push((asked.clone(), why)),
            None => open.push(asked),
        }
    }
    if open.is_empty() {
        return Ok(proved);
    }
    let (reference, mut known) = (prover.reference()?, Vec::new());
    for asked in open {
        tell(format!("quality {}: {}", asked.name, asked.wish().words()));
        match prover.prove_against(&asked.wish(), &reference, &mut known, tell) {
            Ok(proof) => proved.kept.push((asked.clone(), proof)),
            Err(e) if e.code == ErrorCode::StaticEquilibrium => proved.refused.push((asked.clone(), e)),
            Err(e) => return Err(e),
        }
    }
    Ok(proved)
}

/// The pipeline file with the proved qualities in its field, comments and order kept. Qualities
/// that are there already stay, but where `--set` changes the file that they were measured on.
///
/// Errors: the settings do not fit the file any more.
pub fn written(
    prover: &Prover<'_>,
    kept: &[(AskedQuality, SettingProof)],
    date: &str,
) -> Result<String, StageError> {
    let source = prover.source;
    let invalid = |words: String| StageError::invalid(words);
    let base = source.load(&[]).map_err(|f| invalid(f.to_string()))?.text;
    let is_same = source.set.is_empty() && source.quality.is_none();
    let base = if is_same { base } else { without_qualities(&base).map_err(|f| invalid(f.message))? };
    let one = |(asked, proof): &(AskedQuality, SettingProof)| {
        let quality = quality(prover, asked, proof, date);
        let measured_on = load(&base, &source.file, &source.base, source.registry, &quality.set);
        let measured_on = measured_on.map_err(|f| invalid(f.to_string()))?;
        Ok(quality.measured_for(Basis::of(&measured_on)))
    };
    let qualities = kept.iter().map(one).collect::<Result<Vec<_>, StageError>>()?;
    let text = fill_qualities(&base, &qualities).map_err(|f| invalid(f.message))?;
    load(&text, &source.file, &source.base, source.registry, &[]).map_err(|f| invalid(f.to_string()))?;
    Ok(text)
}

fn quality(prover: &Prover<'_>, asked: &AskedQuality, proof: &SettingProof, date: &str) -> Quality {
    let set = overrides(&prover.trade.points[proof.point].overrides);
    let floor = prover.trade.reference.floor_mm();
    let measured = words(proof, floor, env!("CARGO_PKG_VERSION"), &Machine::here(), date);
    Quality::new(asked.name.clone(), asked.max_error, set, Some(measured))
}

/// What a proof found, in a line.
fn words(proof: &SettingProof, floor: Option<f64>, toile: &str, machine: &Machine, date: &str) -> String {
    let starts = match proof.starts.len() {
        0 => "a fresh run".to_owned(),
        n => format!("the worst of a fresh run and {n} moved starts"),
    };
    let known = floor.map_or_else(String::new, |f| format!(" (itself known to {f:.2} mm)"));
    format!(
        "{date}: 95 % of the surface within {:.2} mm of the reference{known}, {starts}; {:.2} s of processor time (toile {toile}, {}, {} cores)",
        proof.worst_mm(),
        proof.fresh.time(Clock::Cpu),
        machine.system,
        machine.cores
    )
}
