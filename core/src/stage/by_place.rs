//! Parameters that follow from where a stage stands in a pipeline.

/// Values of parameters that the file leaves out, by a stage's place.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ByPlace {
    /// The index of an earlier stage of the same name, whose parameters it takes.
    pub like: Option<usize>,
    /// Parameters and their values as they would stand in a pipeline file; before those of `like`.
    pub set: Vec<(&'static str, String)>,
}
