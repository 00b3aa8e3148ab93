//! What stands on the report's page, gathered from the run's record.

use crate::fit::Fit;
use crate::render::{ArtifactPicture, ModelScene, PictureForm, View, jpeg, pictures_of, thumbnail};
use crate::write::reporting::outline::outlined;
use crate::write::reporting::pieces::pieces;
use crate::write::reporting::top::{self, ResultVerdict, StageRemark, verdict, warnings};
use crate::write::reporting::turn::{TurnedGarment, turn};
use crate::write::reporting::views::{Views, taken};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::collections::BTreeMap;
use toile_core::artifact::{
    Artifact, Body, Digester, Figures, Garment, GarmentPanel, Measure, Model, Outline, OutputFiles,
    PanelFigures, Photo, SeamState, SewingPlan, StrainFigures, quantile, stored,
};
use toile_core::cost::Estimate;
use toile_core::{Context, StageError, StageMeta};
use toile_core::{RunLog, StageRecord};

/// Pictures of one page in bytes, as they stand in it: keeps the page fit for mail.
const PICTURE_BUDGET: usize = 2_600_000;

/// Height of the three views at the head, px.
pub(crate) const VIEW_HEIGHT: u32 = 640;
/// A longer text output of a stage is cut.
const MOST_NOTES: usize = 24;

/// The page.
#[derive(Debug, Serialize)]
pub(crate) struct ReportPage {
    title: String,
    /// The named quality; empty where none was requested.
    quality: String,
    version: &'static str,
    total: String,
    /// Why the run ended early; none if it came to its end.
    failure: Option<EarlyEnd>,
    verdict: ResultVerdict,
    warnings: Vec<StageRemark>,
    /// What stages decided.
    decisions: Vec<StageRemark>,
    views: Vec<Shown>,
    turn: Option<TurnedGarment>,
    outlines: Vec<Shown>,
    pieces: Vec<Shown>,
    /// Ease and finished measures.
    fit: Vec<Vec<NamedValue>>,
    /// Strain, tension and pressure on the cloth.
    maps: Vec<Shown>,
    shortfalls: Vec<String>,
    figures: Vec<Vec<NamedValue>>,
    stages: Vec<StageSection>,
    skipped: Vec<NamedValue>,
}

/// Why a run ended early.
#[derive(Debug, Serialize)]
struct EarlyEnd {
    stage: String,
    message: String,
    /// Empty where no remedy is known.
    hint: String,
    /// Details behind the message; empty where there are none.
    detail: String,
}

/// A picture as the page holds it.
#[derive(Debug, Serialize, Deserialize)]
struct Shown {
    caption: String,
    /// A data URI: nothing in it needs escaping.
    src: String,
}

/// A name and a value.
#[derive(Debug, Serialize)]
struct NamedValue {
    name: String,
    value: String,
}

#[derive(Debug, Serialize)]
struct StageSection {
    id: String,
    name: String,
    role: &'static str,
    params: String,
    wall: String,
    /// What was expected before the run; empty where no prediction was requested.
    expected: String,
    /// Per cent of the longest stage.
    share: String,
    warnings: Vec<String>,
    figures: Vec<NamedValue>,
    pictures: Vec<Shown>,
    left_out: usize,
    notes: Vec<String>,
    outputs: Vec<StageOutput>,
}

#[derive(Debug, Serialize)]
struct StageOutput {
    name: String,
    measures: Vec<NamedValue>,
}

/// Gathers the page; `height` is that of the stages' pictures.
pub(crate) fn page(run: &RunLog, height: u32, views: Views, cx: &Context) -> Result<ReportPage, StageError> {
    let longest = run.stages.iter().map(|s| s.wall_s).fold(1e-9, f64::max);
    let total = run.stages.iter().fold(0.0, |sum, s| sum + s.wall_s);
    let mut budget = PICTURE_BUDGET;
    let model = last::<Model>(run, run.stages.len());
    let heads = model.map_or(Ok(Vec::new()), |model| heads(run, model, views, cx))?;
    let draw = Draw { run, height, model, heads, cx };
    let garment = last::<Garment>(run, run.stages.len());
    let views = match (&run.failure, garment) {
        (Some(_), Some(garment)) if model.is_none() => unfinished(garment, last(run, run.stages.len())),
        _ => draw.heads_at(VIEW_HEIGHT),
    };
    let views = within(shown(views), &mut budget).0;
    let missed = shortfalls(run);
    let outlines = within(shown(outlines(run, height)), &mut budget).0;
    let maps =
        within(shown(fit_files(run).map_or_else(Vec::new, |f| pictures_of(f, None, height))), &mut budget).0;
    let drawn = |i: usize| {
        cx.check()?;
        cx.progress(i as f64 / run.stages.len() as f64, format!("pictures of {}", run.stages[i].id));
        Ok(draw.stage(i))
    };
    let pictures: Vec<Vec<Shown>> =
        (0..run.stages.len()).into_par_iter().map(drawn).collect::<Result<_, StageError>>()?;
    let sections = run.stages.iter().zip(pictures);
    let stages = sections.map(|(record, shown)| section(record, shown, longest, &mut budget)).collect();
    let skipped = run.skipped.iter().map(|(name, why)| NamedValue { name: name.clone(), value: why.clone() });
    Ok(ReportPage {
        title: if run.pipeline.is_empty() { "A garment".to_owned() } else { run.pipeline.clone() },
        quality: run.quality.clone().unwrap_or_default(),
        version: env!("CARGO_PKG_VERSION"),
        total: seconds(total),
        failure: run.failure.as_ref().map(|f| EarlyEnd {
            stage: f.stage.clone(),
            message: f.message.clone(),
            hint: f.hint.clone().unwrap_or_default(),
            detail: f.detail.clone().unwrap_or_default(),
        }),
        verdict: verdict(run, garment, missed.len()),
        warnings: warnings(run),
        decisions: top::notes(run),
        turn: turn(run.stages.iter().flat_map(entries).filter_map(|(_, a)| is(a))),
        outlines,
        pieces: shown(garment.and_then(pieces).into_iter().collect()),
        fit: fit_files(run).map(fit).unwrap_or_default(),
        maps,
        views,
        shortfalls: missed,
        figures: key_figures(run),
        stages,
        skipped: skipped.collect(),
    })
}

/// A garment that a run left unfinished, with its open seams.
fn unfinished(garment: &Garment, body: Option<&Body>) -> Vec<ArtifactPicture> {
    let told = |p: ArtifactPicture| ArtifactPicture {
        caption: format!("{} of what the run left; threads of seams that are not closed are red", p.caption),
        ..p
    };
    pictures_of(garment, body, VIEW_HEIGHT).into_iter().map(told).collect()
}

fn section(record: &StageRecord, shown: Vec<Shown>, longest: f64, budget: &mut usize) -> StageSection {
    let (pictures, left_out) = within(shown, budget);
    StageSection {
        id: record.id.clone(),
        name: record.name.clone(),
        role: record.role.as_str(),
        params: record.params.clone(),
        wall: seconds(record.wall_s),
        expected: record.predicted.and_then(|p| p.wall_s).map_or_else(String::new, expected),
        share: format!("{:.1}", (record.wall_s / longest * 100.0).clamp(0.0, 100.0)),
        warnings: record.remarks.warnings.clone(),
        figures: record.figures.iter().map(figure).collect(),
        pictures,
        left_out,
        notes: entries(record).flat_map(|(_, a)| notes(a)).take(MOST_NOTES).collect(),
        outputs: entries(record)
            .map(|(name, a)| output(name, a))
            .filter(|o| !o.measures.is_empty())
            .collect(),
    }
}

/// Every artifact that a stage made, with its name in its set.
fn entries(record: &StageRecord) -> impl Iterator<Item = (&str, &dyn Artifact)> {
    record.outputs.iter().flat_map(|value| value.entries()).map(|(name, artifact)| (name, artifact.as_ref()))
}

fn is<T: 'static>(artifact: &dyn Artifact) -> Option<&T> {
    let any: &dyn Any = artifact;
    any.downcast_ref()
}

/// The last artifact of a type among the first `stages` stages.
fn last<T: 'static>(run: &RunLog, stages: usize) -> Option<&T> {
    run.stages[..stages].iter().rev().flat_map(entries).find_map(|(_, a)| is(a))
}

/// What pictures are drawn from.
struct Draw<'a> {
    run: &'a RunLog,
    /// Height of the stages' pictures.
    height: u32,
    /// The last model.
    model: Option<&'a Model>,
    /// It from the front, the back and the side.
    heads: Vec<(&'static str, RgbImage)>,
    cx: &'a Context,
}

impl Draw<'_> {
    /// Pictures of what a stage made, in the order of its outputs.
    fn stage(&self, index: usize) -> Vec<Shown> {
        if self.run.stages[index].name == Fit::NAME {
            // Its maps stand at the head.
            return Vec::new();
        }
        let body = last::<Body>(self.run, index);
        let made: Vec<(&str, &dyn Artifact)> = entries(&self.run.stages[index]).collect();
        let each = |(name, artifact): &(&str, &dyn Artifact)| {
            let named = |p: Shown| Shown { caption: caption(name, &p.caption), ..p };
            self.artifact(*artifact, body).into_iter().map(named).collect::<Vec<_>>()
        };
        made.par_iter().flat_map_iter(each).collect()
    }

    fn artifact(&self, artifact: &dyn Artifact, body: Option<&Body>) -> Vec<Shown> {
        match (self.model, is::<Model>(artifact)) {
            (Some(last), Some(this)) if std::ptr::eq(last, this) => {
                shown(self.heads_at(self.height).into_iter().take(2).collect())
            }
            _ => self.known(artifact, body),
        }
    }

    /// Pictures of an artifact that an earlier page may have shown: then they need not be drawn
    /// again.
    fn known(&self, artifact: &dyn Artifact, body: Option<&Body>) -> Vec<Shown> {
        let draw = || shown(pictures_of(artifact, body, self.height));
        let Some(bytes) = stored::encode(artifact) else { return draw() };
        let mut key = Digester::new();
        key.text("pictures")
            .count(self.height as usize)
            .text(artifact.kind().0)
            .count(bytes.len())
            .bytes(&bytes);
        if let (Some(_), Some(behind)) = (is::<Garment>(artifact), body.and_then(|b| stored::encode(b))) {
            key.bytes(&behind);
        }
        let bytes = self.cx.memo(&key, || Ok(serde_json::to_vec(&draw()).unwrap_or_default()));
        bytes.ok().and_then(|b| serde_json::from_slice(&b).ok()).unwrap_or_else(draw)
    }

    /// The views at the head, at most so high.
    fn heads_at(&self, height: u32) -> Vec<ArtifactPicture> {
        let picture = |(name, head): &(&str, RgbImage)| {
            let form = jpeg(&thumbnail(head, height))?;
            Some(ArtifactPicture { caption: (*name).to_owned(), form })
        };
        self.heads.par_iter().map(picture).collect::<Vec<_>>().into_iter().flatten().collect()
    }
}

/// The outlines over their photos: those that the last stage that names outlines left, on the
/// photos as they were read.
fn outlines(run: &RunLog, height: u32) -> Vec<ArtifactPicture> {
    let photos = run.stages.iter().find(|s| entries(s).any(|(_, a)| is::<Photo>(a).is_some()));
    let found = run.stages.iter().rev().find(|s| entries(s).any(|(_, a)| is::<Outline>(a).is_some()));
    let (Some(photos), Some(found)) = (photos, found) else { return Vec::new() };
    let photo = |name: &str| entries(photos).find(|(n, _)| *n == name).and_then(|(_, a)| is::<Photo>(a));
    let of = |(name, a): (&str, &dyn Artifact)| outlined(name, photo(name)?, is(a)?, height);
    entries(found).filter_map(of).collect()
}

/// What `Fit` has written.
fn fit_files(run: &RunLog) -> Option<&OutputFiles> {
    let fit = run.stages.iter().rev().find(|s| s.name == Fit::NAME)?;
    entries(fit).find_map(|(_, a)| is(a))
}

/// Ease and finished measures from the file of `Fit`, in centimetres.
fn fit(files: &OutputFiles) -> Vec<Vec<NamedValue>> {
    let json = files.0.iter().find(|f| f.path.ends_with(".json"));
    let json: serde_json::Value =
        json.and_then(|f| serde_json::from_slice(&f.bytes).ok()).unwrap_or_default();
    let cm = |v: &serde_json::Value| format!("{:.1} cm", 1e2 * v.as_f64().unwrap_or(0.0));
    let rows = |key: &str, row: &dyn Fn(&str, &serde_json::Value) -> NamedValue| -> Vec<NamedValue> {
        json[key].as_object().into_iter().flatten().map(|(name, v)| row(&name.replace('_', " "), v)).collect()
    };
    let ease = |name: &str, v: &serde_json::Value| {
        let value = format!("{} (cloth {}, body {})", cm(&v["ease"]), cm(&v["cloth"]), cm(&v["body"]));
        NamedValue { name: format!("ease, {name}"), value }
    };
    let measure = |name: &str, v: &serde_json::Value| NamedValue { name: name.to_owned(), value: cm(v) };
    vec![rows("ease", &ease), rows("measures", &measure)]
}

/// The three views at the head.
fn heads(
    run: &RunLog,
    model: &Model,
    views: Views,
    cx: &Context,
) -> Result<Vec<(&'static str, RgbImage)>, StageError> {
    let names = ["front", "back", "left side"];
    if let Some(pictures) = (views == Views::Taken).then(|| taken(run, VIEW_HEIGHT)).flatten() {
        return Ok(names.into_iter().zip(pictures).collect());
    }
    let scene = ModelScene::draft_in(model, cx)?;
    let drawn = [View::front as fn(u32) -> View, View::back, View::side];
    let named: Vec<_> = names.into_iter().zip(drawn).collect();
    let heads = named.par_iter().map(|(name, view)| (*name, scene.render(&view(VIEW_HEIGHT)))).collect();
    cx.check().map(|()| heads)
}

fn caption(name: &str, detail: &str) -> String {
    match (name, detail) {
        ("", detail) => detail.to_owned(),
        (name, "") => name.to_owned(),
        (name, detail) => format!("{name}, {detail}"),
    }
}

/// Pictures as data URIs.
fn shown(pictures: Vec<ArtifactPicture>) -> Vec<Shown> {
    pictures.into_iter().map(|p| Shown { src: data_uri(&p.form), caption: p.caption }).collect()
}

/// Pictures as far as the budget goes, and the number of those left out.
fn within(pictures: Vec<Shown>, budget: &mut usize) -> (Vec<Shown>, usize) {
    let count = pictures.len();
    let mut kept = Vec::new();
    for picture in pictures {
        if picture.src.len() <= *budget {
            *budget -= picture.src.len();
            kept.push(picture);
        }
    }
    let left_out = count - kept.len();
    (kept, left_out)
}

fn data_uri(form: &PictureForm) -> String {
    let (mime, bytes) = match form {
        PictureForm::Png(bytes) => ("image/png", bytes.as_slice()),
        PictureForm::Jpeg(bytes) => ("image/jpeg", bytes.as_slice()),
        PictureForm::Svg(text) => ("image/svg+xml", text.as_bytes()),
    };
    format!("data:{mime};base64,{}", STANDARD.encode(bytes))
}

/// Lines of an artifact that has text rather than a picture: files written, seams.
fn notes(artifact: &dyn Artifact) -> Vec<String> {
    if let Some(files) = is::<OutputFiles>(artifact) {
        let line = |f: &toile_core::artifact::OutputFile| format!("{} ({})", f.path, bytes(f.bytes.len()));
        return files.0.iter().map(line).collect();
    }
    if is::<SewingPlan>(artifact).is_none() {
        return Vec::new();
    }
    let text = artifact.export().into_iter().find(|(kind, _)| *kind == "txt");
    let text = text.and_then(|(_, bytes)| String::from_utf8(bytes).ok()).unwrap_or_default();
    text.lines().map(str::to_owned).collect()
}

fn output(name: &str, artifact: &dyn Artifact) -> StageOutput {
    let kind = artifact.kind().to_string();
    let name = if name.is_empty() { kind } else { format!("{name} ({kind})") };
    StageOutput { name, measures: artifact.measures().0.iter().map(figure).collect() }
}

/// What a tailor asks of the result first: cloth, seams, strain, rest.
fn key_figures(run: &RunLog) -> Vec<Vec<NamedValue>> {
    let Some(garment) = last::<Garment>(run, run.stages.len()) else { return Vec::new() };
    // What was judged is the garment by the pattern that it was sewn from, whatever flattener
    // stands behind.
    let figures = last::<Figures>(run, run.stages.len());
    let strain = figures.map_or_else(|| strain(garment), |f| f.garment.edge_strain);
    let open = garment.seams.iter().filter(|s| s.state == SeamState::Open).count();
    let row =
        |name: &str, value: f64, unit: &str| NamedValue { name: name.to_owned(), value: number(value, unit) };
    let word = |yes: bool| if yes { "yes" } else { "no" }.to_owned();
    let mut cloth = vec![
        row("vertices", garment.positions.len() as f64, ""),
        row("triangles", garment.triangles.len() as f64, ""),
        row("solver steps", garment.status.steps as f64, ""),
        NamedValue { name: "came to rest".to_owned(), value: word(garment.status.converged) },
        row("greatest speed", garment.status.max_speed * 1e3, "mm/s"),
        row("energy", garment.status.energy, "J"),
    ];
    let mut fit = vec![
        row("seams", garment.seams.len() as f64, ""),
        row("seams still open", open as f64, ""),
        row("widest seam gap", garment.seam_gap_max() * 1e3, "mm"),
        row("edge strain, median", strain.p50 * 1e2, "%"),
        row("edge strain, 99 of 100", strain.p99 * 1e2, "%"),
        row("edge strain, greatest", strain.max * 1e2, "%"),
    ];
    let panels = figures.map_or_else(|| changes(garment), |f| f.panels.clone());
    for (name, p) in &panels {
        cloth.push(row(&format!("{name}, change of area"), -p.area_error * 1e2, "%"));
        fit.push(row(&format!("{name}, change of outline"), -p.outline_error * 1e2, "%"));
    }
    for (name, p) in figures.iter().flat_map(|f| &f.flat) {
        cloth.push(row(&format!("{name} laid flat, change of area"), p.area_error * 1e2, "%"));
        fit.push(row(&format!("{name} laid flat, change of outline"), p.outline_error * 1e2, "%"));
    }
    let judged = figures.map(|f| &f.garment);
    if let Some(inside) = judged.and_then(|g| g.body_penetration) {
        cloth.push(row("vertices inside the body", inside.vertices as f64, ""));
        fit.push(row("deepest in the body", inside.max_m * 1e3, "mm"));
    }
    for (level, girth) in judged.iter().flat_map(|g| &g.girths) {
        fit.push(row(&format!("cloth around the {level}"), girth.cloth_m * 1e2, "cm"));
        fit.push(row(&format!("ease at the {level}"), (girth.cloth_m - girth.body_m) * 1e2, "cm"));
    }
    if let Some(crossings) = judged.and_then(|g| g.body_crossings) {
        cloth.push(row("pairs of triangles that cross the body", crossings as f64, ""));
    }
    if let Some(crossings) = judged.and_then(|g| g.self_crossings) {
        cloth.push(row("pairs of triangles that cross", crossings as f64, ""));
    }
    if let Some(share) = judged.and_then(|g| g.on_body) {
        fit.push(row("still in its place on the body", share * 1e2, "%"));
    }
    vec![cloth, fit]
}

fn strain(garment: &Garment) -> StrainFigures {
    let strains = garment.edge_strains();
    let at = |q: f64| quantile(&strains, q);
    StrainFigures { p50: at(0.5), p99: at(0.99), max: at(1.0) }
}

/// How far each panel is from its pattern.
fn changes(garment: &Garment) -> BTreeMap<String, PanelFigures> {
    let error = |(flat, now): (f64, f64)| if flat > 0.0 { (flat - now) / flat } else { 0.0 };
    let of = |p: &GarmentPanel| {
        let (area, outline) = (garment.panel_areas(p), garment.panel_boundaries(p));
        (p.name.clone(), PanelFigures { area_error: error(area), outline_error: error(outline) })
    };
    garment.panels.iter().map(of).collect()
}

/// The quality limits that the result misses.
fn shortfalls(run: &RunLog) -> Vec<String> {
    let figures = last::<Figures>(run, run.stages.len());
    figures.map(|f| f.shortfalls.iter().map(|s| s.message.clone()).collect()).unwrap_or_default()
}

fn figure(m: &Measure) -> NamedValue {
    NamedValue { name: m.name.replace('_', " "), value: number(m.value, m.unit) }
}

/// A number for people: whole numbers whole, others with four significant digits.
pub(crate) fn number(value: f64, unit: &str) -> String {
    let text = match () {
        () if !value.is_finite() => "not finite".to_owned(),
        () if value == value.trunc() && value.abs() < 1e15 => grouped(value as i64),
        () if value.abs() < 1e-4 => format!("{value:.2e}"),
        () => {
            let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 7) as usize;
            format!("{value:.digits$}")
        }
    };
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

/// A whole number with a narrow space between its thousands.
fn grouped(value: i64) -> String {
    let digits = value.unsigned_abs().to_string();
    let mut text = if value < 0 { "-".to_owned() } else { String::new() };
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(c);
    }
    text
}

fn seconds(s: f64) -> String {
    if s < 1.0 { format!("{:.0} ms", s * 1e3) } else { format!("{s:.2} s") }
}

fn expected(e: Estimate) -> String {
    format!("{} expected ({} to {})", seconds(e.value), seconds(e.low), seconds(e.high))
}

fn bytes(n: usize) -> String {
    match n {
        0..1_000 => format!("{n} bytes"),
        1_000..1_000_000 => format!("{} kB", n / 1_000),
        _ => format!("{:.1} MB", n as f64 / 1e6),
    }
}
