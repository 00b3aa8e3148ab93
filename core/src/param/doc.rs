//! What is known of a parameter.

use super::{Length, ParamFault};
use std::sync::Arc;

/// One parameter of a stage: the single source of its RON form, checks, card and schema.
#[derive(Debug, Clone)]
pub struct ParamDoc {
    /// Field name.
    pub name: &'static str,
    /// What it does.
    pub doc: &'static str,
    /// Its type in words.
    pub kind: String,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// Least value allowed (lengths in metres).
    pub min: Option<f64>,
    /// Greatest value allowed.
    pub max: Option<f64>,
    /// Default as RON text.
    pub default: String,
    /// True where it trades accuracy for time.
    pub trades: bool,
    /// Which way it is refined where it is a resolution; none where it is none.
    pub finer: Option<Finer>,
    /// True where the stage does different work if the value is not the default: the cost of that
    /// is recorded separately.
    pub way: bool,
    /// Parses a RON text as this parameter's type and checks its numbers' range.
    pub check: Check,
}

/// Parameters whose values are paths of files that a stage reads.
pub const FILE_PARAMS: [&str; 4] = ["file", "seams", "measurements", "panorama"];

impl ParamDoc {
    /// Whether its value is the path of a file that the stage reads, one of [`FILE_PARAMS`].
    pub fn names_file(&self) -> bool {
        FILE_PARAMS.contains(&self.name) && self.kind.starts_with("text")
    }

    /// Its range in words, `1 mm to 100 mm`; `None` where it has none.
    pub fn range(&self) -> Option<String> {
        let show =
            |x: f64| if self.kind.contains("length") { Length::m(x).to_string() } else { x.to_string() };
        match (self.min, self.max) {
            (Some(lo), Some(hi)) => Some(format!("{} to {}", show(lo), show(hi))),
            (Some(lo), None) => Some(format!("at least {}", show(lo))),
            (None, Some(hi)) => Some(format!("at most {}", show(hi))),
            (None, None) => None,
        }
    }
}

/// Which way a resolution is refined: the results of ever finer values come nearer to one limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finer {
    /// Less is finer: an edge length, a time step, a tolerance.
    Less,
    /// More is finer: a count of iterations.
    More,
}

impl Finer {
    /// In one word.
    pub fn as_str(self) -> &'static str {
        match self {
            Finer::Less => "less",
            Finer::More => "more",
        }
    }
}

/// How a parameter's text is checked: by its own type, or by the plugin that knows the type.
#[derive(Clone)]
pub struct Check(Arc<CheckFn>);

type CheckFn = dyn Fn(&str, &ParamDoc) -> Result<(), ParamFault> + Send + Sync;

impl Check {
    /// Checks by a function.
    pub fn by(check: impl Fn(&str, &ParamDoc) -> Result<(), ParamFault> + Send + Sync + 'static) -> Self {
        Check(Arc::new(check))
    }

    /// Checks a text as the value of that parameter.
    pub fn run(&self, text: &str, doc: &ParamDoc) -> Result<(), ParamFault> {
        (self.0)(text, doc)
    }
}

impl std::fmt::Debug for Check {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Check")
    }
}
