//! Every parameter acts: with another value a stage gives something else on some input of the shared suite, or refuses it.
//!
//! A value is made from the parameter's type, default and range; [`VALUES`] has those that no rule makes. What the suite does not
//! show stands in [`UNSEEN`], which only gets shorter.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use toile_core::param::ParamDoc;
use toile_core::testkit::{Trial, cases, folder, from_example};
use toile_core::{Card, Registry};

/// Parameters whose values no rule makes.
const VALUES: &[(&str, &str)] = &[];

/// Parameters that change nothing on the shared suite: each wants an input on which it must matter, or goes.
const UNSEEN: &[&str] = &[
    "Arap.seams",
    "Arap.mirror",
    "Arap.darts",
    "Arap.iterations",
    "Arrange.bend",
    "Arrange.clearance",
    "Auto.holes",
    "Auto.touch",
    "Background.shadow",
    "Background.touch",
    "Block.stray",
    "Block.waist",
    "BodyObj.up",
    "Canny.low",
    "CentralDifferences.gravity",
    "CentralDifferences.air_normal",
    "CentralDifferences.air_tangential",
    "CentralDifferences.speed",
    "CentralDifferences.longest",
    "CentralDifferences.join_gap",
    "Cloth.warp",
    "Cloth.weft",
    "Difference.shadow",
    "Difference.holes",
    "Difference.touch",
    "Garment3d.weld",
    "Global.holes",
    "Global.touch",
    "GradedMesher.tolerance",
    "GraphCut.rounds",
    "GraphCut.holes",
    "GraphCut.touch",
    "GraphCut.garment",
    "GraphCut.ground",
    "GraphCut.rect",
    "GraphCut.strokes",
    "ImplicitEuler.gravity",
    "ImplicitEuler.air_normal",
    "ImplicitEuler.air_tangential",
    "ImplicitEuler.speed",
    "ImplicitEuler.longest",
    "ImplicitEuler.join_gap",
    "Kes.weight",
    "Kes.emt",
    "Kes.lt",
    "Kes.g",
    "Kes.hb",
    "Kes.thickness",
    "Kes.miu",
    "Laplacian.threshold",
    "Local.method",
    "Local.holes",
    "Local.touch",
    "Mannequin.height",
    "Mannequin.bust",
    "Mannequin.waist",
    "Mannequin.hip",
    "Mannequin.shoulder_width",
    "Mannequin.neck",
    "Mannequin.arm",
    "Mannequin.inseam",
    "Measure.max_area_error",
    "Measure.max_outline_error",
    "Measure.max_tight",
    "Measure.least_on_body",
    "Measure.max_body_crossings",
    "Neckline.usual",
    "NeighbourhoodMean.pixel",
    "Obj.textures",
    "Obj.quality",
    "Obj.weld",
    "Otsu.holes",
    "Otsu.touch",
    "PatternDxf.standard",
    "PhotoTexturer.unseen",
    "Photos.photos",
    "Prewitt.threshold",
    "Projective.gravity",
    "Projective.air_normal",
    "Projective.air_tangential",
    "Projective.speed",
    "Projective.longest",
    "Projective.join_gap",
    "Report.pictures",
    "Report.views",
    "Roberts.threshold",
    "Scene.distances",
    "Scene.weld",
    "Seams.seams",
    "Sobel.threshold",
    "SpringDraper.max_strain",
    "SpringFlatten.seams",
    "SpringFlatten.mirror",
    "SpringFlatten.darts",
    "SpringFlatten.settled",
    "SpringFlatten.iterations",
    "StaticEquilibrium.gravity",
    "StaticEquilibrium.coarsest",
    "StaticEquilibrium.coarse_steps",
    "StaticEquilibrium.join_gap",
    "StaticEquilibrium.sew_through",
    "StaticEquilibrium.asleep",
    "StaticEquilibrium.thickness",
    "SymmetricDirichlet.seams",
    "SymmetricDirichlet.mirror",
    "SymmetricDirichlet.darts",
    "SymmetricDirichlet.iterations",
    "Woven.seams",
    "Woven.mirror",
    "Woven.darts",
    "Woven.angle",
    "Woven.iterations",
    "Xpbd.gravity",
    "Xpbd.air_normal",
    "Xpbd.air_tangential",
    "Xpbd.speed",
    "Xpbd.longest",
    "Xpbd.join_gap",
];

/// What bounds or paces a run; another value must not change the result.
const PACE: &[&str] = &["time_limit"];

/// The arguments of an example, `(a: 1, b: (2, 3))`, by name.
fn arguments(example: &str) -> Vec<(String, String)> {
    let inner = example.split_once('(').map_or("", |(_, rest)| rest.trim_end().trim_end_matches(')'));
    let (mut depth, mut quoted, mut parts, mut part) = (0, false, Vec::new(), String::new());
    for c in inner.chars() {
        match c {
            '"' => quoted = !quoted,
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            ',' if !quoted && depth == 0 => {
                parts.push(std::mem::take(&mut part));
                continue;
            }
            _ => {}
        }
        part.push(c);
    }
    parts.push(part);
    let pair = |p: &String| p.split_once(':').map(|(k, v)| (k.trim().to_owned(), v.trim().to_owned()));
    parts.iter().filter_map(pair).collect()
}

/// Other values of a parameter, each within its range.
fn others(card: &Card, p: &ParamDoc, now: &str) -> Vec<String> {
    let named = format!("{}.{}", card.name, p.name);
    let mut all: Vec<String> =
        VALUES.iter().filter(|(name, _)| *name == named).map(|(_, value)| (*value).to_owned()).collect();
    all.extend(["true", "false"].map(str::to_owned));
    // The variants of a choice, as its type names them.
    all.extend(p.kind.split('|').map(|v| v.trim().to_owned()));
    let number = now.trim_matches(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'));
    let now_number: Option<f64> = number.parse().ok();
    let mut numbers = vec![0.0, 1.0, 2.0, 3.0, 5.0, 10.0, 100.0];
    numbers.extend(now_number.into_iter().flat_map(|n| [2.0 * n, 0.5 * n, 0.1 * n, 10.0 * n, n + 1.0]));
    numbers.extend(p.min.into_iter().chain(p.max));
    all.extend(
        ["\"another\"", "(0.1, 0.2)", "(1.0, 2.0)", "(0.3, 0.3)", "(0.1, 0.2, 0.3)", "(3.0, 2.0, 1.0)"]
            .map(str::to_owned),
    );
    for n in numbers {
        all.extend([format!("{n}"), format!("{n:?}"), format!("Some({n:?})"), format!("\"{n} mm\"")]);
    }
    all.retain(|v| v != now && *v != p.default && p.check.run(v, p).is_ok());
    all.dedup();
    all
}

/// Whether any value changes what the stage gives on the suite.
fn acts(registry: &Registry, card: &Card, p: &ParamDoc, folder: &Path) -> bool {
    let example = arguments(card.example);
    let now = example.iter().find(|(k, _)| k == p.name).map_or(p.default.clone(), |(_, v)| v.clone());
    let suite = cases(card);
    let outcomes = |stage: &dyn toile_core::Stage| -> Vec<String> {
        suite.iter().map(|c| Trial { stage, folder }.run(&c.inputs).fingerprint()).collect()
    };
    let Ok(plain) = from_example(registry, card, folder) else { return false };
    let mut known: Option<Vec<String>> = None;
    for value in others(card, p, &now).into_iter().take(12) {
        let rest = example.iter().filter(|(k, _)| k != p.name).map(|(k, v)| format!("{k}: {v}"));
        let text: Vec<String> = rest.chain([format!("{}: {value}", p.name)]).collect();
        let Ok(stage) = registry.make(card, &format!("({})", text.join(", "))) else { continue };
        let known = known.get_or_insert_with(|| outcomes(plain.as_ref()));
        if outcomes(stage.as_ref()) != *known {
            return true;
        }
    }
    false
}

#[test]
#[ignore = "slow: .ci/wide"]
fn every_parameter_acts_or_is_named_here() {
    let registry = toile::registry();
    let (_dir, folder) = folder().unwrap();
    let mut unseen = Vec::new();
    for card in registry.cards() {
        for p in card.params.iter().filter(|p| !PACE.contains(&p.name)) {
            if !acts(&registry, card, p, &folder) {
                unseen.push(format!("{}.{}", card.name, p.name));
            }
        }
    }
    assert_eq!(unseen, UNSEEN, "{unseen:#?}");
}

#[test]
fn arguments_of_an_example_are_told_apart() {
    let found = arguments("A(x: 1, y: (2, 3), z: \"a, b\")");
    let wanted = [("x", "1"), ("y", "(2, 3)"), ("z", "\"a, b\"")];
    assert_eq!(found, wanted.map(|(k, v)| (k.to_owned(), v.to_owned())));
}
