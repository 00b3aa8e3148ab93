//! Changes as a page sends them.

use serde::Deserialize;
use toile_pipeline::PipelineEdit;

/// One change of the project's text.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum StudioChange {
    /// A value at a path, as with `--set`.
    Set {
        /// The path.
        path: String,
        /// The value, RON.
        value: String,
    },
    /// What is at a path goes.
    Remove(String),
    /// Another stage in a stage's place.
    Swap {
        /// The id of the one that is there.
        stage: String,
        /// The other, as it is written.
        with: String,
    },
    /// One stage more.
    Add {
        /// As it is written.
        stage: String,
        /// The id of the stage before it; none for the last place.
        #[serde(default)]
        after: Option<String>,
    },
    /// Another text.
    Text(String),
}

impl StudioChange {
    /// As an edit of the text; none where the whole text is another one.
    pub(super) fn edit(&self) -> Option<PipelineEdit> {
        Some(match self.clone() {
            StudioChange::Set { path, value } => PipelineEdit::Set { path, value },
            StudioChange::Remove(path) => PipelineEdit::Remove { path },
            StudioChange::Swap { stage, with } => PipelineEdit::Swap { stage, with },
            StudioChange::Add { stage, after } => PipelineEdit::Add { stage, after },
            StudioChange::Text(_) => return None,
        })
    }
}
