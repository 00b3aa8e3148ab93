//! `Fit`: how a garment sits on its body, in numbers, words and pictures.

mod load;
mod map;
mod openings;
mod tape;
#[cfg(test)]
mod tests;
mod words;

use self::load::ClothLoad;
pub use self::load::pressures;
use self::map::VertexMap;
use self::openings::{finished, openings};
use crate::file_names::check_name;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use toile_core::Registry;
use toile_core::artifact::{GirthFigures, quantile};
use toile_core::prelude::*;
use toile_drape::measure::with_pattern;

/// Adds this folder's stage.
pub fn register(registry: &mut Registry) {
    registry.add::<Fit>();
}

/// Writes how the garment sits: ease, strain and tension along warp and weft, pressure on the body,
/// finished measures.
///
/// `fit.json` has lengths in metres, tensions in N per metre of cut width, pressures in kPa. A
/// picture of each map is an SVG with its legend. Where the cloth presses harder than `comfort`
/// over more than `over`, a warning says where. The garment must be at rest.
#[stage(
    role = Writer,
    source = "pressure: Laplace 1806; comfort: Denton 1972",
    contracts(Deterministic, ThreadInvariant),
    example = "Fit(comfort: 5.9)"
)]
pub struct Fit {
    /// The name of the file without its extension; pictures begin with it.
    #[param(default = "fit".to_owned())]
    name: String,
    /// Height of the pictures; 0 draws none.
    #[param(default = 480, min = 0, max = 2000, unit = "px", trades)]
    pictures: u32,
    /// The pressure from which on people call clothing tight: between 5.9 and 9.8 (Denton 1972).
    #[param(default = 5.9, min = 0.01, max = 100.0, unit = "kPa")]
    comfort: f64,
    /// The area with more than that pressure that is worth a warning, in one part of the body.
    #[param(default = 10.0, min = 0.0, max = 10_000.0, unit = "cm2")]
    over: f64,
}

#[stage]
impl Fit {
    fn run(
        &self,
        #[sewn] garment: &Garment,
        collider: Option<&Collider>,
        body: Option<&Body>,
        flat: Option<&Garment>,
        cx: &Context,
    ) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        let garment = with_pattern(garment, flat);
        garment.check_solvable()?;
        let load = ClothLoad::of(garment, collider, cx)?;
        let open = openings(garment);
        let girths = body.map(|b| tape::girths(garment, b, &open)).unwrap_or_default();
        let measures = finished(garment, body, &open);
        let tight = words::tight(garment, body, &load, self.comfort * 1e3, self.over * 1e-4);
        tight.iter().for_each(|t| cx.warn(t.sentence(self.comfort)));
        let json = json!({
            "units": { "length": "m", "strain": "share", "tension": "N/m", "pressure": "kPa", "area": "cm2" },
            "ease": ease(&girths),
            "measures": measures,
            "panels": panels(garment, &load),
            "pressure": pressure(&load, self.comfort, &tight),
        });
        let text = serde_json::to_string_pretty(&json)
            .map_err(|e| StageError::internal(format!("fit.json cannot be written: {e}")))?;
        let mut files = vec![OutputFile::new(format!("{}.json", self.name), (text + "\n").into_bytes())];
        files.extend(self.draw(garment, body, &load, cx)?);
        Ok(OutputFiles(files))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}

impl Fit {
    fn draw(
        &self,
        garment: &Garment,
        body: Option<&Body>,
        load: &ClothLoad,
        cx: &Context,
    ) -> Result<Vec<OutputFile>, StageError> {
        if self.pictures == 0 {
            return Ok(Vec::new());
        }
        cx.check()?;
        let percent = |k: usize| at_vertices(garment, load.strain.iter().map(|s| 1e2 * s[k]));
        let tension = |k: usize| at_vertices(garment, load.tension.iter().map(|s| s[k].max(0.0)));
        let pressure = load.pressure.iter().map(|p| p.unwrap_or(0.0) * 1e-3).collect();
        let mut maps = vec![
            ("warp_strain", "strain along the warp", "%", percent(0), true),
            ("weft_strain", "strain along the weft", "%", percent(1), true),
            ("warp_tension", "tension along the warp", "N/m", tension(0), false),
            ("weft_tension", "tension along the weft", "N/m", tension(1), false),
        ];
        if load.pressure.iter().any(Option::is_some) {
            maps.push(("pressure", "pressure on the body", "kPa", pressure, false));
        }
        let draw = |(file, title, unit, values, is_signed): &(&str, &str, &str, Vec<f64>, bool)| {
            let map = VertexMap { title, unit, values, is_signed: *is_signed };
            let fault = || StageError::internal(format!("the map of {file} cannot be drawn"));
            let svg = map.draw(garment, body, self.pictures).ok_or_else(fault)?;
            Ok(OutputFile::new(format!("{}_{file}.svg", self.name), svg.into_bytes()))
        };
        maps.par_iter().map(draw).collect()
    }
}

/// The mean at each vertex over its triangles in its panel.
fn at_vertices(garment: &Garment, of_triangles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sums = vec![[0.0; 2]; garment.positions.len()];
    for (t, value) in garment.triangles.iter().zip(of_triangles) {
        t.iter().for_each(|&v| {
            sums[v as usize][0] += value;
            sums[v as usize][1] += 1.0;
        });
    }
    sums.into_iter().map(|[sum, n]| if n > 0.0 { sum / n } else { 0.0 }).collect()
}

fn ease(girths: &BTreeMap<String, GirthFigures>) -> Value {
    let one = |(name, g): (&String, &GirthFigures)| {
        (name.clone(), json!({ "cloth": g.cloth_m, "body": g.body_m, "ease": g.cloth_m - g.body_m }))
    };
    Value::Object(girths.iter().map(one).collect())
}

fn panels(garment: &Garment, load: &ClothLoad) -> Value {
    let one = |p: &GarmentPanel| {
        let of = |all: &[load::Yarns], k: usize| spread(all[p.triangles.clone()].iter().map(|y| y[k]));
        let figures = json!({
            "warp_strain": of(&load.strain, 0),
            "weft_strain": of(&load.strain, 1),
            "warp_tension": of(&load.tension, 0),
            "weft_tension": of(&load.tension, 1),
        });
        (p.name.clone(), figures)
    };
    Value::Object(garment.panels.iter().map(one).collect())
}

/// Median, 1st and 99th percentile.
fn spread(values: impl Iterator<Item = f64>) -> Value {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let at = |q| quantile(&values, q);
    json!({ "p1": at(0.01), "p50": at(0.5), "p99": at(0.99) })
}

fn pressure(load: &ClothLoad, comfort: f64, tight: &[words::TightPlace]) -> Value {
    let mut on: Vec<f64> = load.pressure.iter().flatten().map(|p| p * 1e-3).collect();
    if on.is_empty() {
        return Value::Null;
    }
    on.sort_by(f64::total_cmp);
    let places = tight
        .iter()
        .map(|t| json!({ "place": t.place, "area": t.area * 1e4, "pressure": t.pressure * 1e-3 }));
    json!({
        "p50": quantile(&on, 0.5),
        "p99": quantile(&on, 0.99),
        "greatest": on.last(),
        "comfort": comfort,
        "too_tight": places.collect::<Vec<_>>(),
    })
}
