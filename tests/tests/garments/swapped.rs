//! Each stage of a shipped photo pipeline stands in for each other one of its role: the run ends
//! well, or is refused with a reason.

use std::path::Path;
use toile_core::Role;
use toile_pipeline::{Override, load};
use toile_tests::{pipeline, toile};

/// Height of the photos, px: small, so that many runs are cheap.
const PHOTO_HEIGHT: u32 = 240;

/// The shipped pipelines that begin with photos.
const PHOTOS: [&str; 14] = [
    "vest.ron",
    "tshirt.ron",
    "photo.ron",
    "photo_tee.ron",
    "photo_vest.ron",
    "photo_longsleeve.ron",
    "photo_skirt.ron",
    "photo_dress.ron",
    "photo_trousers.ron",
    "photo_shirt.ron",
    "photo_shorts.ron",
    "photo_gathered.ron",
    "photo_pleated.ron",
    "photo_onepiece.ron",
];

/// Those of them that are sewn with each stage that sews, drapes and dresses: without sleeves, with
/// short and long ones, with legs, with pleats.
const SEWN: [&str; 5] =
    ["vest.ron", "tshirt.ron", "photo_longsleeve.ron", "photo_trousers.ron", "photo_pleated.ron"];

/// The time that a solver has which steps in time, seconds: by default it gives up after 600.
const TIME: f64 = 10.0;

/// What makes a run of a pipeline cheap: a coarse mesh, and photos from its samples made small.
fn cheap(name: &str, dir: &Path) -> Vec<String> {
    let mut sets = vec!["stages.GridMesher.edge=\"40 mm\"".to_owned()];
    let text = std::fs::read_to_string(pipeline(name)).unwrap();
    for side in ["front", "back"] {
        let own = text.lines().find_map(|l| l.trim().strip_prefix(&format!("\"{side}\":")));
        let file = own.and_then(|l| l.split("file: \"").nth(1)).and_then(|l| l.split('"').next());
        let Some(file) = file else { continue };
        let path = dir.join(format!("{side}.png"));
        let photo = image::open(pipeline(file)).unwrap();
        photo.thumbnail(PHOTO_HEIGHT, PHOTO_HEIGHT).to_rgb8().save(&path).unwrap();
        sets.push(format!("photos.{side}.file={:?}", path.display().to_string()));
    }
    sets
}

/// Every stage of these roles in a pipeline with every other one of its role, as a setting.
fn swaps(name: &str, roles: &[Role]) -> Vec<String> {
    let registry = toile::registry();
    let file = pipeline(name);
    let text = std::fs::read_to_string(&file).unwrap();
    let none: [Override; 0] = [];
    let loaded = load(&text, &file, Path::new(&file).parent().unwrap(), &registry, &none).unwrap();
    let mut found = Vec::new();
    for node in loaded.nodes.iter().filter(|n| roles.contains(&n.card.role)) {
        let others = registry.cards().filter(|c| c.role == node.card.role && c.name != node.card.name);
        for card in others {
            let has_limit = card.params.iter().any(|p| p.name == "time_limit");
            let limit = if has_limit { format!("time_limit: {TIME:?}") } else { String::new() };
            let own = format!("{}({limit})", card.name);
            let arguments = own.strip_prefix(card.name).unwrap_or("()");
            let written = if registry.make(card, arguments).is_ok() { own } else { card.example.to_owned() };
            found.push(format!("stages.{}={written}", node.id));
        }
    }
    found
}

/// Runs a pipeline with each of its swaps; what is neither done nor refused with a reason.
fn faults(name: &str, roles: &[Role], until: Option<&str>) -> Vec<String> {
    let dir = tempfile::tempdir().unwrap();
    let (file, cheap, out) = (pipeline(name), cheap(name, dir.path()), dir.path().join("out"));
    let out = out.display().to_string();
    let mut faults = Vec::new();
    for swap in swaps(name, roles) {
        // A coarse mesh is asked of the mesher that is there.
        let is_mesher = swap.starts_with("stages.GridMesher=");
        let mut args = vec!["run", &file, "--out", &out, "--set", &swap];
        cheap.iter().skip(usize::from(is_mesher)).for_each(|s| args.extend(["--set", s]));
        until.iter().for_each(|stage| args.extend(["--until", stage]));
        let answer = toile(&args);
        println!("{name} {swap}: {}", answer.code);
        let reason = !answer.err.trim().is_empty();
        let is_late =
            answer.code == 5 && swap.contains("time_limit") && answer.err.contains("out of time after");
        if !(answer.code == 0 || ([3, 4].contains(&answer.code) && reason) || is_late) {
            faults.push(format!("{name} {swap}: exit code {}\n{}{}", answer.code, answer.out, answer.err));
        }
    }
    faults
}

/// Roles whose stages turn photos into outlines.
const OF_PHOTOS: [Role; 3] = [Role::Denoiser, Role::Binariser, Role::EdgeDetector];

#[test]
fn a_vest_is_cut_or_refused_whichever_stages_look_at_its_photos() {
    let faults = faults("vest.ron", &OF_PHOTOS, Some("PlaneSmoother"));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
#[ignore = "slow: .ci/wide"]
fn every_photo_pipeline_is_cut_or_refused_whichever_stages_look_at_its_photos() {
    let until = Some("PlaneSmoother");
    let faults: Vec<String> = PHOTOS.iter().flat_map(|name| faults(name, &OF_PHOTOS, until)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
#[ignore = "slow: .ci/wide"]
fn photo_pipelines_end_well_or_are_refused_whichever_stages_sew_and_dress() {
    let roles = [Role::Mesher, Role::Smoother, Role::Collider, Role::Stitcher, Role::Draper, Role::Texturer];
    let faults: Vec<String> = SEWN.iter().flat_map(|name| faults(name, &roles, None)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
