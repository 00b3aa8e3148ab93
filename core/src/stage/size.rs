//! The size of what a stage made.

use super::PortValue;
use crate::artifact::{Artifact, Body, Garment, Mask, Model, Outline, Panel, Photo};
use crate::cost::{Quantity, Size};
use std::any::Any;

impl PortValue {
    /// Its size, of a set all entries together. Empty for kinds whose size no stage's work depends
    /// on.
    pub fn size(&self) -> Size {
        self.entries().into_iter().fold(Size::new(), |sum, (_, a)| sum.plus(&of_artifact(a.as_ref())))
    }
}

fn of_artifact(artifact: &dyn Artifact) -> Size {
    let any: &dyn Any = artifact;
    let size = Size::new();
    let pixels = |(w, h): (u32, u32)| f64::from(w) * f64::from(h);
    if let Some(photo) = any.downcast_ref::<Photo>() {
        return size.with(Quantity::Pixels, pixels(photo.pixels.dimensions()));
    }
    if let Some(mask) = any.downcast_ref::<Mask>() {
        return size.with(Quantity::Pixels, pixels(mask.pixels.dimensions()));
    }
    if let Some(outline) = any.downcast_ref::<Outline>() {
        let points = outline.outer.points.len() + outline.holes.iter().map(|h| h.points.len()).sum::<usize>();
        return size.with(Quantity::Area, outline.area()).with(Quantity::Points, points as f64);
    }
    if let Some(panel) = any.downcast_ref::<Panel>() {
        return size.with(Quantity::Triangles, panel.triangles.len() as f64);
    }
    if let Some(garment) = any.downcast_ref::<Garment>() {
        return size.with(Quantity::Triangles, garment.triangles.len() as f64);
    }
    if let Some(body) = any.downcast_ref::<Body>() {
        return size.with(Quantity::BodyTriangles, body.triangles.len() as f64);
    }
    match any.downcast_ref::<Model>() {
        Some(model) => {
            let texels = model.textures.iter().map(|t| pixels(t.pixels.dimensions())).sum();
            size.with(Quantity::Texels, texels)
        }
        None => size,
    }
}
