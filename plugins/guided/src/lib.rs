//! A denoiser as a third party writes it: the guided filter, by the photo itself or by a
//! bilaterally smoothed photo.

mod bilateral;
mod filter;

pub use filter::{GuidedBy, guided};

use toile_core::prelude::*;

/// What the filter follows.
#[choice]
#[derive(Copy, Eq)]
pub enum FilterGuide {
    /// The photo itself: fastest, keeps some grain along edges.
    Photo,
    /// The photo after a small bilateral filter: cleaner along edges, about three times the time.
    Bilateral,
}

/// Takes grain off and keeps edges, at a cost that does not grow with the radius.
///
/// Where a window of the guide varies by less than `noise`, the photo becomes flat; where it varies
/// by more, as at the garment's outline, it follows the guide. Unlike a bilateral filter it makes
/// no steps out of soft shading.
#[stage(
    role = Denoiser,
    source = "He, Sun, Tang 2010; Petschnigg et al. 2004",
    example = "Guided(guide: Bilateral, radius: 4, noise: 12.0)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct Guided {
    /// What the filter follows.
    #[param(default = FilterGuide::Bilateral, trades, way)]
    pub guide: FilterGuide,
    /// Half the window's width.
    #[param(default = 4, min = 1, max = 100, unit = "px")]
    pub radius: u32,
    /// Standard deviation below which a window counts as flat.
    #[param(default = 12.0, min = 0.1, max = 255.0, unit = "grey levels")]
    pub noise: f64,
}

#[stage]
impl Guided {
    fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        let by = match self.guide {
            FilterGuide::Photo => GuidedBy::Photo,
            FilterGuide::Bilateral => GuidedBy::Bilateral,
        };
        Ok(photo.with_pixels(guided(&photo.pixels, by, self.radius as usize, self.noise, cx)?))
    }
}

toile_core::plugin!(Guided);
