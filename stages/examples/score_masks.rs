//! Scores the binarisers on real photos with true masks.
//!
//!     TOILE_SHARED=... cargo run --release -p toile-stages --example score_masks [OUT_DIR] ["STAGE(...)"]...
//!
//! Reads `$TOILE_SHARED/data/photos/*.jpg` and `masks/*.png`, prints the intersection over union of
//! each photo and stage, and writes the masks beside the photos into OUT_DIR where one is given.
//! Without `TOILE_SHARED` it prints "skipped".

#![allow(clippy::print_stdout)]

use image::GrayImage;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use toile_core::param::ron_options;
use toile_core::prelude::*;
use toile_core::{Inputs, PortValue};
use toile_stages::binarise::{Auto, Background, GraphCut, Local, Otsu};
use toile_stages::denoise::NeighbourhoodMean;
use toile_stages::photo::decode;

fn main() -> Result<(), Box<dyn Error>> {
    let Some(shared) = std::env::var_os("TOILE_SHARED") else {
        println!("skipped: TOILE_SHARED is not set");
        return Ok(());
    };
    let photos = Path::new(&shared).join("data/photos");
    let mut args = std::env::args().skip(1);
    let out = args.next().map(PathBuf::from);
    let given: Vec<String> = args.collect();
    let all = ["Otsu()", "Local()", "Background()", "GraphCut()", "Auto()"].map(str::to_owned);
    let texts = if given.is_empty() { all.to_vec() } else { given };
    let stages = texts.into_iter().map(|t| stage(&t).map(|s| (t, s))).collect::<Result<Vec<_>, _>>()?;
    score(&photos, &stages, out.as_deref())
}

/// The stage of a text such as `GraphCut(rounds: 2)`.
fn stage(text: &str) -> Result<Box<dyn Stage>, Box<dyn Error>> {
    let (name, params) = text.strip_suffix(')').and_then(|t| t.split_once('(')).ok_or("write STAGE(...)")?;
    match name {
        "Otsu" => parse::<Otsu>(params),
        "Local" => parse::<Local>(params),
        "Background" => parse::<Background>(params),
        "GraphCut" => parse::<GraphCut>(params),
        "Auto" => parse::<Auto>(params),
        _ => Err("no such stage".into()),
    }
}

/// Some of the true masks hold garments that the frame cuts, which the default refuses.
fn parse<S: Stage + serde::de::DeserializeOwned + 'static>(
    set: &str,
) -> Result<Box<dyn Stage>, Box<dyn Error>> {
    Ok(Box::new(ron_options().from_str::<S>(&format!("(touch: 4, {set})"))?))
}

fn score(
    photos: &Path,
    stages: &[(String, Box<dyn Stage>)],
    out: Option<&Path>,
) -> Result<(), Box<dyn Error>> {
    let mut names: Vec<String> = std::fs::read_dir(photos)?
        .filter_map(|e| Some(e.ok()?.path().file_stem()?.to_str()?.to_owned()))
        .filter(|n| photos.join(format!("{n}.jpg")).is_file())
        .collect();
    names.sort();
    names.dedup();
    println!(
        "{:36}{}",
        "photo",
        stages.iter().map(|(n, _)| format!("{:>20}", n.split('(').next().unwrap_or(n))).collect::<String>()
    );
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); stages.len()];
    for name in &names {
        let file = photos.join(format!("{name}.jpg"));
        let photo = read(&file)?;
        let truth = photos.join(format!("masks/{name}.png"));
        let truth = if truth.is_file() { Some(image::open(truth)?.into_luma8()) } else { None };
        let mut line = format!("{name:36}");
        for ((stage, column), (label, _)) in stages.iter().zip(&mut columns).zip(stages) {
            let start = Instant::now();
            let result = run(stage.1.as_ref(), &photo);
            let ms = start.elapsed().as_secs_f64() * 1e3;
            let cell = match (&result, &truth) {
                (Ok(mask), Some(truth)) => {
                    let iou = iou(&mask.pixels, truth);
                    column.push(iou);
                    format!("{iou:.3}")
                }
                (Ok(_), None) => "-".into(),
                (Err(e), _) => {
                    if truth.is_some() {
                        column.push(0.0);
                    }
                    e.message
                        .split(" in \"")
                        .next()
                        .unwrap_or("")
                        .replace("the garment", "cut")
                        .chars()
                        .take(11)
                        .collect()
                }
            };
            line += &format!("{:>20}", format!("{cell} {ms:.0} ms"));
            if let (Some(out), Ok(mask)) = (out, &result) {
                picture(
                    &photo,
                    mask,
                    truth.as_ref(),
                    &out.join(format!("{name}.{}.png", label.split('(').next().unwrap_or(label))),
                )?;
            }
        }
        println!("{line}");
    }
    summary("median", &columns, |c| c[c.len() / 2]);
    summary("mean", &columns, |c| c.iter().sum::<f64>() / c.len() as f64);
    summary("0.95 and more, share", &columns, |c| {
        c.iter().filter(|v| **v >= 0.95).count() as f64 / c.len() as f64
    });
    Ok(())
}

fn summary(label: &str, columns: &[Vec<f64>], of: impl Fn(&[f64]) -> f64) {
    let cells = columns.iter().map(|c| {
        let mut sorted = c.clone();
        sorted.sort_by(f64::total_cmp);
        format!("{:>20}", if sorted.is_empty() { "-".into() } else { format!("{:.3}", of(&sorted)) })
    });
    println!("{label:36}{}", cells.collect::<String>());
}

fn read(file: &Path) -> Result<Photo, Box<dyn Error>> {
    let name = file.display().to_string();
    let decoded = decode(&std::fs::read(file)?, &name)?;
    Ok(Photo {
        pixels: decoded.pixels.into(),
        alpha: decoded.alpha.map(Shared::new),
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
    })
}

/// The stage's mask of the photo, denoised as pipelines do by default.
fn run(stage: &dyn Stage, photo: &Photo) -> Result<Mask, StageError> {
    let cx = Context::quiet();
    let smooth = NeighbourhoodMean::default()
        .run_ports(&Inputs(vec![Some(PortValue::One(Arc::new(photo.clone())))]), &cx)?;
    // The first port takes the photo; the others may be left out.
    let inputs = (0..stage.card().inputs.len()).map(|k| smooth.first().filter(|_| k == 0).cloned()).collect();
    let out = stage.run_ports(&Inputs(inputs), &cx)?;
    match out.first() {
        Some(PortValue::One(mask)) => {
            let any: &dyn std::any::Any = mask.as_ref();
            any.downcast_ref::<Mask>().cloned().ok_or_else(|| StageError::internal("no mask"))
        }
        _ => Err(StageError::internal("no mask")),
    }
}

fn iou(mask: &GrayImage, truth: &GrayImage) -> f64 {
    let pairs = || mask.as_raw().iter().zip(truth.as_raw());
    let both = pairs().filter(|(a, b)| **a > 127 && **b > 127).count();
    let either = pairs().filter(|(a, b)| **a > 127 || **b > 127).count();
    both as f64 / either.max(1) as f64
}

/// The photo with its ground dimmed; missed garment red, ground taken for garment green.
fn picture(photo: &Photo, mask: &Mask, truth: Option<&GrayImage>, file: &Path) -> Result<(), Box<dyn Error>> {
    let mut shown = photo.pixels.as_ref().clone();
    for (i, p) in shown.pixels_mut().enumerate() {
        let on = mask.pixels.as_raw()[i] != 0;
        match (on, truth.map(|t| t.as_raw()[i] > 127)) {
            (true, Some(false)) => p.0[1] = 255,
            (false, Some(true)) => p.0[0] = 255,
            (false, _) => p.0 = p.0.map(|v| v / 4),
            _ => {}
        }
    }
    Ok(shown.save(file)?)
}
