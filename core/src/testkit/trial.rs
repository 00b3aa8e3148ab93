//! A single run of a stage and what came of it.

use crate::artifact::{Artifact, Collider, Digester};
use crate::{Cancel, Context, ErrorCode, Inputs, PortValue, Stage};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;

/// A stage with the folder that its files lie in.
#[derive(Debug, Clone, Copy)]
pub struct Trial<'a> {
    /// The stage.
    pub stage: &'a dyn Stage,
    /// Where paths of its parameters begin.
    pub folder: &'a Path,
}

/// What a run came to.
#[derive(Debug, Clone)]
pub enum TrialOutcome {
    /// It gave sound artifacts.
    Answered(Vec<PortValue>),
    /// It refused, with a code and a sentence.
    Refused(ErrorCode, String),
    /// It panicked, gave something unsound, or called the fault its own.
    Broken(String),
}

impl Trial<'_> {
    /// Runs it.
    pub fn run(&self, inputs: &Inputs) -> TrialOutcome {
        self.run_until(inputs, Cancel::new())
    }

    /// Runs it with a stop flag.
    pub fn run_until(&self, inputs: &Inputs, cancel: Cancel) -> TrialOutcome {
        let cx = Context::new(self.stage.card().name, self.folder, cancel, Arc::new(()));
        match catch_unwind(AssertUnwindSafe(|| self.stage.run_ports(inputs, &cx))) {
            Err(payload) => TrialOutcome::Broken(format!("it panicked: {}", words(payload.as_ref()))),
            Ok(Err(e)) if e.code == ErrorCode::Internal => {
                TrialOutcome::Broken(format!("it calls it its own fault: {e}"))
            }
            Ok(Err(e)) => TrialOutcome::Refused(e.code, e.message),
            Ok(Ok(made)) => match unsound(&made) {
                Some(fault) => TrialOutcome::Broken(fault),
                None => TrialOutcome::Answered(made),
            },
        }
    }
}

fn words(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default()
}

fn unsound(made: &[PortValue]) -> Option<String> {
    let faults =
        made.iter().flat_map(PortValue::entries).find_map(|(_, a)| a.check().err().map(|e| (a.kind(), e)));
    faults.map(|(kind, fault)| format!("it gave a {kind} that cannot be: {fault}"))
}

impl TrialOutcome {
    /// True where it gave something.
    pub fn answered(&self) -> bool {
        matches!(self, TrialOutcome::Answered(_))
    }

    /// What it gave.
    pub fn values(&self) -> Option<&[PortValue]> {
        match self {
            TrialOutcome::Answered(made) => Some(made),
            _ => None,
        }
    }

    /// A text that two outcomes share if they are the same bits.
    pub fn fingerprint(&self) -> String {
        match self {
            TrialOutcome::Refused(code, message) => format!("refused ({code}): {message}"),
            TrialOutcome::Broken(fault) => fault.clone(),
            TrialOutcome::Answered(made) => {
                let each = made.iter().flat_map(PortValue::entries);
                each.map(|(name, a)| format!("{name} {} {}", a.kind(), digest(a.as_ref())))
                    .collect::<Vec<_>>()
                    .join("; ")
            }
        }
    }
}

fn digest(artifact: &dyn Artifact) -> String {
    let mut d = Digester::new();
    artifact.digest(&mut d);
    let any: &dyn Any = artifact;
    // A collider's digest is its settings: its answers are what must not vary.
    if let Some(collider) = any.downcast_ref::<Collider>() {
        answers(collider, &mut d);
    }
    d.finish().short()
}

/// What a collider says of the suite's garment.
fn answers(collider: &Collider, d: &mut Digester) {
    let garment = super::dress::garment();
    let (mut body, mut own, mut hits) = (Vec::new(), Vec::new(), Vec::new());
    let inward: Vec<_> =
        garment.positions.iter().map(|p| p + (crate::artifact::Point3::new(0.0, p.y, 0.0) - p)).collect();
    collider.scheme.body_contacts(&garment.positions, 0.2, &mut body);
    collider.scheme.body_hits(&garment.positions, &inward, &mut hits);
    collider.scheme.self_contacts(&garment.positions, &garment.triangles, 0.06, &mut own);
    for c in body.iter().chain(&hits) {
        d.count(c.vertex as usize)
            .floats([c.distance, c.point.x, c.point.y, c.point.z])
            .floats(c.normal.iter().copied());
    }
    for c in &own {
        d.indices(c.vertices).floats(c.weights).floats([c.distance]);
    }
    d.floats(collider.scheme.conservative_bounds(&garment.positions, &garment.triangles, 0.06));
    let crossings = collider.scheme.self_crossings(&garment.positions, &garment.triangles);
    d.indices(crossings.into_iter().flatten());
}
