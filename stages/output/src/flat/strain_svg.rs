//! Flat pieces coloured by strain, beside the garment, as a drawing.
//!
//! Blue: the cloth is shorter on the garment than in the plane; red: longer; by the principal
//! strain of larger absolute value.

use super::sheet::GarmentPieces;
use crate::render::parts::plain_cloth;
use crate::render::{ModelScene, PictureForm, View, jpeg};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::collections::BTreeMap;
use std::fmt::Write;
use toile_core::prelude::*;
use toile_flatten::distortion::Distortion;

/// Steps of colour on each side of none.
const STEPS: i32 = 8;
/// Between pieces, metres.
const GAP: f64 = 0.02;
/// Height of a view of the garment, px.
const VIEW: u32 = 480;
/// The legend's height, metres.
const LEGEND: f64 = 0.06;

/// The drawing.
pub(super) fn drawn(
    sheet: &GarmentPieces,
    flat: &[Vec<Point2>],
    judged: &[Distortion],
    garment: &Garment,
    full: f64,
) -> String {
    let views = views(sheet, garment, judged, full);
    let (mut body, mut x, mut height) = (String::new(), 0.0, 0.3_f64);
    for (i, points) in flat.iter().enumerate() {
        let [lo, hi] = bounds(points);
        piece(&mut body, sheet, i, points, &judged[i], full, Vector2::new(x - lo.x, hi.y));
        let _ = writeln!(body, "<text x=\"{:.1}\" y=\"-6\">{}</text>", x * 1e3, escaped(&sheet.names[i]));
        x += hi.x - lo.x + GAP;
        height = height.max(hi.y - lo.y);
    }
    for (caption, src, share) in views {
        let (w, h) = (height * share * 1e3, height * 1e3);
        let _ = writeln!(
            body,
            "<image x=\"{:.1}\" y=\"0\" width=\"{w:.1}\" height=\"{h:.1}\" href=\"{src}\"/>",
            x * 1e3
        );
        let _ = writeln!(body, "<text x=\"{:.1}\" y=\"-6\">{caption}</text>", x * 1e3);
        x += height * share + GAP;
    }
    legend(&mut body, height, full);
    let (w, h) = (x * 1e3 + 40.0, (height + LEGEND) * 1e3 + 40.0);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-20 -30 {w:.0} {h:.0}\" width=\"{w:.0}mm\" height=\"{h:.0}mm\" \
         font-family=\"sans-serif\" font-size=\"16\">\n<rect x=\"-20\" y=\"-30\" width=\"{w:.0}\" height=\"{h:.0}\" fill=\"#fff\"/>\n{body}</svg>\n"
    )
}

/// A piece's triangles, one path a colour, and its outline.
fn piece(
    body: &mut String,
    sheet: &GarmentPieces,
    i: usize,
    points: &[Point2],
    d: &Distortion,
    full: f64,
    shift: Vector2,
) {
    let surface = &sheet.pieces.pieces[i].surface;
    let place = |v: u32| {
        let p = points[v as usize];
        format!("{:.1} {:.1}", (p.x + shift.x) * 1e3, (shift.y - p.y) * 1e3)
    };
    let mut paths: BTreeMap<i32, String> = BTreeMap::new();
    for (t, strain) in surface.triangles().iter().zip(&d.triangles) {
        let [a, b, c] = t.map(place);
        let _ = write!(paths.entry(step(strain.principal, full)).or_default(), "M{a}L{b}L{c}Z");
    }
    for (step, path) in paths {
        let colour = hex(colour(step));
        let _ =
            writeln!(body, "<path fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\".3\" d=\"{path}\"/>");
    }
    for l in surface.loops() {
        let line: Vec<String> = l.iter().map(|&v| place(v)).collect();
        let _ = writeln!(
            body,
            "<path fill=\"none\" stroke=\"#222\" stroke-width=\"1\" d=\"M{}Z\"/>",
            line.join("L")
        );
    }
}

fn bounds(points: &[Point2]) -> [Point2; 2] {
    let first = points.first().copied().unwrap_or_else(Point2::origin);
    points.iter().fold([first; 2], |[lo, hi], p| [lo.inf(p), hi.sup(p)])
}

fn step(strain: f64, full: f64) -> i32 {
    (strain / full * f64::from(STEPS)).round().clamp(f64::from(-STEPS), f64::from(STEPS)) as i32
}

/// From blue over a light grey to red, sRGB.
fn colour(step: i32) -> [u8; 3] {
    let share = f64::from(step.abs()) / f64::from(STEPS);
    let end = if step < 0 { [33.0, 102.0, 172.0] } else { [178.0, 24.0, 43.0] };
    end.map(|e| (238.0 + (e - 238.0) * share).round() as u8)
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn legend(body: &mut String, height: f64, full: f64) {
    let y = height * 1e3 + 20.0;
    for step in -STEPS..=STEPS {
        let x = f64::from(step + STEPS) * 16.0;
        let _ = writeln!(
            body,
            "<rect x=\"{x}\" y=\"{y:.1}\" width=\"16\" height=\"12\" fill=\"{}\"/>",
            hex(colour(step))
        );
    }
    let percent = full * 1e2;
    let _ = writeln!(
        body,
        "<text x=\"{}\" y=\"{:.1}\">strain of the garment against the flat piece, -{percent} % to +{percent} %</text>",
        f64::from(2 * STEPS + 1) * 16.0 + 10.0,
        y + 12.0
    );
}

/// The garment from the front and the back in the same colours: caption, picture, and its width
/// over its height.
fn views(
    sheet: &GarmentPieces,
    garment: &Garment,
    judged: &[Distortion],
    full: f64,
) -> Vec<(&'static str, String, f64)> {
    let model = model(sheet, garment, judged, full);
    let scene = ModelScene::draft(&model);
    let view = |(caption, view): (&'static str, View)| {
        let picture = scene.render(&view);
        let share = f64::from(picture.width()) / f64::from(picture.height().max(1));
        let Some(PictureForm::Jpeg(bytes)) = jpeg(&picture) else { return None };
        Some((caption, format!("data:image/jpeg;base64,{}", STANDARD.encode(bytes)), share))
    };
    [("from the front", View::front(VIEW)), ("from behind", View::back(VIEW))]
        .into_iter()
        .filter_map(view)
        .collect()
}

/// One mesh a colour.
fn model(sheet: &GarmentPieces, garment: &Garment, judged: &[Distortion], full: f64) -> Model {
    let mut by_step: BTreeMap<i32, Vec<[u32; 3]>> = BTreeMap::new();
    for (piece, d) in sheet.pieces.pieces.iter().zip(judged) {
        for (&t, strain) in piece.triangles.iter().zip(&d.triangles) {
            by_step.entry(step(strain.principal, full)).or_default().push(garment.triangles[t as usize]);
        }
    }
    let normals = garment.vertex_normals();
    let mut model = Model::default();
    for (step, triangles) in by_step {
        let linear = colour(step).map(|v| crate::render::LINEAR[v as usize]);
        model.materials.push(plain_cloth(&format!("strain {step}"), linear));
        model.meshes.push(Mesh {
            name: format!("strain {step}"),
            positions: garment.positions.clone(),
            normals: normals.clone(),
            uv: Vec::new(),
            triangles,
            material: model.materials.len() - 1,
        });
    }
    model
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
