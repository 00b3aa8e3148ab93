//! The named qualities of a text: error against time, as measured.

use crate::fault::StudioFault;
use crate::live::ask::RunAsk;
use serde_json::{Value, json};
use toile_core::Registry;
use toile_pipeline::{Changes, Standing, load, load_with};

/// What stands before the time in the words of a measurement.
const BEFORE: &str = "; ";
/// What stands behind it.
const BEHIND: &str = " s of processor time";

/// All qualities; `chosen` is the one that full runs have.
///
/// Errors: the faults of the text.
pub(crate) fn trade(ask: &RunAsk, chosen: Option<&str>, registry: &Registry) -> Result<Value, StudioFault> {
    let plain = load(&ask.text, &ask.file, &ask.base, registry, &[])?;
    let mut all = Vec::new();
    for quality in &plain.qualities {
        let changes = Changes { quality: Some(&quality.name), ..Changes::default() };
        let pipeline = load_with(&ask.text, &ask.file, &ask.base, registry, &changes)?;
        all.push(json!({
            "name": quality.name,
            "max_error": quality.max_error.to_string(),
            "measured": quality.measured,
            "seconds": quality.measured.as_deref().and_then(seconds),
            "stands": quality.standing(&pipeline) == Standing::Holds,
            "chosen": chosen == Some(quality.name.as_str()),
        }));
    }
    Ok(json!({ "qualities": all }))
}

/// The seconds that a measurement names.
fn seconds(words: &str) -> Option<f64> {
    let before = words.split(BEHIND).next().filter(|before| before.len() < words.len())?;
    before.rsplit(BEFORE).next()?.parse().ok()
}
