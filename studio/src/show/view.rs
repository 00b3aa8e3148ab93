//! What the runs have made, for all panes.

use super::pattern::{pieces_of_outlines, pieces_of_pattern, seams_of_pattern, seams_of_plan};
use super::proposals::proposals;
use crate::live::shown::ShownArtifacts;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use toile_core::artifact::{Figures, Outline, Photo, Point2};

/// The photo whose landmarks are named without it.
pub(crate) const FRONT: &str = "front";

/// What a view has that runs have not made.
#[derive(Debug)]
pub(crate) struct ViewText {
    /// The names of landmarks that the text gives.
    pub(crate) given: BTreeSet<String>,
    /// Whether seams may be proposed.
    pub(crate) proposes: bool,
    /// The kinds that the garment of the front is taken for, with their probabilities.
    pub(crate) guesses: Vec<(&'static str, f64)>,
}

/// The view with its number.
pub(crate) fn view(number: u64, shown: &ShownArtifacts, text: &ViewText) -> Value {
    let pieces = match &shown.pattern {
        Some(pattern) => Some((pieces_of_pattern(pattern, &shown.photos), seams_of_pattern(pattern, shown))),
        None if shown.outlines.values().any(|o| !o.edges.is_empty()) => {
            Some((pieces_of_outlines(shown), seams_of_plan(shown)))
        }
        None => None,
    };
    let figures = shown.figures.as_deref();
    let read = shown.read.as_deref().filter(|_| text.proposes);
    let girth = |(level, g): (&String, &toile_core::artifact::GirthFigures)| json!({ "level": level, "cloth_m": g.cloth_m, "body_m": g.body_m });
    let missed = figures.iter().flat_map(|f| &f.shortfalls);
    json!({
        "view": number,
        "photos": shown.photos.iter().map(|(name, photo)| photo_json(name, photo, shown, &text.given)).collect::<Vec<_>>(),
        "guesses": text.guesses.iter().map(|(kind, share)| json!({ "kind": kind, "share": share })).collect::<Vec<_>>(),
        "outlines": shown.outlines.iter().filter_map(|(name, o)| outline(name, o)).collect::<Vec<_>>(),
        "pattern": pieces.map(|(pieces, seams)| json!({ "pieces": pieces, "seams": seams })),
        "proposals": read.map_or(json!([]), |read| proposals(read, shown.pattern.as_deref())),
        "start": shown.start.is_some(),
        "unplaced": shown.pattern.as_deref().map_or_else(Vec::new, toile_pattern::place::undecided),
        "garment": shown.garment.is_some(),
        "start_edit": shown.start.as_ref().map(|_| shown.start_edit),
        "pattern_edit": shown.pattern.as_ref().map(|_| shown.pattern_edit),
        "garment_edit": shown.garment.as_ref().map(|_| shown.garment_edit),
        "body": shown.body.is_some(),
        "figures": figures.map(figures_json),
        "girths": figures.iter().flat_map(|f| &f.garment.girths).map(girth).collect::<Vec<_>>(),
        "qualities_missed": missed
            .map(|s| json!({ "code": s.code.as_str(), "message": s.message }))
            .collect::<Vec<_>>(),
    })
}

fn photo_json(name: &str, photo: &Photo, shown: &ShownArtifacts, given: &BTreeSet<String>) -> Value {
    let (width, height) = photo.pixels.dimensions();
    let scale = photo.px_per_metre.map(|s| s * f64::from(photo.joined));
    let known = || shown.outlines.get(name).and_then(|o| Some(o.frame?.px_per_metre));
    json!({
        "name": name,
        "width": width * photo.joined,
        "height": height * photo.joined,
        "px_per_metre": scale.or_else(known),
        "landmarks": landmarks(name, shown, given),
    })
}

/// The landmarks of the garment in a photo, in its pixels. One is given where the text names it,
/// for another photo than the front behind the photo's name.
fn landmarks(photo: &str, shown: &ShownArtifacts, given: &BTreeSet<String>) -> Vec<Value> {
    let all =
        toile_pattern::style::landmarks(shown.outlines.iter().map(|(name, o)| (name.as_str(), o.as_ref())));
    let of_photo = all.into_iter().filter(|l| l.photo == photo);
    let told = |l: toile_pattern::style::PhotoLandmark| {
        let said = if photo == FRONT { l.name.clone() } else { format!("{photo}.{}", l.name) };
        json!({ "name": l.name, "x": l.place.x, "y": l.place.y, "given": given.contains(&said) })
    };
    of_photo.map(told).collect()
}

/// Where a point of an outline lies in its photo.
fn pixel(outline: &Outline, k: usize) -> Option<Point2> {
    let place = outline.lies.get(k).or_else(|| outline.outer.points.get(k))?;
    Some(outline.frame?.to_px(*place))
}

fn outline(name: &str, outline: &Outline) -> Option<Value> {
    let points: Option<Vec<[f64; 2]>> = (0..outline.outer.points.len())
        .map(|k| pixel(outline, k).map(|p| [tenth(p.x), tenth(p.y)]))
        .collect();
    Some(json!({ "panel": name, "points": points? }))
}

/// To a tenth of a pixel, which no screen shows.
fn tenth(x: f64) -> f64 {
    (10.0 * x).round() / 10.0
}

fn figures_json(figures: &Figures) -> Value {
    let mut all = serde_json::to_value(&figures.garment).unwrap_or_default();
    if let Value::Object(map) = &mut all {
        let strain = figures.garment.edge_strain;
        map.remove("girths");
        map.remove("edge_strain");
        for (name, value) in [("p50", strain.p50), ("p99", strain.p99), ("max", strain.max)] {
            map.insert(format!("strain_{name}"), json!(value));
        }
    }
    all
}
