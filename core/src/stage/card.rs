//! What a stage says of itself.

use super::{Contract, Role};
use crate::ParamDoc;
use crate::artifact::{Digest, Kind};

/// Everything that is known of a stage before it has parameters.
#[derive(Debug, Clone)]
pub struct Card {
    /// Its name in pipeline files.
    pub name: &'static str,
    /// What it is for.
    pub role: Role,
    /// The user's page: the doc comment of the parameter struct.
    pub doc: &'static str,
    /// The method's author and year.
    pub source: &'static str,
    /// The version of its algorithm: raised when the same parameters give another result.
    pub version: u32,
    /// An example as it stands in a pipeline file.
    pub example: &'static str,
    /// What it promises.
    pub contracts: Vec<Contract>,
    /// Its parameters.
    pub params: Vec<ParamDoc>,
    /// Its input ports.
    pub inputs: Vec<InPort>,
    /// Its output ports.
    pub outputs: Vec<OutPort>,
    /// The crate that holds it, with its version: `toile-image 0.1.0`.
    pub package: &'static str,
    /// The plugin that it comes from; `None` for a stage that is linked in.
    pub plugin: Option<PluginId>,
}

impl Card {
    /// True where the stage is run once for each entry of a named set.
    pub fn is_mapped(&self) -> bool {
        self.inputs.iter().any(|p| p.arity == Arity::Each)
    }

    /// The first line of its page.
    pub fn summary(&self) -> &'static str {
        self.doc.lines().map(str::trim).find(|l| !l.is_empty()).unwrap_or("")
    }
}

/// Whether a port takes one value, each of a named set, or the whole set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arity {
    /// A single value.
    One,
    /// One value of a named set at a time: the stage is mapped over the set.
    Each,
    /// The whole named set.
    All,
}

/// An input port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InPort {
    /// The argument's name.
    pub name: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// How many.
    pub arity: Arity,
    /// True where the stage can do without.
    pub optional: bool,
    /// True where it takes the first made of its kind (the photo as read), not the latest.
    pub original: bool,
    /// True where it takes what was sewn: of a garment that flatteners have laid flat, the one that
    /// they were given.
    pub sewn: bool,
}

/// An output port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutPort {
    /// What it gives.
    pub kind: Kind,
    /// `All` where one run gives a whole named set; `One` else (a mapped stage gives a set as
    /// well).
    pub arity: Arity,
}

/// Which plugin a stage comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PluginId {
    /// The plugin's name.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
    /// The digest of its file.
    pub digest: Digest,
}
