//! What these tests share.

use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::{Artifact, Outline, Photo, Point2, Shared};
use toile_core::plugin::Refused;
use toile_core::{Context, Inputs, PortValue, Registry, Stage, StageError};
use toile_pipeline::plugin::load_plugin;
use toile_tests::plugins::{compiled, library};

/// The built-in stages and those of plugins.
pub(crate) fn registry_with(names: &[&str]) -> Registry {
    let mut registry = toile::registry();
    for name in names {
        load_plugin(&mut registry, &library(name), None).unwrap();
    }
    registry
}

pub(crate) fn make(registry: &Registry, name: &str, arguments: &str) -> Box<dyn Stage> {
    registry.make(registry.card(name).unwrap(), arguments).unwrap()
}

pub(crate) fn photo() -> Photo {
    let pixels = image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([(x * 6) as u8, (y * 8) as u8, 99]));
    Photo {
        pixels: Shared::new(pixels),
        alpha: None,
        px_per_metre: Some(500.0),
        garment_width: Some(0.5),
        mirrored: false,
        joined: 1,
        file: "front.jpg".into(),
    }
}

pub(crate) fn outline() -> Outline {
    let points = vec![Point2::new(0.0, 0.0), Point2::new(0.1, 0.0), Point2::new(0.0, 0.2)];
    let outer = toile_core::artifact::Loop { points, corners: vec![0, 1, 2] };
    Outline { outer, holes: vec![], edges: vec![], inner: vec![], frame: None, lies: vec![] }
}

/// Runs a stage on single values.
pub(crate) fn run(stage: &dyn Stage, inputs: Vec<Arc<dyn Artifact>>) -> Result<Vec<PortValue>, StageError> {
    run_in(stage, inputs, &Context::quiet())
}

pub(crate) fn run_in(
    stage: &dyn Stage,
    inputs: Vec<Arc<dyn Artifact>>,
    cx: &Context,
) -> Result<Vec<PortValue>, StageError> {
    stage.run_ports(&Inputs(inputs.into_iter().map(|a| Some(PortValue::One(a))).collect()), cx)
}

/// The artifact on the only port, in its own words.
pub(crate) fn only(made: &[PortValue]) -> String {
    assert_eq!(made.len(), 1);
    format!("{:?}", made[0].entries()[0].1)
}

/// A plugin of `tests/faulty/bad.c`, wrong in one way.
pub(crate) fn bad(case: &str, dir: &Path) -> Result<Registry, Refused> {
    let library = compiled("tests/faulty/bad.c", dir, &[&format!("-DCASE_{case}")]).unwrap();
    let mut registry = toile::registry();
    load_plugin(&mut registry, &library, None).map(|()| registry)
}
