//! Stages whose runs go wrong, each in its own way.

use std::time::{Duration, Instant};
use toile_core::prelude::*;

/// Panics when it runs.
#[stage(role = Denoiser)]
pub struct PanicsInRun;

#[stage]
impl PanicsInRun {
    fn run(&self, photo: &Photo, _: &Context) -> Result<Photo, StageError> {
        match photo.pixels.width() {
            0 => Ok(photo.clone()),
            w => panic!("a photo of {w} pixels frightens me"),
        }
    }
}

/// Panics when it is dropped.
#[stage(role = Denoiser)]
pub struct PanicsInDrop {
    /// True where it does.
    armed: bool,
}

#[stage]
impl PanicsInDrop {
    fn run(&self, photo: &Photo, _: &Context) -> Result<Photo, StageError> {
        Ok(photo.clone())
    }
}

impl Drop for PanicsInDrop {
    fn drop(&mut self) {
        if self.armed {
            panic!("dropped");
        }
    }
}

/// Panics in a loop on the program's threads.
#[stage(role = Denoiser)]
pub struct PanicsInLoop;

#[stage]
impl PanicsInLoop {
    fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        cx.parallel_for(8, |i| assert!(i != 5, "five"));
        Ok(photo.clone())
    }
}

/// Makes a panel with a vertex that is no number.
#[stage(role = Mesher)]
pub struct GivesNan;

#[stage]
impl GivesNan {
    fn run(&self, _outline: &Outline, _: &Context) -> Result<Panel, StageError> {
        Ok(Panel {
            positions: vec![Point2::new(f64::NAN, 0.0), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)],
            ..triangle()
        })
    }
}

/// Makes a panel whose triangle names a vertex that does not exist.
#[stage(role = Mesher)]
pub struct GivesBadTriangles;

#[stage]
impl GivesBadTriangles {
    fn run(&self, _outline: &Outline, _: &Context) -> Result<Panel, StageError> {
        Ok(Panel { triangles: vec![[0, 1, 7]], ..triangle() })
    }
}

/// Makes a square of two triangles, of which the second lies with its back up.
#[stage(role = Mesher)]
pub struct TurnsOver;

#[stage]
impl TurnsOver {
    fn run(&self, _outline: &Outline, _: &Context) -> Result<Panel, StageError> {
        let at = Point2::new;
        Ok(Panel {
            positions: vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
            triangles: vec![[0, 1, 2], [0, 3, 2]],
            boundary: vec![0, 1, 2, 3],
            ..triangle()
        })
    }
}

/// Turns a triangle of a garment over.
#[stage(role = Draper)]
pub struct TurnsCloth;

#[stage]
impl TurnsCloth {
    fn run(&self, garment: &Garment, _: &Context) -> Result<Garment, StageError> {
        let mut out = garment.clone();
        if let Some(last) = out.triangles.last_mut() {
            last.swap(0, 1);
        }
        Ok(out)
    }
}

fn triangle() -> Panel {
    Panel {
        positions: vec![Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)],
        triangles: vec![[0, 1, 2]],
        boundary: vec![0, 1, 2],
        holes: vec![],
        edges: vec![],
        inner: vec![],
        photo_px: vec![],
        outline_area: 0.5,
        outline_length: 3.414,
    }
}

/// Never asks whether to stop, for a minute.
#[stage(role = Denoiser)]
pub struct NeverStops;

#[stage]
impl NeverStops {
    fn run(&self, photo: &Photo, _: &Context) -> Result<Photo, StageError> {
        let until = Instant::now() + Duration::from_secs(60);
        while Instant::now() < until {
            std::thread::sleep(Duration::from_millis(20));
        }
        Ok(photo.clone())
    }
}

/// Refuses its input with a hint.
#[stage(role = Denoiser)]
pub struct Forgets {
    /// What it forgot.
    #[param(default = 3, min = 1, max = 9)]
    what: u32,
}

#[stage]
impl Forgets {
    fn run(&self, _photo: &Photo, _: &Context) -> Result<Photo, StageError> {
        let message = format!("it forgot {} things", self.what);
        Err(StageError::invalid(message).hint("remember them").at("what"))
    }
}

/// Counts on the program's threads, and says so.
#[stage(role = Denoiser)]
pub struct Loops;

#[stage]
impl Loops {
    fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        let squares: usize = cx.parallel_map(100, |i| i * i).into_iter().sum();
        cx.check()?;
        cx.progress(0.5, "half way");
        cx.figure("squares", squares as f64, "");
        cx.warn(format!("{} of {}", cx.entry(), cx.stage()));
        Ok(photo.clone())
    }
}

/// Adds the first byte of a file to every level.
#[stage(role = Denoiser, contracts(Deterministic))]
pub struct Tints {
    /// The file, without its ending.
    #[param(default = "tint".into())]
    stem: String,
}

#[stage]
impl Tints {
    fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        let tint = cx.read(&format!("{}.txt", self.stem))?.first().copied().unwrap_or(0);
        let mut pixels = photo.pixels.as_ref().clone();
        pixels.iter_mut().for_each(|v| *v = v.saturating_add(tint));
        Ok(photo.with_pixels(pixels))
    }
}

/// Multiplies every level: a stage as it should be.
#[stage(role = Denoiser, source = "none", example = "Shades(by: 0.5)", contracts(Deterministic, ThreadInvariant))]
pub struct Shades {
    /// The factor.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    by: f64,
}

#[stage]
impl Shades {
    fn run(&self, photo: &Photo, _: &Context) -> Result<Photo, StageError> {
        let mut pixels = photo.pixels.as_ref().clone();
        pixels.iter_mut().for_each(|v| *v = (f64::from(*v) * self.by) as u8);
        Ok(photo.with_pixels(pixels))
    }
}
