//! Every built-in stage keeps what it promises, and every example of a card runs.
//!
//! `ONLY_STAGE=Otsu cargo test --release -p toile-tests --test contracts` looks at one stage.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

use std::path::Path;
use std::time::Instant;
use toile_core::testkit::contract::{check_registered, checked, is_checked};
use toile_core::testkit::{Trial, cases, folder, from_example};
use toile_core::{Card, Contract, Registry};

fn registry() -> Registry {
    toile::registry()
}

/// All cards, or those of the one stage that `ONLY_STAGE` names.
fn cards(registry: &Registry) -> Vec<&Card> {
    let only = std::env::var("ONLY_STAGE").ok();
    registry.cards().filter(|c| only.as_ref().is_none_or(|name| name == c.name)).collect()
}

/// Holds every stage to those of its contracts that `wanted` picks; each that is shown as checked
/// is run.
fn hold(wanted: impl Fn(Contract) -> bool) {
    let registry = registry();
    let mut broken = Vec::new();
    for card in cards(&registry) {
        for contract in checked(card).into_iter().filter(|c| wanted(*c)) {
            let start = Instant::now();
            match check_registered(&registry, card, contract) {
                Ok(kept) => eprintln!(
                    "{} ({}) {contract:?}: {} cases, {} answered, {:.1} s",
                    card.name,
                    card.role.as_str(),
                    kept.cases,
                    kept.answered,
                    start.elapsed().as_secs_f64()
                ),
                Err(e) => {
                    eprintln!("BROKEN {e}");
                    broken.push(e);
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn stages_are_deterministic() {
    hold(|c| c == Contract::Deterministic);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    hold(|c| c == Contract::ThreadInvariant);
}

#[test]
fn moved_input_gives_moved_output() {
    use Contract::{RotationEquivariant, ScaleEquivariant, TranslationEquivariant};
    hold(|c| [TranslationEquivariant, RotationEquivariant, ScaleEquivariant].contains(&c));
}

#[test]
fn borders_empty_input_and_second_runs_are_as_promised() {
    hold(|c| [Contract::Idempotent, Contract::BoundaryPreserving, Contract::RefusesEmpty].contains(&c));
}

#[test]
fn stages_stop_when_they_are_asked_to() {
    hold(|c| c == Contract::Cancellable);
}

#[test]
fn every_promise_of_a_built_in_stage_can_be_checked() {
    let registry = registry();
    let unchecked = |card: &Card| {
        let open: Vec<Contract> = card.contracts.iter().copied().filter(|c| !is_checked(card, *c)).collect();
        (!open.is_empty()).then(|| format!("{} ({}): {open:?}", card.name, card.role.as_str()))
    };
    let open: Vec<String> = registry.cards().filter_map(unchecked).collect();
    assert!(open.is_empty(), "{}", open.join("\n"));
}

#[test]
fn every_example_runs() {
    let registry = registry();
    let mut failures = Vec::new();
    for card in cards(&registry) {
        let (_kept, path) = folder().unwrap();
        if let Err(e) = example(&registry, card, &path) {
            failures.push(format!("{} ({}): {e}", card.name, card.role.as_str()));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Runs a card's example on the suite's first case.
fn example(registry: &Registry, card: &Card, path: &Path) -> Result<(), String> {
    let stage = from_example(registry, card, path)?;
    let trial = Trial { stage: stage.as_ref(), folder: path };
    let answered = cases(card).iter().any(|case| trial.run(&case.inputs).answered());
    match answered {
        true => Ok(()),
        false => Err(cases(card).first().map_or("the suite has no case for it".into(), |case| {
            format!("on {}, {}", case.name, trial.run(&case.inputs).fingerprint())
        })),
    }
}

mod broken {
    //! The kit finds what is broken: one stage that breaks every promise it makes.

    use std::sync::atomic::{AtomicU8, Ordering};
    use toile_core::prelude::*;
    use toile_core::testkit::Trial;
    use toile_core::testkit::contract::check;

    /// Breaks its promises.
    #[stage(
        role = Smoother,
        source = "none",
        example = "Liar()",
        contracts(Deterministic, TranslationEquivariant, Idempotent, BoundaryPreserving, RefusesEmpty)
    )]
    pub struct Liar;

    static CALLS: AtomicU8 = AtomicU8::new(0);

    #[stage]
    impl Liar {
        fn run(&self, panel: &Panel, _cx: &Context) -> Result<Panel, StageError> {
            let step = f64::from(CALLS.fetch_add(1, Ordering::Relaxed) % 7) + 1.0;
            let mut out = panel.clone();
            out.positions.iter_mut().for_each(|p| *p *= 1.0 + step * 1e-3);
            Ok(out)
        }
    }

    /// Counts threads, and hears nothing.
    #[stage(
        role = Smoother,
        source = "none",
        example = "Deaf()",
        contracts(ThreadInvariant, Cancellable, RotationEquivariant)
    )]
    pub struct Deaf;

    #[stage]
    impl Deaf {
        fn run(&self, panel: &Panel, _cx: &Context) -> Result<Panel, StageError> {
            let mut out = panel.clone();
            out.positions.iter_mut().for_each(|p| p.x *= 1.0 + 0.1 * rayon::current_num_threads() as f64);
            if panel.positions.len() > 10_000 {
                std::thread::sleep(std::time::Duration::from_millis(900));
            }
            Ok(out)
        }
    }

    fn fault(stage: &dyn toile_core::Stage, contract: Contract) -> String {
        check(Trial { stage, folder: super::Path::new(".") }, None, contract).unwrap_err()
    }

    #[test]
    fn a_stage_that_breaks_its_promises_is_told_so() {
        assert!(fault(&Liar {}, Contract::Deterministic).starts_with("on a vest it gives  panel "));
        assert!(fault(&Liar {}, Contract::TranslationEquivariant).starts_with("on a vest, panel : it is "));
        assert_eq!(
            fault(&Liar {}, Contract::Idempotent),
            "on a vest a second run changes what the first gave"
        );
        assert_eq!(fault(&Liar {}, Contract::BoundaryPreserving), "on a vest, vertex 0 of the border moved");
        assert_eq!(fault(&Liar {}, Contract::RefusesEmpty), "it gives something of an empty panel");
    }

    #[test]
    fn a_stage_that_hears_nothing_is_told_so() {
        let threads = fault(&Deaf {}, Contract::ThreadInvariant);
        assert!(
            threads.starts_with("on a vest it gives  panel ") && threads.contains(" with 1 threads, "),
            "{threads}"
        );
        assert!(fault(&Deaf {}, Contract::RotationEquivariant).starts_with("on a vest, panel : it is "));
        let late = fault(&Deaf {}, Contract::Cancellable);
        assert!(late.ends_with(" ms after it was asked to, 0 ms into its run; 50 ms are allowed"), "{late}");
    }
}
