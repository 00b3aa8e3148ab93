//! The stage in a pipeline, loaded as a plugin.

use crate::kit::{digest, given, overlap, run, tiny};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_core::artifact::{Mask, Photo};
use toile_pipeline::{RunOptions, load};
use toile_core::testkit::{self, Trial};
use toile_core::{Cancel, Inputs, Listener, PortValue, Registry};
use toile_pipeline::plugin::load_plugin;

/// The library of this crate, which lies beside the tests' programs.
fn library() -> PathBuf {
    let (start, end) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    std::env::current_exe().unwrap().with_file_name(format!("{start}toile_saliency{end}"))
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    toile_stages::register(&mut registry);
    registry
}

/// The mask that the last stage leaves as a picture, of a pipeline with those stages.
fn mask_after(stages: &str, dir: &Path) -> Mask {
    testkit::photo().pixels.save(dir.join("front.png")).unwrap();
    let plugin = library();
    let text = format!(
        "(name: \"p\", plugins: [{plugin:?}], photos: {{\"front\": (file: \"front.png\", width: \"52 cm\")}}, stages: [{stages}])"
    );
    let pipeline = load(&text, "p.ron", dir, &registry(), &[]).unwrap_or_else(|e| panic!("{e:?}"));
    let until = pipeline.nodes.iter().rfind(|n| n.card.outputs[0].kind.0 == "mask").unwrap().id.clone();
    let options = RunOptions { until: Some(until), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let made = toile_pipeline::run(&pipeline, &options, &Cancel::new(), &listener).unwrap();
    let picture = made.files.iter().find(|f| f.path.ends_with(".png")).unwrap();
    Mask { pixels: image::load_from_memory(&picture.bytes).unwrap().into_luma8().into() }
}

#[test]
fn it_stands_alone_or_before_auto() {
    let bytes = tiny().file();
    let (dir, _) = given(&bytes);
    let stage = format!("Saliency(weights: \"tiny.onnx\", digest: \"{}\")", digest(&bytes));
    for stages in [stage.clone(), format!("{stage}, Auto()")] {
        let found = overlap(&mask_after(&stages, dir.path()), &testkit::mask());
        assert!(found > 0.97, "{stages}: {found}");
    }
}

#[test]
fn it_gives_the_same_bits_loaded_and_linked_in() {
    let (dir, own) = given(&tiny().file());
    let mut registry = Registry::new();
    load_plugin(&mut registry, &library(), None).unwrap();
    let arguments = format!("(weights: \"tiny.onnx\", digest: \"{}\")", own.digest);
    let foreign = registry.make(registry.card("Saliency").unwrap(), &arguments).unwrap();
    let photo: PortValue = PortValue::One(Arc::new(testkit::photo()));
    let answer =
        |stage| Trial { stage, folder: dir.path() }.run(&Inputs(vec![Some(photo.clone())])).fingerprint();
    assert_eq!(answer(&own), answer(foreign.as_ref()));
    let empty = Photo { pixels: image::RgbImage::new(0, 0).into(), ..testkit::photo() };
    assert_eq!(run(&own, &empty, dir.path()).0.unwrap_err().message, "photo \"suite.png\" has no pixels");
}

#[test]
fn a_file_that_is_not_there_is_told_before_the_run() {
    let mut registry = registry();
    toile_saliency::register(&mut registry);
    let text = "(name: \"p\", photos: {\"front\": (file: \"front.png\", width: \"52 cm\")}, stages: [Saliency(weights: \"gone.onnx\"), Auto()])";
    let (dir, _) = given(&tiny().file());
    testkit::photo().pixels.save(dir.path().join("front.png")).unwrap();
    let pipeline = load(text, "p.ron", dir.path(), &registry, &[]).unwrap();
    let told = toile_pipeline::faults(&pipeline, |_| true, None).unwrap_err().to_string();
    assert!(told.contains("cannot read \"gone.onnx\": no such file"), "{told}");
}

/// The lines of the README's block of RON that name a plugin or stages.
fn readme() -> (String, String) {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let block = text.split("```ron\n").nth(1).unwrap().split("```").next().unwrap().to_owned();
    let (plugins, stages) = block.split_once("    stages: [\n").unwrap();
    (plugins.to_owned(), stages.replace("        // ...\n    ],\n", ""))
}

#[test]
fn the_readmes_lines_fit_into_the_shipped_pipeline() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../pipelines");
    let photo = std::fs::read_to_string(folder.join("photo.ron")).unwrap();
    let (plugins, stages) = readme();
    assert!(plugins.contains("toile_saliency") && stages.contains("Saliency(") && stages.contains("Auto()"));
    let written = plugins.split('"').nth(1).unwrap();
    let text = photo.replacen("    photos: {", &format!("{plugins}    photos: {{"), 1);
    let lines = |text: &str| {
        text.lines()
            .filter(|l| !l.contains("NeighbourhoodMean(") && !l.trim().starts_with("Auto()"))
            .map(|l| format!("{l}\n"))
            .collect::<String>()
    };
    let text = lines(&text).replacen("    stages: [\n", &format!("    stages: [\n{stages}"), 1);
    let text = text.replace(written, &library().display().to_string());
    let pipeline =
        load(&text, "photo.ron", &folder, &registry(), &[]).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    let ids: Vec<&str> = pipeline.nodes.iter().map(|n| n.id.as_str()).collect();
    let at = |id: &str| ids.iter().position(|i| *i == id).unwrap();
    assert!(at("Saliency") < at("Auto") && at("Auto") < at("Canny"), "{ids:?}");
}
