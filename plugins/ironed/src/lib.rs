//! A texturer that irons the photo: light and shade of the wrinkles in which the garment lay are
//! taken out, so that they do not show beside those that the drape makes.
//!
//! - [`Ironed`]: the stage.
//! - [`iron`]: the filter, on pixels alone.
//! - `crop`: the panel's part of its photo.
//! - `fill`: colours beyond the panel's rim.

mod crop;
mod fill;
mod iron;

pub use iron::{Settings, iron};

use crop::PanelCrop;
use toile_core::prelude::*;

/// Dresses each panel in its own photo, with the shading of wrinkles taken out.
///
/// Cloth of one colour varies in the photo because it does not lie flat. Where the light level
/// wanders by less than `contrast` from that of equal cloth around it, and over more than `detail`,
/// it is brought back; prints, stripes and seams, which differ by more, and the weave, which is
/// finer, stay. What is left of a deep fold, darker than `contrast` allows, stays too. A panel
/// without a photo gets a plain cloth.
#[stage(
    role = Texturer,
    source = "Tomasi & Manduchi 1998; Chen, Paris & Durand 2007",
    example = "Ironed(strength: 1.0, contrast: 0.25)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Ironed {
    /// Share of the shading that is taken out.
    #[param(default = 1.0, min = 0.0, max = 1.0)]
    pub strength: f64,
    /// Levels that differ by more than this share are another colour and no shading.
    #[param(default = 0.25, min = 0.02, max = 2.0)]
    pub contrast: f64,
    /// Anything finer than this belongs to the cloth.
    #[param(default = Length::mm(3.0), min = 2e-4, max = 0.05)]
    pub detail: Length,
    /// How far around equal cloth is looked for: wider than the widest wrinkle.
    #[param(default = Length::cm(12.0), min = 5e-3, max = 2.0)]
    pub reach: Length,
    /// Longer side of a texture at most; larger crops are scaled down.
    #[param(default = 2048, min = 16, max = 8192, unit = "px", trades)]
    pub size: u32,
    /// How far inside the outline colours are taken: past the garment's own rim and shadow.
    #[param(default = Length::mm(2.0), min = 0.0, max = 0.05)]
    pub inset: Length,
    /// Whether the body stands in the model.
    #[param(default = true)]
    pub body: bool,
}

/// Undyed linen, and a mannequin's grey; linear.
const PLAIN: [f32; 3] = [0.66, 0.60, 0.49];
const MANNEQUIN: [f32; 3] = [0.42, 0.41, 0.40];

#[stage]
impl Ironed {
    fn run(
        &self,
        garment: &Garment,
        #[original] photos: Option<Set<Photo>>,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Model, StageError> {
        garment.check().map_err(|e| StageError::invalid(format!("the garment cannot be dressed: {e}")))?;
        if garment.triangles.is_empty() {
            return Err(StageError::invalid("the garment is empty: it has no triangles"));
        }
        let normals = garment.vertex_normals();
        let mut model = Model::default();
        for (i, panel) in garment.panels.iter().enumerate() {
            cx.progress(i as f64 / garment.panels.len() as f64, format!("ironing {}", panel.name));
            let photo =
                photos.as_ref().and_then(|p| p.get(&panel.name)).filter(|_| !panel.photo_px.is_empty());
            if photo.is_none() {
                cx.warn(format!("panel \"{}\" has no photo and gets a plain cloth", panel.name));
            }
            self.add_panel(&mut model, garment, panel, &normals, photo, cx)?;
        }
        if let Some(body) = body.filter(|b| self.body && !b.triangles.is_empty()) {
            add_body(&mut model, body);
        }
        Ok(model)
    }

    fn add_panel(
        &self,
        model: &mut Model,
        garment: &Garment,
        panel: &GarmentPanel,
        normals: &[Vector3],
        photo: Option<&Photo>,
        cx: &Context,
    ) -> Result<(), StageError> {
        let first = panel.vertices.start as u32;
        let triangles: Vec<[u32; 3]> =
            garment.triangles[panel.triangles.clone()].iter().map(|t| t.map(|v| v - first)).collect();
        let mut uv = Vec::new();
        let mut texture = None;
        if let Some(photo) = photo {
            let crop = PanelCrop::of(photo, &panel.photo_px, &triangles, self.size)
                .ok_or_else(|| beside(&panel.name, &photo.file))?;
            uv = panel.photo_px.iter().map(|px| crop.uv(px)).collect();
            let scale = px_per_metre(garment, panel, &triangles) / crop.step;
            let pixels = self.texture(crop, scale, cx)?.ok_or_else(|| beside(&panel.name, &photo.file))?;
            model.textures.push(Texture {
                name: panel.name.clone(),
                pixels: Shared::new(pixels),
                repeats: false,
            });
            texture = Some(model.textures.len() - 1);
        }
        let colour = if texture.is_some() { [1.0; 3] } else { PLAIN };
        model.materials.push(cloth(&panel.name, colour, texture, true));
        model.meshes.push(Mesh {
            name: panel.name.clone(),
            positions: garment.positions[panel.vertices.clone()].to_vec(),
            normals: normals[panel.vertices.clone()].iter().map(unit).collect(),
            uv,
            triangles,
            material: model.materials.len() - 1,
        });
        Ok(())
    }

    /// The ironed crop, its colours carried past its rim; `None` where the panel covers no pixel.
    fn texture(
        &self,
        crop: PanelCrop,
        scale: f64,
        cx: &Context,
    ) -> Result<Option<image::RgbImage>, StageError> {
        cx.check()?;
        let inner = crop.eroded((self.inset.metres() * scale).round() as usize);
        // A panel thinner than twice the inset has no inner part: then its whole inside must do.
        let sure = if inner.contains(&true) { inner } else { crop.inside.clone() };
        let settings = Settings {
            strength: self.strength,
            contrast: self.contrast,
            detail: self.detail.metres() * scale,
            reach: self.reach.metres() * scale,
        };
        let (mut pixels, shading) = iron(&crop.pixels, &sure, &settings, cx)?;
        cx.figure("shading", shading * 100.0, "%");
        Ok(fill::fill(&mut pixels, &sure).then_some(pixels))
    }
}

fn beside(panel: &str, file: &str) -> StageError {
    StageError::invalid(format!("panel \"{panel}\" lies beside its photo {file}"))
        .hint("is it the photo that the panel was cut from?")
}

/// Photo pixels a metre of cloth, from the panel's areas in its photo and in the plane.
fn px_per_metre(garment: &Garment, panel: &GarmentPanel, triangles: &[[u32; 3]]) -> f64 {
    let (px, metres) = triangles.iter().fold((0.0, 0.0), |(px, m), t| {
        let [a, b, c] = t.map(|v| panel.photo_px[v as usize]);
        let [p, q, r] = t.map(|v| garment.rest[v as usize + panel.vertices.start]);
        (px + (b - a).perp(&(c - a)).abs(), m + (q - p).perp(&(r - p)).abs())
    });
    if metres > 0.0 { (px / metres).sqrt() } else { 0.0 }
}

fn cloth(name: &str, colour: [f32; 3], texture: Option<usize>, double_sided: bool) -> Material {
    Material {
        name: name.to_owned(),
        colour,
        texture,
        unlit: false,
        roughness: 0.95,
        double_sided,
        sheen: None,
        normal_texture: None,
        wrong_side: None,
        fabric: String::new(),
    }
}

fn add_body(model: &mut Model, body: &Body) {
    model.materials.push(cloth("body", MANNEQUIN, None, false));
    model.meshes.push(Mesh {
        name: "body".into(),
        positions: body.positions.clone(),
        normals: body.vertex_normals().iter().map(unit).collect(),
        uv: vec![],
        triangles: body.triangles.clone(),
        material: model.materials.len() - 1,
    });
}

/// A normal where no triangle gives one: any does, since nothing is seen there.
fn unit(n: &Vector3) -> Vector3 {
    if *n == Vector3::zeros() { Vector3::z() } else { *n }
}

toile_core::plugin!(Ironed);
