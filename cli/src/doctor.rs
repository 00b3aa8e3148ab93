//! `toile doctor`: makes every stage that the program knows, runs it on tiny input and says what fails.

use crate::{Streams, exit};
use serde_json::{Value, json};
use std::time::Instant;
use toile_core::testkit::{Outcome, Trial, cases, folder, from_example};
use toile_core::{Card, Registry};

/// How a stage fared.
enum Health {
    /// It gave something.
    Works,
    /// It refused everything that the suite holds, each time in its own words.
    Refuses(String),
    /// The suite holds nothing that it takes.
    Untried,
    /// It cannot be made, it panics, or what it gives is unsound.
    Fails(String),
}

impl Health {
    fn word(&self) -> &'static str {
        match self {
            Health::Works => "works",
            Health::Refuses(_) => "refuses",
            Health::Untried => "untried",
            Health::Fails(_) => "fails",
        }
    }

    fn reason(&self) -> &str {
        match self {
            Health::Refuses(reason) | Health::Fails(reason) => reason,
            Health::Works => "",
            Health::Untried => "the doctor has no input for it",
        }
    }
}

/// A stage's line in the doctor's list.
struct Finding<'a> {
    card: &'a Card,
    health: Health,
    seconds: f64,
}

/// Examines every stage; exit code 70 where one fails or a plugin was refused.
pub(crate) fn doctor(json: bool, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let mut findings = Vec::new();
    for card in registry.cards() {
        let start = Instant::now();
        let health = examine(registry, card).unwrap_or_else(Health::Fails);
        let finding = Finding { card, health, seconds: start.elapsed().as_secs_f64() };
        if !json {
            streams.say(line(&finding));
        }
        findings.push(finding);
    }
    let failing = findings.iter().filter(|f| matches!(f.health, Health::Fails(_))).count();
    let refused = registry.refused();
    if json {
        let stages: Vec<Value> = findings.iter().map(finding_json).collect();
        let plugins: Vec<Value> =
            refused.iter().map(|r| json!({ "file": r.file, "reason": r.reason })).collect();
        streams.say(json!({ "stages": stages, "failing": failing, "refused_plugins": plugins }));
    } else {
        refused.iter().for_each(|r| streams.say(format!("refused  {}: {}", r.file, r.reason)));
        streams.say(summary(findings.len(), failing, refused.len()));
    }
    if failing + refused.len() > 0 { exit::BUG } else { exit::DONE }
}

/// Runs the stage of a card's example on case after case, until it answers one.
///
/// Errors: what is wrong with it.
fn examine(registry: &Registry, card: &Card) -> Result<Health, String> {
    let (_kept, path) = folder()?;
    let stage = from_example(registry, card, &path)
        .map_err(|e| format!("its example `{}` does not load: {e}", card.example))?;
    let trial = Trial { stage: stage.as_ref(), folder: &path };
    let mut first = None;
    for case in cases(card) {
        match trial.run(&case.inputs) {
            Outcome::Answered(_) => return Ok(Health::Works),
            Outcome::Broken(fault) => return Err(format!("on {}, {fault}", case.name)),
            Outcome::Refused(_, message) => first = first.or(Some(format!("{}: {message}", case.name))),
        }
    }
    Ok(first.map_or(Health::Untried, Health::Refuses))
}

fn line(f: &Finding<'_>) -> String {
    let name = format!("{} ({})", f.card.name, f.card.role.as_str());
    let plugin = f.card.plugin.map_or(String::new(), |p| format!(" of {}", p.name));
    let time = format!("{:.0} ms", f.seconds * 1e3);
    let reason = f.health.reason();
    let reason = if reason.is_empty() { String::new() } else { format!("  {reason}") };
    format!("{:<8} {:<34} {time:>8}{reason}", f.health.word(), name + &plugin)
}

fn summary(stages: usize, failing: usize, refused: usize) -> String {
    let mut words = match failing {
        0 => format!("{stages} stages, none fails"),
        1 => format!("{stages} stages, 1 fails"),
        n => format!("{stages} stages, {n} fail"),
    };
    match refused {
        0 => {}
        1 => words += "; 1 plugin was refused",
        n => words += &format!("; {n} plugins were refused"),
    }
    words
}

fn finding_json(f: &Finding<'_>) -> Value {
    json!({ "name": f.card.name, "role": f.card.role.as_str(), "health": f.health.word(), "reason": f.health.reason(),
        "plugin": f.card.plugin.map(|p| p.name), "seconds": f.seconds })
}
