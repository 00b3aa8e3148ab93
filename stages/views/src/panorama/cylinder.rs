//! `Cylinder`: one panorama from photos of a camera that turns.

use super::blend::{Blend, Blended, blended};
use super::camera::CylinderCamera;
use super::canvas::PanoramaCanvas;
use super::focal::{ROUGH_PX, degrees, estimated};
use super::layout::{CameraTurn, PanoramaLayout, laid_out, neighbours};
use super::lens::Lens;
use super::pair::{HalvedPhoto, LONGEST_PX};
use crate::picture::{flipped, in_order};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;
use std::borrow::Cow;
use std::f64::consts::TAU;
use toile_core::prelude::*;

/// The most photos of a panorama.
pub const MAX_PHOTOS: usize = 100;
/// The shortest side of a photo, px.
pub const MIN_SIDE_PX: u32 = 48;
/// The largest panorama, pixels.
const MAX_PIXELS: usize = 200_000_000;
/// The name of the panorama among the photos.
const NAME: &str = "panorama";
/// The focal length is found again by the closed ring so often.
const ROUNDS: usize = 3;
/// A turn of the focal length smaller than this share is the last.
const STEADY: f64 = 1e-4;

/// Makes one panorama of overlapping photos that a camera took while it turned.
///
/// Photos follow each other in the order of their names, `1` to `12`, to the right or to the left,
/// each with a third or more of what the one before shows. Each is unrolled from a cylinder around
/// the camera and registered with the next: phase correlation, then to a fraction of a pixel. Where
/// the last fits onto the first the ring is closed and what is left is spread over all. `lens` is
/// found from the photos where it is not given; of a whole turn that is exact, of less it is within
/// some per cent. The result is a photo named `panorama`, which `Pictures` writes.
///
/// Limits: the camera turns around its own place, upright; something near it does not fit where it
/// moves. At most 100 photos, and 200 megapixels in all.
#[stage(
    role = Panorama,
    source = "garment modelling thesis, 2012: cylindrical panorama; Kuglin, Hines 1975; Lucas, Kanade 1981; Szeliski, Shum 1997; Burt, Adelson 1983; Brown, Lowe 2007",
    example = "Cylinder(lens: Degrees(62))",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Cylinder {
    /// The focal length of the camera: what its data sheet says, as `Equivalent(26)`, or found from
    /// the photos.
    #[param(default = Lens::Estimate)]
    lens: Lens,
    /// Whether the camera turned all around.
    #[param(default = CameraTurn::Auto)]
    turn: CameraTurn,
    /// How overlapping photos become one picture.
    #[param(default = Blend::Multiband)]
    blend: Blend,
    /// Photos are brightened and darkened so that neighbours are equally bright. `false` for a
    /// camera whose exposure was held.
    #[param(default = true)]
    exposure: bool,
    /// The panorama is cut to the rows that it fills from side to side. `false` keeps all rows;
    /// what no photo shows is transparent.
    #[param(default = true)]
    crop: bool,
}

#[stage]
impl Cylinder {
    pub(super) fn run(&self, photos: Set<Photo>, cx: &Context) -> Result<Set<Photo>, StageError> {
        let names = in_order(photos.iter().map(|(name, _)| name));
        let ordered: Vec<&Photo> = names.iter().filter_map(|name| photos.get(name)).collect();
        let size = one_size(&names, &ordered)?;
        let pixels: Vec<Cow<'_, RgbImage>> = ordered.iter().map(|p| flipped(p)).collect();
        let layout = self.layout(&pixels, &names, size, cx)?;
        figures(&layout, &names, size, cx);
        let ones = vec![1.0; pixels.len()];
        cx.check()?;
        let plain = PanoramaCanvas::new(&pixels, &ones, &layout);
        check_size(plain.size)?;
        let gains = if self.exposure {
            super::exposure::gains(pixels.len(), &plain.overlaps())
        } else {
            ones.clone()
        };
        cx.progress(0.8, "blending");
        let made = blended(&PanoramaCanvas::new(&pixels, &gains, &layout), self.blend, cx)?;
        if let Some(psnr) = made.overlap_psnr {
            cx.figure("overlap_psnr", psnr, "dB");
        }
        let panorama = self.cropped(made, cx);
        Ok([(NAME.to_owned(), panorama)].into_iter().collect())
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.lens.fault().into_iter().collect()
    }
}

impl Cylinder {
    /// Where all photos lie, with the focal length that is given or found.
    fn layout(
        &self,
        pixels: &[Cow<'_, RgbImage>],
        names: &[&str],
        size: [u32; 2],
        cx: &Context,
    ) -> Result<PanoramaLayout, StageError> {
        let given = self.lens.focal(size)?;
        let reduced = |longest: usize| -> Result<Vec<HalvedPhoto>, StageError> {
            pixels.par_iter().map(|p| HalvedPhoto::new(p, longest, cx)).collect()
        };
        let focal = match given {
            Some(focal) => focal,
            None => match estimated(&reduced(ROUGH_PX)?, size, cx)? {
                Some(focal) => focal,
                // No pair overlaps with any lens: the usual one says which is the first.
                None => f64::from(size[0]),
            },
        };
        cx.check()?;
        let photos = reduced(LONGEST_PX)?;
        cx.progress(0.5, "registering");
        let laid = |focal: f64| {
            let camera = CylinderCamera::new(focal, size);
            laid_out(&photos, neighbours(&photos, names, camera, cx)?, camera, self.turn, cx)
        };
        let mut layout = laid(focal)?;
        for _ in 0..ROUNDS {
            let before = layout.camera.focal;
            let found = layout.around().abs() / TAU;
            if given.is_some() || !layout.closed || (found / before - 1.0).abs() < STEADY {
                break;
            }
            let again = laid(found)?;
            // A ring that does not close again keeps what closed.
            if !again.closed {
                break;
            }
            layout = again;
        }
        if given.is_none() {
            let (view, focal) = (degrees(layout.camera.focal, size), layout.camera.focal);
            cx.note(format!(
                "a photo shows {view:.1} degrees from left to right: the focal length is {focal:.1} px"
            ));
        }
        Ok(layout)
    }

    /// The panorama cut to the rows that are filled from side to side.
    fn cropped(&self, blended: Blended, cx: &Context) -> Photo {
        let (width, height) = blended.pixels.dimensions();
        let row = |y: u32| {
            let from = y as usize * width as usize;
            blended.seen.get(from..from + width as usize).is_some_and(|row| row.iter().all(|s| *s))
        };
        let top = (0..height).find(|y| row(*y)).unwrap_or(height);
        let rows = (top..height).take_while(|y| row(*y)).count() as u32;
        if !self.crop || rows < height / 4 {
            if self.crop {
                cx.warn("the photos lie too far above and below each other for one frame; what no photo shows is transparent");
            }
            let whole = blended.seen.iter().all(|s| *s);
            let alpha = blended.seen.iter().map(|s| if *s { 255 } else { 0 }).collect();
            let alpha = GrayImage::from_raw(width, height, alpha).filter(|_| !whole);
            return photo(blended.pixels, alpha);
        }
        photo(image::imageops::crop_imm(&blended.pixels, 0, top, width, rows).to_image(), None)
    }
}

fn photo(pixels: RgbImage, alpha: Option<GrayImage>) -> Photo {
    Photo {
        pixels: Shared::new(pixels),
        alpha: alpha.map(Shared::new),
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: NAME.to_owned(),
    }
}

/// Shifts, residuals and what the camera did, for `metrics.json`.
fn figures(layout: &PanoramaLayout, names: &[&str], size: [u32; 2], cx: &Context) {
    cx.figure("focal_px", layout.camera.focal, "px");
    cx.figure("view_deg", degrees(layout.camera.focal, size), "degrees");
    cx.figure("turn_deg", layout.turn_deg(), "degrees");
    for (k, fit) in layout.pairs.iter().enumerate() {
        let next = names.get(k + 1).or(names.first()).unwrap_or(&"");
        cx.figure(&format!("shift_x.{next}"), fit.shift[0], "px");
        cx.figure(&format!("shift_y.{next}"), fit.shift[1], "px");
        cx.figure(&format!("likeness.{next}"), fit.likeness, "");
        cx.figure(&format!("residual.{next}"), fit.residual, "grey levels");
    }
    if layout.closed {
        cx.figure("gap_x", layout.gap[0], "px");
        cx.figure("gap_y", layout.gap[1], "px");
        let [x, y] = layout.gap;
        let share = x.abs() / (TAU * layout.camera.focal);
        if share > 0.01 {
            let percent = 100.0 * share;
            cx.warn(format!(
                "the ring closes but for {percent:.1} % of a turn ({x:.0} px across, {y:.0} px down), which is spread over all photos: set `lens: Estimate`, \
                 or give what the camera's data sheet says"
            ));
        }
    }
}

/// The size of all photos.
fn one_size(names: &[&str], photos: &[&Photo]) -> Result<[u32; 2], StageError> {
    let few = |n: usize| {
        let have = if n == 0 { "there are none".to_owned() } else { format!("there is {n}") };
        StageError::invalid(format!("a panorama needs two photos or more, and {have}"))
            .hint("add the other photos of the turn to `photos`, named in their order: \"01\", \"02\"")
    };
    let [first, _, ..] = photos else { return Err(few(photos.len())) };
    if photos.len() > MAX_PHOTOS {
        let text = format!("a panorama takes at most {MAX_PHOTOS} photos, and there are {}", photos.len());
        return Err(
            StageError::invalid(text).hint("leave out every second one: a third of overlap is enough")
        );
    }
    let (w, h) = first.pixels.dimensions();
    for (name, photo) in names.iter().zip(photos) {
        let (pw, ph) = photo.pixels.dimensions();
        if (pw, ph) != (w, h) {
            let text = format!("photo \"{name}\" is {pw} x {ph} px, and photo \"{}\" {w} x {h} px", names[0]);
            return Err(StageError::invalid(text).hint(
                "a panorama is made of uncut photos of one camera, all upright or all across; give photos of one size",
            ));
        }
    }
    if w.min(h) < MIN_SIDE_PX {
        let text = format!("the photos are {w} x {h} px, too small to be registered");
        return Err(
            StageError::invalid(text).hint(format!("give photos of at least {MIN_SIDE_PX} px a side"))
        );
    }
    Ok([w, h])
}

fn check_size([w, h]: [usize; 2]) -> Result<(), StageError> {
    if w.saturating_mul(h) <= MAX_PIXELS {
        return Ok(());
    }
    let text =
        format!("the panorama would have {w} x {h} px, more than {} megapixels", MAX_PIXELS / 1_000_000);
    Err(StageError::invalid(text).hint("give smaller photos, or fewer"))
}
