//! What the result of a stage depends on, and the key made from it.
//!
//! Scheme: the key is the BLAKE3 digest of [`SCHEME`], the stage's name, role, version and plugin,
//! its canonical parameters, the entry of the named set at work, and the digests of its inputs in
//! the order of its ports. The contents of files that it reads come in by a second step, since
//! which they are is known only after a run.
//!
//! Ids of stages and places in the file are no part of it: white space, comments and another order
//! of the file make no stage run again.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_core::artifact::{Digest, Digester};
use toile_core::{Card, Node};

/// The version of this scheme and of the cache's files; raised when either changes.
pub(crate) const SCHEME: u32 = 1;

/// What one run of a stage is made from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Ingredients {
    pub(super) name: String,
    pub(super) role: String,
    pub(super) version: u32,
    /// The digest of the plugin that holds the stage; none for a stage that is linked in.
    pub(super) plugin: Option<String>,
    /// Parameters as RON.
    pub(super) params: String,
    pub(super) entry: String,
    pub(super) inputs: Vec<FedPort>,
}

/// The value on an input port.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct FedPort {
    /// The port's name.
    pub(super) port: String,
    /// The id of the stage that made it, for people; no part of the key.
    pub(super) from: String,
    pub(super) value: Fed,
}

/// Digests of a port's value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Fed {
    /// Nothing feeds the port.
    Nothing,
    /// It is not known: its maker has yet to run, or promises no equal result.
    Unknown,
    /// One artifact.
    One(Digest),
    /// A named set.
    Set(BTreeMap<String, Digest>),
}

impl Ingredients {
    /// Of the stage `node` for an entry of its sets; `inputs` has a value for each of the card's
    /// ports.
    pub(crate) fn of(node: &Node, entry: &str, inputs: Vec<(String, Fed)>) -> Self {
        let ports = node.card.inputs.iter().zip(inputs);
        Ingredients {
            name: node.card.name.to_owned(),
            role: node.card.role.as_str().to_owned(),
            version: node.card.version,
            plugin: node.card.plugin.map(|p| p.digest.hex()),
            params: node.stage.params(),
            entry: entry.to_owned(),
            inputs: ports
                .map(|(port, (from, value))| FedPort { port: port.name.to_owned(), from, value })
                .collect(),
        }
    }

    /// The key without the files that the stage reads; none while an input is not known.
    pub(crate) fn key(&self) -> Option<Digest> {
        if self.inputs.iter().any(|used| used.value == Fed::Unknown) {
            return None;
        }
        let mut d = Digester::new();
        d.text("toile stage").count(SCHEME as usize).text(&self.name).text(&self.role);
        d.count(self.version as usize).text(self.plugin.as_deref().unwrap_or("")).text(&self.params);
        d.text(&self.entry).count(self.inputs.len());
        for used in &self.inputs {
            match &used.value {
                Fed::Nothing | Fed::Unknown => d.text("nothing"),
                Fed::One(hash) => d.text("one").bytes(&hash.0),
                Fed::Set(set) => {
                    d.text("set").count(set.len());
                    set.iter().fold(&mut d, |d, (name, hash)| d.text(name).bytes(&hash.0))
                }
            };
        }
        Some(d.finish())
    }
}

/// What stands for a stage, whatever its parameters and inputs.
pub(crate) fn of_stage(card: &Card) -> Digest {
    let mut d = Digester::new();
    d.text("toile stage alone").count(SCHEME as usize).text(card.name).text(card.role.as_str());
    d.count(card.version as usize).text(card.package);
    d.text(&card.plugin.map(|p| p.digest.hex()).unwrap_or_default());
    d.finish()
}

/// The key with the files that the stage read.
pub(super) fn with_reads(key: &Digest, reads: &[(String, Option<Digest>)]) -> Digest {
    let mut d = Digester::new();
    d.text("toile files").bytes(&key.0).count(reads.len());
    for (path, hash) in reads {
        d.text(path).text(&hash.map(|h| h.hex()).unwrap_or_default());
    }
    d.finish()
}

/// The digest that stands for an artifact that cannot be stored: of what it is made from.
pub(super) fn of_unstored(key: &Digest, port: usize, name: &str) -> Digest {
    let mut d = Digester::new();
    d.text("toile unstored").bytes(&key.0).count(port).text(name);
    d.finish()
}
