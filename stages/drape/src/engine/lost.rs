//! Names what of a scene a garment cannot hold, so that the result is not taken for that of the
//! scene.

use toile_cloth::scene::Scene;

/// One sentence for each thing that is left out when the scene becomes a garment.
pub fn lost(scene: &Scene) -> Vec<String> {
    let seams = |is: fn(&toile_cloth::scene::Seam) -> bool| {
        names(scene.seams.iter().filter(|s| is(s)).map(|s| s.name.as_str()))
    };
    let panels = |is: &dyn Fn(&toile_cloth::scene::Panel) -> bool| {
        names(scene.panels.iter().filter(|p| is(p)).map(|p| p.name.as_str()))
    };
    let limit = "its strain limit is left out: a garment's fabric has curves instead";
    let poisson = (0..scene.panels.len()).any(|k| scene.fabric_of(k).poisson != 0.0);
    let found = [
        scene.strain_limit.map(|_| limit.to_owned()),
        seams(|s| !s.joined).map(|s| format!("its seams {s} are joined: a garment has no threads")),
        panels(&|p| p.layer != 0).map(|p| format!("the layers of its panels {p} are left out")),
        panels(&|p| p.body_friction.is_some()).map(|p| {
            format!(
                "its panels {p} slide on the body as all others do: a garment's collider has one friction"
            )
        }),
        panels(&|p| p.material.as_ref().is_some_and(|m| m.thickness != scene.material.thickness)).map(|p| {
            format!("the thickness of its panels {p} is that of the scene: a garment's collider has one")
        }),
        poisson.then(|| "the Poisson's ratio of its fabric is left out".to_owned()),
    ];
    found.into_iter().flatten().map(|what| format!("the scene is not held whole: {what}")).collect()
}

/// Names in quotes; none where there are none.
fn names<'a>(all: impl Iterator<Item = &'a str>) -> Option<String> {
    let quoted: Vec<String> = all.map(|name| format!("\"{name}\"")).collect();
    (!quoted.is_empty()).then(|| quoted.join(", "))
}
