//! What is wrong with where a scene starts, told before anything is solved.
//!
//! A fault of the start that is found by solving is found late, and told as another: panels that
//! lie in each other as cloth that does not come free, a seam that is sewn the wrong way round as
//! one whose panels are cut too small. Looked at are vertices in the body, seams (`seams`: pins
//! that they would bring together, pairs that run against each other), and cloth in cloth
//! (`touching`).
//!
//! Cost: a distance to the body for each vertex and a search for neighbours, O(n log n). Limit:
//! cloth that crosses on a fine mesh alone is not refused, for the garment starts on a coarser one
//! that is free of crossings.

mod seams;
mod touching;

pub(crate) use seams::probably_reversed;
pub use seams::surely_reversed;
pub(crate) use touching::crossings_at_start;
pub(crate) use touching::{crossing, crossings};

use crate::contact::skin::CollisionSurface;
use crate::contact::start::{DEEPEST, clear_start};
use crate::error::ClothError;
use crate::scene::Scene;
use crate::statics::levels::assemble::{cloths, layer_thickness};
use crate::statics::levels::pieces::Pieces;
use crate::statics::report::words::{both, list, place};
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// What is wrong with a start.
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
        /// How often these do.
        pairs: usize,
        /// Where one of the crossings is, m.
        at: Vec3,
        /// How many other pairs of panels cross.
        more: usize,
    },
    /// Cloth that lies in cloth, so that nothing tells which of the two is above.
    #[error(
        "{} at the start: {:.0} % of {} is nearer than {:.3} mm, one place is {}{}; lay them {:.1} mm apart, which is the thickness of \
         the cloth",
        both(panels, "lie in", "lies in"), 1e2 * share, panels[0], 1e3 * within, place(at), others(*more), 1e3 * thickness
    )]
    Lying {
        /// The panel and what it lies in.
        panels: [String; 2],
        /// The part of its area that does.
        share: f64,
        /// The distance below which cloth lies in cloth, m.
        within: f64,
        /// The distance at which cloth is held off cloth, m.
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
        /// The part of its area that is.
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
        /// The same with one side turned round, m.
        turned: f64,
    },
    /// A seam between pins at two places.
    #[error(
        "seam '{seam}' sews together vertices that are pinned {:.1} mm apart; pin them at one place, or let one of them go",
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

/// Where the vertices start, those a little inside the body moved out.
///
/// # Errors
/// [`StartError`], or what is wrong with the mesh.
pub(crate) fn check<E: From<StartError> + From<ClothError>>(
    scene: &Scene,
    skin: Option<&dyn CollisionSurface>,
    join_gap: f64,
) -> Result<Vec<Vec3>, E> {
    seams::check_pins(scene, join_gap)?;
    let (start, is_worn) = cleared(scene, skin)?;
    if is_worn {
        seams::check_order(scene, &start)?;
    }
    Ok(start)
}

/// Where the vertices start, those inside the body moved out to its nearest point, however deep
/// they are.
///
/// # Errors
/// [`StartError::PinnedApart`]: what seams cannot bring together whatever lies between.
pub(crate) fn moved_out<E: From<StartError>>(
    scene: &Scene,
    skin: Option<&dyn CollisionSurface>,
    join_gap: f64,
) -> Result<Vec<Vec3>, E> {
    seams::check_pins(scene, join_gap)?;
    let Some(skin) = skin else { return Ok(scene.positions.clone()) };
    let near = skin.nearest(&scene.positions, &vec![f64::INFINITY; scene.positions.len()]);
    let out = |(p, n): (&Vec3, Option<Nearest>)| match n {
        Some(n) if n.distance < scene.material.thickness => n.point + n.normal * scene.material.thickness,
        _ => *p,
    };
    Ok(scene.positions.iter().zip(near).map(out).collect())
}

/// Refuses cloth that lies in cloth where it starts.
///
/// # Errors
/// [`StartError::Lying`], [`StartError::Squeezed`], or what is wrong with the mesh.
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

/// The start with vertices that lie a little inside the body moved out, and whether there is a
/// body.
fn cleared(scene: &Scene, skin: Option<&dyn CollisionSurface>) -> Result<(Vec<Vec3>, bool), StartError> {
    let Some(skin) = skin else { return Ok((scene.positions.clone(), false)) };
    clear_start(&scene.positions, skin, scene.material.thickness).map_err(|sunk| {
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
