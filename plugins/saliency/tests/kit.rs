//! A network of one convolution that takes what is light for the object, and the stage that runs
//! it.

use crate::onnx::Net;
use std::path::Path;
use std::sync::{Arc, Mutex};
use toile_core::artifact::{Digester, Mask, Photo};
use toile_core::{Artifact, Cancel, Context, Event, Inputs, Listener, PortValue, Stage, StageError};
use toile_saliency::Saliency;

/// Slopes of the convolution: the sum of the channels, each by its spread in training, so that it
/// is the sum of levels.
const SLOPES: [f32; 3] = [0.229, 0.224, 0.225];
/// What makes a mean level of one half the border: the means of training, less three halves.
const SHIFT: f32 = 0.485 + 0.456 + 0.406 - 1.5;
/// How steep the answer is.
const STEEP: f32 = 20.0;

/// The network: the mean level of a pixel, above one half the object.
pub(crate) fn tiny() -> Net {
    Net {
        takes: vec![1, 3, 320, 320],
        gives: Some(vec![1, 1, 320, 320]),
        nodes: vec![("Conv", vec!["slopes", "shift"]), ("Sigmoid", vec![])],
        constants: vec![
            ("slopes", vec![1, 3, 1, 1], SLOPES.map(|s| s * STEEP).to_vec()),
            ("shift", vec![1], vec![SHIFT * STEEP]),
        ],
        spare: 0,
    }
}

/// The BLAKE3 digest of a file.
pub(crate) fn digest(bytes: &[u8]) -> String {
    Digester::new().bytes(bytes).finish().hex()
}

/// A folder with a file of those bytes, and the stage that names it with its digest.
pub(crate) fn given(bytes: &[u8]) -> (tempfile::TempDir, Saliency) {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("tiny.onnx"), bytes).unwrap();
    let stage = Saliency { weights: "tiny.onnx".into(), digest: digest(bytes), ..Saliency::default() };
    (dir, stage)
}

/// What a run said.
#[derive(Default)]
pub(crate) struct Said(pub Mutex<Vec<String>>);

impl Listener for Said {
    fn event(&self, _: &str, _: &str, event: &Event) {
        if let Event::Warning(text) = event {
            self.0.lock().unwrap().push(text.clone());
        }
    }
}

/// Runs the stage on a photo, with files in that folder; gives its mask and its warnings.
pub(crate) fn run(stage: &Saliency, photo: &Photo, dir: &Path) -> (Result<Mask, StageError>, Vec<String>) {
    let said = Arc::new(Said::default());
    let cx = Context::new("Saliency", dir, Cancel::new(), said.clone());
    let photo: Arc<dyn Artifact> = Arc::new(photo.clone());
    let made = stage.run_ports(&Inputs(vec![Some(PortValue::One(photo))]), &cx);
    let mask = made.map(|made| {
        let first = made[0].entries()[0].1.clone();
        let any: &dyn std::any::Any = first.as_ref();
        any.downcast_ref::<Mask>().unwrap().clone()
    });
    let said = said.0.lock().unwrap().clone();
    (mask, said)
}

/// The mask of a photo by the tiny network.
pub(crate) fn mask_of(photo: &Photo) -> Mask {
    let (dir, stage) = given(&tiny().file());
    run(&stage, photo, dir.path()).0.unwrap()
}

/// Intersection over union.
pub(crate) fn overlap(a: &Mask, b: &Mask) -> f64 {
    let pairs = || a.pixels.as_raw().iter().zip(b.pixels.as_raw());
    let both = pairs().filter(|(a, b)| **a != 0 && **b != 0).count();
    let either = pairs().filter(|(a, b)| **a != 0 || **b != 0).count();
    both as f64 / either as f64
}
