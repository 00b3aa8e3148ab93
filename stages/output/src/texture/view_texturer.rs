//! `ViewTexturer`: photos of the garment as it hangs, from several sides, become its texture.
//!
//! Method: each texel takes the colours of the photos that see its place, the more of each the more
//! squarely it looks at the cloth (view-dependent texture mapping: Debevec, Taylor, Malik 1996).
//! Cost: texels times photos. Limits: the garment must hang as it does in the photos, and a photo
//! shows nothing but it before a plain ground.

use super::edge::add_edges;
use super::photo_texturer::{BodyShown, Light, PhotoDetail, check_garment};
use super::texture_size::LARGEST;
use super::{bleed, photo_detail, plain};
use crate::render::{LINEAR, PhotoCamera, PhotoShot, encode, parts};
use image::{GrayImage, Luma, Rgb, RgbImage};
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// The diagonal of the film that "35 mm equivalent" speaks of, 36 x 24 mm.
const FILM_DIAGONAL_MM: f64 = 43.266_615_305_567_87;

/// A photo that looks at cloth at more than this from its normal does not count, as a cosine.
const LEAST_COSINE: f64 = 0.15;

/// The weight of a photo is this power of the cosine.
const POWER: i32 = 6;

/// Pixels of a photo as near as this to the rim of the garment do not count, px.
const RIM_PX: f64 = 2.0;

/// Thickness of open edges, metres.
const EDGE: f64 = 2e-3;

/// Texels around a panel.
const MARGIN: f64 = 4.0;

/// Dresses a garment in photos that were taken of it as it hangs, from several sides, as on a
/// turntable.
///
/// Each place of the cloth has the colours of the photos that see it, the more of each the more
/// squarely it looks there. Where no photo looks, the colours beside go on. Masks say where the
/// garment is in a photo; how far the camera was and where it pointed follow from the box that the
/// garment fills.
#[stage(
    role = Texturer,
    source = "Debevec, Taylor, Malik 1996; garment modelling thesis, about 2012: view-dependent textures, replace and modulate",
    example = "ViewTexturer(turns: {\"front\": 0, \"back\": 180})",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct ViewTexturer {
    /// From which side each photo was taken: 0 sees the wearer's front, 90 the wearer's left. Where
    /// none is given the photos go round once in the order of their names, the first one in front.
    #[param(default = BTreeMap::new(), min = -360, max = 360, unit = "deg")]
    turns: BTreeMap<String, f64>,
    /// The height of the camera above the garment's level, as an angle.
    #[param(default = 0.0, min = -80, max = 80, unit = "deg")]
    elevation: f64,
    /// The camera's focal length as its 35 mm equivalent: 26 for the main camera of most phones.
    #[param(default = 50.0, min = 8, max = 2000, unit = "mm")]
    lens: f64,
    /// Whether light acts on the photos; they hold the light under which they were taken.
    #[param(default = Light::Replace)]
    light: Light,
    /// Longer side of the largest panel's texture.
    #[param(default = 1024, min = 16, max = LARGEST, unit = "px", trades, finer = "more")]
    size: u32,
    /// Where the normal map of the cloth comes from.
    #[param(default = PhotoDetail::None)]
    detail: PhotoDetail,
    /// Whether the body stands in the model.
    #[param(default = BodyShown::Show)]
    body: BodyShown,
}

#[stage]
impl ViewTexturer {
    pub(crate) fn run(
        &self,
        garment: &Garment,
        #[original] photos: Set<Photo>,
        masks: Set<Mask>,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Model, StageError> {
        self.fault().map_or(Ok(()), Err)?;
        check_garment(garment)?;
        let normals = garment.vertex_normals();
        let mut model = Model::default();
        for (i, panel) in garment.panels.iter().enumerate() {
            model.meshes.push(parts::panel_mesh(garment, panel, &normals, i));
            model.materials.push(parts::panel_cloth(panel, parts::UNDYED, 0.0));
        }
        let views = self.views(&photos, &masks, &model, cx)?;
        let texel = self.texel(garment);
        let painted = |(panel, mesh): (&GarmentPanel, &Mesh)| {
            cx.check()?;
            Ok(painted(&garment.rest[panel.vertices.clone()], mesh, &views, texel))
        };
        let pictures: Vec<Result<PanelPainting, StageError>> =
            garment.panels.par_iter().zip(&model.meshes).map(painted).collect();
        for (i, picture) in pictures.into_iter().enumerate() {
            let PanelPainting { mut pixels, seen, share, uv } = picture?;
            let name = model.meshes[i].name.clone();
            cx.figure(&format!("seen.{name}"), share, "");
            if !bleed::bleed(&mut pixels, &seen, 0.0) {
                cx.warn(format!("no photo sees panel \"{name}\": it gets a plain cloth"));
                continue;
            }
            let material = &mut model.materials[i];
            (material.colour, material.unlit) = ([1.0; 3], self.light == Light::Replace);
            material.wrong_side = plain::cloth_colour(&pixels);
            if self.detail == PhotoDetail::Photo {
                let map = photo_detail::normal_map(&pixels, 1.0 / texel, 1.0, cx)?;
                material.normal_texture = Some(model.textures.len());
                let name = format!("{name} normals");
                model.textures.push(Texture { name, pixels: Shared::new(map), repeats: false });
            }
            material.texture = Some(model.textures.len());
            model.textures.push(Texture { name, pixels: Shared::new(pixels), repeats: false });
            model.meshes[i].uv = uv;
        }
        add_edges(&mut model, garment, &normals, EDGE);
        self.body.add(&mut model, body)?;
        Ok(model)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.fault().into_iter().collect()
    }
}

/// A photo with its camera.
struct PhotoView<'a> {
    camera: PhotoCamera,
    photo: &'a RgbImage,
    /// Where the photo surely shows the garment, in the frame of the mask.
    sure: GrayImage,
}

impl ViewTexturer {
    fn fault(&self) -> Option<StageError> {
        let idle = self.light == Light::Replace && self.detail == PhotoDetail::Photo;
        idle.then(|| {
            StageError::invalid("`detail` does nothing with `light: Replace`")
                .hint("light does not act on such a photo: leave it out, or give `light: Modulate`")
                .at("detail")
        })
    }

    /// The photos with their cameras, in the order of their names.
    fn views<'a>(
        &self,
        photos: &'a Set<Photo>,
        masks: &Set<Mask>,
        model: &Model,
        cx: &Context,
    ) -> Result<Vec<PhotoView<'a>>, StageError> {
        let names: Vec<&str> = photos.iter().map(|(name, _)| name).collect();
        if let Some(name) = self.turns.keys().find(|name| photos.get(name).is_none()) {
            return Err(StageError::invalid(format!("`turns` names \"{name}\", of which there is no photo"))
                .at("turns")
                .hint(format!("the photos are {}", names.join(", "))));
        }
        let turn = |i: usize, name: &str| match self.turns.is_empty() {
            true => Ok(360.0 * i as f64 / names.len() as f64),
            false => self.turns.get(name).copied().ok_or_else(|| {
                StageError::invalid(format!("nothing says from which side the photo \"{name}\" was taken"))
                    .at("turns")
                    .hint(format!("add it, like `\"{name}\": 90`, or leave `turns` out"))
            }),
        };
        let mut views = Vec::new();
        for (i, (name, photo)) in photos.iter().enumerate() {
            cx.check()?;
            let turn = turn(i, name)?;
            let shown = masks.get(name).and_then(|mask| Some((mask, mask.bounds()?)));
            let (mask, [left, top, right, bottom]) = shown.ok_or_else(|| {
                StageError::invalid(format!("the mask of the photo \"{name}\" shows no garment"))
                    .hint("look at the masks with `--keep`, and take another binariser or a plainer ground")
            })?;
            let (width, height) = photo.pixels.dimensions();
            let pixel = f64::from(width) / f64::from(mask.pixels.width());
            let filled = [left, top, right + 1, bottom + 1].map(|edge| f64::from(edge) * pixel);
            let focal = self.lens / FILM_DIAGONAL_MM * f64::from(width).hypot(f64::from(height));
            let shot = PhotoShot {
                azimuth: turn.to_radians(),
                elevation: self.elevation.to_radians(),
                focal,
                size: [width, height],
                filled,
            };
            views.push(PhotoView {
                camera: PhotoCamera::new(model, &shot),
                photo: &photo.pixels,
                sure: bleed::eroded(&mask.pixels, RIM_PX / pixel),
            });
        }
        Ok(views)
    }

    /// Side of a texel, metres: the longest panel has as many as are asked.
    fn texel(&self, garment: &Garment) -> f64 {
        let side = |panel: &GarmentPanel| {
            let (lo, hi) = bounds(&garment.rest[panel.vertices.clone()]);
            (hi - lo).amax()
        };
        let longest = garment.panels.iter().map(side).fold(0.0, f64::max);
        (longest / (f64::from(self.size) - 2.0 * MARGIN).max(1.0)).max(1e-6)
    }
}

/// Least and greatest corner.
fn bounds(points: &[Point2]) -> (Point2, Point2) {
    let first = points.first().copied().unwrap_or_else(Point2::origin);
    points.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)))
}

/// The picture of a panel.
struct PanelPainting {
    pixels: RgbImage,
    /// 255 where a photo sees the cloth.
    seen: GrayImage,
    /// The share of the cloth that photos see.
    share: f64,
    uv: Vec<[f32; 2]>,
}

/// Paints a panel, whose flat vertices are `rest`.
fn painted(rest: &[Point2], mesh: &Mesh, views: &[PhotoView<'_>], texel: f64) -> PanelPainting {
    let (lo, hi) = bounds(rest);
    let at = |p: &Point2| [(p.x - lo.x) / texel + MARGIN, (hi.y - p.y) / texel + MARGIN];
    let size = [hi.x - lo.x, hi.y - lo.y].map(|l| (l / texel + 2.0 * MARGIN).ceil().max(1.0) as u32);
    let (mut pixels, mut seen) = (RgbImage::new(size[0], size[1]), GrayImage::new(size[0], size[1]));
    let (mut all, mut found) = (0u64, 0u64);
    for t in &mesh.triangles {
        let corners = t.map(|v| at(&rest[v as usize]));
        for (x, y, weights) in texels(corners, size) {
            let place = (0..3).map(|k| mesh.positions[t[k] as usize].coords * weights[k]).sum::<Vector3>();
            let normal = (0..3).map(|k| mesh.normals[t[k] as usize] * weights[k]).sum::<Vector3>();
            all += 1;
            if let Some(colour) = colour(&Point3::from(place), &normal, views) {
                found += 1;
                pixels.put_pixel(x, y, Rgb(colour));
                seen.put_pixel(x, y, Luma([255]));
            }
        }
    }
    let uv = |p: &Point2| {
        let [x, y] = at(p);
        [(x / f64::from(size[0])) as f32, (y / f64::from(size[1])) as f32]
    };
    PanelPainting { pixels, seen, share: found as f64 / all.max(1) as f64, uv: rest.iter().map(uv).collect() }
}

/// The texels whose middles lie in a triangle, with the weights of its corners there.
fn texels(corners: [[f64; 2]; 3], size: [u32; 2]) -> Vec<(u32, u32, [f64; 3])> {
    let [a, b, c] = corners;
    let cross =
        |o: [f64; 2], p: [f64; 2], q: [f64; 2]| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    let area = cross(a, b, c);
    if area == 0.0 {
        return Vec::new();
    }
    let range = |k: usize| {
        let (lo, hi) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
        (lo - 0.5).ceil().max(0.0) as u32..((hi - 0.5).floor() + 1.0).clamp(0.0, f64::from(size[k])) as u32
    };
    let mut out = Vec::new();
    for y in range(1) {
        for x in range(0) {
            let p = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let weights = [cross(p, b, c), cross(p, c, a), cross(p, a, b)].map(|w| w / area);
            if weights.iter().all(|w| *w >= 0.0) {
                out.push((x, y, weights));
            }
        }
    }
    out
}

/// The colour of a place, where photos see it.
fn colour(place: &Point3, normal: &Vector3, views: &[PhotoView<'_>]) -> Option<[u8; 3]> {
    let normal = normal.try_normalize(0.0)?;
    let (mut sum, mut weight) = ([0.0; 3], 0.0);
    for view in views {
        let cosine = normal.dot(&view.camera.towards(place));
        if cosine < LEAST_COSINE {
            continue;
        }
        let Some(colour) = view.camera.seen(place).and_then(|at| view.colour(at)) else { continue };
        let share = cosine.powi(POWER);
        (0..3).for_each(|k| sum[k] += share * colour[k]);
        weight += share;
    }
    (weight > 0.0).then(|| sum.map(|c| encode((c / weight) as f32)))
}

impl PhotoView<'_> {
    /// The linear colour at a place, px from the corner of the photo; none off the garment.
    fn colour(&self, [x, y]: [f64; 2]) -> Option<[f64; 3]> {
        let (width, height) = self.photo.dimensions();
        let share = [
            f64::from(self.sure.width()) / f64::from(width),
            f64::from(self.sure.height()) / f64::from(height),
        ];
        let on = [(x * share[0]) as u32, (y * share[1]) as u32];
        if *self.sure.get_pixel_checked(on[0], on[1])? == Luma([0]) {
            return None;
        }
        let (x, y) =
            ((x - 0.5).clamp(0.0, f64::from(width - 1)), (y - 0.5).clamp(0.0, f64::from(height - 1)));
        let (left, top) = (x as u32, y as u32);
        let (right, bottom) = ((left + 1).min(width - 1), (top + 1).min(height - 1));
        let (fx, fy) = (x - f64::from(left), y - f64::from(top));
        let of = |x: u32, y: u32, k: usize| f64::from(LINEAR[usize::from(self.photo.get_pixel(x, y).0[k])]);
        Some([0, 1, 2].map(|k| {
            let upper = of(left, top, k) * (1.0 - fx) + of(right, top, k) * fx;
            let lower = of(left, bottom, k) * (1.0 - fx) + of(right, bottom, k) * fx;
            upper * (1.0 - fy) + lower * fy
        }))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::render::{View, render};
    use toile_core::testkit::dress;

    /// The true colour of a flat place: red grows to the right, green upwards, in stripes.
    fn truth(p: &Point2) -> [u8; 3] {
        let share = |v: f64| (127.0 + 120.0 * (9.0 * v).sin()).round() as u8;
        [share(p.x), share(p.y), 0]
    }

    /// The garment in its true colours.
    fn dressed(garment: &Garment) -> Model {
        let normals = garment.vertex_normals();
        let mut model = Model::default();
        for (i, panel) in garment.panels.iter().enumerate() {
            let rest = &garment.rest[panel.vertices.clone()];
            let (lo, hi) = bounds(rest);
            let side = 200;
            let place = |x: u32, y: u32| {
                let [u, v] = [x, y].map(|c| (f64::from(c) + 0.5) / f64::from(side));
                Point2::new(lo.x + u * (hi.x - lo.x), hi.y - v * (hi.y - lo.y))
            };
            let pixels = RgbImage::from_fn(side, side, |x, y| Rgb(truth(&place(x, y))));
            let mut mesh = parts::panel_mesh(garment, panel, &normals, i);
            let uv =
                |p: &Point2| [((p.x - lo.x) / (hi.x - lo.x)) as f32, ((hi.y - p.y) / (hi.y - lo.y)) as f32];
            mesh.uv = rest.iter().map(uv).collect();
            model.meshes.push(mesh);
            let cloth = parts::plain_cloth(&panel.name, [1.0; 3]);
            model.materials.push(Material { texture: Some(i), unlit: true, ..cloth });
            model.textures.push(Texture {
                name: panel.name.clone(),
                pixels: Shared::new(pixels),
                repeats: false,
            });
        }
        model
    }

    /// Photos of it from evenly spaced turns, and their masks.
    fn shots(garment: &Garment, count: usize) -> (Set<Photo>, Set<Mask>) {
        let model = dressed(garment);
        let (mut photos, mut masks) = (BTreeMap::new(), BTreeMap::new());
        for i in 0..count {
            let azimuth = std::f64::consts::TAU * i as f64 / count as f64;
            let pixels = render(&model, &View { elevation: 0.0, ..View::turned(azimuth, 300) });
            // The ground is grey.
            let mask = GrayImage::from_fn(pixels.width(), pixels.height(), |x, y| {
                let [r, g, b] = pixels.get_pixel(x, y).0;
                Luma([if r.max(g).saturating_sub(b) > 25 { 255 } else { 0 }])
            });
            let photo = Photo {
                pixels: Shared::new(pixels),
                alpha: None,
                px_per_metre: None,
                garment_width: None,
                mirrored: false,
                joined: 1,
                file: format!("{i}.png"),
            };
            photos.insert(i.to_string(), photo.into());
            masks.insert(i.to_string(), Mask { pixels: Shared::new(mask) }.into());
        }
        (Set(photos), Set(masks))
    }

    fn texturer(text: &str) -> ViewTexturer {
        toile_core::param::ron_options().from_str(text).unwrap()
    }

    /// The lens of `View::turned` in a picture of 4 to 5.
    const LENS: &str = "lens: 104.67, size: 256";

    #[test]
    fn cloth_seen_from_all_sides_gets_its_true_colours() {
        let garment = dress::sewn_garment();
        let (photos, masks) = shots(&garment, 6);
        let made =
            texturer(&format!("({LENS})")).run(&garment, photos, masks, None, &Context::quiet()).unwrap();
        for (panel, mesh) in garment.panels.iter().zip(&made.meshes) {
            let picture = &made.textures[made.materials[mesh.material].texture.unwrap()].pixels;
            let [w, h] = [picture.width(), picture.height()].map(f64::from);
            let (mut off, mut count) = (0.0, 0.0);
            // The middles of the triangles, which no rim is near.
            for t in &mesh.triangles {
                let flat = t.map(|v| garment.rest[panel.vertices.start + v as usize].coords);
                let flat = Point2::from(flat.iter().sum::<Vector2>() / 3.0);
                let uv =
                    (0..2).map(|k| t.iter().map(|v| f64::from(mesh.uv[*v as usize][k])).sum::<f64>() / 3.0);
                let at: Vec<f64> = uv.collect();
                let pixel = picture.get_pixel((at[0] * w) as u32, (at[1] * h) as u32).0;
                off += (0..3).map(|k| f64::from(pixel[k].abs_diff(truth(&flat)[k]))).sum::<f64>() / 3.0;
                count += 1.0;
            }
            assert!(off / count < 10.0, "\"{}\": {} levels", panel.name, off / count);
        }
    }

    #[test]
    fn a_side_that_no_photo_shows_is_told() {
        let garment = dress::sewn_garment();
        let (photos, masks) = shots(&garment, 1);
        let cx = Context::quiet();
        texturer(&format!("({LENS}, turns: {{\"0\": 0}})")).run(&garment, photos, masks, None, &cx).unwrap();
        let warnings = cx.take_remarks().warnings;
        assert_eq!(warnings, ["no photo sees panel \"back\": it gets a plain cloth"]);
    }

    #[test]
    fn turns_and_photos_must_agree() {
        let garment = dress::sewn_garment();
        let refused = |turns: &str| {
            let (photos, masks) = shots(&garment, 2);
            let texturer = texturer(&format!("(turns: {turns})"));
            let e = texturer.run(&garment, photos, masks, None, &Context::quiet()).unwrap_err();
            (e.message, e.hint.unwrap())
        };
        assert_eq!(
            refused("{\"0\": 0, \"1\": 90, \"left\": 90}"),
            ("`turns` names \"left\", of which there is no photo".into(), "the photos are 0, 1".into())
        );
        assert_eq!(
            refused("{\"0\": 0}"),
            (
                "nothing says from which side the photo \"1\" was taken".into(),
                "add it, like `\"1\": 90`, or leave `turns` out".into()
            )
        );
    }
}
