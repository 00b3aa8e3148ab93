//! Every kind of artifact as a picture, for the report.
//!
//! Photos and masks as thumbnails, outlines and panels as drawings, the rest rendered.

use super::{Frame, ModelScene, OverlayLine, View};
use crate::render::parts::{body_mesh, mannequin, panel_mesh, plain_cloth};
use image::codecs::jpeg::JpegEncoder;
use image::{GrayImage, ImageFormat, RgbImage, imageops};
use std::any::Any;
use std::fmt::Write;
use std::io::Cursor;
use toile_core::artifact::{
    Artifact, Body, Garment, Mask, Material, Mesh, Model, Outline, OutputFile, OutputFiles, Panel, Photo,
    Point2, SeamState,
};

/// The form of a finished picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PictureForm {
    /// A PNG file.
    Png(Vec<u8>),
    /// A JPEG file.
    Jpeg(Vec<u8>),
    /// An SVG document.
    Svg(String),
}

/// A picture of an artifact.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ArtifactPicture {
    /// What it shows: `front`, `from behind`.
    pub caption: String,
    /// The picture.
    pub form: PictureForm,
}

/// Colours of panels and edges, sRGB; used in turn.
pub const PANEL_COLOURS: [[u8; 3]; 6] =
    [[66, 133, 190], [214, 124, 58], [84, 158, 92], [178, 84, 120], [128, 108, 180], [150, 140, 70]];
/// An open seam, sRGB.
const SEAM_COLOUR: [u8; 3] = [200, 30, 40];
/// A landmark, sRGB.
const LANDMARK_COLOUR: [u8; 3] = [30, 110, 200];
/// JPEG quality of thumbnails: the least at which weave shows no blocks.
const JPEG_QUALITY: u8 = 82;
/// A larger drawing of a file is not shown, bytes.
const LARGEST_DRAWING: usize = 1_500_000;
/// Triangles beyond which a panel's mesh is drawn by its outline alone: a finer mesh is a grey
/// blot.
const MOST_TRIANGLES_DRAWN: usize = 12_000;

/// Pictures of an artifact, about `height` px high; none for kinds without a look. `body` stands
/// behind garments.
pub fn pictures_of(artifact: &dyn Artifact, body: Option<&Body>, height: u32) -> Vec<ArtifactPicture> {
    let any: &dyn Any = artifact;
    let picture = |caption: &str, form: Option<PictureForm>| {
        form.map(|form| ArtifactPicture { caption: caption.to_owned(), form }).into_iter().collect::<Vec<_>>()
    };
    if let Some(photo) = any.downcast_ref::<Photo>() {
        picture("", jpeg(&thumbnail(&photo.pixels, height)))
    } else if let Some(mask) = any.downcast_ref::<Mask>() {
        picture("", png(&grey_thumbnail(&mask.pixels, height)))
    } else if let Some(outline) = any.downcast_ref::<Outline>() {
        let svg = outline.export().into_iter().find(|(kind, _)| *kind == "svg");
        picture("", svg.and_then(|(_, bytes)| String::from_utf8(bytes).ok()).map(PictureForm::Svg))
    } else if let Some(panel) = any.downcast_ref::<Panel>() {
        picture("", Some(PictureForm::Svg(panel_svg(panel))))
    } else if let Some(body) = any.downcast_ref::<Body>() {
        body_pictures(body, height)
    } else if let Some(garment) = any.downcast_ref::<Garment>() {
        garment_pictures(garment, body, height)
    } else if let Some(model) = any.downcast_ref::<Model>() {
        shots(&ModelScene::sketch(model), &[], height)
    } else if let Some(files) = any.downcast_ref::<OutputFiles>() {
        drawings(files)
    } else {
        Vec::new()
    }
}

/// The drawings among files.
fn drawings(files: &OutputFiles) -> Vec<ArtifactPicture> {
    let small = files.0.iter().filter(|f| f.path.ends_with(".svg") && f.bytes.len() <= LARGEST_DRAWING);
    let drawing = |f: &OutputFile| {
        let text = String::from_utf8(f.bytes.clone()).ok()?;
        Some(ArtifactPicture { caption: f.path.clone(), form: PictureForm::Svg(text) })
    };
    small.filter_map(drawing).collect()
}

/// A picture as JPEG; `None` for one without pixels.
pub(crate) fn jpeg(picture: &RgbImage) -> Option<PictureForm> {
    let mut bytes = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY);
    picture.write_with_encoder(encoder).ok().map(|()| PictureForm::Jpeg(bytes))
}

fn png(picture: &GrayImage) -> Option<PictureForm> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).ok().map(|()| PictureForm::Png(bytes.into_inner()))
}

/// The size of a picture brought down to `height`.
fn reduced((w, h): (u32, u32), height: u32) -> (u32, u32) {
    let scale = (f64::from(height) / f64::from(h.max(1))).min(1.0);
    let fit = |v: u32| (f64::from(v) * scale).round().max(1.0) as u32;
    (fit(w), fit(h))
}

/// A picture brought down to `height`; never up.
pub(crate) fn thumbnail(picture: &RgbImage, height: u32) -> RgbImage {
    if picture.height() <= height {
        return picture.clone();
    }
    let (w, h) = reduced(picture.dimensions(), height);
    imageops::thumbnail(picture, w, h)
}

fn grey_thumbnail(picture: &GrayImage, height: u32) -> GrayImage {
    let (w, h) = reduced(picture.dimensions(), height);
    imageops::thumbnail(picture, w, h)
}

fn body_pictures(body: &Body, height: u32) -> Vec<ArtifactPicture> {
    let model = Model { meshes: vec![body_mesh(body, 0)], materials: vec![mannequin()], ..Model::default() };
    let dot = |p: &toile_core::artifact::Point3| OverlayLine {
        ends: [*p, *p],
        colour: LANDMARK_COLOUR,
        width: 5.0,
    };
    let dots: Vec<OverlayLine> = body.landmarks.values().map(dot).collect();
    let scene = ModelScene::sketch(&model);
    let whole = |view: View| View { frame: Frame::Whole, margin: 0.04, ..view };
    let shot = |caption: &str, view: View| {
        let form = jpeg(&scene.render_with(&whole(view), &dots))?;
        Some(ArtifactPicture { caption: caption.to_owned(), form })
    };
    [shot("front", View::front(height)), shot("left side", View::side(height))]
        .into_iter()
        .flatten()
        .collect()
}

fn garment_pictures(garment: &Garment, body: Option<&Body>, height: u32) -> Vec<ArtifactPicture> {
    let model = garment_model(garment, body);
    shots(&ModelScene::sketch(&model), &open_seams(garment), height)
}

/// Front and back.
fn shots(scene: &ModelScene, lines: &[OverlayLine], height: u32) -> Vec<ArtifactPicture> {
    let shot = |(caption, view): (&str, View)| {
        let form = jpeg(&scene.render_with(&view, lines))?;
        Some(ArtifactPicture { caption: caption.to_owned(), form })
    };
    [("front", View::front(height)), ("back", View::back(height))].into_iter().filter_map(shot).collect()
}

/// A garment with its panels in distinct colours.
pub fn garment_model(garment: &Garment, body: Option<&Body>) -> Model {
    let normals = garment.vertex_normals();
    let mut model = Model::default();
    for (i, panel) in garment.panels.iter().enumerate() {
        let colour = PANEL_COLOURS[i % PANEL_COLOURS.len()].map(|v| super::LINEAR[v as usize]);
        push(&mut model, panel_mesh(garment, panel, &normals, i), plain_cloth(&panel.name, colour));
    }
    if let Some(body) = body {
        let index = model.materials.len();
        push(&mut model, body_mesh(body, index), mannequin());
    }
    model
}

fn push(model: &mut Model, mesh: Mesh, material: Material) {
    model.meshes.push(mesh);
    model.materials.push(material);
}

/// The pairs of every seam that is still open.
fn open_seams(garment: &Garment) -> Vec<OverlayLine> {
    let open = garment.seams.iter().filter(|s| s.state == SeamState::Open);
    let line = |pair: &[u32; 2]| {
        let ends = pair.map(|i| garment.positions.get(i as usize).copied());
        let [Some(a), Some(b)] = ends else { return None };
        Some(OverlayLine { ends: [a, b], colour: SEAM_COLOUR, width: 1.0 })
    };
    open.flat_map(|s| &s.pairs).filter_map(line).collect()
}

/// A panel's mesh with its named edges, millimetres.
fn panel_svg(panel: &Panel) -> String {
    let first = panel.positions.first().copied().unwrap_or_else(Point2::origin);
    let (lo, hi) = panel.positions.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    let (w, h) = ((hi.x - lo.x) * 1e3 + 60.0, (hi.y - lo.y) * 1e3 + 60.0);
    let at = |i: u32| {
        let p = panel.positions[i as usize];
        ((p.x - lo.x) * 1e3, (hi.y - p.y) * 1e3)
    };
    let mut s = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-30 -30 {w:.0} {h:.0}\" width=\"{w:.0}mm\" height=\"{h:.0}mm\" \
         font-family=\"sans-serif\" font-size=\"16\">\n<path fill=\"none\" stroke=\"#8a93a0\" stroke-width=\".6\" d=\""
    );
    for [a, b] in drawn_edges(panel) {
        let ((ax, ay), (bx, by)) = (at(a), at(b));
        let _ = write!(s, "M{ax:.0} {ay:.0}L{bx:.0} {by:.0}");
    }
    s.push_str("\"/>\n");
    for (i, edge) in panel.edges.iter().enumerate() {
        let [r, g, b] = PANEL_COLOURS[i % PANEL_COLOURS.len()];
        let points: String =
            edge.vertices.iter().map(|&v| format!("{:.1},{:.1} ", at(v).0, at(v).1)).collect();
        let colour = format!("#{r:02x}{g:02x}{b:02x}");
        let _ = writeln!(
            s,
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"3\" points=\"{points}\"/>"
        );
        let Some(&middle) = edge.vertices.get(edge.vertices.len() / 2) else { continue };
        let (x, y) = at(middle);
        let _ = writeln!(
            s,
            "<text x=\"{x:.0}\" y=\"{y:.0}\" text-anchor=\"middle\" fill=\"{colour}\" stroke=\"#fff\" \
             stroke-width=\"4\" paint-order=\"stroke\">{}</text>",
            escaped(&edge.name)
        );
    }
    s.push_str("</svg>\n");
    s
}

/// The mesh's edges once each, or the boundary alone where there are too many.
fn drawn_edges(panel: &Panel) -> Vec<[u32; 2]> {
    let sorted = |a: u32, b: u32| [a.min(b), a.max(b)];
    let ring = |ring: &Vec<u32>| {
        let n = ring.len();
        (0..n).map(|k| sorted(ring[k], ring[(k + 1) % n])).collect::<Vec<_>>()
    };
    let mut edges: Vec<[u32; 2]> = match panel.triangles.len() > MOST_TRIANGLES_DRAWN {
        true => std::iter::once(&panel.boundary).chain(&panel.holes).flat_map(ring).collect(),
        false => panel.triangles.iter().flat_map(|t| (0..3).map(|k| sorted(t[k], t[(k + 1) % 3]))).collect(),
    };
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// A text as XML content.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
