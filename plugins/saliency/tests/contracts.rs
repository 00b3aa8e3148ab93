//! What the stage promises, with the tiny network: by default it has no file, and refuses.

use crate::kit::{given, tiny};
use toile_core::testkit::{Trial, check};
use toile_core::{Contract, StageType};
use toile_saliency::Saliency;

fn kept(contract: Contract) {
    let (dir, stage) = given(&tiny().file());
    assert!(Saliency::type_card().contracts.contains(&contract));
    let kept = check(Trial { stage: &stage, folder: dir.path() }, Some(&stage), contract).unwrap();
    println!("{contract:?}: {} cases, {} answered", kept.cases, kept.answered);
}

#[test]
fn deterministic() {
    kept(Contract::Deterministic);
}

#[test]
fn thread_invariant() {
    kept(Contract::ThreadInvariant);
}

#[test]
fn refuses_empty() {
    kept(Contract::RefusesEmpty);
}

#[test]
fn cancellable() {
    kept(Contract::Cancellable);
}

#[test]
fn no_contract_is_left_out() {
    assert_eq!(Saliency::type_card().contracts.len(), 4);
}
