//! `Transfer`: panels into space as an earlier drape of the same pattern lies.
//!
//! Method: each vertex takes the place of its flat point in the earlier garment, by the weights of
//! the triangle that it lies in. Cost: linear in vertices. Limits: what was flat between the old
//! vertices is flat still: on a body, new vertices start a little nearer to the skin than the old
//! ones, and a solver has to push them out.

use super::sew::seams;
use super::whole::{offsets, whole};
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// A vertex beyond the earlier garment's panel by more than this belongs to another pattern,
/// metres.
const REACH: f64 = 0.02;

/// No garment is farther away, metres.
const FARTHEST: f64 = 1e6;

/// Places panels where an earlier drape of the same pattern has them.
///
/// For a second, finer mesh of a garment: drape a coarse mesh, mesh again (finer, or graded to the
/// folds that have formed), carry the drape over, and let a solver settle it.
/// `StaticEquilibrium` goes on from the carried state straight; with `from_here: false`, it would
/// begin anew on coarse meshes. The earlier garment must be sewn.
#[stage(
    role = Placement,
    source = "nested iteration, as in multigrid (Brandt 1977)",
    example = "Transfer()",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Transfer;

#[stage]
impl Transfer {
    pub(crate) fn run(
        &self,
        panels: Set<Panel>,
        plan: &SewingPlan,
        fabric: &Fabric,
        drape: &Garment,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let offsets = offsets(&panels)?;
        let mut points = Vec::new();
        for (name, (_, panel)) in &offsets {
            cx.check()?;
            points.extend(carried(name, panel, drape)?);
        }
        Ok(whole(&offsets, seams(plan, &offsets)?, fabric, points))
    }
}

/// Where the vertices of a panel come to lie.
fn carried(name: &str, panel: &Panel, drape: &Garment) -> Result<Vec<Point3>, StageError> {
    let Some(old) = drape.panels.iter().find(|p| p.name == name) else {
        let known: Vec<String> = drape.panels.iter().map(|p| format!("\"{}\"", p.name)).collect();
        return Err(StageError::invalid(format!("the earlier garment has no panel \"{name}\""))
            .hint(format!("its panels are {}", known.join(", "))));
    };
    let triangles = &drape.triangles[old.triangles.clone()];
    let flat = triangles.iter().map(|t| t.map(|v| drape.rest[v as usize])).collect();
    let locator = Locator::new(flat, REACH)
        .ok_or_else(|| StageError::invalid(format!("panel \"{name}\" of the earlier garment has no area")))?;
    let place = |p: &Point2| {
        let found = locator.find(*p).ok_or_else(|| beyond(name, *p))?;
        let at = found.in_space(triangles[found.triangle].map(|v| drape.positions[v as usize]));
        if at.coords.amax() < FARTHEST { Ok(at) } else { Err(torn(name, *p)) }
    };
    panel.positions.iter().map(place).collect()
}

fn torn(panel: &str, p: Point2) -> StageError {
    let (x, y) = (p.x * 1e3, p.y * 1e3);
    StageError::invalid(format!(
        "panel \"{panel}\" of the earlier garment lies farther away than 1000 km near ({x:.1}, {y:.1}) mm"
    ))
}

fn beyond(panel: &str, p: Point2) -> StageError {
    StageError::invalid(format!(
        "panel \"{panel}\" reaches more than {:.0} mm beyond the earlier garment's near ({:.1}, {:.1}) mm",
        REACH * 1e3,
        p.x * 1e3,
        p.y * 1e3
    ))
    .hint("both must be meshes of the same outlines")
}
