//! The one trait that every step of a pipeline stands behind.

use crate::artifact::{Artifact, ArtifactType, Digest, Kind};
use crate::cost::Size;
use crate::decide::{Decision, Known};
use crate::{Context, ParamDoc, StageError};
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A step of a pipeline, with its parameters set.
///
/// Authors do not implement it by hand: `#[stage]` on the parameter struct and on its `impl`
/// derives it from one typed function.
#[typetag::serde]
pub trait Stage: std::fmt::Debug + Send + Sync {
    /// The stage's card.
    fn card(&self) -> Card;

    /// Its parameters as RON: `(bias: 3.0)`.
    fn params(&self) -> String;

    /// How much it makes of so much, all ports together; none where the rules of its role tell (see [`crate::cost`]).
    fn sizes(&self, _given: &Size, _cx: &Context) -> Option<Size> {
        None
    }

    /// What it leaves out or simplifies here, by which facts of the scene (see [`crate::decide`]).
    fn decisions(&self, _known: &Known<'_>) -> Vec<Decision> {
        Vec::new()
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

/// What a stage is for. The eight roles of the product, and those that stand around them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Reads photos, bodies, patterns.
    Reader,
    /// Removes noise from photos.
    Denoiser,
    /// Photo to mask.
    Binariser,
    /// Photo and mask to outline.
    EdgeDetector,
    /// Names edges, keeps seams.
    Style,
    /// Outline to panel.
    Mesher,
    /// Moves panel vertices.
    Smoother,
    /// Makes or reads the body.
    Body,
    /// Chooses the cloth.
    Fabric,
    /// Panels into space.
    Placement,
    /// Body to collision service.
    Collider,
    /// Sews.
    Stitcher,
    /// Drapes.
    Draper,
    /// Garment and photos to model.
    Texturer,
    /// Writes files.
    Writer,
}

impl Role {
    /// Every role, in the order of a pipeline.
    pub const ALL: [Role; 15] = [
        Role::Reader,
        Role::Denoiser,
        Role::Binariser,
        Role::EdgeDetector,
        Role::Style,
        Role::Mesher,
        Role::Smoother,
        Role::Body,
        Role::Fabric,
        Role::Placement,
        Role::Collider,
        Role::Stitcher,
        Role::Draper,
        Role::Texturer,
        Role::Writer,
    ];

    /// The role of that word.
    pub fn named(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|r| r.as_str() == word)
    }

    /// The role in words: `edge detector`.
    pub fn as_str(self) -> &'static str {
        match self {
            Role::Reader => "reader",
            Role::Denoiser => "denoiser",
            Role::Binariser => "binariser",
            Role::EdgeDetector => "edge detector",
            Role::Style => "style",
            Role::Mesher => "mesher",
            Role::Smoother => "smoother",
            Role::Body => "body",
            Role::Fabric => "fabric",
            Role::Placement => "placement",
            Role::Collider => "collider",
            Role::Stitcher => "stitcher",
            Role::Draper => "draper",
            Role::Texturer => "texturer",
            Role::Writer => "writer",
        }
    }
}

/// A property that a stage promises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Contract {
    /// The same input gives the same bits.
    Deterministic,
    /// The number of threads does not change a bit.
    ThreadInvariant,
    /// Moving the input moves the output.
    TranslationEquivariant,
    /// Turning the input turns the output.
    RotationEquivariant,
    /// Scaling the input scales the output.
    ScaleEquivariant,
    /// A second run changes nothing.
    Idempotent,
    /// The boundary stays where it is.
    BoundaryPreserving,
    /// Empty input is an error, not a crash.
    RefusesEmpty,
    /// Stops within 50 ms of being asked.
    Cancellable,
}

impl Contract {
    /// Every contract.
    pub const ALL: [Contract; 9] = [
        Contract::Deterministic,
        Contract::ThreadInvariant,
        Contract::TranslationEquivariant,
        Contract::RotationEquivariant,
        Contract::ScaleEquivariant,
        Contract::Idempotent,
        Contract::BoundaryPreserving,
        Contract::RefusesEmpty,
        Contract::Cancellable,
    ];

    /// The contract as one word: `thread_invariant`.
    pub fn as_str(self) -> &'static str {
        match self {
            Contract::Deterministic => "deterministic",
            Contract::ThreadInvariant => "thread_invariant",
            Contract::TranslationEquivariant => "translation_equivariant",
            Contract::RotationEquivariant => "rotation_equivariant",
            Contract::ScaleEquivariant => "scale_equivariant",
            Contract::Idempotent => "idempotent",
            Contract::BoundaryPreserving => "boundary_preserving",
            Contract::RefusesEmpty => "refuses_empty",
            Contract::Cancellable => "cancellable",
        }
    }

    /// The contract of that word.
    pub fn named(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.as_str() == word)
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
    /// True where it wants the first made of its kind (the photo as read), not the latest.
    pub original: bool,
}

/// An output port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutPort {
    /// What it gives.
    pub kind: Kind,
    /// `All` where one run gives a whole named set; `One` else (a mapped stage gives a set as well).
    pub arity: Arity,
}

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
    /// The crate that holds it, with its version: `toile-stages 0.1.0`.
    pub package: &'static str,
    /// The plugin that it comes from; `None` for a stage that is linked in.
    pub plugin: Option<PluginId>,
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

/// A value on a port: one artifact, or a named set of one kind.
#[derive(Debug, Clone)]
pub enum PortValue {
    /// A single artifact.
    One(Arc<dyn Artifact>),
    /// A named set.
    Set(Kind, BTreeMap<String, Arc<dyn Artifact>>),
}

impl PortValue {
    /// The kind of what it holds.
    pub fn kind(&self) -> Kind {
        match self {
            PortValue::One(a) => a.kind(),
            PortValue::Set(kind, _) => *kind,
        }
    }

    /// Its artifacts with their names; a single artifact has the empty name.
    pub fn entries(&self) -> Vec<(&str, &Arc<dyn Artifact>)> {
        match self {
            PortValue::One(a) => vec![("", a)],
            PortValue::Set(_, set) => set.iter().map(|(k, v)| (k.as_str(), v)).collect(),
        }
    }
}

/// The values of a stage's input ports, in the order of its card; `None` for an optional port
/// that nothing feeds.
#[derive(Debug, Clone, Default)]
pub struct Inputs(pub Vec<Option<PortValue>>);

/// A named set of artifacts of one type, in the order of their names.
#[derive(Debug, Clone)]
pub struct Set<T>(pub BTreeMap<String, Arc<T>>);

impl<T> Set<T> {
    /// Names and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.0.iter().map(|(k, v)| (k.as_str(), v.as_ref()))
    }

    /// The value of that name.
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0.get(name).map(Arc::as_ref)
    }
}

impl<T> FromIterator<(String, T)> for Set<T> {
    fn from_iter<I: IntoIterator<Item = (String, T)>>(items: I) -> Self {
        Set(items.into_iter().map(|(k, v)| (k, Arc::new(v))).collect())
    }
}

/// A type that may stand as an argument of a stage's typed function.
pub trait Input<'a>: Sized {
    /// Kind, arity and optionality of the port.
    fn port() -> (Kind, Arity, bool);
    /// Takes it from a port.
    fn take(value: Option<&'a PortValue>) -> Option<Self>;
}

fn downcast<T: ArtifactType>(artifact: &Arc<dyn Artifact>) -> Option<&T> {
    let any: &dyn Any = artifact.as_ref();
    any.downcast_ref()
}

impl<'a, T: ArtifactType> Input<'a> for &'a T {
    fn port() -> (Kind, Arity, bool) {
        (T::KIND, if T::IN_SETS { Arity::Each } else { Arity::One }, false)
    }
    fn take(value: Option<&'a PortValue>) -> Option<Self> {
        match value {
            Some(PortValue::One(a)) => downcast(a),
            _ => None,
        }
    }
}

impl<T: ArtifactType> Input<'_> for Set<T> {
    fn port() -> (Kind, Arity, bool) {
        (T::KIND, Arity::All, false)
    }
    fn take(value: Option<&PortValue>) -> Option<Self> {
        let typed = |(k, v): (&String, &Arc<dyn Artifact>)| {
            let any: Arc<dyn Any + Send + Sync> = v.clone();
            any.downcast::<T>().ok().map(|v| (k.clone(), v))
        };
        match value {
            Some(PortValue::Set(_, set)) => set.iter().map(typed).collect::<Option<_>>().map(Set),
            _ => None,
        }
    }
}

impl<'a, I: Input<'a>> Input<'a> for Option<I> {
    fn port() -> (Kind, Arity, bool) {
        let (kind, arity, _) = I::port();
        (kind, arity, true)
    }
    fn take(value: Option<&'a PortValue>) -> Option<Self> {
        match value {
            None => Some(None),
            some => I::take(some).map(Some),
        }
    }
}

/// A type that a stage's typed function may return.
pub trait Output {
    /// Its ports.
    fn ports() -> Vec<OutPort>;
    /// Its values, in the order of the ports.
    fn pack(self) -> Vec<PortValue>;
}

impl<T: ArtifactType> Output for T {
    fn ports() -> Vec<OutPort> {
        vec![OutPort { kind: T::KIND, arity: Arity::One }]
    }
    fn pack(self) -> Vec<PortValue> {
        vec![PortValue::One(Arc::new(self))]
    }
}

impl<T: ArtifactType> Output for Set<T> {
    fn ports() -> Vec<OutPort> {
        vec![OutPort { kind: T::KIND, arity: Arity::All }]
    }
    fn pack(self) -> Vec<PortValue> {
        let erase = |(k, v): (String, Arc<T>)| (k, v as Arc<dyn Artifact>);
        vec![PortValue::Set(T::KIND, self.0.into_iter().map(erase).collect())]
    }
}

impl<A: Output, B: Output> Output for (A, B) {
    fn ports() -> Vec<OutPort> {
        [A::ports(), B::ports()].concat()
    }
    fn pack(self) -> Vec<PortValue> {
        [self.0.pack(), self.1.pack()].concat()
    }
}

impl<A: Output, B: Output, C: Output, D: Output> Output for (A, B, C, D) {
    fn ports() -> Vec<OutPort> {
        [A::ports(), B::ports(), C::ports(), D::ports()].concat()
    }
    fn pack(self) -> Vec<PortValue> {
        [self.0.pack(), self.1.pack(), self.2.pack(), self.3.pack()].concat()
    }
}
