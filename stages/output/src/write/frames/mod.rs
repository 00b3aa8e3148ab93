//! `Frames`: how the garment moved, as files that play it.
//!
//! Solvers that step in time record what this stage asks of them ([`Stage::asks`]): a frame every
//! so many seconds, of all of them together. Cost: 12 bytes a vertex and frame in memory; the texts
//! of OBJ and USDZ take the longest. Limits: the formats' own of 2^31 vertices and frames.

mod glb;
mod mdd;
mod obj;
mod page;
mod pc2;
mod resampled;
#[cfg(test)]
mod tests;
mod usdz;

use crate::file_names::check_name;
use toile_core::Node;
use toile_core::param::ron_text;
use toile_core::prelude::*;

/// What every solver that steps in time calls the time between two frames.
const RECORDED: &str = "frames";

/// Writes how the garment moved while it was sewn and draped: caches, models with an animation, and
/// a page that plays it.
///
/// It stands behind solvers that step in time (`SpringStitcher`, `SpringDraper`, `ImplicitEuler`,
/// `CentralDifferences`, `Xpbd`, `Projective`), and makes them record a frame every `every`
/// seconds; several in a row make one motion. `StaticEquilibrium` goes straight to rest and has
/// none. Written are `motion.pc2` and `motion.mdd` (places of all vertices, in the order of the
/// numbered OBJ files in the folder `motion`), `motion.glb` (morph targets and an animation),
/// `motion.usdz` (time samples) and `motion.html`, which plays it without network or WebGL. Metres,
/// Y up.
#[stage(
    role = Writer,
    source = "Autodesk, PC2, 2004; NewTek, MDD, 2003; Khronos Group, glTF 2.0, 2017; Pixar, USD, 2018",
    example = "Frames(every: 0.04)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct Frames {
    /// The files' name without extension, and the folder of the OBJ files.
    #[param(default = "motion".to_owned())]
    name: String,
    /// Time between two frames: 25 frames a second.
    #[param(default = 0.04, min = 1e-4, max = 100.0, unit = "s")]
    every: f64,
    /// Whether the caches PC2 and MDD are written.
    #[param(default = true)]
    caches: bool,
    /// Whether every frame is written as a numbered OBJ; without, the first alone, which a cache
    /// needs for its triangles.
    #[param(default = true)]
    obj: bool,
    /// Whether a GLB with an animation is written.
    #[param(default = true)]
    glb: bool,
    /// Whether a USDZ with time samples is written.
    #[param(default = true)]
    usdz: bool,
    /// Whether a page that plays the motion is written.
    #[param(default = true)]
    page: bool,
}

#[stage]
impl Frames {
    pub(super) fn run(&self, garment: &Garment, cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        self.check_formats()?;
        let motion = garment.motion.as_deref().filter(|m| !m.is_empty()).ok_or_else(no_motion)?;
        motion.check().map_err(StageError::invalid)?;
        if motion.every > self.every {
            cx.note(format!(
                "frames were recorded every {} s: those in between are interpolated",
                motion.every
            ));
        }
        let other = (motion.every != self.every).then(|| resampled::resampled(motion, self.every));
        let motion = other.as_ref().unwrap_or(motion);
        let name = &self.name;
        let mut files = Vec::new();
        if self.caches {
            files.push(OutputFile::new(format!("{name}.pc2"), pc2::pc2(motion)?));
            files.push(OutputFile::new(format!("{name}.mdd"), mdd::mdd(motion)?));
        }
        if self.obj || self.caches {
            let count = if self.obj { motion.len() } else { 1 };
            cx.check()?;
            files.extend(obj::numbered(name, &motion.triangles, motion.frames().take(count)));
        }
        if self.glb {
            cx.check()?;
            files.push(OutputFile::new(format!("{name}.glb"), glb::glb(motion, name)?));
        }
        if self.usdz {
            cx.check()?;
            files.push(OutputFile::new(format!("{name}.usdz"), usdz::usdz(motion, name)?));
        }
        if self.page {
            cx.check()?;
            files.push(OutputFile::new(format!("{name}.html"), page::page(motion, name)));
        }
        Ok(OutputFiles(files))
    }

    fn asks(&self) -> Vec<(&'static str, String)> {
        vec![(RECORDED, ron_text(&self.every))]
    }

    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let steps = |node: &&Node| node.card.params.iter().any(|p| p.name == RECORDED);
        let none = !placed.sources().iter().any(steps);
        let faults = [check_name(&self.name).err(), self.check_formats().err(), none.then(no_motion)];
        faults.into_iter().flatten().collect()
    }

    fn check_formats(&self) -> Result<(), StageError> {
        if self.caches || self.obj || self.glb || self.usdz || self.page {
            return Ok(());
        }
        let text = "every format is left out: nothing would be written";
        Err(StageError::new(ErrorCode::InvalidParameter, text)
            .hint("leave one of `caches`, `obj`, `glb`, `usdz` and `page` true")
            .at("page"))
    }
}

fn no_motion() -> StageError {
    StageError::invalid("the garment has no motion: no solver before it has recorded frames").hint(
        "put `SpringStitcher(), SpringDraper()` or `ImplicitEuler()` before it, in the place of `StaticEquilibrium()`",
    )
}

/// A count as the caches hold it.
fn most(count: usize) -> Result<i32, StageError> {
    i32::try_from(count).map_err(|_| {
        StageError::invalid("the motion exceeds the 2^31 of its format").hint("take a longer `every`")
    })
}
