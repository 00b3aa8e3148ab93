//! Lock files: what a pipeline was made of when it was locked, and what differs since.
//!
//! A lock holds, stage by stage, everything on which the result rests, in JSON with its fields in a
//! fixed order: the same pipeline and program give the same text. It is compared field by field, so
//! that a run against it says *what* differs and not only that something does.

use crate::RunResult;
use crate::load::{Pipeline, fields_of};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_core::RunLog;
use toile_core::artifact::{ArtifactType, Digest, Digester};
use toile_core::{Card, Node, Registry};

/// The version of the lock file's form.
pub const LOCK_VERSION: u32 = 1;

/// A locked pipeline.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lock {
    /// The version of the form.
    pub lock: u32,
    /// The pipeline's name.
    pub pipeline: String,
    /// Stages that ran, in their order.
    pub stages: Vec<LockedStage>,
}

/// One stage.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LockedStage {
    /// Its id in the pipeline.
    pub id: String,
    /// Its name.
    pub stage: String,
    /// The crate, or the plugin, that holds it, with its version.
    pub package: String,
    /// The version of its algorithm.
    pub version: u32,
    /// The version of its parameters: one more than the changes since its first release.
    pub params_version: u32,
    /// Digest of its parameters' names, types, units, ranges and defaults.
    pub schema: String,
    /// Its parameters as RON.
    pub params: BTreeMap<String, String>,
    /// Digest of what it made; none for what holds times, such as a report on the run.
    pub result: Option<Digest>,
    /// True of a stage that the run left out, which has no result to compare.
    #[serde(skip)]
    pub left_out: bool,
}

impl Lock {
    /// The lock of a pipeline after a run of it that took digests (with a cache, or
    /// [`crate::cache::Cache::nowhere`]).
    pub fn of(pipeline: &Pipeline, registry: &Registry, run: &RunResult) -> Self {
        let ran = |id: &str| run.results.iter().any(|(ran, _)| ran == id);
        let mut lock = Lock::held_against(pipeline, registry, run);
        lock.stages.retain(|s| ran(&s.id));
        lock
    }

    /// What [`Lock::differences`] holds against a lock: stages that the run left out, as with
    /// `--until`, are in it and have no result.
    pub fn held_against(pipeline: &Pipeline, registry: &Registry, run: &RunResult) -> Self {
        let stage = |node: &Node| {
            let ran = run.results.iter().find(|(id, _)| *id == node.id);
            let result = ran.and_then(|(_, result)| *result);
            let timed = node.card.inputs.iter().any(|p| p.kind == RunLog::KIND);
            LockedStage {
                id: node.id.clone(),
                stage: node.card.name.to_owned(),
                package: node.card.package.to_owned(),
                version: node.card.version,
                params_version: registry.params_version(node.card.name),
                schema: schema(&node.card).short(),
                params: fields_of(&node.stage.params()),
                result: result.filter(|_| !timed),
                left_out: ran.is_none(),
            }
        };
        Lock {
            lock: LOCK_VERSION,
            pipeline: pipeline.name.clone(),
            stages: pipeline.nodes.iter().map(stage).collect(),
        }
    }

    /// Its text.
    pub fn to_text(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// From a text.
    ///
    /// Errors: why the text is no lock.
    pub fn from_text(text: &str) -> Result<Self, String> {
        let lock: Lock = serde_json::from_str(text).map_err(|e| format!("it is no lock file: {e}"))?;
        match lock.lock {
            LOCK_VERSION => Ok(lock),
            other => Err(format!("it has the form {other}, this program reads form {LOCK_VERSION}")),
        }
    }

    /// What differs in `now`, a line each: `GridMesher: edge 16 mm -> 12 mm`. Nothing where all is
    /// as it was.
    pub fn differences(&self, now: &Lock) -> Vec<String> {
        let find = |lock: &'_ Lock, id: &str| lock.stages.iter().find(|s| s.id == id).cloned();
        let mut lines = Vec::new();
        for stage in &self.stages {
            match find(now, &stage.id) {
                Some(now) => lines.extend(stage.differences(&now)),
                None => lines.push(format!("{}: it is not run any more", stage.id)),
            }
        }
        let new = now.stages.iter().filter(|s| !s.left_out && find(self, &s.id).is_none());
        lines.extend(new.map(|s| format!("{}: it is not in the lock", s.id)));
        lines
    }
}

impl LockedStage {
    fn differences(&self, now: &LockedStage) -> Vec<String> {
        let mut lines = Vec::new();
        let mut field = |name: &str, was: &str, is: &str| {
            if was != is {
                lines.push(format!("{}: {name} {was} -> {is}", self.id));
            }
        };
        field("stage", &self.stage, &now.stage);
        field("package", &self.package, &now.package);
        field("stage version", &self.version.to_string(), &now.version.to_string());
        field("parameters' version", &self.params_version.to_string(), &now.params_version.to_string());
        field("parameters' schema", &self.schema, &now.schema);
        let shown = |params: &BTreeMap<String, String>, name: &String| {
            params.get(name).map_or("(none)", |v| v.trim_matches('"')).to_owned()
        };
        for name in self.params.keys().chain(now.params.keys().filter(|n| !self.params.contains_key(*n))) {
            field(name, &shown(&self.params, name), &shown(&now.params, name));
        }
        let short = |result: &Option<Digest>| result.map_or("(none)".to_owned(), |h| h.short());
        if !now.left_out {
            field("result", &short(&self.result), &short(&now.result));
        }
        lines
    }
}

/// The digest of a card's parameters.
fn schema(card: &Card) -> Digest {
    let mut d = Digester::new();
    d.text("toile parameters").count(card.params.len());
    for p in &card.params {
        d.text(p.name).text(&p.kind).text(p.unit).text(&p.default);
        d.text(&format!("{:?} {:?}", p.min, p.max));
    }
    d.finish()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn lock() -> Lock {
        let stage = |id: &str, params: &[(&str, &str)]| LockedStage {
            id: id.into(),
            stage: id.into(),
            package: "toile-image 0.1.0".into(),
            version: 1,
            params_version: 1,
            schema: "00".into(),
            params: params.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect(),
            result: Some(Digest::of(id.as_bytes())),
            left_out: false,
        };
        let stages = vec![stage("GridMesher", &[("edge", "\"16 mm\"")]), stage("Otsu", &[("bias", "0.0")])];
        Lock { lock: LOCK_VERSION, pipeline: "vest".into(), stages }
    }

    #[test]
    fn a_lock_comes_back_from_its_text() {
        assert_eq!(Lock::from_text(&lock().to_text()).unwrap(), lock());
        assert!(lock().differences(&lock()).is_empty());
    }

    #[test]
    fn every_difference_is_named_field_by_field() {
        let mut now = lock();
        now.stages[0].params.insert("edge".into(), "\"12 mm\"".into());
        now.stages[0].result = None;
        now.stages[1].version = 2;
        now.stages[1].package = "toile-image 0.2.0".into();
        now.stages[1].params_version = 2;
        now.stages[1].params = BTreeMap::from([("offset".into(), "0.0".into())]);
        let short = Digest::of(b"GridMesher").short();
        assert_eq!(
            lock().differences(&now),
            [
                "GridMesher: edge 16 mm -> 12 mm".to_owned(),
                format!("GridMesher: result {short} -> (none)"),
                "Otsu: package toile-image 0.1.0 -> toile-image 0.2.0".into(),
                "Otsu: stage version 1 -> 2".into(),
                "Otsu: parameters' version 1 -> 2".into(),
                "Otsu: bias 0.0 -> (none)".into(),
                "Otsu: offset (none) -> 0.0".into(),
            ]
        );
        now.stages.remove(0);
        assert_eq!(lock().differences(&now)[0], "GridMesher: it is not run any more");
        assert_eq!(now.differences(&lock()).last().unwrap(), "GridMesher: it is not in the lock");
    }

    #[test]
    fn what_is_no_lock_is_refused_in_words() {
        assert!(Lock::from_text("{").unwrap_err().starts_with("it is no lock file: EOF while parsing"));
        let newer = Lock { lock: 2, ..lock() }.to_text();
        assert_eq!(Lock::from_text(&newer).unwrap_err(), "it has the form 2, this program reads form 1");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_text_is_read_or_refused(text in ".{0,80}") {
            prop_assert!(Lock::from_text(&text).is_err());
        }
    }
}
