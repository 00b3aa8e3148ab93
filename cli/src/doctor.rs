//! `toile doctor`: makes every stage that the program knows, runs it on tiny input and says what
//! fails; with `--contracts` it holds them to what they promise as well.

use crate::args::DoctorArgs;
use crate::contracts::Contracts;
use crate::{Streams, cache, exit};
use serde_json::{Value, json};
use std::time::Instant;
use toile_core::testkit::contract::check_registered;
use toile_core::testkit::{Trial, TrialOutcome, cases, folder, from_example, is_checked};
use toile_core::{Card, Contract, Registry};

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

/// What came of a contract.
enum ContractFinding {
    /// It was kept in so many cases.
    Kept(usize),
    /// It was broken.
    Broken(String),
    /// The suite cannot tell.
    Untried,
}

impl ContractFinding {
    fn word(&self) -> &'static str {
        match self {
            ContractFinding::Kept(_) => "kept",
            ContractFinding::Broken(_) => "broken",
            ContractFinding::Untried => "untried",
        }
    }

    fn reason(&self) -> String {
        match self {
            ContractFinding::Kept(cases) => format!("{cases} cases answered"),
            ContractFinding::Broken(why) => why.clone(),
            ContractFinding::Untried => "the suite cannot tell for what it takes and gives".into(),
        }
    }
}

/// A stage's line in the doctor's list.
struct Finding<'a> {
    card: &'a Card,
    health: Health,
    seconds: f64,
    contracts: Vec<(Contract, ContractFinding)>,
}

impl Finding<'_> {
    fn fails(&self) -> bool {
        matches!(self.health, Health::Fails(_))
    }

    fn broken(&self) -> usize {
        self.contracts.iter().filter(|(_, f)| matches!(f, ContractFinding::Broken(_))).count()
    }
}

/// Examines stages; exit code 70 where one fails or breaks a contract, or a plugin was refused.
pub(crate) fn doctor(args: &DoctorArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    if let Some(unknown) = args.stages.iter().find(|name| registry.named(name).next().is_none()) {
        let near = toile_core::nearest(unknown, registry.cards().map(|c| c.name));
        let hint =
            near.map_or_else(|| "; `toile stages` lists them".into(), |n| format!("; did you mean `{n}`?"));
        return streams.refuse(args.json, format!("there is no stage `{unknown}`{hint}"));
    }
    let asked = |c: &&Card| args.stages.is_empty() || args.stages.iter().any(|name| name == c.name);
    let mut findings = Vec::new();
    for card in registry.cards().filter(asked) {
        let start = Instant::now();
        let health = examine(registry, card).unwrap_or_else(Health::Fails);
        let seconds = start.elapsed().as_secs_f64();
        let mut finding = Finding { card, health, seconds, contracts: Vec::new() };
        if !args.json {
            streams.say(line(&finding));
        }
        if args.contracts {
            finding.contracts = held(registry, card);
        }
        if !args.json {
            finding.contracts.iter().for_each(|c| streams.say(contract_line(c)));
        }
        findings.push(finding);
    }
    keep(args, &findings, streams);
    let failing = findings.iter().filter(|f| f.fails()).count();
    let broken: usize = findings.iter().map(Finding::broken).sum();
    let refused = registry.refused();
    if args.json {
        let stages: Vec<Value> = findings.iter().map(finding_json).collect();
        let plugins: Vec<Value> =
            refused.iter().map(|r| json!({ "file": r.file, "reason": r.reason })).collect();
        streams.say(json!({ "stages": stages, "failing": failing, "refused_plugins": plugins }));
    } else {
        refused.iter().for_each(|r| streams.say(format!("refused  {}: {}", r.file, r.reason)));
        streams.say(summary(findings.len(), failing, refused.len()) + &contract_summary(args, &findings));
    }
    if failing + broken + refused.len() > 0 { exit::BUG } else { exit::DONE }
}

/// Holds a stage to each of its contracts.
fn held(registry: &Registry, card: &Card) -> Vec<(Contract, ContractFinding)> {
    let found = |contract: Contract| match is_checked(card, contract) {
        false => ContractFinding::Untried,
        true => check_registered(registry, card, contract)
            .map_or_else(ContractFinding::Broken, |kept| ContractFinding::Kept(kept.answered)),
    };
    card.contracts.iter().map(|c| (*c, found(*c))).collect()
}

/// Keeps what was found of plugins for `toile stage`.
fn keep(args: &DoctorArgs, findings: &[Finding<'_>], streams: &mut Streams<'_>) {
    if findings.iter().all(|f| f.contracts.is_empty()) {
        return;
    }
    let mut known = Contracts::open(cache::at(args.cache_dir.clone()).map(|c| c.folder().to_owned()));
    for finding in findings {
        for (contract, found) in &finding.contracts {
            match found {
                ContractFinding::Kept(_) => known.note(finding.card, *contract, true),
                ContractFinding::Broken(_) => known.note(finding.card, *contract, false),
                ContractFinding::Untried => {}
            }
        }
    }
    if let Err(e) = known.keep() {
        streams.tell(format!("warning: what was found of contracts is not kept: {e}"));
    }
}

fn contract_line((contract, found): &(Contract, ContractFinding)) -> String {
    format!("    {:<24} {:<8} {}", format!("{contract:?}"), found.word(), found.reason())
}

/// `; 12 contracts kept, 1 broken, 2 untried`; empty where they were not asked for.
fn contract_summary(args: &DoctorArgs, findings: &[Finding<'_>]) -> String {
    let count =
        |word: &str| findings.iter().flat_map(|f| &f.contracts).filter(|(_, f)| f.word() == word).count();
    match args.contracts {
        true => format!(
            "; contracts: {} kept, {} broken, {} untried",
            count("kept"),
            count("broken"),
            count("untried")
        ),
        false => String::new(),
    }
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
            TrialOutcome::Answered(_) => return Ok(Health::Works),
            TrialOutcome::Broken(fault) => return Err(format!("on {}, {fault}", case.name)),
            TrialOutcome::Refused(_, message) => first = first.or(Some(format!("{}: {message}", case.name))),
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
    let contract = |(c, found): &(Contract, ContractFinding)| json!({ "name": format!("{c:?}"), "found": found.word(), "reason": found.reason() });
    let contracts: Vec<Value> = f.contracts.iter().map(contract).collect();
    json!({ "contracts": contracts, "name": f.card.name, "role": f.card.role.as_str(), "health": f.health.word(), "reason": f.health.reason(),
        "plugin": f.card.plugin.map(|p| p.name), "seconds": f.seconds })
}
