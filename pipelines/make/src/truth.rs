//! The truth that tests measure against: a one-bit mask and the outline in millimetres.

use crate::garment::NamedOutline;
use crate::render::PhotoSetup;
use image::GrayImage;
use serde_json::json;

/// The mask as a one-bit PNG.
pub(crate) fn mask_png(mask: &GrayImage) -> Result<Vec<u8>, png::EncodingError> {
    let (w, h) = mask.dimensions();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, w, h);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    let packed: Vec<u8> = mask
        .as_raw()
        .chunks(w as usize)
        .flat_map(|row| row.chunks(8))
        .map(|bits| bits.iter().enumerate().fold(0, |byte, (i, &v)| byte | (u8::from(v != 0) << (7 - i))))
        .collect();
    encoder.write_header()?.write_image_data(&packed)?;
    Ok(bytes)
}

/// The outline with its pixel mapping, corners and edges, as JSON text.
pub(crate) fn outline_json(shot: &PhotoSetup, outline: &NamedOutline) -> String {
    let rounded = |p: &[f64; 2]| p.map(|v| (v * 1e3).round() / 1e3 + 0.0);
    let points: Vec<String> = outline.points.iter().map(|p| json!(rounded(p)).to_string()).collect();
    let corners: serde_json::Map<_, _> =
        outline.corners.iter().map(|(name, p)| (name.clone(), json!(rounded(p)))).collect();
    let edges: Vec<String> = outline
        .edges
        .iter()
        .map(|e| {
            let length = (e.length * 1e3).round() / 1e3;
            json!({"name": e.name, "start": e.start, "end": e.end, "length_mm": length}).to_string()
        })
        .collect();
    let frame = json!({"origin_px": shot.origin, "px_per_mm": shot.px_per_mm});
    format!(
        "{{\n\"unit\": \"mm\",\n\"mapping\": \"px = origin_px + [x, -y] * px_per_mm; pixel centres at integers\",\n\
         \"frame\": {frame},\n\"corners\": {},\n\"edges\": [\n{}\n],\n\"outline\": [\n{}\n]\n}}\n",
        serde_json::Value::Object(corners),
        edges.join(",\n"),
        points.join(",\n"),
    )
}
