//! The built-in stages of Toile, gathered from the crates that hold them, in the order in which
//! data passes through: [`toile_image`], [`toile_views`], [`toile_pattern`], [`toile_body`],
//! [`toile_drape`], [`toile_output`].

pub use toile_body as body;
pub use toile_drape::{collide, drape, engine, fabric, measure, scene, stitch};
pub use toile_image::{binarise, denoise, edges, photo};
pub use toile_output::{fit, flat, render, texture, write};
pub use toile_pattern::{mesh, pattern, place, smooth, style};
pub use toile_views as views;

use toile_core::{Registry, Role, Section};

/// The crates that hold them, by name.
pub const CRATES: [&str; 6] =
    ["toile-image", "toile-views", "toile-pattern", "toile-body", "toile-drape", "toile-output"];

/// Adds every built-in stage: the one line by which a program gets them all.
pub fn register(registry: &mut Registry) {
    toile_image::register(registry);
    toile_views::register(registry);
    toile_pattern::register(registry);
    toile_body::register(registry);
    toile_drape::register(registry);
    toile_output::register(registry);
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
