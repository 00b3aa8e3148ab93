//! `PhotoTexturer`: the photo of every panel becomes its texture.
//!
//! The photo's pixels are cropped to the panel, scaled down by area average and bled past the
//! outline; texture coordinates are the photo coordinates that the mesher kept for every vertex.
//! Cost: a few passes over the photo's pixels. Limit: without `shading: Remove` light and shadow in
//! the photo stay in the texture.

use super::arms::without_arms;
use super::edge::add_edges;
use super::inside::{PixelBox, cover, keep_shown};
use super::shading::Shading;
use super::texture_size::{self, LARGEST};
use super::{bleed, crop, of_panel, photo_detail, plain, variants};
use crate::render::parts;
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_core::Known;
use toile_core::cost::Size;
use toile_core::decide::Decision;
use toile_core::prelude::*;

/// What light does to the photo.
#[choice]
#[derive(Copy, Eq)]
pub enum Light {
    /// The photo is the final colour.
    Replace,
    /// The photo is the cloth's own colour, on which light acts.
    Modulate,
}

/// Whether the body stands in the model.
#[choice]
#[derive(Copy, Eq)]
pub enum BodyShown {
    /// As the last mesh.
    Show,
    /// The same without arms, as a dress form stands in a shop: nothing hides the garment's side.
    /// The garment was draped with them.
    WithoutArms,
    /// Left out.
    Hide,
}

impl BodyShown {
    /// Adds the body to the end of a model.
    pub(super) fn add(self, model: &mut Model, body: Option<&Body>) -> Result<(), StageError> {
        let Some(body) = body.filter(|b| !b.triangles.is_empty()) else { return Ok(()) };
        let mesh = match self {
            BodyShown::Show => parts::body_mesh(body, model.materials.len()),
            BodyShown::WithoutArms => parts::body_mesh(&without_arms(body)?, model.materials.len()),
            BodyShown::Hide => return Ok(()),
        };
        model.meshes.push(mesh);
        model.materials.push(parts::mannequin());
        Ok(())
    }
}

/// What a side shows of which there is no photo, but the other side's mirror image.
#[choice]
#[derive(Copy, Eq)]
pub enum Unseen {
    /// That mirror image.
    Mirrored,
    /// The cloth alone, in its light and weave: without print, label, fly, zip, pocket or seam.
    /// Where a pattern is all over the garment, the mirror image stays, with a note.
    Plain,
}

/// The relief of the cloth, which light brings out beside the folds.
#[choice]
#[derive(Copy, Eq)]
pub enum PhotoDetail {
    /// None: cloth as smooth as its mesh.
    None,
    /// A normal map of the photo's fine detail: what is brighter than its surroundings stands out.
    Photo,
}

/// What becomes of the light under which the photo was taken.
#[choice]
#[derive(Copy, Eq)]
pub enum PhotoLight {
    /// It stays: creases and uneven light are part of the cloth's colour.
    Keep,
    /// It is taken out, as far as it is told from print: folds of the flat garment are not lit a
    /// second time.
    Remove,
}

/// What the wrong side of the cloth shows: the inside of the garment.
#[choice]
#[derive(Copy, Eq)]
pub enum WrongSide {
    /// The cloth's own colour: the commonest one of its photo.
    Plain,
    /// The same as the right side, as a weave or a knit of coloured yarns does.
    Same,
}

/// Dresses each panel in its own photo.
///
/// Front and back photos become the textures of front and back. Colours are taken a little inside
/// of the outline and carried past it, so that no background shows at a seam or when the texture is
/// seen from afar. A panel takes the photo of its own name, or of the last word of its name:
/// `left_sleeve_front` that of `front`. One without a photo gets a plain cloth. Where a piece
/// reaches beyond the garment that its photo shows, as legs do inside of the fork, the colours
/// beside that place go on.
#[stage(
    role = Texturer,
    version = 10,
    source = "garment modelling thesis, 2012: replace and modulate; Land, McCann 1971 and Grosse and others 2009: light apart from colour; Blinn 1978: normals from heights; Estevez, Kulla 2017: sheen",
    example = "PhotoTexturer(light: Modulate, size: 2048)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct PhotoTexturer {
    /// Whether light acts on the photo.
    #[param(default = Light::Modulate)]
    light: Light,
    /// Longer side of a texture at most; larger crops are scaled down.
    #[param(default = 2048, min = 16, max = LARGEST, unit = "px", trades)]
    size: u32,
    /// How far inside the outline colours are taken: past the garment's own rim and shadow, so that
    /// no ground shows along the seams.
    #[param(default = Length::mm(7.0), min = 0.0, max = 0.05)]
    inset: Length,
    /// What a side shows of which there is no photo (`MirrorOf`).
    #[param(default = Unseen::Plain)]
    unseen: Unseen,
    /// What becomes of the photo's own light: creases, shadows and uneven light.
    #[param(default = PhotoLight::Remove)]
    shading: PhotoLight,
    /// What the wrong side of the cloth shows.
    #[param(default = WrongSide::Plain)]
    wrong_side: WrongSide,
    /// Thickness of open edges, as of a hem, neckline or cuff that is turned under; 0 for none.
    #[param(default = Length::mm(2.0), min = 0.0, max = 0.02)]
    edge: Length,
    /// Room around the panel in its texture, filled with its colours.
    #[param(default = 8, min = 0, max = 256, unit = "px")]
    margin: u32,
    /// Whether the body stands in the model.
    #[param(default = BodyShown::Show)]
    body: BodyShown,
    /// Where the normal map of the cloth comes from.
    #[param(default = PhotoDetail::None)]
    detail: PhotoDetail,
    /// Factor of the relief's height; 1 where it is not given.
    #[param(default = None, min = 0.05, max = 10.0)]
    strength: Option<f64>,
    /// The soft shine of fibres at grazing angles, as a share of white; 0.1 where it is not given.
    #[param(default = None, min = 0.0, max = 1.0)]
    sheen: Option<f64>,
    /// Further looks of the model by name, each with the photos that differ:
    /// `{"red": {"front": "red.jpg"}}`. They show the garment where the first ones do. The look
    /// without them is then named `original`.
    #[param(default = BTreeMap::new())]
    variants: BTreeMap<String, BTreeMap<String, String>>,
}

/// A panel with its photo, that photo's mask, whether its print is to be taken off, and the panel's
/// part of the photo.
type Pictured<'a> = (&'a GarmentPanel, &'a Photo, Option<&'a Mask>, bool, PixelBox);

/// Width of the rim inside of the outline whose picture goes on beyond it, metres: some threads.
const RIM: f64 = 2e-3;

/// What only light brings out.
const OF_LIGHT: &str = "light does not act on such a photo: leave it out, or give `light: Modulate`";

/// A panel's picture, and its normal map where there is one.
type Pictures = (Texture, Option<Texture>);

#[stage]
impl PhotoTexturer {
    pub(super) fn run(
        &self,
        garment: &Garment,
        #[original] photos: Option<Set<Photo>>,
        masks: Option<Set<Mask>>,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Model, StageError> {
        self.fault().map_or(Ok(()), Err)?;
        check_garment(garment)?;
        let mut model = self.dressed(garment, photos.as_ref(), masks.as_ref(), cx)?;
        let mut looks = Vec::new();
        for (name, files) in &self.variants {
            cx.check()?;
            let photos = photos.as_ref().ok_or_else(no_photos)?;
            let own = variants::replaced(photos, files, garment, cx)?;
            looks.push((name, self.dressed(garment, Some(&own), masks.as_ref(), cx)?));
        }
        self.body.add(&mut model, body)?;
        for (name, mut look) in looks {
            for (own, texture) in look.textures.iter_mut().zip(&model.textures) {
                match own.pixels == texture.pixels {
                    true => *own = texture.clone(),
                    false => own.name = format!("{} {name}", own.name),
                }
            }
            self.body.add(&mut look, body)?;
            model.add_variant(variants::ORIGINAL, name, &look).map_err(StageError::internal)?;
        }
        Ok(model)
    }

    /// How many texels it will make.
    fn sizes(&self, given: &Size, _cx: &Context) -> Option<Size> {
        texture_size::foreseen(given, self.size)
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        texture_size::rule(known, self.size).into_iter().collect()
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.fault().into_iter().collect()
    }
}

impl PhotoTexturer {
    /// The panels in their photos, without the body.
    fn dressed(
        &self,
        garment: &Garment,
        photos: Option<&Set<Photo>>,
        masks: Option<&Set<Mask>>,
        cx: &Context,
    ) -> Result<Model, StageError> {
        let normals = garment.vertex_normals();
        let (mut model, mut pictures) = (Model::default(), Vec::new());
        for (i, panel) in garment.panels.iter().enumerate() {
            cx.check()?;
            let mut mesh = parts::panel_mesh(garment, panel, &normals, i);
            let mut material = parts::panel_cloth(panel, parts::UNDYED, self.sheen.unwrap_or(parts::SHEEN));
            match photo_of(panel, photos, cx) {
                Some(photo) => {
                    let area = PixelBox::around(&panel.photo_px, self.margin, photo.pixels.dimensions())
                        .ok_or_else(|| off_photo(panel, photo))?;
                    let mask = masks.and_then(|m| of_panel(m, &panel.name));
                    pictures.push((panel, photo, mask, self.hides(photo, photos), area));
                    mesh.uv = panel.photo_px.iter().map(|px| area.uv(px)).collect();
                    material.colour = [1.0; 3];
                    material.texture = Some(pictures.len() - 1);
                    material.unlit = self.light == Light::Replace;
                    // Light does not act on it.
                    material.sheen = material.sheen.filter(|_| !material.unlit);
                }
                None => cx.warn(format!("panel \"{}\" has no photo and gets a plain cloth", panel.name)),
            }
            model.meshes.push(mesh);
            model.materials.push(material);
        }
        cx.progress(0.5, format!("textures of {} panels", pictures.len()));
        let shown: Vec<(&GarmentPanel, &Photo)> = pictures.iter().map(|p| (p.0, p.1)).collect();
        let lights = self.lights(garment, &pictures, cx)?;
        let texture =
            |(panel, photo, mask, plain, area): (&GarmentPanel, &Photo, Option<&Mask>, bool, PixelBox)| {
                cx.check()?;
                let beside: Vec<&GarmentPanel> =
                    shown.iter().filter(|(_, p)| std::ptr::eq(*p, photo)).map(|(panel, _)| *panel).collect();
                let light = lights.iter().find(|(p, _)| std::ptr::eq(*p, photo)).map(|(_, light)| light);
                let (texture, is_plain) =
                    self.texture(garment, panel, &beside, (photo, mask, plain, light), area)?;
                let scale = f64::from(texture.pixels.width()) / f64::from(area.width);
                let relief = self.relief(&texture, px_per_metre(garment, panel) * scale, cx)?;
                Ok(((texture, relief), plain && !is_plain))
            };
        let textures: Vec<Result<(Pictures, bool), StageError>> =
            pictures.par_iter().copied().map(texture).collect();
        let (textures, patterned): (Vec<_>, Vec<bool>) =
            textures.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        let (colours, reliefs): (Vec<_>, Vec<_>) = textures.into_iter().unzip();
        if let Some((panel, ..)) = pictures.iter().zip(&patterned).find(|(_, is)| **is).map(|(p, _)| p) {
            cx.note(format!(
                "no photo shows \"{}\", and a pattern is all over its cloth: it is the front's mirror image, with all that the front shows",
                panel.name
            ));
        }
        if self.wrong_side == WrongSide::Plain {
            let backs = wrong_sides(&colours, &pictures);
            for material in &mut model.materials {
                material.wrong_side = material.texture.and_then(|t| backs[t]);
            }
        }
        let first = colours.len();
        model.textures = colours;
        if self.detail == PhotoDetail::Photo {
            model.textures.extend(reliefs.into_iter().flatten());
            for material in &mut model.materials {
                material.normal_texture = material.texture.map(|t| first + t);
            }
        }
        add_edges(&mut model, garment, &normals, self.edge.metres());
        Ok(model)
    }

    /// The first parameter that does nothing beside the others.
    fn fault(&self) -> Option<StageError> {
        let (detail, unlit) = (self.detail == PhotoDetail::Photo, self.light == Light::Replace);
        let idle = |name: &'static str, beside: &str, hint: &str| {
            Some(StageError::invalid(format!("`{name}` does nothing with `{beside}`")).hint(hint).at(name))
        };
        match () {
            () if unlit && detail => idle("detail", "light: Replace", OF_LIGHT),
            () if unlit && self.shading == PhotoLight::Remove => idle("shading", "light: Replace", OF_LIGHT),
            () if unlit && self.sheen.is_some() => idle("sheen", "light: Replace", OF_LIGHT),
            () if !detail && self.strength.is_some() => {
                idle("strength", "detail: None", "leave it out, or give `detail: Photo`")
            }
            () => self.variants.iter().find_map(variants::bad_variant),
        }
    }

    /// The normal map beside a texture with so many texels a metre.
    fn relief(&self, of: &Texture, px_per_metre: f64, cx: &Context) -> Result<Option<Texture>, StageError> {
        if self.detail == PhotoDetail::None {
            return Ok(None);
        }
        let map = photo_detail::normal_map(&of.pixels, px_per_metre, self.strength.unwrap_or(1.0), cx)?;
        let name = format!("{} normals", of.name);
        Ok(Some(Texture { name, pixels: Shared::new(map), repeats: of.repeats }))
    }

    /// Whether print is to be taken off a photo: it is the mirror image of another side's.
    fn hides(&self, photo: &Photo, photos: Option<&Set<Photo>>) -> bool {
        let other = |(_, p): (&str, &Photo)| p.file == photo.file && p.mirrored != photo.mirrored;
        self.unseen == Unseen::Plain && photo.mirrored && photos.is_some_and(|all| all.iter().any(other))
    }

    /// The light of every photo, where it is to be taken out: one for all panels that it shows, so
    /// that no step of light comes between them.
    fn lights<'a>(
        &self,
        garment: &Garment,
        pictures: &[Pictured<'a>],
        cx: &Context,
    ) -> Result<Vec<(&'a Photo, Shading)>, StageError> {
        let mut lights: Vec<(&Photo, Shading)> = Vec::new();
        if self.shading == PhotoLight::Keep {
            return Ok(lights);
        }
        for &(panel, photo, mask, ..) in pictures {
            if lights.iter().any(|(p, _)| std::ptr::eq(*p, photo)) {
                continue;
            }
            let (width, height) = photo.pixels.dimensions();
            let whole = PixelBox { left: 0, top: 0, width, height };
            let beside: Vec<&GarmentPanel> =
                pictures.iter().filter(|p| std::ptr::eq(p.1, photo)).map(|p| p.0).collect();
            let inside = shown_in(garment, &beside, photo, mask, whole);
            lights.push((photo, Shading::of(&photo.pixels, &inside, px_per_metre(garment, panel), cx)?));
        }
        Ok(lights)
    }

    /// A panel's texture, and whether it was made plain. `beside` are all panels that the photo
    /// shows, this one as well: where two of them meet is no rim of the garment.
    fn texture(
        &self,
        garment: &Garment,
        panel: &GarmentPanel,
        beside: &[&GarmentPanel],
        (photo, mask, plain, light): (&Photo, Option<&Mask>, bool, Option<&Shading>),
        area: PixelBox,
    ) -> Result<(Texture, bool), StageError> {
        let inside = shown_in(garment, beside, photo, mask, area);
        let size = crop::scaled_size(area, self.size);
        let mut crop = crop::crop(&photo.pixels, area, &inside, size);
        if let Some(light) = light {
            let step =
                [f64::from(area.width) / f64::from(size[0]), f64::from(area.height) / f64::from(size[1])];
            light.take_out(&mut crop.pixels, [area.left as f64, area.top as f64], step);
        }
        let scale = f64::from(size[0]) / f64::from(area.width);
        let depth = self.inset.metres() * px_per_metre(garment, panel) * scale;
        let sure = bleed::eroded(&crop.inside, depth);
        let is_plain = plain && plain::plain(&mut crop.pixels, &sure);
        // A panel thinner than twice the inset has no inner part: then its whole inside must do.
        let rim = RIM * px_per_metre(garment, panel) * scale;
        if !bleed::bleed(&mut crop.pixels, &sure, rim) && !bleed::bleed(&mut crop.pixels, &crop.inside, rim) {
            return Err(off_photo(panel, photo));
        }
        let texture = Texture { name: panel.name.clone(), pixels: Shared::new(crop.pixels), repeats: false };
        Ok((texture, is_plain))
    }
}

/// The colour of every texture's wrong side: that of the cloth in the largest texture of the same
/// photo, so that panels of one cloth agree.
fn wrong_sides(textures: &[Texture], pictures: &[Pictured<'_>]) -> Vec<Option<[f32; 3]>> {
    let area = |i: &usize| textures[*i].pixels.as_raw().len();
    let largest = |of: &Photo| {
        let same = |i: &usize| std::ptr::eq(pictures[*i].1, of);
        (0..textures.len()).filter(same).max_by_key(|i| (area(i), std::cmp::Reverse(*i)))
    };
    let colour = |p: &Pictured<'_>| plain::cloth_colour(&textures[largest(p.1)?].pixels);
    pictures.iter().map(colour).collect()
}

/// The pixels of a part of a photo that show one of the panels.
fn shown_in(
    garment: &Garment,
    panels: &[&GarmentPanel],
    photo: &Photo,
    mask: Option<&Mask>,
    area: PixelBox,
) -> image::GrayImage {
    let mut inside = image::GrayImage::new(area.width, area.height);
    for panel in panels {
        let first = panel.vertices.start as u32;
        let triangles: Vec<[u32; 3]> =
            garment.triangles[panel.triangles.clone()].iter().map(|t| t.map(|i| i - first)).collect();
        cover(&mut inside, &panel.photo_px, &triangles, area);
    }
    if let Some(mask) = mask {
        keep_shown(&mut inside, &mask.pixels, photo.pixels.width(), area);
    }
    inside
}

/// The panel's photo, where both it and the panel's place in it are known.
fn photo_of<'a>(panel: &GarmentPanel, photos: Option<&'a Set<Photo>>, cx: &Context) -> Option<&'a Photo> {
    let photo = of_panel(photos?, &panel.name)?;
    if panel.photo_px.len() != panel.vertices.len() {
        cx.warn(format!("panel \"{}\" does not know its place in its photo", panel.name));
        return None;
    }
    Some(photo)
}

/// Photo pixels a metre of cloth, from the areas of the panel in its photo and in the plane.
fn px_per_metre(garment: &Garment, panel: &GarmentPanel) -> f64 {
    let first = panel.vertices.start;
    let (px, metres) = garment.triangles[panel.triangles.clone()].iter().fold((0.0, 0.0), |(px, m), t| {
        let [a, b, c] = t.map(|i| panel.photo_px[i as usize - first]);
        let [p, q, r] = t.map(|i| garment.rest[i as usize]);
        (px + (b - a).perp(&(c - a)).abs(), m + (q - p).perp(&(r - p)).abs())
    });
    if metres > 0.0 { (px / metres).sqrt() } else { 0.0 }
}

/// Refuses what would put NaN into a file or a panel outside of its lists.
pub(super) fn check_garment(garment: &Garment) -> Result<(), StageError> {
    let count = garment.positions.len();
    let finite = garment.positions.iter().all(|p| p.iter().all(|c| c.is_finite()));
    if !finite {
        let hint = "the solver before this stage has blown up; try a smaller time step";
        return Err(StageError::invalid("the garment has a vertex that is not finite").hint(hint));
    }
    for panel in &garment.panels {
        let known = panel.vertices.end <= count && panel.triangles.end <= garment.triangles.len();
        let own = |t: &[u32; 3]| t.iter().all(|&i| panel.vertices.contains(&(i as usize)));
        if !known || !garment.triangles[panel.triangles.clone()].iter().all(own) {
            let text = format!("panel \"{}\" has a triangle with another panel's vertex", panel.name);
            return Err(StageError::internal(text));
        }
        if !panel.photo_px.iter().all(|p| p.iter().all(|c| c.is_finite())) {
            let text = format!("panel \"{}\" has a photo coordinate that is not finite", panel.name);
            return Err(StageError::invalid(text));
        }
    }
    Ok(())
}

fn no_photos() -> StageError {
    StageError::invalid("there are no photos that variants could stand for")
        .hint("leave `variants` out")
        .at("variants")
}

fn off_photo(panel: &GarmentPanel, photo: &Photo) -> StageError {
    let text = format!("panel \"{}\" covers no pixel of its photo \"{}\"", panel.name, photo.file);
    StageError::invalid(text).hint("was the mesh made from another photo?")
}
