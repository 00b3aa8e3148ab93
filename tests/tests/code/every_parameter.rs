//! Every parameter acts: with another value a stage gives something else on some input of the
//! shared suite, or refuses it.
//!
//! A value is made from the parameter's type, default and range; [`VALUES`] has those that no rule
//! makes. What the suite does not show stands in [`UNSEEN`], which only gets shorter.
#![allow(clippy::unwrap_used)]

use image::{Rgb, RgbImage};
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::{Artifact, ArtifactType, Garment, Outline, Phases, Photo, Point2};
use toile_core::param::ParamDoc;
use toile_core::testkit::{Trial, cases, dress, folder, from_example, shapes, suite};
use toile_core::{Card, Inputs, Registry};

/// Parameters whose values no rule makes.
const VALUES: &[(&str, &str)] = &[
    ("Alter.alterations", "[MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"-20 mm\")]"),
    ("Arap.darts", "Auto(max_strain: 0.02)"),
    (
        "Arrange.hand_places",
        "[(piece: \"front\", middle: (\"50 mm\", \"1200 mm\", \"300 mm\"), turn: (0, 10, 0))]",
    ),
    ("Arrange.key_points", "[(edge: \"front.hem\", at: 0.5, landmark: \"neck_left\")]"),
    ("Block.landmarks", "{\"armpit_left\": (0.3, 0.4)}"),
    ("Block.waist", "Gathered(fullness: 1.5, band: \"3 cm\")"),
    ("BvhCollider.penalty", "Linear(50)"),
    ("Cloth.warp", "[(0.02, 90.0), (0.03, 490.0)]"),
    ("Cloth.weft", "[(0.03, 90.0), (0.06, 490.0)]"),
    ("FabricTexturer.colours", "[\"#7a2f3a\"]"),
    ("GraphCut.garment", "{\"front\": [(0.5, 0.5)]}"),
    ("GraphCut.ground", "{\"front\": [(0.5, 0.5)]}"),
    ("GraphCut.rect", "{\"front\": ((0.3, 0.3), (0.6, 0.6))}"),
    ("GraphCut.strokes", "{\"front\": \"strokes.png\"}"),
    ("Kes.emt", "(5.0, 9.0)"),
    ("Kes.hb", "(0.02, 0.03)"),
    ("Local.method", "Mean(offset: 4.0)"),
    ("NeighbourhoodMean.pixel", "\"2 mm\""),
    ("Outfit.garments", "[\"pinafore_specification.json\", \"shirt_specification.json\"]"),
    ("ParryCollider.penalty", "Linear(50)"),
    ("Photos.photos", "{\"front\": (file: \"another.jpg\", width: \"52 cm\")}"),
    ("Preview.turns", "[60]"),
    ("Seams.seams", "[Match(\"front.side_left\", \"back.side_right\")]"),
    ("SpringFlatten.darts", "Auto(max_strain: 0.02)"),
    ("SpringStitcher.seam_force", "Linear(2000.0)"),
    ("SymmetricDirichlet.darts", "Auto(max_strain: 0.02)"),
    ("Unpick.edges", "[\"front.side_right\"]"),
    ("ViewTexturer.turns", "{\"front\": 90, \"back\": 270}"),
    ("Woven.darts", "Auto(max_strain: 0.02)"),
];

/// Other arguments with which a parameter matters, or a stage takes less time.
const BESIDE: &[(&str, &str)] = &[
    ("air_normal", "air: 1.2"),
    ("air_tangential", "air: 1.2"),
    ("Glb.quality", "textures: Jpeg"),
    ("Obj.quality", "textures: Jpeg"),
    ("Turntable", "views: 4, tiers: 1, size: 64"),
    ("Usdz.quality", "textures: Jpeg"),
];

/// Parameters that change nothing on the shared suite: each wants an input on which it must matter,
/// or goes.
const UNSEEN: &[&str] = &[
    "Arrange.bend",
    "Arrange.clearance",
    "Arrange.max_tight",
    "Auto.holes",
    "Auto.touch",
    "Auto.garment",
    "Auto.rect",
    "Block.stray",
    "CentralDifferences.sew_through",
    "CentralDifferences.coarsest",
    "Difference.shadow",
    "Difference.holes",
    "Difference.touch",
    "FabricTexturer.ribs",
    "FabricTexturer.stitches",
    "FabricTexturer.variants",
    "Fit.comfort",
    "Fit.over",
    "Garment3d.leave_out",
    "Garment3d.weld",
    "GraphCut.rounds",
    "GraphCut.holes",
    "GraphCut.garment",
    "GraphCut.ground",
    "GraphCut.rect",
    "GraphCut.strokes",
    "ImplicitEuler.sew_through",
    "ImplicitEuler.coarsest",
    "LightField.down",
    "Measure.max_tight",
    "Measure.least_on_body",
    "Measure.max_body_crossings",
    "Neckline.usual",
    "NeighbourhoodMean.pixel",
    "Obj.weld",
    "PhotoTexturer.unseen",
    "PhotoTexturer.variants",
    "Projective.sew_through",
    "Projective.coarsest",
    "Report.pictures",
    "Report.views",
    "Scene.distances",
    "Scene.weld",
    "SpringDraper.sew_through",
    "SpringDraper.coarsest",
    "SpringStitcher.coarsest",
    "StaticEquilibrium.coarsest",
    "StaticEquilibrium.coarse_steps",
    "StaticEquilibrium.steps",
    "StaticEquilibrium.sew_through",
    "StaticEquilibrium.asleep",
    "StaticEquilibrium.thickness",
    "Woven.angle",
    "Xpbd.sew_through",
    "Xpbd.coarsest",
];

/// What bounds or paces a run; another value must not change the result.
const PACE: &[&str] = &["time_limit"];

/// The arguments of an example, `(a: 1, b: (2, 3))`, by name.
fn arguments(example: &str) -> Vec<(String, String)> {
    let inner =
        example.split_once('(').map_or("", |(_, rest)| rest.trim_end().strip_suffix(')').unwrap_or(rest));
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
    all.extend(within(p));
    all.extend(
        ["\"another\"", "(0.1, 0.2)", "(1.0, 2.0)", "(0.3, 0.3)", "(0.1, 0.2, 0.3)", "(3.0, 2.0, 1.0)"]
            .map(str::to_owned),
    );
    for n in numbers {
        all.extend([format!("{n}"), format!("{n:?}"), format!("Some({n:?})"), format!("\"{n} mm\"")]);
    }
    all.retain(|v| v != now && p.check.run(v, p).is_ok());
    all.dedup();
    all
}

/// Values spread over a parameter's range, lengths in mm.
fn within(p: &ParamDoc) -> Vec<String> {
    let (Some(lo), Some(hi)) = (p.min, p.max) else { return Vec::new() };
    let of = |share: f64| {
        let at = lo + share * (hi - lo);
        // Wide ranges are walked by factors.
        let at = if lo > 0.0 && hi > 100.0 * lo { lo * (hi / lo).powf(share) } else { at };
        match p.kind.contains("length") {
            true => format!("\"{} mm\"", 1e3 * at),
            false if p.kind.contains("integer") || p.kind.contains("whole") => format!("{}", at.round()),
            false => format!("{at:?}"),
        }
    };
    [0.5, 0.2, 0.8, 0.05].map(of).into()
}

/// Inputs beside the shared suite's.
fn more(card: &Card) -> Vec<Inputs> {
    [hard_photos(card), cut_outlines(card), garments_alone(card)].concat()
}

/// A T-shirt of which the frame cuts half a sleeve, with its photo.
fn cut_outlines(card: &Card) -> Vec<Inputs> {
    let port = |kind| card.inputs.iter().position(|p| p.kind == kind);
    let (Some(outline), Some(photo)) = (port(Outline::KIND), port(Photo::KIND)) else { return Vec::new() };
    let whole = shapes::tshirt();
    let frame = shapes::frame(&whole);
    let at = 0.38;
    let cut = Outline { frame: Some(frame), ..shapes::plain(left_of(&whole.outer.points, at), vec![0]) };
    let pixels = shapes::photo_of(&whole).0.pixels;
    let width = frame.to_px(shapes::p(at, 0.0)).x as u32;
    let seen = shapes::photo_from(RgbImage::from_fn(width, pixels.height(), |x, y| *pixels.get_pixel(x, y)));
    let with = |mut inputs: Inputs| {
        let (cut, seen): (Arc<dyn Artifact>, Arc<dyn Artifact>) = (Arc::new(cut), Arc::new(seen));
        inputs.0[outline] = Some(suite::value(&card.inputs[outline], &cut));
        inputs.0[photo] = Some(suite::value(&card.inputs[photo], &seen));
        inputs
    };
    cases(card).into_iter().next().map(|case| with(case.inputs)).into_iter().collect()
}

/// The part of a polygon left of a line across.
fn left_of(points: &[Point2], at: f64) -> Vec<Point2> {
    let mut left = Vec::new();
    for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
        if a.x <= at {
            left.push(*a);
        }
        if (a.x < at) != (b.x < at) && a.x != at && b.x != at {
            left.push(a + (b - a) * ((at - a.x) / (b.x - a.x)));
        }
    }
    left
}

/// Photos of a garment with a hole, specks and a shadow on uneven ground, whole and cut by the
/// frame.
fn hard_photos(card: &Card) -> Vec<Inputs> {
    let Some(port) = card.inputs.iter().position(|p| p.kind == Photo::KIND) else { return Vec::new() };
    let with = |cut: bool| {
        let photo: Arc<dyn Artifact> = Arc::new(shapes::photo_from(hard_picture(cut)));
        let mut inputs = cases(card).first()?.inputs.clone();
        inputs.0[port] = Some(suite::value(&card.inputs[port], &photo));
        Some(inputs)
    };
    [false, true].into_iter().filter_map(with).collect()
}

/// A garment held at its upper rim, without phases, which would set gravity and air; and one that
/// bulges and so cannot be laid flat.
fn garments_alone(card: &Card) -> Vec<Inputs> {
    let Some(port) = card.inputs.iter().position(|p| p.kind == Garment::KIND) else { return Vec::new() };
    let with = |garment: Garment| {
        let garment: Arc<dyn Artifact> = Arc::new(garment);
        let mut inputs = cases(card).first()?.inputs.clone();
        let phases = card.inputs.iter().position(|p| p.kind == Phases::KIND);
        phases.into_iter().for_each(|at| inputs.0[at] = None);
        inputs.0[port] = Some(suite::value(&card.inputs[port], &garment));
        Some(inputs)
    };
    [dress::sewn_garment(), bulging()].into_iter().filter_map(with).collect()
}

fn bulging() -> Garment {
    let mut garment = dress::sewn_garment();
    for (at, rest) in garment.positions.iter_mut().zip(&garment.rest) {
        let wider = 1.0 + 0.4 * (6.0 * rest.y).sin() + 0.1 * rest.x;
        (at.x, at.z) = (at.x * wider, at.z * wider);
    }
    garment
}

/// A dark rectangle with a hole on a light, uneven ground; with `cut` it reaches the lower frame.
fn hard_picture(cut: bool) -> RgbImage {
    let low = if cut { 140 } else { 112 };
    RgbImage::from_fn(120, 140, |x, y| {
        let is_hole = (i64::from(x) - 60).pow(2) + (i64::from(y) - 70).pow(2) < 81;
        let is_cloth = (30..90).contains(&x) && (28..low).contains(&y) && !is_hole;
        let is_speck =
            (10..13).contains(&x) && (20..23).contains(&y) || (4..6).contains(&x) && (40..90).contains(&y);
        let shadow = if (90..104).contains(&x) && (40..low).contains(&y) { 45 } else { 0 };
        let noise = ((x * 7919 + y * 104_729) % 13) as u8;
        let ground = 190 + (x / 5) as u8 - shadow + noise;
        Rgb(if is_cloth || is_speck {
            [50 + noise, 60 + noise, 70 + noise]
        } else {
            [ground, ground, ground - 12]
        })
    })
}

/// Whether any value changes what the stage gives on the suite.
fn acts(registry: &Registry, card: &Card, p: &ParamDoc, folder: &Path) -> bool {
    let whole = format!("{}.{}", card.name, p.name);
    let mut example = arguments(card.example);
    for (k, v) in BESIDE
        .iter()
        .filter(|(name, _)| [p.name, card.name, &whole].contains(name))
        .flat_map(|(_, a)| arguments(&format!("({a})")))
    {
        example.retain(|(known, _)| *known != k);
        example.push((k, v));
    }
    let now = example.iter().find(|(k, _)| k == p.name).map_or(p.default.clone(), |(_, v)| v.clone());
    let inputs: Vec<Inputs> = cases(card).into_iter().map(|c| c.inputs).chain(more(card)).collect();
    let outcomes = |stage: &dyn toile_core::Stage| -> Vec<String> {
        inputs.iter().map(|i| Trial { stage, folder }.run(i).fingerprint()).collect()
    };
    let with = |others: &[(String, String)]| {
        let text: Vec<String> = others.iter().map(|(k, v)| format!("{k}: {v}")).collect();
        registry.make(card, &format!("({})", text.join(", ")))
    };
    // The files that the example names are laid down with it.
    let (Ok(_), Ok(plain)) = (from_example(registry, card, folder), with(&example)) else { return false };
    let mut known: Option<Vec<String>> = None;
    for value in others(card, p, &now).into_iter().take(16) {
        let mut others = example.clone();
        others.retain(|(k, _)| k != p.name);
        others.push((p.name.to_owned(), value));
        let Ok(stage) = with(&others) else { continue };
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
