//! `Turntable`: the model from all sides, in one page that any browser opens.
//!
//! Views around the model are rendered once; between them the page finds through the mesh which
//! pixel of the nearest views each place is (view interpolation: Chen, Williams 1993; with a mesh
//! in between: Buehler and others 2001), or moves the pixels of the nearest views along the flow
//! that block matching finds between them (`flow`). What the page holds is set down in
//! `docs/reference/turntable.md`. Cost: one picture per view. Limits: 255 parts, 2040 px of width.

mod flow;
mod mesh;
mod numbers;
mod sheet;

use super::check::check_model;
use crate::file_names::check_name;
use crate::render::{ModelScene, Orbit, Surroundings};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{RgbImage, RgbaImage};
use rayon::prelude::*;
use serde_json::{Value, json};
use toile_core::prelude::*;
use toile_image::photo::decode;

/// The viewer: defines `turntable(root, data)`.
const SCRIPT: &str = include_str!("page/turntable.js");
/// Its part that shows views along the flow.
const FLOW_SCRIPT: &str = include_str!("page/flow.js");
/// Its looks; every class begins with `tt-`.
pub(super) const STYLE: &str = include_str!("page/turntable.css");
const PAGE: &str = include_str!("page/page.html");

/// Heights of the camera above the horizon, degrees, by the number of tiers.
const TIERS: [&[f64]; 4] = [&[8.0], &[-5.0, 25.0], &[-5.0, 15.0, 40.0], &[-10.0, 10.0, 30.0, 55.0]];
/// Turns that are rendered at the same time; a run can be stopped between them.
const AT_ONCE: usize = 4;
/// Views in one sheet.
const PER_SHEET: usize = 12;
/// Behind the model.
const BACKGROUND: &str = "#e9e9e6";
/// The width of the panorama in the page, px, and its quality as JPEG: it is out of focus.
const PANORAMA_WIDTH: u32 = 1024;
const PANORAMA_QUALITY: u8 = 75;
/// Below this quality JPEG shows its blocks: a page that is larger still says so.
const LEAST_QUALITY: u8 = 30;
/// Steps by which the quality is lowered.
const QUALITY_STEP: u8 = 5;

/// How the page shows what lies between two views.
#[choice]
#[derive(Copy, Eq)]
pub enum Interpolation {
    /// The mesh says which pixels of the nearest views each place is.
    Depth,
    /// Pixels of the nearest views move along the flow between them, found by block matching, and
    /// are blended: far outlines are double.
    Flow,
}

/// Writes one page that shows the model from all sides: drag to turn it, zoom into it; no network,
/// no WebGL.
///
/// The page holds the mesh and rendered views; between views it shows each place of the mesh as the
/// nearest views do. `interpolate: Flow` moves pixels from view to view instead, without the mesh:
/// a larger page, made in about twice the time, and less exact. A click on the model dispatches the
/// event `toile:pick` with part, triangle and barycentric coordinates.
#[stage(
    role = Writer,
    version = 5,
    source = "Chen and Williams 1993; Buehler and others 2001; flow: Jain and Jain 1981, Bierling 1988; light of a panorama: Debevec 1998",
    example = "Turntable(views: 24, tiers: 3)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct Turntable {
    /// The file's name without its extension.
    #[param(default = "turntable".to_owned())]
    name: String,
    /// Views around the model, at each height; 16 where it is not given, 24 with `Flow`, which
    /// shows jumps with fewer.
    #[param(default = None, min = 4, max = 120, trades)]
    views: Option<usize>,
    /// Heights from which it is seen: 1 to 4.
    #[param(default = 3, min = 1, max = 4, trades)]
    tiers: usize,
    /// Height of a view; its width is three quarters of it.
    #[param(default = 720, min = 64, max = 1440, unit = "px", trades)]
    size: u32,
    /// Quality of the JPEG sheets.
    #[param(default = 70, min = 30, max = 100, trades)]
    quality: u8,
    /// The page's size that the quality is lowered for, at most to 30.
    #[param(default = 2000, min = 50, max = 100_000, unit = "kB")]
    page: usize,
    /// A panorama that surrounds the model and lights it: a picture twice as wide as high, of which
    /// the middle is seen behind the wearer.
    #[param(default = None)]
    panorama: Option<String>,
    /// How the page shows what lies between two views.
    #[param(default = Interpolation::Depth, trades)]
    interpolate: Interpolation,
}

#[stage]
impl Turntable {
    pub(super) fn run(&self, model: &Model, cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        check_model(model)?;
        if model.meshes.len() > 255 {
            let text = format!("the model has {} parts, a turntable holds 255", model.meshes.len());
            return Err(StageError::invalid(text).hint("leave `Turntable` out"));
        }
        let panorama = self.panorama.as_deref().map(|file| read_panorama(file, cx)).transpose()?;
        let html = page(&self.data(model, panorama.as_ref(), cx)?);
        let kilobytes = html.len() / 1000;
        if kilobytes > self.page {
            cx.warn(format!(
                "the turntable's page has {kilobytes} kB and not {}, though the quality is lowered to {LEAST_QUALITY}: take fewer `views` or \
                 `tiers`, or a smaller `size`",
                self.page
            ));
        }
        Ok(OutputFiles::one(&format!("{}.html", self.name), html.into_bytes()))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}

impl Turntable {
    /// Views around the model, at each height.
    fn around(&self) -> usize {
        self.views.unwrap_or(match self.interpolate {
            Interpolation::Depth => 16,
            Interpolation::Flow => 24,
        })
    }

    /// What the page shows.
    fn data(&self, model: &Model, panorama: Option<&RgbImage>, cx: &Context) -> Result<Value, StageError> {
        let tiers = TIERS[self.tiers - 1];
        let orbit = Orbit::around(model, self.size * 3 / 4, self.size, tiers);
        let views = self.render(model, panorama, &orbit, tiers, cx)?;
        let spans: Vec<Vec<[u8; 2]>> = views.par_iter().map(sheet::spans).collect();
        let sheets = by_sheet(&views, &spans, cx, |own, spans| Ok(sheet::packed(own, spans)))?;
        let mut data = json!({
            "title": self.name,
            "label": "the garment from all sides",
            "width": orbit.width,
            "height": orbit.height,
            "views": self.around(),
            "tiers": tiers,
            "fov": orbit.angle.to_degrees(),
            "distance": orbit.distance,
            "centre": [orbit.centre.x, orbit.centre.y, orbit.centre.z],
            "background": BACKGROUND,
            "mesh": mesh::mesh(model),
            "perSheet": PER_SHEET,
            "sheetBlocks": sheet::SHEET_BLOCKS,
            "spans": STANDARD.encode(spans.concat().as_flattened()),
        });
        if let Some(panorama) = panorama {
            data["panorama"] = format!(
                "data:image/jpeg;base64,{}",
                STANDARD.encode(sheet::jpeg(panorama, PANORAMA_QUALITY)?)
            )
            .into();
        }
        if self.interpolate == Interpolation::Flow {
            data["covers"] = by_sheet(&views, &spans, cx, flow::cover)?.into();
            data["flow"] = flow::flow(&views, &spans, self.around(), cx)?;
        }
        let room = (1000 * self.page).saturating_sub(page(&data).len());
        data["sheets"] = self.encoded(&sheets, room, cx)?.into();
        Ok(data)
    }

    /// Every view, tier after tier.
    fn render(
        &self,
        model: &Model,
        panorama: Option<&RgbImage>,
        orbit: &Orbit,
        tiers: &[f64],
        cx: &Context,
    ) -> Result<Vec<RgbaImage>, StageError> {
        let scene = ModelScene::draft_within(model, panorama.map(Surroundings::new), cx)?;
        let elevations: Vec<f64> = tiers.iter().map(|t| t.to_radians()).collect();
        let mut by_azimuth = Vec::new();
        let turns: Vec<f64> =
            (0..self.around()).map(|v| std::f64::consts::TAU * v as f64 / self.around() as f64).collect();
        for some in turns.chunks(AT_ONCE) {
            cx.check()?;
            let done = by_azimuth.len();
            cx.progress(done as f64 / self.around() as f64, format!("view {done} of {}", self.around()));
            let made: Vec<Vec<RgbaImage>> =
                some.par_iter().map(|turn| scene.cut_outs(orbit, *turn, &elevations)).collect();
            by_azimuth.extend(made.into_iter().map(Vec::into_iter));
        }
        cx.check()?;
        Ok((0..tiers.len())
            .flat_map(|_| by_azimuth.iter_mut().filter_map(Iterator::next).collect::<Vec<_>>())
            .collect())
    }

    /// The sheets as data URIs, of the greatest quality with which they fit into so many bytes.
    fn encoded(&self, sheets: &[RgbImage], room: usize, cx: &Context) -> Result<Vec<String>, StageError> {
        let mut quality = self.quality;
        loop {
            let uri = |s: &RgbImage| {
                cx.check()?;
                Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(sheet::jpeg(s, quality)?)))
            };
            let uris: Vec<String> = sheets.par_iter().map(uri).collect::<Result<_, StageError>>()?;
            if quality <= LEAST_QUALITY || uris.iter().map(|u| u.len() + 3).sum::<usize>() <= room {
                return Ok(uris);
            }
            quality = quality.saturating_sub(QUALITY_STEP).max(LEAST_QUALITY);
        }
    }
}

/// What is made of the views of each sheet and of their spans.
fn by_sheet<T: Send>(
    views: &[RgbaImage],
    spans: &[Vec<[u8; 2]>],
    cx: &Context,
    make: impl Fn(&[&RgbaImage], &[&[[u8; 2]]]) -> Result<T, StageError> + Sync,
) -> Result<Vec<T>, StageError> {
    let one = |(views, spans): (&[RgbaImage], &[Vec<[u8; 2]>])| {
        cx.check()?;
        let spans: Vec<&[[u8; 2]]> = spans.iter().map(Vec::as_slice).collect();
        make(&views.iter().collect::<Vec<_>>(), &spans)
    };
    views.par_chunks(PER_SHEET).zip(spans.par_chunks(PER_SHEET)).map(one).collect()
}

/// A panorama, reduced to what the page shows of it.
fn read_panorama(file: &str, cx: &Context) -> Result<RgbImage, StageError> {
    let at = |e: StageError| e.at("panorama");
    let picture = cx.read(file).and_then(|bytes| decode(&bytes, file)).map_err(at)?.pixels;
    let (w, h) = picture.dimensions();
    if w.abs_diff(2 * h) > h / 50 {
        let text = format!("the panorama \"{file}\" is {w} x {h} px, and not twice as wide as high");
        let hint = "a panorama shows 360 degrees across and 180 down (equirectangular projection)";
        return Err(at(StageError::invalid(text).hint(hint)));
    }
    if w <= PANORAMA_WIDTH {
        return Ok(picture);
    }
    Ok(image::imageops::thumbnail(&picture, PANORAMA_WIDTH, PANORAMA_WIDTH / 2))
}

/// The data in a page that this stage has written, as escaped JSON.
pub(super) fn data_of(html: &str) -> Option<&str> {
    Some(html.split_once("id=\"tt-data\">")?.1.split_once("</script>")?.0)
}

/// The viewer for such data, as JSON: what shows views along the flow is there where they have one.
pub(super) fn script(data: &str) -> String {
    // A name that reads like the field brings more script than the page needs, and changes nothing.
    if data.contains("\"flow\":") { [SCRIPT, FLOW_SCRIPT].concat() } else { SCRIPT.to_owned() }
}

/// The page, whole.
fn page(data: &Value) -> String {
    let json = data.to_string().replace('<', "\\u003c");
    // The data come last: names in them may look like a mark.
    PAGE.replacen("/*CSS*/", STYLE, 1).replacen("/*JS*/", &script(&json), 1).replacen("/*DATA*/", &json, 1)
}

#[cfg(test)]
mod tests;
