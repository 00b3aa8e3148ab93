//! Extremes of whole scenes through `StaticEquilibrium`: gaps, bodies in the way, seams, stacks,
//! scenes that are none.

use std::ops::ControlFlow;

use nalgebra::Vector3;

use super::{Check, Must, Verdict};
use toile_cloth::contact::body::Body;
use toile_cloth::mesh::Sheet;
use toile_cloth::scene::{Scene, SceneError, Seam, generate};
use toile_cloth::statics::drive::solve::{Equilibrium, StaticEquilibrium, StaticsError};
use toile_geometry::cloth_tree::ClothTree;

/// Widest seam at the end, m.
const CLOSED: f64 = 1e-3;
/// A vertex may be this deep in the body, m.
const DEEPEST: f64 = 1e-4;

/// What makes a scene wrong.
type Spoil = fn(&mut Scene);

pub(super) fn checks(large: bool) -> Vec<Check> {
    let must = Must::Converge;
    let mut checks = Vec::new();
    for gap in [0.0, 0.01, 1.0, 10.0] {
        checks.push(Check::new("seam_gap", format!("{gap} m, hanging"), must, move || sewn(&sheets(gap))));
    }
    for gap in [1.0, 10.0] {
        checks
            .push(Check::new("seam_gap", format!("{gap} m, round a body"), must, move || sewn(&apart(gap))));
    }
    for (name, depth, size) in [("1 mm", 1e-3, 1.0), ("20 mm", 0.02, 1.0), ("panel inside", 0.3, 0.2)] {
        let scene = move || sunk(depth, size);
        checks.push(Check::new("body_penetration_at_start", name, must, move || freed(&scene())));
    }
    for layers in if large { vec![3, 5, 50] } else { vec![3, 5] } {
        checks.push(Check::new("contact_stack", format!("{layers} layers"), must, move || {
            freed(&generate::stack(layers, 8))
        }));
    }
    checks.push(Check::new("coincident_vertices", "unjoined: two panels in one place", must, || {
        freed(&doubled())
    }));
    checks.push(Check::new("empty", "no panels", Must::Refuse, || {
        named(&Scene::new("empty", generate::cloth()))
    }));
    let seams: [(&str, Spoil); 3] = [
        ("same seam twice", |s| s.seams.push(s.seams[0].clone())),
        ("seam to itself", |s| s.seams.push(Seam::new("itself", vec![[3, 3]]))),
        ("a vertex that is not there", |s| s.seams.push(Seam::new("short", vec![[0, u32::MAX]]))),
    ];
    for (name, spoil) in seams {
        checks.push(Check::new("duplicated_seam", name, Must::Refuse, move || spoiled(spoil)));
    }
    let numbers: [(&str, Spoil); 4] = [
        ("scene positions NaN", |s| s.positions[4].y = f64::NAN),
        ("scene gravity inf", |s| s.phases[1].gravity.y = f64::INFINITY),
        ("scene density NaN", |s| s.material.density = f64::NAN),
        ("scene rest inf", |s| s.rest[2].x = f64::INFINITY),
    ];
    for (name, spoil) in numbers {
        checks.push(Check::new("non_finite_input", name, Must::Refuse, move || spoiled(spoil)));
    }
    checks
}

fn solve(scene: &Scene) -> Result<Equilibrium, StaticsError> {
    StaticEquilibrium::default().solve(scene, &mut |_, _| ControlFlow::Continue(()))
}

/// Two sheets that hang side by side, to be sewn, so far apart.
fn sheets(gap: f64) -> Scene {
    let one = generate::hang(6);
    let mut scene = Scene { self_collision: true, ..one.clone() };
    let across = |x: f64| -> Vec<Vector3<f64>> {
        one.rest.iter().map(|p| Vector3::new(p.x + x, 1.0 + p.y, 0.0)).collect()
    };
    scene.positions = across(0.0);
    let second = scene.add_panel("second", &one.rest, &across(1.0 + gap), &one.triangles);
    scene.seams = vec![Seam::new("middle", (0..7).map(|j| [7 * j + 6, second.start + 7 * j]).collect())];
    scene.pinned = (42..49).collect();
    scene
}

/// A skirt whose panels start this much farther from the form.
fn apart(gap: f64) -> Scene {
    let mut scene = generate::tube(8, 9);
    scene.positions.iter_mut().for_each(|p| p.z += 0.5 * gap * p.z.signum());
    scene
}

/// A square whose plane lies so deep in the ball's top.
fn sunk(depth: f64, size: f64) -> Scene {
    let mut scene = generate::drape(12);
    for (p, r) in scene.positions.iter_mut().zip(&mut scene.rest) {
        *r *= size;
        *p = Vector3::new(size * p.x, 0.3 - depth, size * p.z);
    }
    scene
}

/// Two sheets on the same pins, in the same place.
fn doubled() -> Scene {
    let one = generate::hang(5);
    let mut scene = Scene { self_collision: true, ..one.clone() };
    let second = scene.add_panel("second", &one.rest, &one.positions, &one.triangles);
    scene.pinned.extend(one.pinned.iter().map(|v| v + second.start));
    scene
}

/// The state with what to say of it: at rest, or still moving where an axis asks for no more than
/// freedom from faults.
fn state(solved: Result<Equilibrium, StaticsError>) -> Result<(Equilibrium, &'static str), Verdict> {
    match solved {
        Ok(state) => Ok((state, "at rest")),
        Err(StaticsError::NotAtRest { state, .. }) => Ok((*state, "not at rest, as the error says")),
        Err(
            e @ (StaticsError::SeamNotClosed { .. }
            | StaticsError::Start(_)
            | StaticsError::Tangled { .. }
            | StaticsError::Falls
            | StaticsError::FallsPast(_)
            | StaticsError::Timeout { .. }),
        ) => Err(Verdict::Refused(e.to_string())),
        Err(e) => Err(Verdict::Failed(e.to_string())),
    }
}

fn sewn(scene: &Scene) -> Verdict {
    let (rested, how) = match state(solve(scene)) {
        Ok(s) => s,
        Err(verdict) => return verdict,
    };
    let x = &rested.positions;
    let gap = |p: &[u32; 2]| (x[p[0] as usize] - x[p[1] as usize]).norm();
    let widest = scene.seams.iter().flat_map(|s| &s.pairs).map(gap).fold(0.0, f64::max);
    let (fault, strain) = faults(scene, x);
    let detail = format!("{how}, widest seam {widest:.1e} m, greatest strain {:.1} %{fault}", 100.0 * strain);
    let good = widest < CLOSED && fault.is_empty() && rested.outcome.at_rest;
    if good { Verdict::Converged(detail) } else { Verdict::Failed(detail) }
}

fn freed(scene: &Scene) -> Verdict {
    let (rested, how) = match state(solve(scene)) {
        Ok(s) => s,
        Err(verdict) => return verdict,
    };
    let (fault, strain) = faults(scene, &rested.positions);
    let speed = rested.outcome.speed;
    let detail = format!("{how}, speed {speed:.0e} m/s, greatest strain {:.1} %{fault}", 100.0 * strain);
    match (fault.is_empty(), rested.outcome.at_rest) {
        (true, true) => Verdict::Converged(detail),
        (true, false) => Verdict::Refused(detail),
        (false, _) => Verdict::Failed(detail),
    }
}

/// What is wrong with an end, and its greatest strain.
fn faults(scene: &Scene, x: &[Vector3<f64>]) -> (String, f64) {
    let mut text = String::new();
    if x.iter().any(|p| !p.iter().all(|c| c.is_finite())) {
        return (", not finite".into(), f64::NAN);
    }
    if let Some(b) = &scene.body {
        let body = Body::new(b.vertices.clone(), &b.triangles);
        let depth = x.iter().filter_map(|p| body.nearest(p, 1.0)).map(|n| -n.distance).fold(0.0, f64::max);
        if depth > DEEPEST {
            text += &format!(", {depth:.1e} m in the body");
        }
    }
    let Ok(sheet) = Sheet::flat(&scene.rest, &scene.triangles, scene.material.density) else {
        return (", no sheet".into(), f64::NAN);
    };
    // Sewn vertices are the same point: only panels without seams are looked at.
    if scene.self_collision && scene.seams.is_empty() {
        let crossings = ClothTree::new(sheet.triangles(), x).crossings(x).len();
        if crossings > 0 {
            text += &format!(", {crossings} crossings");
        }
    }
    (text, sheet.greatest_strain(x).1)
}

fn spoiled(spoil: Spoil) -> Verdict {
    let mut scene = generate::tube(3, 3);
    spoil(&mut scene);
    named(&scene)
}

/// Refused by the check of scenes, before anything is solved.
fn named(scene: &Scene) -> Verdict {
    match scene.check() {
        Err(e @ (SceneError::Cloth(_) | SceneError::SeamPair { .. })) => Verdict::Refused(e.to_string()),
        other => Verdict::Failed(format!("{other:?}")),
    }
}
