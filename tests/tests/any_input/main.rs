//! Every built-in stage, given inputs that no one would give it on purpose: it answers or refuses,
//! and never panics, and what it gives is sound.
//!
//! Artifacts of a small, real run of the vest are edited at random. What fails the artifact's own
//! check never reaches a stage in a real run, because the runner names it where it was made; so it
//! does not here.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

mod pool;
mod spoil;

use pool::Pool;
use proptest::prelude::*;
use spoil::Edit;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, LazyLock};
use std::time::Duration;
use toile_core::artifact::{Artifact, Kind};
use toile_core::{Arity, Cancel, Card, Context, ErrorCode, InPort, Inputs, PortValue, Registry, Stage};

/// A solver that finds nothing wrong would go on for seconds: it is stopped after this.
const PATIENCE: Duration = Duration::from_millis(100);
/// Cases a stage; `PROPTEST_CASES=100` looks longer, as `.ci/wide` does.
const CASES: u32 = 8;

/// So many times the cases are drawn for a stage that none of them reached.
const MORE: u32 = 4;

static POOL: LazyLock<Pool> = LazyLock::new(Pool::new);

fn registry() -> &'static Registry {
    static REGISTRY: LazyLock<Registry> = LazyLock::new(toile::registry);
    &REGISTRY
}

/// The stages of all cards that can be made without arguments or by their own example.
fn stages() -> Vec<(&'static Card, Box<dyn Stage>)> {
    let arguments = |card: &Card| card.example.strip_prefix(card.name).unwrap_or("()").to_owned();
    let make = |card: &'static Card| {
        let made = registry().make(card, "()").or_else(|_| registry().make(card, &arguments(card)));
        (card, made.unwrap_or_else(|e| panic!("{} cannot be made from its own example: {e}", card.name)))
    };
    let asked = |card: &&Card| only().is_none_or(|name| name == card.name);
    registry().cards().filter(asked).map(make).collect()
}

/// A value for a port: artifacts of its kind, each with its own share of the edits.
fn value(port: &InPort, edits: &[Edit]) -> Option<PortValue> {
    let made = POOL.of(port.kind);
    let edited = |k: usize, artifact: &Arc<dyn Artifact>| {
        let own: Vec<Edit> = edits.iter().filter(|e| e.entry % 3 != k).copied().collect();
        spoil::artifact(artifact, &own)
    };
    match port.arity {
        Arity::All => {
            let set = made.iter().enumerate().map(|(k, (name, a))| (name.clone(), edited(k, a)));
            Some(PortValue::Set(port.kind, set.collect()))
        }
        _ => made.first().map(|(_, a)| PortValue::One(edited(0, a))),
    }
}

fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(CASES)
}

/// The one stage to try, where `ONLY_STAGE` names it.
fn only() -> Option<String> {
    std::env::var("ONLY_STAGE").ok()
}

fn sound(value: &PortValue) -> bool {
    value.entries().iter().all(|(_, a)| a.check().is_ok())
}

/// Runs a stage on edited inputs, unless they are unsound; says whether it ran, or what is wrong
/// with its answer.
fn trial(card: &Card, stage: &dyn Stage, edits: &[Edit]) -> Result<bool, String> {
    let inputs: Vec<Option<PortValue>> = card.inputs.iter().map(|port| value(port, edits)).collect();
    let missing = inputs.iter().zip(&card.inputs).any(|(v, port)| v.is_none() && !port.optional);
    if missing || !inputs.iter().flatten().all(sound) {
        return Ok(false);
    }
    let (cancel, dir) = (Cancel::new(), toile_tests::root());
    let watched = cancel.clone();
    let (done, waiting) = std::sync::mpsc::channel::<()>();
    let watchdog = std::thread::spawn(move || {
        let _ = waiting.recv_timeout(PATIENCE);
        watched.cancel();
    });
    let cx = Context::new(card.name, &dir, cancel, Arc::new(()));
    let outcome = catch_unwind(AssertUnwindSafe(|| stage.run_ports(&Inputs(inputs), &cx)));
    drop(done);
    let _ = watchdog.join();
    match outcome {
        Err(panic) => Err(format!("it panicked: {:?}", panic.downcast_ref::<String>())),
        Ok(Err(e)) if e.code == ErrorCode::Internal => Err(format!("it calls it its own fault: {e}")),
        Ok(Err(e)) if e.message.is_empty() => Err("it refuses without a word".to_owned()),
        Ok(Err(_)) => Ok(true),
        Ok(Ok(made)) => made.iter().flat_map(PortValue::entries).try_fold(true, |ran, (_, a)| {
            let _ = (a.measures(), a.export());
            a.check().map(|()| ran).map_err(|e| format!("it gave a {} that cannot be: {e}", a.kind()))
        }),
    }
}

#[test]
fn every_stage_answers_or_refuses_whatever_it_is_given() {
    let mut failures = Vec::new();
    for (card, stage) in stages() {
        // With --nocapture this line names the stage that ended the process, should one run out of
        // memory.
        eprintln!("{} ({})", card.name, card.role.as_str());
        let edits = prop::collection::vec(any::<Edit>(), 0..4);
        let edited = Cell::new(0);
        let tried = |cases: u32| {
            let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
            let mut runner = proptest::test_runner::TestRunner::new_with_rng(config, pool::rng(card.name));
            runner.run(&edits, |edits| {
                let ran = trial(card, stage.as_ref(), &edits).map_err(TestCaseError::fail)?;
                edited.set(edited.get() + u32::from(ran && !edits.is_empty()));
                Ok(())
            })
        };
        let mut outcome = tried(cases());
        // Some stages refuse most edited inputs and need more cases.
        if outcome.is_ok() && edited.get() == 0 {
            outcome = tried(cases() * MORE);
        }
        eprintln!("  ran on edited inputs in {} of {} cases or more", edited.get(), cases());
        let reached = edited.get() > 0;
        failures.extend(
            (!reached).then(|| format!("{}: no edited input was sound enough to reach it", card.name)),
        );
        failures.extend(outcome.err().map(|e| format!("{} ({}): {e}", card.name, card.role.as_str())));
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_pool_holds_every_kind_that_a_stage_takes() {
    let kinds = registry().cards().flat_map(|c| &c.inputs).map(|port| port.kind);
    let missing: Vec<Kind> = kinds.filter(|kind| POOL.of(*kind).is_empty()).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
