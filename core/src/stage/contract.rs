//! What stages promise.

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
    /// Only improves on what it is given: where it fails, that goes on.
    Improves,
}

impl Contract {
    /// Every contract.
    pub const ALL: [Contract; 10] = [
        Contract::Deterministic,
        Contract::ThreadInvariant,
        Contract::TranslationEquivariant,
        Contract::RotationEquivariant,
        Contract::ScaleEquivariant,
        Contract::Idempotent,
        Contract::BoundaryPreserving,
        Contract::RefusesEmpty,
        Contract::Cancellable,
        Contract::Improves,
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
            Contract::Improves => "improves",
        }
    }

    /// The contract of that word.
    pub fn named(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.as_str() == word)
    }
}
