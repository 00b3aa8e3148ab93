//! Scores the network, and `Auto` with and without it as a voice, on real photos with true masks.
//!
//!     TOILE_SHARED=... TOILE_SALIENCY_WEIGHTS=u2netp.onnx cargo run --release --example score [OUT_DIR]
//!
//! Reads `$TOILE_SHARED/data/photos/masks/*.png` and the photos beside them, prints the
//! intersection over union of each photo, the confidence of `Auto` and the times, and writes the
//! masks into OUT_DIR where one is given. Without the variables it prints "skipped".

#![allow(clippy::print_stdout)]

use image::GrayImage;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use toile_core::artifact::Digester;
use toile_core::prelude::*;
use toile_core::{Artifact, Cancel, Inputs, PortValue};
use toile_saliency::Saliency;
use toile_stages::binarise::Auto;
use toile_stages::denoise::NeighbourhoodMean;
use toile_stages::photo::decode;

/// What was found in a photo.
struct Found {
    mask: Mask,
    confidence: Option<f64>,
    seconds: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let named = |name: &str| std::env::var_os(name).map(PathBuf::from);
    let (Some(shared), Some(weights)) = (named("TOILE_SHARED"), named("TOILE_SALIENCY_WEIGHTS")) else {
        println!("skipped: TOILE_SHARED or TOILE_SALIENCY_WEIGHTS is not set");
        return Ok(());
    };
    let digest = Digester::new().bytes(&std::fs::read(&weights)?).finish().hex();
    println!("weights {digest}");
    let network = Saliency { weights: weights.display().to_string(), digest, ..Saliency::default() };
    let auto = Auto { confidence: 0.0, touch: 4.0, ..Auto::default() };
    let out = std::env::args().nth(1).map(PathBuf::from);
    score(&shared.join("data/photos"), &network, &auto, out.as_deref())
}

fn score(photos: &Path, network: &Saliency, auto: &Auto, out: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let mut names: Vec<String> = std::fs::read_dir(photos.join("masks"))?
        .filter_map(|e| Some(e.ok()?.file_name().to_str()?.strip_suffix(".png")?.to_owned()))
        .collect();
    names.sort();
    println!(
        "| photo | network | time | `Auto()` | confidence | with the network | confidence |\n|---|---|---|---|---|---|---|"
    );
    let mut sums = [0.0; 3];
    for name in &names {
        let photo = read(&photos.join(format!("{name}.jpg")))?;
        let truth = image::open(photos.join(format!("masks/{name}.png")))?.into_luma8();
        let seen = run(network, &photo, None)?;
        let (alone, told) = (run(auto, &photo, None)?, run(auto, &photo, Some(&seen.mask))?);
        let ious = [&seen, &alone, &told].map(|f| iou(&f.mask.pixels, &truth));
        sums.iter_mut().zip(ious).for_each(|(sum, iou)| *sum += iou);
        let sure = |f: &Found| f.confidence.unwrap_or(0.0);
        println!(
            "| {name} | {:.3} | {:.2} s | {:.3} | {:.2} | {:.3} | {:.2} |",
            ious[0],
            seen.seconds,
            ious[1],
            sure(&alone),
            ious[2],
            sure(&told)
        );
        for (found, what) in [(&seen, "network"), (&alone, "auto"), (&told, "both")] {
            if let Some(out) = out {
                picture(&photo, &found.mask, &truth, &out.join(format!("{name}.{what}.png")))?;
            }
        }
    }
    let [network, alone, both] = sums.map(|s| s / names.len() as f64);
    println!("| mean | {network:.3} | | {alone:.3} | | {both:.3} | |");
    Ok(())
}

fn read(file: &Path) -> Result<Photo, Box<dyn Error>> {
    let decoded = decode(&std::fs::read(file)?, &file.display().to_string())?;
    let photo = Photo {
        pixels: decoded.pixels.into(),
        alpha: decoded.alpha.map(Shared::new),
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
    };
    made(&NeighbourhoodMean::default(), vec![one(photo)], &Context::quiet())
}

fn one(artifact: impl Artifact) -> Option<PortValue> {
    Some(PortValue::One(Arc::new(artifact)))
}

/// The stage's only output.
fn made<T: Clone + 'static>(
    stage: &dyn Stage,
    inputs: Vec<Option<PortValue>>,
    cx: &Context,
) -> Result<T, Box<dyn Error>> {
    let out = stage.run_ports(&Inputs(inputs), cx)?;
    let first = out.first().and_then(|value| value.entries().first().map(|(_, a)| (*a).clone()));
    let any: &dyn std::any::Any = first.as_deref().ok_or("nothing was made")?;
    Ok(any.downcast_ref::<T>().cloned().ok_or("something else was made")?)
}

fn run(stage: &dyn Stage, photo: &Photo, given: Option<&Mask>) -> Result<Found, Box<dyn Error>> {
    let cx = Context::new("score", Path::new("."), Cancel::new(), Arc::new(()));
    let start = Instant::now();
    let mask = made(stage, vec![one(photo.clone()), given.and_then(|m| one(m.clone()))], &cx)?;
    let seconds = start.elapsed().as_secs_f64();
    let confidence = cx.take_figures().into_iter().find(|m| m.name == "confidence").map(|m| m.value);
    Ok(Found { mask, confidence, seconds })
}

fn iou(mask: &GrayImage, truth: &GrayImage) -> f64 {
    let pairs = || mask.as_raw().iter().zip(truth.as_raw());
    let both = pairs().filter(|(a, b)| **a > 127 && **b > 127).count();
    let either = pairs().filter(|(a, b)| **a > 127 || **b > 127).count();
    both as f64 / either.max(1) as f64
}

/// The photo with its ground dimmed; missed garment red, ground taken for garment green.
fn picture(photo: &Photo, mask: &Mask, truth: &GrayImage, file: &Path) -> Result<(), Box<dyn Error>> {
    let mut shown = photo.pixels.as_ref().clone();
    for ((p, on), truth) in shown.pixels_mut().zip(mask.pixels.as_raw()).zip(truth.as_raw()) {
        match (*on != 0, *truth > 127) {
            (true, false) => p.0[1] = 255,
            (false, true) => p.0[0] = 255,
            (false, false) => p.0 = p.0.map(|v| v / 4),
            (true, true) => {}
        }
    }
    Ok(shown.save(file)?)
}
