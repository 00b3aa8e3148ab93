//! A parameter whose reading panics.

use serde::{Deserialize, Deserializer, Serialize};
use toile_core::prelude::*;

/// A whole number that must not be 13.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Trap(u32);

impl<'de> Deserialize<'de> for Trap {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        match u32::deserialize(d)? {
            13 => panic!("thirteen"),
            n => Ok(Trap(n)),
        }
    }
}

impl ParamType for Trap {
    fn describe() -> String {
        "a trap".into()
    }
}

/// Panics when it is made with 13.
#[stage(role = Denoiser)]
pub struct PanicsInCreate {
    /// Not 13.
    trap: Trap,
}

#[stage]
impl PanicsInCreate {
    fn run(&self, photo: &Photo, _: &Context) -> Result<Photo, StageError> {
        Ok(photo.clone())
    }
}
