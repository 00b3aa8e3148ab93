//! Writing the JSON form `garment-scene-1`, so that a garment of ours can be given to other
//! programs.

use super::held::figures;
use super::{Held, Panel, Phase, Scene, Seam};
use crate::contact::friction::FrictionContact;
use crate::fabric::{Curve, Fabric};
use serde_json::{Value, json};
use toile_geometry::obj;

/// The scene as JSON; `body_obj` is the name of the OBJ that holds its body, beside the file.
///
/// Every panel's own fabric is written with the panel. Programs that know one stiffness for warp
/// and weft find the greater of the scene's two in `stretch`, and likewise in `bend`.
#[must_use]
pub fn to_json(scene: &Scene, body_obj: &str) -> String {
    let seconds: f64 = scene.phases.iter().map(|p| p.seconds).sum();
    let body = scene.body.as_ref().map(|b| json!({ "obj": body_obj, "friction": b.friction }));
    let phases = scene.phases.iter().map(phase);
    let seams = scene.seams.iter().map(seam);
    let bands = scene.bands.iter().map(
        |b| json!({ "name": b.name, "vertices": b.vertices, "ratio": b.ratio, "stiffness": b.stiffness }),
    );
    let limit = scene.strain_limit.map(|l| json!({ "warp": l.warp, "weft": l.weft }));
    let mut value = json!({
        "format": "garment-scene-1",
        "name": scene.name,
        "up": "y",
        "rest_uv": scene.rest.iter().map(|p| json!([p.x, p.y])).collect::<Vec<_>>(),
        "positions": scene.positions.iter().map(|p| json!([p.x, p.y, p.z])).collect::<Vec<_>>(),
        "triangles": scene.triangles,
        "panels": scene.panels.iter().map(panel).collect::<Vec<_>>(),
        "seams": seams.collect::<Vec<_>>(),
        "bands": bands.collect::<Vec<_>>(),
        "strain_limit": limit,
        "pinned": scene.pinned,
        "body": body,
        "material": material(&scene.material),
        "phases": phases.collect::<Vec<_>>(),
        "seconds": seconds,
        "self_collision": scene.self_collision,
    });
    if !scene.held.is_empty() {
        value["held"] = held(&scene.held);
    }
    value.to_string()
}

fn held(h: &Held) -> Value {
    let contact = |c: &FrictionContact| json!({ "nodes": c.nodes, "figures": figures(c) });
    json!({
        "slides": h.slides.iter().map(|s| json!([s.x, s.y, s.z])).collect::<Vec<_>>(),
        "offsets": h.offsets,
        "folds": h.folds,
        "contacts": h.contacts.iter().map(contact).collect::<Vec<_>>(),
    })
}

/// The scene's body as OBJ text; empty where it has none.
#[must_use]
pub fn body_to_obj(scene: &Scene) -> String {
    scene.body.as_ref().map_or_else(String::new, |b| obj::to_text(&b.vertices, &b.triangles))
}

fn phase(p: &Phase) -> Value {
    let mut value =
        json!({ "name": p.name, "seconds": p.seconds, "gravity": [p.gravity.x, p.gravity.y, p.gravity.z] });
    if let Some(a) = &p.air {
        let wind = [a.wind.x, a.wind.y, a.wind.z];
        value["air"] =
            json!({ "density": a.density, "normal": a.normal, "tangential": a.tangential, "wind": wind });
    }
    value
}

fn seam(s: &Seam) -> Value {
    let mut value = json!({ "name": s.name, "pairs": s.pairs, "joined": s.joined });
    if let Some(angle) = s.fold {
        value["fold"] = json!(angle.to_degrees());
    }
    if let Some(ratio) = s.gather {
        value["gather"] = json!(ratio);
    }
    value
}

fn panel(p: &Panel) -> Value {
    let mut value = json!({
        "name": p.name,
        "vertices": [p.vertices.start, p.vertices.end],
        "triangles": [p.triangles.start, p.triangles.end],
        "layer": p.layer,
    });
    if let Some(own) = &p.material {
        value["material"] = material(own);
    }
    if let Some(friction) = p.body_friction {
        value["body_friction"] = json!(friction);
    }
    value
}

fn material(f: &Fabric) -> Value {
    let mut value = json!({
        "area_density": f.density,
        "stretch": f.stretch(),
        "warp": curve(&f.warp),
        "weft": curve(&f.weft),
        "poisson": f.poisson,
        "shear": curve(&f.shear),
        "bend": f.bending_warp.max(f.bending_weft),
        "bend_warp": f.bending_warp,
        "bend_weft": f.bending_weft,
        "friction": f.friction,
        "thickness": f.thickness,
        "damping": f.damping,
    });
    for (key, couple) in
        [("bend_friction_warp", f.bending_friction_warp), ("bend_friction_weft", f.bending_friction_weft)]
    {
        if couple != 0.0 {
            value[key] = json!(couple);
        }
    }
    value
}

/// A straight line as its stiffness, anything else as its points.
fn curve(c: &Curve) -> Value {
    match c.points()[..] {
        [[strain, force]] => json!(force / strain),
        ref points => json!(points),
    }
}
