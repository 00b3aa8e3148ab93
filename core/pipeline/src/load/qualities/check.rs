//! The settings of every quality, compared with the file that they are in.

use super::{Quality, named};
use crate::load::fault::Fault;
use crate::load::overrides::{self, Given};
use crate::load::{MAX_FAULTS, check};
use std::ops::Range;
use toile_core::Registry;

/// Fields of a file that no quality sets: it would change itself, or what program runs.
const FIXED: [&str; 2] = ["qualities", "plugins"];

/// The faults that each quality's settings bring into the file, at their places in it. Where the
/// file has faults of its own, only those that lie in what is set: a path may lead nowhere because
/// of them.
pub(in crate::load) fn settings(text: &str, registry: &Registry) -> Vec<Fault> {
    let qualities = named(text);
    if qualities.is_empty() {
        return Vec::new();
    }
    let mut own = Vec::new();
    check(text, (registry, false), &mut own);
    let mut faults: Vec<Fault> =
        qualities.iter().flat_map(|q| one(text, registry, q, own.is_empty())).collect();
    faults.truncate(MAX_FAULTS);
    faults
}

fn one(text: &str, registry: &Registry, quality: &Quality, file_is_clean: bool) -> Vec<Fault> {
    let fixed = fixed(quality);
    if !fixed.is_empty() {
        return fixed;
    }
    let given: Vec<Given<'_>> = Given::of_quality(quality).collect();
    let applied = overrides::apply(text, registry, &given);
    let mut found = Vec::new();
    check(&applied.text, (registry, false), &mut found);
    let refused = applied.refused.iter().map(|(i, f)| (Some(*i), f.clone())).filter(|_| file_is_clean);
    let brought = found.into_iter().map(|f| (applied.origin.number(&f), f));
    let brought = brought.filter(|(i, _)| file_is_clean || i.is_some());
    refused.chain(brought).map(|(i, fault)| placed(quality, i, fault)).collect()
}

/// Settings of fields that no quality may set.
fn fixed(quality: &Quality) -> Vec<Fault> {
    let top = |path: &str| path.split('.').next().unwrap_or("").to_owned();
    let pairs = quality.set.iter().map(|o| top(&o.path)).zip(&quality.places);
    let fault = |(field, at): (String, &Range<usize>)| {
        let message = format!("quality `{}`: a quality cannot set `{field}`", quality.name);
        FIXED.contains(&field.as_str()).then(|| Fault::new("bad_override", message).at(at, ""))
    };
    pairs.filter_map(fault).collect()
}

/// A fault of the changed text at the setting that makes it, else at the quality's name.
fn placed(quality: &Quality, setting: Option<usize>, fault: Fault) -> Fault {
    let at = setting.and_then(|i| quality.places.get(i)).unwrap_or(&quality.place);
    let path = setting.and_then(|i| quality.set.get(i)).map(|o| format!(" `{}`:", o.path));
    // A refused path has its name in its own words.
    let path = path.filter(|_| fault.code != "bad_override").unwrap_or_default();
    let message = format!("quality `{}`:{path} {}", quality.name, fault.message);
    Fault::new(fault.code, message).at(at, "").hint(fault.hint)
}
