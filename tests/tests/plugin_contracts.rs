//! The crates of plugins/, loaded as libraries: each stage keeps across the plugin border what it promises.
#![allow(clippy::unwrap_used)]

use toile_core::Registry;
use toile_core::testkit::contract::{check_registered, checked};
use toile_tests::plugins::library;

#[test]
fn what_is_loaded_keeps_its_promises() {
    for (name, stage) in [
        ("toile_guided", "Guided"),
        ("toile_ironed", "Ironed"),
        ("toile_lattice", "LatticeMesher"),
        ("toile_sdf", "SdfCollider"),
        ("toile_tutorial", "Dust"),
    ] {
        let mut registry = Registry::new();
        registry.load_plugin(&library(name), None).unwrap();
        let card = registry.card(stage).unwrap();
        assert!(card.plugin.is_some() && checked(card).len() >= 3, "{name}");
        for contract in checked(card) {
            let kept = check_registered(&registry, card, contract);
            assert!(kept.is_ok(), "{}", kept.unwrap_err());
        }
    }
}
