//! Grey levels along lines beside an edge.

use crate::pixels::colour;
use crate::segments::Segment;
use image::RgbImage;
use nalgebra::{Point2, Vector2};

/// An edge with its frame: x along it from its start, depth to its right where y grows downwards.
#[derive(Debug, Clone)]
pub(crate) struct Strip {
    start: Point2<f64>,
    pub(crate) along: Vector2<f64>,
    across: Vector2<f64>,
    /// Pixels along it.
    pub(crate) length: usize,
}

/// Half the window of the mean that is taken off, pixels.
const WINDOW: usize = 24;

impl Strip {
    pub(crate) fn of(edge: &Segment) -> Option<Self> {
        let along = (edge.b - edge.a).try_normalize(1e-6)?;
        let across = Vector2::new(-along.y, along.x);
        Some(Strip { start: edge.a, along, across, length: edge.length() as usize })
    }

    /// The photo's point at `x` pixels along the strip and `depth` pixels across it.
    pub(crate) fn place(&self, x: f64, depth: f64) -> Point2<f64> {
        self.start + self.along * x + self.across * depth
    }

    /// Grey levels each pixel along a line at a depth, less their mean around.
    pub(crate) fn profile(&self, photo: &RgbImage, depth: f64) -> Vec<f64> {
        let grey = |x: usize| {
            let two = [-0.5, 0.5].map(|s| {
                let p = self.place(x as f64, depth + s);
                colour(photo, p.x, p.y).iter().sum::<f32>()
            });
            f64::from(two[0] + two[1]) / 6.0
        };
        less_mean(&(0..self.length).map(grey).collect::<Vec<f64>>())
    }
}

/// Values less the mean of those around.
fn less_mean(values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    values.iter().for_each(|v| sums.push(sums[sums.len() - 1] + v));
    let around = |i: usize| {
        let (a, b) = (i.saturating_sub(WINDOW), (i + WINDOW + 1).min(values.len()));
        (sums[b] - sums[a]) / (b - a) as f64
    };
    values.iter().enumerate().map(|(i, v)| v - around(i)).collect()
}
