//! The record of a study, `trade.jsonl`: its reference in the first line, then a line a setting.

use crate::journal::{Journal, JournalKind};
use crate::record::{Point, Reference, SCHEME};
use serde::{Deserialize, Serialize};

/// The record's kind.
pub(super) const KIND: JournalKind = JournalKind {
    name: "trade",
    scheme: SCHEME,
    changed: "the pipeline, what is refined or the number of threads has changed",
};

/// What the settings are measured against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Against {
    /// The reference.
    pub(super) reference: Reference,
}

/// The record of a study.
pub(super) type Store = Journal<Against, Point>;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::record::SettingOutcome;
    use std::collections::BTreeMap;

    #[test]
    fn a_record_of_an_earlier_session_is_read_word_for_word() {
        let dir = tempfile::tempdir().unwrap();
        let head = format!(
            r#"{{"scheme":1,"toile":"{}","base":"base","reads":{{}},"reference":{{"ratio":2.0,"levels":[],"mean":null,"p95":null,"displacement":null,"stopped":"it stopped moving","spread":null,"ease_mm":{{}}}}}}"#,
            env!("CARGO_PKG_VERSION")
        );
        let line = r#"{"key":"one","setting":{},"overrides":[],"outcome":{"over_limit":{"seconds":3.0}}}"#;
        let text = format!("{head}\n{line}\n");
        std::fs::write(dir.path().join("trade.jsonl"), &text).unwrap();
        let found = Store::open(dir.path(), KIND, "base").unwrap().unwrap();
        let stopped = "it stopped moving".to_owned();
        assert_eq!(found.head.on.reference, Reference { ratio: 2.0, stopped, ..Reference::default() });
        let outcome = SettingOutcome::OverLimit { seconds: 3.0 };
        let point = Point { key: "one".into(), setting: BTreeMap::new(), overrides: Vec::new(), outcome };
        assert_eq!(found.lines, [point]);
        found.write().unwrap();
        assert_eq!(std::fs::read_to_string(dir.path().join("trade.jsonl")).unwrap(), text);
    }
}
