//! Cameras on a sphere around the garment: one point that all look at, one distance, one focal
//! length.

use super::camera::{Camera, Frame, NEAREST, PORTRAIT_ANGLE, axes, bounds, framed_points};
use toile_core::artifact::{Model, Point3};

/// Turns about the vertical at which the garment must be in the picture.
const TURNS: usize = 24;

/// Share of the picture left free at each side: a view from another height sees a little more of
/// the body.
const MARGIN: f64 = 0.12;

/// What all views of a turntable share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// What every camera looks at, metres.
    pub centre: Point3,
    /// From there to every camera, metres.
    pub distance: f64,
    /// Vertical angle of view, radians.
    pub angle: f64,
    /// Width of a view, px.
    pub width: u32,
    /// Height of a view, px.
    pub height: u32,
}

impl Orbit {
    /// Around a model's garment, near enough that it just fits into every view from these heights
    /// above the horizon, degrees.
    pub fn around(model: &Model, width: u32, height: u32, elevations: &[f64]) -> Orbit {
        let framed: Vec<_> = framed_points(model, Frame::Garment).map(|p| p.coords).collect();
        let (lo, hi) = bounds(&framed);
        let centre = Point3::from((lo + hi) / 2.0);
        let focal = f64::from(height) / 2.0 / (PORTRAIT_ANGLE / 2.0).tan();
        let room = [width, height].map(|s| f64::from(s) / 2.0 * (1.0 - 2.0 * MARGIN));
        let nearest =
            framed_points(model, Frame::Whole).map(|p| (p - centre).norm()).fold(0.0, f64::max) + NEAREST;
        let turns = (0..TURNS).map(|k| std::f64::consts::TAU * k as f64 / TURNS as f64);
        let seen = turns.flat_map(|turn| elevations.iter().map(move |e| axes(turn, e.to_radians())));
        let distance = seen.fold(nearest, |most, [right, up, back]| {
            let fits = |p: &toile_core::artifact::Vector3| {
                let p = p - centre.coords;
                back.dot(&p) + focal * (right.dot(&p).abs() / room[0]).max(up.dot(&p).abs() / room[1])
            };
            framed.iter().map(fits).fold(most, f64::max)
        });
        Orbit { centre, distance, angle: PORTRAIT_ANGLE, width, height }
    }

    /// The camera at a turn about the vertical and a height above the horizon, radians.
    pub(super) fn camera(&self, azimuth: f64, elevation: f64) -> Camera {
        let [right, up, back] = axes(azimuth, elevation);
        let half = [self.width, self.height].map(|s| f64::from(s) / 2.0);
        let focal = half[1] / (self.angle / 2.0).tan();
        Camera { right, up, back, target: self.centre, distance: self.distance, focal, centre: half }
    }
}
