//! The files of a measurement: CSV, JSON, the picture twice, and a page on which each setting shows
//! its garment.

use crate::measure::Ran;
use crate::plot::{marks, png, svg};
use crate::record::{Clock, Measured, SettingOutcome, Trade};
use crate::table::{by_time, csv, reference, setting_of, whose_memory};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use minijinja::Environment;
use minijinja::value::{Serde, Value};
use serde::Serialize;
use std::path::Path;
use toile_core::StageError;
use toile_core::artifact::OutputFile;
use toile_stages::render::{ModelScene, View, garment_model};

/// Height of a garment's picture, px: folds show, and forty settings make a page of a megabyte.
const HEIGHT: u32 = 300;
/// JPEG quality of the pictures.
const QUALITY: u8 = 82;
/// The name of the page's template: autoescaped, since it ends in `.html`.
const TEMPLATE_NAME: &str = "trade.html";
/// The page's template.
const TEMPLATE: &str = include_str!("page.html");

/// Front and side of a run's garment, as files of the folder.
pub(crate) fn pictures(key: &str, ran: &Ran) -> Vec<OutputFile> {
    let plain;
    let model = match &ran.model {
        Some(model) => model,
        None => {
            plain = garment_model(&ran.garment, ran.body.as_ref());
            &plain
        }
    };
    let scene = ModelScene::draft(model);
    let shot = |(name, view): (&str, View)| {
        let mut bytes = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut bytes, QUALITY);
        scene.render(&view).write_with_encoder(encoder).ok()?;
        Some(OutputFile { path: picture(key, name), bytes })
    };
    [("front", View::front(HEIGHT)), ("side", View::side(HEIGHT))].into_iter().filter_map(shot).collect()
}

fn picture(key: &str, name: &str) -> String {
    format!("points/{key}-{name}.jpg")
}

/// All files of a measurement; pictures of garments are read from `folder`.
///
/// Errors: a fault of the program's own.
pub fn files(trade: &Trade, folder: &Path) -> Result<Vec<OutputFile>, StageError> {
    let fault = |what: &str, e: String| StageError::internal(format!("the {what} cannot be written: {e}"));
    let json = serde_json::to_string_pretty(trade).map_err(|e| fault("record", e.to_string()))?;
    let marks = marks(trade);
    let drawing = svg(&marks);
    let page = html(trade, &drawing, folder).map_err(|e| fault("page", e.to_string()))?;
    let file = |path: &str, bytes: Vec<u8>| OutputFile { path: path.into(), bytes };
    Ok(vec![
        file("trade.csv", csv(trade).into_bytes()),
        file("trade.json", json.into_bytes()),
        file("trade.png", png(&marks)),
        file("trade.svg", drawing.into_bytes()),
        file("trade.html", page.into_bytes()),
    ])
}

/// What the template shows.
#[derive(Serialize)]
struct StudyPage {
    pipeline: String,
    file: String,
    about: String,
    drawing: String,
    reference: Vec<String>,
    knobs: Vec<[String; 2]>,
    points: Vec<SettingEntry>,
    missed: Vec<[String; 2]>,
}

/// One setting.
#[derive(Serialize)]
struct SettingEntry {
    number: usize,
    on_front: bool,
    sound: bool,
    setting: String,
    pictures: Vec<String>,
    figures: Vec<[String; 2]>,
    shortfalls: Vec<String>,
}

fn html(trade: &Trade, drawing: &str, folder: &Path) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.add_template(TEMPLATE_NAME, TEMPLATE)?;
    environment.get_template(TEMPLATE_NAME)?.render(Value::from(Serde(page(trade, drawing, folder))))
}

fn page(trade: &Trade, drawing: &str, folder: &Path) -> StudyPage {
    let machine = &trade.machine;
    let load = machine.load.map_or_else(String::new, |l| format!(", load {l:.1}"));
    let ran = by_time(trade).into_iter().filter_map(|i| Some((i, trade.points[i].measured()?)));
    StudyPage {
        pipeline: trade.pipeline.clone(),
        file: trade.file.clone(),
        about: format!(
            "toile {}, {}, {}, {} threads{load}; memory is {}",
            trade.toile,
            trade.date,
            machine.system,
            machine.threads,
            whose_memory(trade)
        ),
        drawing: drawing.to_owned(),
        reference: reference(trade),
        knobs: trade.knobs.iter().map(|k| [k.key.clone(), k.values.clone()]).collect(),
        points: ran.map(|(i, m)| entry(trade, i, m, folder)).collect(),
        missed: trade.points.iter().filter_map(|p| Some([setting_of(trade, p), why(&p.outcome)?])).collect(),
    }
}

fn why(outcome: &SettingOutcome) -> Option<String> {
    match outcome {
        SettingOutcome::Measured(_) => None,
        SettingOutcome::Failed { message, .. } => Some(message.clone()),
        SettingOutcome::OverLimit { seconds } => Some(format!("stopped after {seconds:.0} s")),
    }
}

fn entry(trade: &Trade, i: usize, m: &Measured, folder: &Path) -> SettingEntry {
    let point = &trade.points[i];
    let inline = |name: &str| {
        let bytes = toile_core::read_file(&folder.join(picture(&point.key, name))).ok()?;
        Some(format!("data:image/jpeg;base64,{}", STANDARD.encode(bytes)))
    };
    SettingEntry {
        number: i + 1,
        on_front: trade.front.contains(&i),
        sound: m.sound,
        setting: setting_of(trade, point),
        pictures: ["front", "side"].into_iter().filter_map(inline).collect(),
        figures: figures(m),
        shortfalls: m.shortfalls.iter().map(|(_, message)| message.clone()).collect(),
    }
}

fn figures(m: &Measured) -> Vec<[String; 2]> {
    let e = &m.errors;
    let times = |clock| {
        format!("{:.2} s (spread {:.2} s over {} runs)", m.time(clock), m.time_spread(clock), m.wall_s.len())
    };
    let three = |d: &crate::errors::Millimetres| format!("{:.2} / {:.2} / {:.2} mm", d.mean, d.p95, d.max);
    let ease = e.ease_mm.iter().map(|(name, x)| format!("{name} {x:+.1}")).collect::<Vec<_>>().join(", ");
    let rows = [
        ("wall time", Some(times(Clock::Wall))),
        ("processor time", Some(times(Clock::Cpu))),
        ("memory", m.peak_memory_bytes.map(|b| format!("{:.0} MB", b as f64 / 1e6))),
        ("triangles", Some(m.triangles.to_string())),
        ("distance: mean / 95 % / worst", Some(three(&e.distance_mm))),
        ("displacement: mean / 95 % / worst", Some(three(&e.displacement_mm))),
        ("ease, difference in mm", Some(ease).filter(|t| !t.is_empty())),
        ("seam gap", Some(format!("{:.2} mm", e.seam_gap_mm))),
        ("area", Some(format!("{:.2} points", e.area_pp))),
        ("outline", Some(format!("{:.2} points", e.outline_pp))),
        ("strain p99", Some(format!("{:+.2} points", e.strain_p99_pp))),
        ("silhouette: front, side", Some(format!("{:.4}, {:.4}", e.silhouette_front, e.silhouette_side))),
        ("texture", e.texture_levels.map(|t| format!("{t:.1} grey levels"))),
        ("repeatable", (!m.repeatable).then(|| "no: its runs gave other garments".to_owned())),
    ];
    rows.into_iter().filter_map(|(name, text)| Some([name.to_owned(), text?])).collect()
}
