//! What is wrong with a parameter's text.

/// Why a text is no value for a parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParamFault {
    /// The reason with the parameter's name, lower case.
    pub message: String,
    /// The reason alone, for a fault deep inside a value.
    pub reason: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// Byte offset of the fault in the text, where the parser knows it.
    pub offset: Option<usize>,
}
