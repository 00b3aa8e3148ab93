//! A stage that gives what cannot be is named at once, before a later stage stumbles over it.
#![allow(clippy::unwrap_used)]

use image::{GrayImage, Luma};
use std::path::Path;
use std::sync::Arc;
use toile_core::prelude::*;
use toile_core::{Cancel, ErrorCode};
use toile_pipeline::load;
use toile_pipeline::{RunOptions, run};

/// Gives a mask with a grey pixel.
#[stage(role = Reader)]
struct Grey {}

#[stage]
impl Grey {
    fn run(&self, _cx: &Context) -> Result<Set<Mask>, StageError> {
        let pixels = Shared::new(GrayImage::from_pixel(2, 2, Luma([128])));
        Ok([("front".to_owned(), Mask { pixels })].into_iter().collect())
    }
}

/// Writes a file beside the output folder.
#[stage(role = Writer)]
struct Escape {}

#[stage]
impl Escape {
    fn run(&self, _cx: &Context) -> Result<OutputFiles, StageError> {
        Ok(OutputFiles::one("../secret.txt", vec![1]))
    }
}

fn error_of(stages: &str) -> StageError {
    let mut registry = Registry::new();
    registry.add::<Grey>().add::<Escape>();
    let text = format!("(stages: [{stages}])");
    let pipeline = load(&text, "test.ron", Path::new("."), &registry, &[]).unwrap();
    let listener: Arc<dyn toile_core::Listener> = Arc::new(());
    run(&pipeline, &RunOptions::default(), &Cancel::new(), &listener).unwrap_err().error
}

#[test]
fn a_grey_mask_is_the_stages_own_fault() {
    let error = error_of("Grey()");
    assert_eq!(error.code, ErrorCode::Internal);
    assert_eq!(error.message, "its mask \"front\" cannot be used: it has pixels between 0 and 255");
    assert_eq!(error.hint.unwrap(), "this is a bug of the stage, please report it to its author");
}

#[test]
fn no_stage_writes_outside_the_output_folder() {
    let message = error_of("Escape()").message;
    assert_eq!(message, "its files cannot be used: \"../secret.txt\" is not a path below the output folder");
}
