//! The one trait that every step of a pipeline stands behind.

mod by_place;
mod card;
mod contract;
mod known;
mod node;
mod placed;
mod role;
mod size;
mod values;

pub use by_place::ByPlace;
pub use card::{Arity, Card, InPort, OutPort, PluginId};
pub use contract::Contract;
pub use known::Known;
pub use node::{Feed, Node, needed_for};
pub use placed::Placed;
pub use role::Role;
pub use values::{Input, Inputs, Output, PortValue, Set};

use crate::cost::Size;
use crate::decide::Decision;
use crate::{Context, StageError};

/// A step of a pipeline, with its parameters set.
///
/// Authors do not implement it by hand: `#[stage]` on the parameter struct and on its `impl`
/// derives it from one typed function.
#[cfg_attr(feature = "typetag", typetag::serde)]
pub trait Stage: std::fmt::Debug + Send + Sync {
    /// The stage's card.
    fn card(&self) -> Card;

    /// Its parameters as RON: `(bias: 3.0)`.
    fn params(&self) -> String;

    /// The size of its outputs for a size of its inputs, all ports together; none where the rules
    /// of its role estimate it (see [`crate::cost`]).
    fn sizes(&self, _given: &Size, _cx: &Context) -> Option<Size> {
        None
    }

    /// What it leaves out or simplifies here, by which facts of the scene (see [`crate::decide`]).
    fn decisions(&self, _known: &Known<'_>) -> Vec<Decision> {
        Vec::new()
    }

    /// Values of parameters that follow from where stage `index` stands among the pipeline's
    /// stages, such as whether the garment has been draped before. The loader sets those that the
    /// file leaves out, before it calls anything else of the stage; [`Stage::decisions`] reports
    /// them.
    fn by_place(&self, _nodes: &[Node], _index: usize) -> ByPlace {
        ByPlace::default()
    }

    /// Values of parameters that it asks of the stages which feed it, near and far, such as that
    /// solvers record frames: a stage that has a parameter of that name takes the value where the
    /// file leaves it out. The loader asks for them together with [`Stage::by_place`].
    fn asks(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// What is wrong with its parameters and files, as far as can be known before anything runs:
    /// all of it, each at its own parameter and element ([`StageError::at`],
    /// [`StageError::within`]). It is asked before every run and by `toile validate`, so it must be
    /// quick: it looks at files, and computes nothing. The run would find the same faults.
    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        Vec::new()
    }

    /// What the user should look at before anything runs, such as a name that no edge of a file
    /// has, each at its own parameter. It is called after [`Stage::faults`] found nothing, and must
    /// be as quick.
    fn warnings(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        Vec::new()
    }

    /// Whether it only improves on what it is given, which is good without it: where it fails, or
    /// takes more work than what it was given took, the run goes on with that
    /// (docs/reference/pipeline.md).
    fn improves(&self) -> bool {
        self.card().contracts.contains(&Contract::Improves)
    }

    /// Runs it on its ports' values, in the order of the card's inputs.
    fn run_ports(&self, inputs: &Inputs, cx: &Context) -> Result<Vec<PortValue>, StageError>;
}

/// What a stage type says of itself, apart from any parameters.
pub trait StageType: Stage + StageMeta + Default + serde::de::DeserializeOwned {
    /// Its card.
    fn type_card() -> Card;
}

/// The half of the card that comes from the parameter struct.
pub trait StageMeta {
    /// The stage's name.
    const NAME: &'static str;
    /// A card without its ports.
    fn meta() -> Card;
}
