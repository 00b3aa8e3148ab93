//! Errors of stages: typed, lower case, with a hint.

/// What went wrong, as a stable word that scripts can match.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ErrorCode {
    /// A file could not be read or is not what it should be.
    PatternLoading,
    /// Input that cannot be worked on: a blank photo, a garment cut by the frame, a wrong style.
    InvalidInput,
    /// A parameter out of its range.
    InvalidParameter,
    /// A mesh with triangles of no area, or an outline that crosses itself.
    DegenerateTriangles,
    /// A seam that did not close. One that is known to be wrong before it is sewn is invalid input.
    StitchingError,
    /// The solver did not come to rest.
    StaticEquilibrium,
    /// The simulation was over suspiciously early.
    FastFinish,
    /// Cloth ended inside the body. A start in the body is invalid input.
    BodyIntersection,
    /// Cloth ended through itself. A start that crosses itself is invalid input.
    SelfIntersection,
    /// Out of time.
    Timeout,
    /// Stopped by the user.
    Cancelled,
    /// The program's own fault.
    Internal,
}

impl ErrorCode {
    /// Every code.
    pub const ALL: [ErrorCode; 12] = [
        ErrorCode::PatternLoading,
        ErrorCode::InvalidInput,
        ErrorCode::InvalidParameter,
        ErrorCode::DegenerateTriangles,
        ErrorCode::StitchingError,
        ErrorCode::StaticEquilibrium,
        ErrorCode::FastFinish,
        ErrorCode::BodyIntersection,
        ErrorCode::SelfIntersection,
        ErrorCode::Timeout,
        ErrorCode::Cancelled,
        ErrorCode::Internal,
    ];

    /// The code of that word.
    pub fn named(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.as_str() == word)
    }

    /// The word: `stitching_error`.
    pub fn as_str(self) -> &'static str {
        match self {
            ErrorCode::PatternLoading => "pattern_loading",
            ErrorCode::InvalidInput => "invalid_input",
            ErrorCode::InvalidParameter => "invalid_parameter",
            ErrorCode::DegenerateTriangles => "degenerate_triangles",
            ErrorCode::StitchingError => "stitching_error",
            ErrorCode::StaticEquilibrium => "static_equilibrium",
            ErrorCode::FastFinish => "fast_finish",
            ErrorCode::BodyIntersection => "body_intersection",
            ErrorCode::SelfIntersection => "self_intersection",
            ErrorCode::Timeout => "timeout",
            ErrorCode::Cancelled => "cancelled",
            ErrorCode::Internal => "internal",
        }
    }

    /// The exit code of a run that ends with it: 3 what is wrong before anything is solved, 4 what
    /// solving came to, 5 out of time or stopped, 70 a bug.
    pub fn exit_code(self) -> u8 {
        match self {
            ErrorCode::PatternLoading
            | ErrorCode::InvalidInput
            | ErrorCode::InvalidParameter
            | ErrorCode::DegenerateTriangles => 3,
            ErrorCode::StitchingError
            | ErrorCode::StaticEquilibrium
            | ErrorCode::FastFinish
            | ErrorCode::BodyIntersection
            | ErrorCode::SelfIntersection => 4,
            ErrorCode::Timeout | ErrorCode::Cancelled => 5,
            ErrorCode::Internal => 70,
        }
    }
}

impl std::fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Why a stage could not do its work.
///
/// The runner adds the stage's id, the panel and the line of the pipeline file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StageError {
    /// The stable word.
    pub code: ErrorCode,
    /// One sentence in lower case, without a full stop.
    pub message: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// Details behind the message: forces, counts, places in metres. Shown with `--verbose`, in
    /// `reason.txt` and in the report.
    pub detail: Option<String>,
    /// The parameter at fault, so that the runner can point at it.
    pub param: Option<&'static str>,
    /// The element of the parameter's value at fault: keys, or numbers in a list, from the outside
    /// in.
    pub path: Vec<String>,
}

impl std::fmt::Display for StageError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for StageError {}

impl StageError {
    /// An error with a code and a sentence.
    pub fn new(code: ErrorCode, message: impl Into<String>) -> Self {
        StageError { code, message: message.into(), hint: None, detail: None, param: None, path: Vec::new() }
    }

    /// Invalid input (exit code 3).
    pub fn invalid(message: impl Into<String>) -> Self {
        Self::new(ErrorCode::InvalidInput, message)
    }

    /// A fault of the program itself.
    pub fn internal(message: impl Into<String>) -> Self {
        Self::new(ErrorCode::Internal, message)
    }

    /// Adds a hint.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Adds what lies behind it, for those who need them.
    pub fn detail(mut self, detail: impl Into<String>) -> Self {
        self.detail = Some(detail.into());
        self
    }

    /// Names the parameter at fault.
    pub fn at(mut self, param: &'static str) -> Self {
        self.param = Some(param);
        self
    }

    /// Names an element of the parameter's value: a key of a map, a field, the number of an item.
    /// Called again, one within it.
    ///
    /// `error.at("photos").within("front").within("file")`
    pub fn within(mut self, key: impl ToString) -> Self {
        self.path.push(key.to_string());
        self
    }
}
