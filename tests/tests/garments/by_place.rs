//! What the file leaves out follows from where a stage stands.

use toile_pipeline::{Override, load};
use toile_tests::{pipeline, toile};

/// The value of a stage's parameter in a shipped pipeline with these settings.
fn value(name: &str, stage: &str, param: &str, set: &[(&str, &str)]) -> String {
    let file = pipeline(name);
    let text = std::fs::read_to_string(&file).unwrap();
    let overrides: Vec<Override> =
        set.iter().map(|(path, value)| Override { path: (*path).into(), value: (*value).into() }).collect();
    let base = std::path::Path::new(&file).parent().unwrap();
    let loaded = load(&text, name, base, &toile::registry(), &overrides).unwrap();
    let node = &loaded.nodes[loaded.find(stage).unwrap()];
    toile_pipeline::fields_of(&node.stage.params())[param].clone()
}

#[test]
fn behind_a_placement_cloth_passes_through_cloth_and_behind_a_draper_it_goes_on() {
    for name in ["photo.ron", "shirt.ron", "vest.ron"] {
        assert_eq!(value(name, "StaticEquilibrium", "sew_through", &[]), "true", "{name}");
        assert_eq!(value(name, "StaticEquilibrium", "from_here", &[]), "false", "{name}");
        assert_eq!(value(name, "Settle", "sew_through", &[]), "false", "{name}");
        assert_eq!(value(name, "Settle", "from_here", &[]), "true", "{name}");
    }
}

#[test]
fn a_prepared_scene_lies_as_its_author_laid_it() {
    assert_eq!(value("scene.ron", "StaticEquilibrium", "sew_through", &[]), "false");
    assert_eq!(value("scene.ron", "StaticEquilibrium", "from_here", &[]), "false");
}

#[test]
fn a_prepared_scene_is_solved_to_its_last_vertex() {
    for name in ["scene.ron", "skirt.ron"] {
        for (param, wanted) in [("speed", "0.001"), ("non_static", "0.0"), ("proof", "Short")] {
            assert_eq!(value(name, "StaticEquilibrium", param, &[]), wanted, "{name}");
        }
    }
    assert_eq!(value("skirt.ron", "Settle", "non_static", &[]), "0.0");
    assert_eq!(value("photo.ron", "StaticEquilibrium", "non_static", &[]), "0.015");
    let set = [("stages.StaticEquilibrium.speed", "0.01")];
    assert_eq!(value("scene.ron", "StaticEquilibrium", "speed", &set), "0.01");
}

#[test]
fn a_second_stage_of_a_kind_takes_the_parameters_of_the_first() {
    let set = [("stages.StaticEquilibrium.speed", "0.002"), ("stages.BvhCollider.friction", "0.4")];
    assert_eq!(value("photo.ron", "Settle", "speed", &set), "0.002");
    assert_eq!(value("photo.ron", "Hanging", "friction", &set), "0.4");
}

#[test]
fn what_the_file_says_comes_first() {
    let set = [
        ("stages.Settle.from_here", "false"),
        ("stages.Settle.speed", "0.003"),
        ("stages.StaticEquilibrium.sew_through", "false"),
        ("stages.Hanging.friction", "0.2"),
    ];
    assert_eq!(value("photo.ron", "Settle", "from_here", &set), "false");
    assert_eq!(value("photo.ron", "Settle", "speed", &set), "0.003");
    assert_eq!(value("photo.ron", "StaticEquilibrium", "sew_through", &set), "false");
    assert_eq!(value("photo.ron", "Hanging", "friction", &set), "0.2");
}

#[test]
fn explain_tells_what_was_decided_and_how_it_is_turned_round() {
    let answer = toile(&["explain", &pipeline("shirt.ron")]);
    for line in [
        "  StaticEquilibrium    on         seams close through what lies between them (by-place)\n      by      `Arrange` puts a pattern's pieces around the body\n",
        "      else    --set 'stages.StaticEquilibrium.sew_through=false'\n",
        "  Settle               on         goes on from where the garment hangs (by-place)\n      by      `StaticEquilibrium` has draped it\n",
        "      else    --set 'stages.Settle.from_here=false'\n",
    ] {
        assert!(answer.out.contains(line), "{line}\n{}", answer.out);
    }
    let set =
        ["--set", "stages.Settle.from_here=false", "--set", "stages.StaticEquilibrium.sew_through=false"];
    let written = toile(&[&["explain", &pipeline("shirt.ron")], &set[..]].concat());
    assert!(!written.out.contains("by-place"), "{}", written.out);
}
