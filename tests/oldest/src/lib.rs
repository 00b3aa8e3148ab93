//! A plugin for ABI 1.0: its tables end before `check`, and it knows no `parallel_for`.
#![allow(clippy::panic)]

use toile_core::prelude::*;

/// Turns dark into light.
#[stage(role = Denoiser, example = "OldInvert(white: 200)", contracts(Deterministic, ThreadInvariant))]
pub struct OldInvert {
    /// The level that becomes black; 13 frightens it.
    #[param(default = Level(255), min = 1, max = 255, unit = "grey levels")]
    white: Level,
}

#[stage]
impl OldInvert {
    fn run(&self, photo: &Photo, _: &Context) -> Result<Photo, StageError> {
        let mut pixels = photo.pixels.as_ref().clone();
        pixels.iter_mut().for_each(|v| *v = self.white.0.saturating_sub(*v));
        Ok(photo.with_pixels(pixels))
    }
}

/// A grey level.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Level(u8);

impl<'de> serde::Deserialize<'de> for Level {
    fn deserialize<D: serde::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        match u8::deserialize(d)? {
            13 => panic!("thirteen"),
            level => Ok(Level(level)),
        }
    }
}

impl ParamType for Level {
    fn describe() -> String {
        "whole number".into()
    }
    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(self.0)]
    }
}

toile_core::plugin!(OldInvert; minor = 0);
