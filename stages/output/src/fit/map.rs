//! Values on the cloth as colours, seen from the front and the back, with a legend.
//!
//! Scales that colour-blind readers tell apart: cividis (Nunez, Anderton, Renslow 2018) for values
//! from zero on, purple to orange (ColorBrewer's PuOr: Harrower, Brewer 2003) for values of both
//! signs. No light falls on the cloth, so a colour is the legend's.

use crate::render::parts::{body_mesh, mannequin, panel_mesh, plain_cloth};
use crate::render::{ModelScene, PictureForm, View, jpeg};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{Rgb, RgbImage};
use std::fmt::Write;
use toile_core::artifact::{Body, Garment, Material, Model, Shared, Texture};

const CIVIDIS: &[[u8; 3]] = &[
    [0, 34, 78],
    [18, 53, 112],
    [59, 73, 108],
    [87, 93, 109],
    [112, 113, 115],
    [138, 134, 121],
    [165, 155, 117],
    [195, 178, 105],
    [225, 202, 85],
    [254, 232, 56],
];
const PURPLE_ORANGE: &[[u8; 3]] = &[
    [84, 39, 136],
    [128, 115, 172],
    [178, 171, 210],
    [216, 218, 235],
    [247, 247, 247],
    [254, 224, 182],
    [253, 184, 99],
    [224, 130, 20],
    [179, 88, 6],
];
/// Shades of a legend.
const SHADES: u32 = 256;

/// What a map shows.
#[derive(Debug, Clone)]
pub(super) struct VertexMap<'a> {
    pub title: &'a str,
    pub unit: &'a str,
    /// One a vertex.
    pub values: &'a [f64],
    /// Whether values below zero are shown as well.
    pub is_signed: bool,
}

impl VertexMap<'_> {
    /// The end of the scale: a round number at or above all but one value in a hundred.
    pub(super) fn end(&self) -> f64 {
        let mut sizes: Vec<f64> = self.values.iter().map(|v| v.abs()).filter(|v| *v > 0.0).collect();
        sizes.sort_by(f64::total_cmp);
        rounded_up(toile_core::artifact::quantile(&sizes, 0.99))
    }

    /// An SVG document of two pictures, so high, and the legend.
    pub(super) fn draw(&self, garment: &Garment, body: Option<&Body>, height: u32) -> Option<String> {
        let end = self.end();
        let model = self.model(garment, body, end);
        let scene = ModelScene::draft(&model);
        let views = [View::front(height), View::back(height)];
        let width = views[0].width;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"15\" role=\"img\" \
             aria-label=\"{}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            2 * width,
            height + 70,
            self.title
        );
        for (k, view) in views.iter().enumerate() {
            let PictureForm::Jpeg(bytes) = jpeg(&scene.render(view))? else { return None };
            let _ = writeln!(
                svg,
                "<image x=\"{}\" y=\"0\" width=\"{width}\" height=\"{height}\" href=\"data:image/jpeg;base64,{}\"/>",
                k as u32 * width,
                STANDARD.encode(bytes)
            );
        }
        self.add_legend(&mut svg, end, [f64::from(width), f64::from(height)]);
        svg.push_str("</svg>\n");
        Some(svg)
    }

    fn scale(&self) -> &'static [[u8; 3]] {
        if self.is_signed { PURPLE_ORANGE } else { CIVIDIS }
    }

    /// Where a value stands on the scale, 0 to 1.
    fn place(&self, value: f64, end: f64) -> f64 {
        let low = if self.is_signed { -end } else { 0.0 };
        ((value - low) / (end - low)).clamp(0.0, 1.0)
    }

    fn model(&self, garment: &Garment, body: Option<&Body>, end: f64) -> Model {
        let normals = garment.vertex_normals();
        let pixels = RgbImage::from_fn(SHADES, 1, |x, _| {
            Rgb(colour(self.scale(), f64::from(x) / f64::from(SHADES - 1)))
        });
        let texture = Texture { name: "scale".into(), pixels: Shared::new(pixels), repeats: false };
        let cloth = Material { texture: Some(0), unlit: true, ..plain_cloth("map", [1.0; 3]) };
        let half = 0.5 / f64::from(SHADES);
        let at = |v: &f64| [(half + self.place(*v, end) * (1.0 - 2.0 * half)) as f32, 0.5];
        let mut model = Model {
            meshes: Vec::new(),
            materials: vec![cloth, Material { unlit: true, ..mannequin() }],
            textures: vec![texture],
            ..Model::default()
        };
        for panel in &garment.panels {
            let mut mesh = panel_mesh(garment, panel, &normals, 0);
            mesh.uv = self.values[panel.vertices.clone()].iter().map(at).collect();
            model.meshes.push(mesh);
        }
        model.meshes.extend(body.map(|b| body_mesh(b, 1)));
        model
    }

    fn add_legend(&self, svg: &mut String, end: f64, [width, height]: [f64; 2]) {
        let (left, wide, top) = (width * 0.4, width * 1.2, height + 26.0);
        let _ = writeln!(svg, "<text x=\"{left}\" y=\"{:.0}\">{}</text>", top - 8.0, self.title);
        let steps = 60;
        for k in 0..steps {
            let [r, g, b] = colour(self.scale(), (f64::from(k) + 0.5) / f64::from(steps));
            let step = wide / f64::from(steps);
            let x = left + f64::from(k) * step;
            let _ = writeln!(
                svg,
                "<rect x=\"{x:.1}\" y=\"{top:.0}\" width=\"{:.1}\" height=\"16\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>",
                step + 0.5
            );
        }
        for k in 0..=4 {
            let share = f64::from(k) / 4.0;
            let value = if self.is_signed { end * (2.0 * share - 1.0) } else { end * share };
            let _ = writeln!(
                svg,
                "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{}{}</text>",
                left + wide * share,
                top + 34.0,
                plain(value),
                if k == 4 { format!(" {}", self.unit) } else { String::new() }
            );
        }
    }
}

fn plain(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The next of 1, 2, 5, 10, ... times a power of ten.
fn rounded_up(value: f64) -> f64 {
    if value <= 0.0 || !value.is_finite() {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|s| s * power)
        .find(|s| *s >= value * (1.0 - 1e-12))
        .unwrap_or(10.0 * power)
}

fn colour(scale: &[[u8; 3]], share: f64) -> [u8; 3] {
    let at = share.clamp(0.0, 1.0) * (scale.len() - 1) as f64;
    let k = (at.floor() as usize).min(scale.len() - 2);
    let mix = |c: usize| {
        let (a, b) = (f64::from(scale[k][c]), f64::from(scale[k + 1][c]));
        (a + (b - a) * (at - k as f64)).round() as u8
    };
    [mix(0), mix(1), mix(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_ends_at_a_round_number() {
        assert_eq!([0.0, 0.013, 0.05, 0.051, 3.2, 9.0].map(rounded_up), [1.0, 0.02, 0.05, 0.1, 5.0, 10.0]);
    }

    #[test]
    fn ends_and_middle_have_the_colours_of_the_published_scales() {
        assert_eq!(colour(CIVIDIS, 0.0), [0, 34, 78]);
        assert_eq!(colour(CIVIDIS, 1.0), [254, 232, 56]);
        assert_eq!(colour(PURPLE_ORANGE, 0.5), [247, 247, 247]);
    }

    #[test]
    fn numbers_of_a_legend_are_short() {
        assert_eq!([-0.0, 0.5, 2.0, -0.025].map(plain), ["0", "0.5", "2", "-0.025"]);
    }
}
