//! The binariser that knows when it is wrong.
//!
//! Seven methods, and the mask of an earlier stage where there is one, most of which share neither
//! model nor start, look at the photo at a reduced size (`methods`): a graph cut, the ground's
//! colours, a split of colours in two, the distance to the rim's colours, a random walk that sees
//! edges alone, a graph cut from that walk's end, and what a network has learnt (`network`). For
//! each mask `evidence` asks how far others agree with it, how much of its contour lies on an edge
//! of the photo, and how alike its halves are. The best is taken: thin parts without a mirror image
//! are taken off it and pairs of straps are put back (`thin`), wedges of ground between sleeve and
//! side are opened (`wedge`), its boundary is cut at twice the size, inlets of ground between legs
//! are opened up to their tips, it is set at the photo's own size, and a strip of ground between
//! hem and frame is found (`frame`). The product of the evidence is the confidence. Below the least
//! that is requested, and where the mask looks like a print on something larger (`larger`), the
//! photo is refused with a picture of the doubt (`doubt`).
//!
//! Agreement of independent methods is far better evidence than any one method's own confidence.
//!
//! Cost: 0.2 to 0.5 s for any photo. Limits: where all methods take the same part of a garment for
//! ground and the photo has an edge there (sleeves of the ground's colour on a body of another),
//! the mask passes.

mod choose;
mod colour_split;
mod contour;
mod doubt;
mod evidence;
mod frame;
mod grid;
mod ground_distance;
mod larger;
mod methods;
mod network;
mod symmetry;
#[cfg(test)]
mod tests;
mod thin;
mod things;
mod walker;
mod wedge;

use super::beside::{Thing, at_size, tell_beside};
use super::finish::{CleanUp, cut_by_frame, fill_holes, mask_of, no_garment};
use super::graph_cut::GraphCut;
use super::marked::marked;
use super::marks::{self, PhotoPlace, of_photo};
use super::refine::refine;
use super::regions::Regions;
use super::small::SmallPhoto;
use choose::{ChosenMask, choose};
use contour::bare_along_frame;
use doubt::{doubtful, refuse};
use grid::{bits, picture};
use image::GrayImage;
use image::imageops::{crop_imm, replace};
use methods::methods;
use std::collections::BTreeMap;
use things::things;
use toile_core::prelude::*;
use wedge::{follow, with_inlets, with_wedges};

/// The binariser that takes what a user marks.
const NEXT: &str = "`GraphCut()`";

/// Takes the best of several methods' masks, and refuses the photo where they leave doubt.
///
/// The default for photos of any ground. Tells its confidence in the mask, 0 to 1; a photo that is
/// refused is shown with what the methods disagree about, and one thing to try. The frame's rim
/// must show ground, its middle the garment. Transparent pixels are ground. Where several things
/// lie apart from each other, the largest is taken, or the one that is marked.
#[stage(
    role = Binariser,
    version = 4,
    source = "Boykov and Jolly, 2001; Grady, 2006; Otsu, 1979",
    example = "Auto(confidence: 0.3)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Auto {
    /// The least confidence in a mask that is taken; 0 takes the best mask whatever the doubt.
    #[param(default = 0.4, min = 0.0, max = 1.0)]
    pub confidence: f64,
    /// The longer side at which the last cut is made; methods are compared at half of it.
    #[param(default = 400, min = 128, max = 2000, unit = "px", trades)]
    pub size: u32,
    /// Holes up to this share of the garment's area are filled.
    #[param(default = 1.0, min = 0.0, max = 1.0)]
    pub holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side. `Block`
    /// completes a half that is cut from the other one, and refuses what is cut on both.
    #[param(default = 0.3, min = 0.0, max = 4.0)]
    pub touch: f64,
    /// Whether a network that has learnt what garments look like is one of the methods.
    #[param(default = true)]
    pub network: bool,
    /// Places on the garment, by photo, as shares of width and height from the left upper corner:
    /// which of several things is meant.
    #[param(default = BTreeMap::new(), min = 0.0, max = 1.0)]
    pub garment: BTreeMap<String, Vec<PhotoPlace>>,
    /// Two opposite corners of a rectangle that holds all of the garment, by photo, likewise.
    #[param(default = BTreeMap::new(), min = 0.0, max = 1.0)]
    pub rect: BTreeMap<String, (PhotoPlace, PhotoPlace)>,
}

/// What is left around a rectangle that a user draws, as a share of its sides.
const AROUND: f64 = 0.04;

#[stage]
impl Auto {
    /// The mask of the garment.
    pub fn run(&self, photo: &Photo, given: Option<&Mask>, cx: &Context) -> Result<Mask, StageError> {
        // `mask_of` refuses a garment that touches the frame too far, and says what goes on past
        // it; the binarisers need not.
        let settings = CleanUp { open: 0, close: 0, holes: self.holes, touch: f64::INFINITY, next: NEXT };
        let mask = mask_of(photo, settings, cx, || self.one_of_all(photo, given, cx))?;
        tell_beside(photo, &mask, None, || things(photo), cx);
        self.holds_the_places(photo, &mask, cx).map(|()| mask)
    }

    /// The mask at the photo's size, before it is finished, of the thing that is meant.
    fn one_of_all(&self, photo: &Photo, given: Option<&Mask>, cx: &Context) -> Result<GrayImage, StageError> {
        let Some([[left, top], [right, bottom]]) = self.part(photo, cx)? else {
            return self.mask(photo, given, cx);
        };
        let (w, h) = photo.pixels.dimensions();
        let at = |share: f64, n: u32| ((share * f64::from(n)).round() as u32).min(n);
        let (x, y) = (at(left, w).min(w - 1), at(top, h).min(h - 1));
        let (width, height) = (at(right, w).saturating_sub(x).max(1), at(bottom, h).saturating_sub(y).max(1));
        let part = Photo {
            pixels: Shared::new(crop_imm(photo.pixels.as_ref(), x, y, width, height).to_image()),
            alpha: photo
                .alpha
                .as_ref()
                .map(|a| Shared::new(crop_imm(a.as_ref(), x, y, width, height).to_image())),
            ..photo.clone()
        };
        let given = given.filter(|mask| mask.pixels.dimensions() == (w, h)).map(|mask| Mask {
            pixels: crop_imm(mask.pixels.as_ref(), x, y, width, height).to_image().into(),
        });
        let found = self.mask(&part, given.as_ref(), cx)?;
        let mut mask = GrayImage::new(w, h);
        replace(&mut mask, &found, x.into(), y.into());
        Ok(mask)
    }

    /// The part of the photo that shows the thing that is meant, with ground around; none where
    /// that is the whole photo.
    fn part(&self, photo: &Photo, cx: &Context) -> Result<Option<[[f64; 2]; 2]>, StageError> {
        if let Some(((a, b), (c, d))) = of_photo(&self.rect, photo, cx).copied() {
            let ([left, right], [top, bottom]) = ([a.min(c), a.max(c)], [b.min(d), b.max(d)]);
            let (x, y) = (AROUND * (right - left), AROUND * (bottom - top));
            return Ok(Some([
                [(left - x).max(0.0), (top - y).max(0.0)],
                [(right + x).min(1.0), (bottom + y).min(1.0)],
            ]));
        }
        let mut all = things(photo);
        let places = of_photo(&self.garment, photo, cx).map_or(&[][..], |places| places);
        if all.len() < 2 {
            return Ok(None);
        }
        let is_meant = |t: &Thing| places.iter().all(|place| t.holds(*place));
        let Some(meant) = all.iter().position(is_meant) else {
            return places.first().map_or(Ok(None), |place| Err(not_held(photo, *place, cx)));
        };
        let meant = all.remove(meant);
        let (w, h) = photo.pixels.dimensions();
        Ok(Some(meant.alone(&all, f64::from(w) / f64::from(h.max(1)))))
    }

    /// Refuses a mask beside the places that are marked.
    fn holds_the_places(&self, photo: &Photo, mask: &Mask, cx: &Context) -> Result<(), StageError> {
        let (w, h) = mask.pixels.dimensions();
        let at = |share: f64, n: u32| ((share * f64::from(n)) as u32).min(n.saturating_sub(1));
        let places = of_photo(&self.garment, photo, cx).map_or(&[][..], |places| places);
        let beside = |(x, y): &&PhotoPlace| mask.pixels.get_pixel(at(*x, w), at(*y, h)).0[0] == 0;
        places.iter().find(beside).map_or(Ok(()), |place| Err(not_held(photo, *place, cx)))
    }

    /// Marks for photos that are not there.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let photos = crate::photo::sides(&placed.sources());
        let photos = photos.as_deref();
        let mut all = marks::check("garment", self.garment.keys(), photos);
        all.extend(marks::check("rect", self.rect.keys(), photos));
        all
    }

    /// The mask at the photo's size, before it is finished.
    fn mask(&self, photo: &Photo, given: Option<&Mask>, cx: &Context) -> Result<GrayImage, StageError> {
        let small = SmallPhoto::of(photo, self.size / 2);
        let large = SmallPhoto::of(photo, self.size);
        cx.check()?;
        let given =
            given.map(|mask| same_size(mask, photo).map(|()| at_size(&mask.pixels, &small))).transpose()?;
        let seen = self.network.then(|| network::seen(photo)).transpose()?;
        let found = methods(&small, given, seen.as_ref(), cx)?;
        cx.progress(0.6, "methods compared");
        let garment = seen.as_ref().map(|seen| network::garment(&small, seen));
        let Some(choice) = choose(&small, &large, &found, garment.as_deref(), cx)? else {
            return Err(no_garment(photo, "no method parts it from the ground along the frame", NEXT));
        };
        let ChosenMask { coarse, evidence, larger, .. } = &choice;
        let confidence = if larger.is_some() { 0.0 } else { evidence.confidence() };
        cx.figure("confidence", confidence, "");
        cx.figure("agreement", evidence.agreement, "");
        cx.figure("edges", 100.0 * evidence.support, "% of the outline");
        cx.figure("symmetry", evidence.symmetry, "");
        cx.figure("seen", evidence.seen, "");
        let large = match seen.zip(garment) {
            Some((seen, garment)) if network::agrees(&coarse.mask, &garment) => {
                network::with_odds(large, &seen)
            }
            _ => large,
        };
        let cut = GraphCut::default();
        let (fine, inlets) =
            with_inlets(&cut.fine(&large, coarse, cx)?, &cut.raw_at(&large, coarse, cx)?, large.w);
        let mut mask = refine(photo, &large, &fine, cx)?;
        let (w, h) = mask.dimensions();
        let in_photo =
            |at: usize, of: usize, to: u32| ((2 * at as u32 + 1) * to / (2 * of as u32)).min(to - 1);
        for [x, y] in inlets {
            follow(&mut mask, photo, [in_photo(x, large.w, w), in_photo(y, large.h, h)]);
        }
        frame::without_strips(&mut mask, photo);
        let mask = opened(mask);
        if confidence < self.confidence {
            cx.so_far(doubtful(photo, &mask, &small, &found));
            return Err(refuse(&photo.file, &choice, confidence, cx.stage()));
        }
        self.whole(&mask, photo, bare_along_frame(&large, &fine), cx)?;
        Ok(mask)
    }

    /// Refuses a garment that the frame cuts. `bare` is the length of what ends beside the frame
    /// without an edge, as a share of the shorter side.
    fn whole(&self, mask: &GrayImage, photo: &Photo, bare: f64, cx: &Context) -> Result<(), StageError> {
        let regions = Regions::of(mask);
        let frame = regions.by_size().first().map_or(0, |&i| regions.pieces[i].frame);
        let (w, h) = mask.dimensions();
        let side = f64::from(w.min(h));
        let pixels = bare * side + frame as f64;
        if pixels <= self.touch * side {
            return Ok(());
        }
        cx.so_far(marked(photo, mask));
        Err(cut_by_frame(photo, pixels, cx.stage(), NEXT))
    }
}

/// The refusal of a mark that lies on no thing.
fn not_held(photo: &Photo, (x, y): PhotoPlace, cx: &Context) -> StageError {
    let set = format!("--set 'stages.{}.rect={{\"{}\": ((0.1, 0.1), (0.5, 0.9))}}'", cx.stage(), cx.entry());
    StageError::invalid(format!(
        "what was found in \"{}\" does not contain the marked place ({x}, {y})",
        photo.file
    ))
    .hint(format!(
        "places are shares of the photo's width and height from its left upper corner; or draw a rectangle around the garment: {set}"
    ))
    .at("garment")
}

fn same_size(mask: &Mask, photo: &Photo) -> Result<(), StageError> {
    let (m, p) = (mask.pixels.dimensions(), photo.pixels.dimensions());
    match m == p {
        true => Ok(()),
        false => Err(StageError::invalid(format!(
            "the mask has {} x {} pixels, its photo {} x {}",
            m.0, m.1, p.0, p.1
        ))),
    }
}

/// The mask with wedges of ground opened; its other holes stay as they are.
fn opened(mut mask: GrayImage) -> GrayImage {
    let solid = bits(&fill_holes(mask.clone(), 1.0));
    let open = with_wedges(&solid, &bits(&mask), mask.width() as usize);
    let cut = solid.iter().zip(&open).map(|(solid, open)| *solid && !open);
    mask.iter_mut().zip(cut).filter(|(_, cut)| *cut).for_each(|(v, _)| *v = 0);
    mask
}

/// What each method finds, at a reduced size, for tools that compare them.
///
/// # Errors
/// Cancelled.
pub fn candidates(photo: &Photo, cx: &Context) -> Result<Vec<(&'static str, GrayImage)>, StageError> {
    let small = SmallPhoto::of(photo, 200);
    let found = methods(&small, None, Some(&network::seen(photo)?), cx)?;
    Ok(found.into_iter().map(|f| (f.name, picture(&f.mask, small.w, small.h))).collect())
}
