//! Makes named outlines from real photos and draws them.
//!
//!     TOILE_SHARED=... cargo run --release -p toile-stages --example name_edges [OUT_DIR] [NAME]...
//!
//! Reads `$TOILE_SHARED/data/photos/*.jpg` (tees, tops and vests, or those named), makes the mask
//! with `GraphCut()`, the outline with `Canny()` and names its edges; prints what came out, and
//! draws the edges over the photos into OUT_DIR where one is given. Without `TOILE_SHARED` it
//! prints "skipped".

#![allow(clippy::print_stdout)]

use image::{Rgb, RgbImage, imageops};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use toile_core::artifact::Outline;
use toile_core::prelude::*;
use toile_core::{Inputs, Kind, PortValue};
use toile_stages::binarise::GraphCut;
use toile_stages::edges::Canny;
use toile_stages::photo::decode;
use toile_stages::style::Outline as Cut;

fn main() -> Result<(), Box<dyn Error>> {
    let Some(shared) = std::env::var_os("TOILE_SHARED") else {
        println!("skipped: TOILE_SHARED is not set");
        return Ok(());
    };
    let photos = Path::new(&shared).join("data/photos");
    let mut args = std::env::args().skip(1);
    let out = args.next().map(PathBuf::from);
    let wanted: Vec<String> = args.collect();
    let mut names: Vec<String> = std::fs::read_dir(&photos)?
        .filter_map(|e| Some(e.ok()?.path().file_stem()?.to_str()?.to_owned()))
        .filter(|n| photos.join(format!("{n}.jpg")).is_file())
        .filter(|n| match wanted.is_empty() {
            true => ["tee", "vest", "top", "sweat"].iter().any(|p| n.starts_with(p)),
            false => wanted.contains(n),
        })
        .collect();
    names.sort();
    for name in names {
        match outlined(&photos.join(format!("{name}.jpg"))) {
            Err(e) => println!("{name}: {e}"),
            Ok((photo, outline, seconds)) => {
                let (outline, words) = match named(&outline) {
                    Ok(o) => o,
                    Err(why) => (typed(&outline)?, why),
                };
                println!("{name}: {seconds}, {} corners, {words}", outline.outer.corners.len());
                if let Some(out) = &out {
                    std::fs::create_dir_all(out)?;
                    drawn(&photo, &outline).save(out.join(format!("{name}.png")))?;
                }
            }
        }
    }
    Ok(())
}

fn outlined(file: &Path) -> Result<(Photo, Arc<dyn Artifact>, String), String> {
    let bytes = std::fs::read(file).map_err(|e| e.to_string())?;
    let photo = photo(&bytes, file)?;
    let start = Instant::now();
    let mask = one(&GraphCut::default(), vec![&photo])?;
    let masked = start.elapsed().as_secs_f64();
    let outline = one(&Canny::default(), vec![&photo, &mask])?;
    let seconds = format!("mask {masked:.2} s, outline {:.2} s", start.elapsed().as_secs_f64() - masked);
    Ok((typed(&photo)?, outline, seconds))
}

/// Names the edges by the style that suits them better; the reason where none does.
fn named(outline: &Arc<dyn Artifact>) -> Result<(Outline, String), String> {
    let named = styled(&Cut::default(), outline)?;
    let edges: Vec<String> = named.edges.iter().map(|e| e.name.clone()).collect();
    Ok((named, edges.join(" ")))
}

fn photo(bytes: &[u8], file: &Path) -> Result<Arc<dyn Artifact>, String> {
    let decoded = decode(bytes, &file.display().to_string()).map_err(|e| e.to_string())?;
    Ok(Arc::new(Photo {
        pixels: Shared::new(decoded.pixels),
        alpha: decoded.alpha.map(Shared::new),
        px_per_metre: None,
        garment_width: Some(0.6),
        mirrored: false,
        joined: 1,
        file: file.display().to_string(),
    }))
}

/// Runs a stage on single artifacts.
fn one(stage: &dyn Stage, inputs: Vec<&Arc<dyn Artifact>>) -> Result<Arc<dyn Artifact>, String> {
    let ports = inputs.into_iter().map(|a| Some(PortValue::One(a.clone()))).collect();
    let out = stage.run_ports(&Inputs(ports), &Context::quiet()).map_err(|e| e.to_string())?;
    match out.into_iter().next() {
        Some(PortValue::One(a)) => Ok(a),
        _ => Err("the stage gave no single artifact".into()),
    }
}

fn styled(style: &dyn Stage, outline: &Arc<dyn Artifact>) -> Result<Outline, String> {
    let set = BTreeMap::from([("front".to_owned(), outline.clone())]);
    let neck = ("neck_left".to_owned(), Point3::new(0.06, 1.45, 0.0));
    let body =
        Body { positions: vec![], triangles: vec![], landmarks: [neck].into(), measurements: [].into() };
    let body: Arc<dyn Artifact> = Arc::new(body);
    let inputs = Inputs(vec![Some(PortValue::Set(Kind("outline"), set)), Some(PortValue::One(body))]);
    let out = style.run_ports(&inputs, &Context::quiet()).map_err(|e| e.to_string())?;
    match out.get(1) {
        Some(PortValue::Set(_, set)) => set.get("front").map_or(Err("no front".into()), typed),
        _ => Err("the style gave no set".into()),
    }
}

fn typed<T: Clone + 'static>(artifact: &Arc<dyn Artifact>) -> Result<T, String> {
    let any: &dyn std::any::Any = artifact.as_ref();
    any.downcast_ref::<T>().cloned().ok_or_else(|| "another type".to_owned())
}

/// Colours that follow each other around the loop.
const COLOURS: [[u8; 3]; 6] =
    [[255, 0, 0], [0, 120, 255], [0, 200, 0], [255, 160, 0], [200, 0, 255], [0, 200, 200]];

/// The photo at twice its size with the edges in changing colours and the corners as squares.
fn drawn(photo: &Photo, outline: &Outline) -> RgbImage {
    let (w, h) = photo.pixels.dimensions();
    let mut picture = imageops::resize(photo.pixels.as_ref(), 2 * w, 2 * h, imageops::FilterType::Triangle);
    let mut dot = |p: Point2, r: i64, colour: [u8; 3]| {
        let Some(px) = outline.frame.map(|f| f.to_px(p)) else { return };
        let at = [(2.0 * px.x + 0.5) as i64, (2.0 * px.y + 0.5) as i64];
        for (x, y) in (-r..=r).flat_map(|dy| (-r..=r).map(move |dx| (at[0] + dx, at[1] + dy))) {
            if x >= 0 && y >= 0 && x < i64::from(2 * w) && y < i64::from(2 * h) {
                picture.put_pixel(x as u32, y as u32, Rgb(colour));
            }
        }
    };
    for (i, e) in outline.edges.iter().enumerate() {
        outline.edge_points(e).iter().for_each(|p| dot(*p, 1, COLOURS[i % COLOURS.len()]));
    }
    outline.outer.corners.iter().for_each(|&c| dot(outline.outer.points[c], 2, [255; 3]));
    outline.edges.iter().for_each(|e| dot(outline.outer.points[e.start], 3, [255, 255, 0]));
    picture
}
