//! The built-in stages of Toile: a folder a role, a file a stage.

pub mod binarise;
pub mod body;
pub mod collide;
pub mod denoise;
pub mod drape;
pub mod edges;
pub mod engine;
pub mod fabric;
mod file_names;
#[cfg(test)]
mod fixtures;
pub mod flat;
mod grid;
pub mod measure;
pub mod mesh;
pub mod pattern;
pub mod photo;
pub mod place;
pub mod render;
pub mod scene;
pub mod smooth;
pub mod stitch;
pub mod style;
pub mod texture;
pub mod write;

use toile_core::{Registry, Role, Section};

/// Adds every built-in stage: the one line by which a program gets them all.
pub fn register(registry: &mut Registry) {
    photo::register(registry);
    denoise::register(registry);
    binarise::register(registry);
    edges::register(registry);
    style::register(registry);
    mesh::register(registry);
    smooth::register(registry);
    body::register(registry);
    fabric::register(registry);
    place::register(registry);
    scene::register(registry);
    pattern::register(registry);
    collide::register(registry);
    stitch::register(registry);
    drape::register(registry);
    flat::register(registry);
    measure::register(registry);
    texture::register(registry);
    write::register(registry);
    sections(registry);
}

/// The top-level fields of pipeline files that stand for stages.
fn sections(registry: &mut Registry) {
    registry.section(Section::table("photos", "Photos", "photos"));
    registry.section(Section::stage("style", Role::Style));
    registry.section(Section::table("seams", "Seams", "seams"));
    registry.section(Section::stage("scene", Role::Reader));
    registry.section(Section::stage("pattern", Role::Reader));
    registry.section(Section::stage("body", Role::Body));
    registry.section(Section::stage("fabric", Role::Fabric));
    registry.section(Section::stage("garment", Role::Reader));
}
