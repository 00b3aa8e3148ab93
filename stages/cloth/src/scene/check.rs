//! Checks that every scene must pass before it is solved. Cost: O(n log n).

use super::{Scene, SceneError};
use crate::energy::Air;
use crate::error::{ClothError, check_parameter};
use crate::fabric::Fabric;
use nalgebra::Vector3;

/// Checks that every index points at something and every coordinate is finite.
pub(super) fn check_lists(scene: &Scene) -> Result<(), SceneError> {
    let n = scene.rest.len();
    if scene.triangles.is_empty() {
        return Err(ClothError::EmptyScene.into());
    }
    if scene.positions.len() != n {
        return Err(SceneError::Length { name: "positions", found: scene.positions.len(), wanted: n });
    }
    finite("rest_uv", scene.rest.iter().map(|p| p.iter().all(|v| v.is_finite())))?;
    finite("positions", scene.positions.iter().map(is_finite))?;
    refers("triangle", scene.triangles.iter().map(|t| &t[..]), n)?;
    refers("pin", scene.pinned.iter().map(std::slice::from_ref), n)?;
    refers("seam pair", scene.seams.iter().flat_map(|s| &s.pairs).map(|p| &p[..]), n)?;
    check_ranges(scene)?;
    let Some(body) = &scene.body else { return Ok(()) };
    if body.triangles.is_empty() {
        return Err(SceneError::EmptyBody);
    }
    finite("body", body.vertices.iter().map(is_finite))?;
    Ok(refers("body triangle", body.triangles.iter().map(|t| &t[..]), body.vertices.len())?)
}

/// Checks everything.
pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    check_lists(scene)?;
    check_held(scene)?;
    scene.held.check(scene)?;
    finite("held.slides", scene.held.slides.iter().map(is_finite))?;
    for phase in &scene.phases {
        finite("gravity", std::iter::once(is_finite(&phase.gravity)))?;
        check_parameter("seconds", phase.seconds, |s| s >= 0.0, "0 s or more")?;
        phase.air.as_ref().map_or(Ok(()), Air::check)?;
    }
    check_panels(scene)?;
    check_seams(scene)?;
    check_gathers(scene)?;
    check_folds(scene)?;
    check_bands(scene)?;
    check_fabric(&scene.material)?;
    if let Some(limit) = scene.strain_limit {
        check_parameter("strain_limit.warp", limit.warp, |v| v > 0.0, "above 0")?;
        check_parameter("strain_limit.weft", limit.weft, |v| v > 0.0, "above 0")?;
    }
    if let Some(body) = &scene.body {
        check_parameter("body.friction", body.friction, |v| v >= 0.0, "0 or more")?;
    }
    Ok(())
}

/// A vertex of no triangle has neither mass nor stiffness: it must be pinned.
fn check_held(scene: &Scene) -> Result<(), SceneError> {
    let mut held = vec![false; scene.rest.len()];
    scene.triangles.iter().flatten().chain(&scene.pinned).for_each(|&v| held[v as usize] = true);
    let Some(vertex) = held.iter().position(|h| !h) else { return Ok(()) };
    for seam in &scene.seams {
        if let Some(pair) = seam.pairs.iter().position(|p| p.contains(&(vertex as u32))) {
            return Err(SceneError::SewnToNothing { seam: seam.name.clone(), pair, vertex: vertex as u32 });
        }
    }
    Err(SceneError::Loose { vertex })
}

fn is_finite(p: &Vector3<f64>) -> bool {
    p.iter().all(|v| v.is_finite())
}

fn finite(field: &'static str, good: impl Iterator<Item = bool>) -> Result<(), ClothError> {
    match good.enumerate().find(|(_, good)| !good) {
        Some((index, _)) => Err(ClothError::NonFiniteInput { field, index }),
        None => Ok(()),
    }
}

fn refers<'a>(
    what: &'static str,
    groups: impl Iterator<Item = &'a [u32]>,
    count: usize,
) -> Result<(), ClothError> {
    for (index, group) in groups.enumerate() {
        if let Some(&v) = group.iter().find(|&&v| v as usize >= count) {
            return Err(ClothError::VertexOutOfRange { what, index, vertex: v as usize, count });
        }
    }
    Ok(())
}

fn check_panels(scene: &Scene) -> Result<(), SceneError> {
    for panel in &scene.panels {
        panel.material.iter().try_for_each(check_fabric)?;
        if let Some(friction) = panel.body_friction {
            check_parameter("body_friction", friction, |v| v >= 0.0, "0 or more")?;
        }
    }
    Ok(())
}

fn check_ranges(scene: &Scene) -> Result<(), SceneError> {
    for panel in &scene.panels {
        let both = [
            ("vertices", &panel.vertices, scene.rest.len()),
            ("triangles", &panel.triangles, scene.triangles.len()),
        ];
        for (what, range, count) in both {
            if range.start > range.end || range.end > count {
                let (start, end) = (range.start, range.end);
                return Err(SceneError::PanelRange { panel: panel.name.clone(), what, start, end, count });
            }
        }
    }
    Ok(())
}

fn check_seams(scene: &Scene) -> Result<(), SceneError> {
    let mut seen: Vec<([u32; 2], usize, usize)> = Vec::new();
    for (s, seam) in scene.seams.iter().enumerate() {
        for (pair, &[a, b]) in seam.pairs.iter().enumerate() {
            if a == b {
                return Err(SceneError::SeamPair {
                    seam: seam.name.clone(),
                    pair,
                    why: "sews a vertex to itself",
                });
            }
            seen.push(([a.min(b), a.max(b)], s, pair));
        }
    }
    seen.sort_unstable();
    match seen.windows(2).find(|w| w[0].0 == w[1].0) {
        Some(w) => {
            let (_, s, pair) = w[1];
            Err(SceneError::SeamPair { seam: scene.seams[s].name.clone(), pair, why: "is sewn already" })
        }
        None => Ok(()),
    }
}

fn check_folds(scene: &Scene) -> Result<(), SceneError> {
    for seam in &scene.seams {
        let Some(angle) = seam.fold else { continue };
        let degrees = angle.to_degrees();
        check_parameter("fold", degrees, |v| (0.0..=360.0).contains(&v), "from 0 to 360 degrees")?;
        if !seam.joined {
            return Err(SceneError::FoldOpen { seam: seam.name.clone() });
        }
    }
    Ok(())
}

/// Difference of a gathered seam's ratio from the stated one that is rounding of the pattern.
const GATHER_SLACK: f64 = 0.05;

fn check_gathers(scene: &Scene) -> Result<(), SceneError> {
    for seam in &scene.seams {
        let Some(stated) = seam.gather else { continue };
        check_parameter("gather", stated, |v| v >= 1.0, "1 or more")?;
        let side = |k: usize| -> f64 {
            let way =
                seam.pairs.windows(2).map(|w| scene.rest[w[1][k] as usize] - scene.rest[w[0][k] as usize]);
            way.map(|d| d.norm()).sum()
        };
        let (a, b) = (side(0), side(1));
        let found = a.max(b) / a.min(b);
        if found.is_nan() || (found / stated - 1.0).abs() > GATHER_SLACK {
            return Err(SceneError::Gather { seam: seam.name.clone(), stated, found });
        }
    }
    Ok(())
}

fn check_bands(scene: &Scene) -> Result<(), SceneError> {
    refers(
        "band vertex",
        scene.bands.iter().flat_map(|b| &b.vertices).map(std::slice::from_ref),
        scene.rest.len(),
    )?;
    let panel = |v: u32| scene.panels.iter().position(|p| p.vertices.contains(&(v as usize)));
    for band in &scene.bands {
        check_parameter("band.ratio", band.ratio, |v| v > 0.0, "above 0")?;
        check_parameter("band.stiffness", band.stiffness, |v| v >= 0.0, "0 N or more")?;
        let fault = |why: String| SceneError::BandPath { band: band.name.clone(), why };
        if band.vertices.len() < 2 {
            return Err(fault("its path needs two vertices".into()));
        }
        let sewn =
            |a: u32, b: u32| scene.seams.iter().flat_map(|s| &s.pairs).any(|p| *p == [a, b] || *p == [b, a]);
        for w in band.vertices.windows(2) {
            if panel(w[0]) != panel(w[1]) && !sewn(w[0], w[1]) {
                let why =
                    format!("vertices {} and {} lie on two panels and are not sewn together", w[0], w[1]);
                return Err(fault(why));
            }
        }
    }
    Ok(())
}

/// What a scene needs beyond a valid fabric: a contact layer.
fn check_fabric(fabric: &Fabric) -> Result<(), ClothError> {
    fabric.check()?;
    check_parameter("thickness", fabric.thickness, |v| v > 0.0, "above 0 m")
}
