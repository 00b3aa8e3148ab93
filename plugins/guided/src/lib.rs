//! A stage crate as a third party writes it: one denoiser, one registration line.
//!
//! `src/main.rs` is a `toile` command that knows this stage besides the built-in ones.

mod filter;

pub use filter::guided;

use toile_core::prelude::*;

/// Takes grain off and keeps edges, at a cost that does not grow with the radius.
///
/// The photo guides itself: where a window varies by less than `noise`, it becomes flat; where it
/// varies by more, as at the garment's outline, it stays.
#[stage(
    role = Denoiser,
    source = "He, Sun, Tang, 2010",
    example = "Guided(radius: 4, noise: 12.0)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct Guided {
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
        Ok(photo.with_pixels(guided(&photo.pixels, self.radius as usize, self.noise, cx)?))
    }
}

/// Adds this crate's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Guided>();
}
