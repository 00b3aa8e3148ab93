//! `toile stages` and `toile stage NAME`: what the registry knows.

use crate::contracts::Contracts;
use crate::{Streams, cache, exit};
use serde_json::{Value, json};
use std::path::PathBuf;
use toile_core::{Arity, Card, Contract, Finer, InPort, ParamDoc, Registry, Role};
use toile_pipeline::plugin::{Plugin, Refused};

/// What becomes of a run in which a stage that only improves fails.
const IMPROVES: &str = "Only improves on what it is given: where it fails, or takes more work than that took, the run warns and goes on with\n\
                        what it was given.";

/// Lists all stages, role by role.
pub(crate) fn list(json: bool, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    if json {
        streams.say(listing(registry));
        return exit::DONE;
    }
    for role in Role::ALL {
        let mut cards = registry.of_role(role).peekable();
        if cards.peek().is_some() {
            streams.say(role.as_str());
        }
        for card in cards {
            let from = card.plugin.map_or(String::new(), |p| format!(" [plugin {}]", p.name));
            streams.say(format!("  {:<22} {}{from}", card.name, card.summary()));
        }
    }
    list_plugins(registry, streams);
    exit::DONE
}

/// The cards of all stages, and the plugins.
pub(crate) fn listing(registry: &Registry) -> Value {
    let contracts = known(None);
    let cards: Vec<Value> = registry.cards().map(|card| card_json(card, &contracts)).collect();
    let mut listing = json!({ "stages": cards });
    if !registry.plugins().is_empty() || !registry.refused().is_empty() {
        listing["plugins"] = registry.plugins().iter().map(plugin_json).collect();
        listing["refused"] = registry.refused().iter().map(refused_json).collect();
    }
    listing
}

/// Prints the JSON schema of pipeline files.
pub(crate) fn schema(registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    streams.say(format!("{:#}", crate::schema::schema(registry)));
    exit::DONE
}

/// The plugins, with the digests that pipelines may pin, and those that are refused.
fn list_plugins(registry: &Registry, streams: &mut Streams<'_>) {
    if !registry.plugins().is_empty() {
        streams.say("plugins");
    }
    for p in registry.plugins() {
        let (major, minor) = p.abi;
        streams.say(format!("  {} {}, ABI {major}.{minor}, {}", p.id.name, p.id.version, p.file.display()));
        streams.say(format!("    blake3: \"{}\"", p.id.digest.hex()));
    }
    if !registry.refused().is_empty() {
        streams.say("refused plugins");
    }
    for r in registry.refused() {
        let hint = r.hint.as_ref().map_or(String::new(), |h| format!(" ({h})"));
        streams.say(format!("  {}: {}{hint}", r.file, r.reason));
    }
}

fn plugin_json(p: &Plugin) -> Value {
    json!({ "name": p.id.name, "version": p.id.version, "blake3": p.id.digest.hex(),
        "abi": format!("{}.{}", p.abi.0, p.abi.1), "file": p.file.display().to_string(),
        "stages": p.cards.iter().map(|c| c.name).collect::<Vec<_>>() })
}

fn refused_json(r: &Refused) -> Value {
    json!({ "file": r.file, "reason": r.reason, "hint": r.hint })
}

/// Shows one card.
pub(crate) fn show(
    name: &str,
    cache_dir: Option<PathBuf>,
    json: bool,
    registry: &Registry,
    streams: &mut Streams<'_>,
) -> u8 {
    let cards: Vec<&Card> = registry.named(name).collect();
    if cards.is_empty() {
        let names: Vec<&str> = registry.cards().map(|c| c.name).collect();
        let hint = match toile_core::nearest(name, names.iter().copied()) {
            Some(near) => format!("; did you mean `{near}`?"),
            None => String::from("; `toile stages` lists them"),
        };
        return streams.refuse(json, format!("there is no stage `{name}`{hint}"));
    }
    let contracts = known(cache_dir);
    let as_json = |card| card_json(card, &contracts);
    match json {
        true => streams.say(json!({ "stages": cards.into_iter().map(as_json).collect::<Vec<_>>() })),
        false => cards.into_iter().for_each(|card| streams.say(card_text(card, &contracts))),
    }
    exit::DONE
}

/// What the doctor found of contracts, beside the cache in a folder or that of the environment.
fn known(cache_dir: Option<PathBuf>) -> Contracts {
    Contracts::open(cache::at(cache_dir).map(|c| c.folder().to_owned()))
}

fn card_text(card: &Card, contracts: &Contracts) -> String {
    let mut s = format!("{} ({}, version {})\n\n{}\n", card.name, card.role.as_str(), card.version, card.doc);
    if !card.source.is_empty() {
        s += &format!("\nSource: {}\n", card.source);
    }
    s += "\nTakes:\n";
    for port in &card.inputs {
        s += &format!("  {:<12} {}\n", port.name, port_words(port));
    }
    s += "Gives:\n";
    for port in &card.outputs {
        let set = card.is_mapped() || port.arity == Arity::All;
        s += &format!("  {}{}\n", port.kind, if set { ", one for each panel" } else { "" });
    }
    s += if card.params.is_empty() { "\nNo parameters.\n" } else { "\nParameters:\n" };
    for p in &card.params {
        s += &param_text(p);
    }
    if !card.contracts.is_empty() {
        s += "\nPromises:\n";
    }
    for contract in &card.contracts {
        s += &format!("  {:<24} {}\n", format!("{contract:?}"), contracts.word(card, *contract));
    }
    if card.contracts.iter().any(|c| contracts.word(card, *c) == "declared") {
        s += &format!("  (declared: nobody ran it here; `toile doctor {} --contracts` does)\n", card.name);
    }
    if card.contracts.contains(&Contract::Improves) {
        s += &format!("\n{IMPROVES}\n");
    }
    if let Some(p) = card.plugin {
        s += &format!("\nFrom: plugin \"{}\" {}\n", p.name, p.version);
    }
    s + &format!("\nExample:\n  {}", card.example)
}

fn port_words(port: &InPort) -> String {
    let arity = match port.arity {
        Arity::One => "",
        Arity::Each => ", each panel's in turn",
        Arity::All => ", all panels' together",
    };
    let optional = if port.optional { ", may be missing" } else { "" };
    let original = if port.original { ", as first made" } else { "" };
    let sewn = if port.sewn { ", as it was sewn" } else { "" };
    format!("{}{arity}{original}{sewn}{optional}", port.kind)
}

fn param_text(p: &ParamDoc) -> String {
    let unit = if p.unit.is_empty() { String::new() } else { format!(" [{}]", p.unit) };
    let doc = p.doc.replace('\n', "\n      ");
    let trades = trades(p).map_or_else(String::new, |words| format!("      {words}\n"));
    format!("  {}: {}{unit}{}, default {}\n      {doc}\n{trades}", p.name, p.kind, range(p), p.default)
}

/// What turning it does: `Trades accuracy for time; less is finer.`
fn trades(p: &ParamDoc) -> Option<String> {
    let finer = p.finer.map_or_else(String::new, |way| format!("; {} is finer", way.as_str()));
    p.trades.then(|| format!("Trades accuracy for time{finer}."))
}

fn range(p: &ParamDoc) -> String {
    p.range().map_or(String::new(), |words| format!(", {words}"))
}

fn card_json(card: &Card, known: &Contracts) -> Value {
    let params: Vec<Value> = card
        .params
        .iter()
        .map(|p| {
            json!({ "name": p.name, "doc": p.doc, "type": p.kind, "unit": p.unit, "min": p.min, "max": p.max,
                "default": p.default, "trades": p.trades, "finer": p.finer.map(Finer::as_str),
                "file": p.names_file() })
        })
        .collect();
    let inputs: Vec<Value> = card
        .inputs
        .iter()
        .map(|p| {
            json!({ "name": p.name, "kind": p.kind.0, "arity": format!("{:?}", p.arity).to_lowercase(),
                "optional": p.optional, "original": p.original })
        })
        .collect();
    let outputs: Vec<Value> = card.outputs.iter().map(|p| json!({ "kind": p.kind.0 })).collect();
    let names = |all: &[Contract]| all.iter().map(|c| format!("{c:?}")).collect::<Vec<_>>();
    let is_checked = |c: &Contract| known.word(card, *c) == "checked";
    let checked: Vec<Contract> = card.contracts.iter().copied().filter(is_checked).collect();
    let (contracts, checked) = (names(&card.contracts), names(&checked));
    json!({ "name": card.name, "role": card.role.as_str(), "doc": card.doc, "source": card.source,
        "version": card.version, "example": card.example, "contracts": contracts, "checked": checked, "params": params,
        "inputs": inputs, "outputs": outputs, "improves": card.contracts.contains(&Contract::Improves) })
}
