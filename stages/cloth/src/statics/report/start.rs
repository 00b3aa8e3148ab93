//! Checks of the initial positions of a scene, before anything is solved.
//!
//! A fault of the start that only shows while solving is reported late and as another one: panels
//! that lie in each other as intersections that cannot be resolved, a reversed seam as panels that
//! are too small. So these are checked: vertices in the body, seams (`seams`: pins that they would
//! bring together, reversed pairs), and cloth that lies in cloth (`touching`).
//!
//! Cost: one distance to the body per vertex and a search for neighbours, O(n log n). Limit:
//! crossings on a fine mesh alone are not refused, for the garment starts on a coarser one without
//! crossings.

mod seams;
mod touching;

pub(crate) use seams::probably_reversed;
pub use seams::surely_reversed;
pub(crate) use touching::crossings_at_start;
pub(crate) use touching::{crossing, crossings};

use crate::contact::collision_surface::CollisionSurface;
use crate::contact::start::{DEEPEST, clear_start};
use crate::error::ClothError;
use crate::scene::Scene;
use crate::statics::levels::assemble::{cloths, layer_thickness};
use crate::statics::levels::pieces::Pieces;
use crate::statics::report::words::{both, list, place};
use toile_geometry::signed_distance::Nearest;
use toile_geometry::{Vec3, cloth_tree::ClothTree};

/// A fault of the initial positions.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StartError {
    /// Vertices start inside the body, too deep to be pushed out.
    #[error(
        "{vertices} vertices start inside the body, the deepest by {:.0} mm: of {panel} at {}; place the panels outside it, for only \
         what is less than {:.0} mm deep is moved out",
        1e3 * depth, place(at), 1e3 * DEEPEST
    )]
    InBody {
        /// How many.
        vertices: usize,
        /// The deepest, m.
        depth: f64,
        /// The panel of the deepest one.
        panel: String,
        /// Where the deepest one starts, m.
        at: Vec3,
    },
    /// Cloth that passes through cloth.
    #[error(
        "{} at the start: {pairs} pairs of an edge and a triangle cross, one at {}{}; lay them out so that none do",
        both(panels, "pass through", "passes through"), place(at), others(*more)
    )]
    Crossing {
        /// The two panels that cross most.
        panels: [String; 2],
        /// How many crossings these have.
        pairs: usize,
        /// Where one of the crossings is, m.
        at: Vec3,
        /// How many other pairs of panels cross.
        more: usize,
    },
    /// Cloth that lies in cloth, so that their sides cannot be told apart.
    #[error(
        "{} at the start: {:.0} % of {} is nearer than {:.3} mm, one place is {}{}; lay them {:.1} mm apart, which is the thickness of \
         the cloth",
        both(panels, "lie in", "lies in"), 1e2 * share, panels[0], 1e3 * within, place(at), others(*more), 1e3 * thickness
    )]
    Lying {
        /// The panel and what it lies in.
        panels: [String; 2],
        /// The share of its area that does.
        share: f64,
        /// The distance below which cloth counts as lying in cloth, m.
        within: f64,
        /// The thickness of self-contact, m.
        thickness: f64,
        /// One place of it, m.
        at: Vec3,
        /// How many other pairs of panels lie in each other.
        more: usize,
    },
    /// A panel that starts much smaller than it is cut.
    #[error(
        "{panel} starts squeezed together: {:.0} % of it is so narrow that it lies in itself, at {} a triangle that is cut {:.3} mm high \
         starts with {:.3} mm; lay it out as large as it is cut",
        1e2 * share, place(at), 1e3 * cut, 1e3 * height
    )]
    Squeezed {
        /// The panel.
        panel: String,
        /// The share of its area that is.
        share: f64,
        /// One place of it, m.
        at: Vec3,
        /// The height of the triangle there where it starts, m.
        height: f64,
        /// The same as it is cut, m.
        cut: f64,
    },
    /// Seams whose two sides run in opposite directions.
    #[error(
        "the pairs of {} run against each other: the two sides start {:.0} mm apart in the mean, and {:.0} mm if the order of \
         one is turned round; list the second vertices of the pairs in reverse order",
        named(seams), 1e3 * apart, 1e3 * turned
    )]
    Reversed {
        /// Their names.
        seams: Vec<String>,
        /// Mean distance of the pairs, m.
        apart: f64,
        /// The same with one side reversed, m.
        turned: f64,
    },
    /// A seam between pins at two places.
    #[error(
        "seam '{seam}' sews together vertices that are pinned {:.1} mm apart; pin them at one place, or unpin one of them",
        1e3 * gap
    )]
    PinnedApart {
        /// The seam.
        seam: String,
        /// The distance of the pins, m.
        gap: f64,
    },
}

fn others(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", and so do two other panels".into(),
        n => format!(", and so do {n} other pairs of panels"),
    }
}

fn named(seams: &[String]) -> String {
    format!("{} {}", if seams.len() == 1 { "seam" } else { "seams" }, list(seams))
}

/// The initial positions, with vertices a little inside the body moved out.
///
/// # Errors
/// [`StartError`], or a fault of the mesh.
pub(crate) fn check<E: From<StartError> + From<ClothError>>(
    scene: &Scene,
    surface: Option<&dyn CollisionSurface>,
    join_gap: f64,
) -> Result<Vec<Vec3>, E> {
    seams::check_pins(scene, join_gap)?;
    let (start, is_worn) = cleared(scene, surface)?;
    if is_worn {
        seams::check_order(scene, &start)?;
    }
    Ok(start)
}

/// The initial positions, with vertices inside the body moved out to its nearest point, at any
/// depth.
///
/// # Errors
/// [`StartError::PinnedApart`]: pins that seams can never bring together.
pub(crate) fn moved_out<E: From<StartError>>(
    scene: &Scene,
    surface: Option<&dyn CollisionSurface>,
    join_gap: f64,
) -> Result<Vec<Vec3>, E> {
    seams::check_pins(scene, join_gap)?;
    let Some(surface) = surface else { return Ok(scene.positions.clone()) };
    let near = surface.nearest(&scene.positions, &vec![f64::INFINITY; scene.positions.len()]);
    let out = |(p, n): (&Vec3, Option<Nearest>)| match n {
        Some(n) if n.distance < scene.material.thickness => n.point + n.normal * scene.material.thickness,
        _ => *p,
    };
    Ok(scene.positions.iter().zip(near).map(out).collect())
}

/// Refuses cloth that lies in cloth where it starts.
///
/// # Errors
/// [`StartError::Lying`], [`StartError::Squeezed`], or a fault of the mesh.
pub(crate) fn check_lying<E: From<StartError> + From<ClothError>>(
    scene: &Scene,
    pieces: &Pieces,
    start: &[Vec3],
) -> Result<(), E> {
    if !scene.self_collision {
        return Ok(());
    }
    let cloths = cloths(scene);
    let sheet = pieces.open_sheet(&cloths)?;
    let tree = ClothTree::new(sheet.triangles(), start).sewing(pieces.point.clone());
    let thickness = layer_thickness(&cloths, pieces.panel.iter().map(|&p| p as usize), &sheet);
    touching::check_squeezed(scene, pieces, start, thickness)?;
    Ok(touching::check_lying(scene, pieces, &tree, start, thickness)?)
}

/// The initial positions, with vertices a little inside the body moved out, and whether there is a
/// body.
fn cleared(scene: &Scene, surface: Option<&dyn CollisionSurface>) -> Result<(Vec<Vec3>, bool), StartError> {
    let Some(surface) = surface else { return Ok((scene.positions.clone(), false)) };
    clear_start(&scene.positions, surface, scene.material.thickness).map_err(|sunk| {
        let number = scene.panels.iter().position(|p| p.vertices.contains(&sunk.deepest));
        StartError::InBody {
            vertices: sunk.vertices,
            depth: sunk.depth,
            panel: crate::statics::report::words::panel(scene, number.map_or(0, |k| k as u32 + 1)),
            at: scene.positions[sunk.deepest],
        }
    })
}

#[cfg(test)]
mod tests;
