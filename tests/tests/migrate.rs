//! `toile migrate`: files of earlier versions of the built-in stages.

use std::fs;
use toile_tests::{PIPELINES, pipeline, root, toile};

/// As the first versions wrote it: LaplacianEdges is Laplacian now, Rest is StaticEquilibrium,
/// Refine is Subdivide, Place is Arrange, Vest a style of Outline; parameters have other names,
/// `tugs` of the stitcher and `ease` of the placement are gone.
const OLD: &str = r#"// My vest.
(
    photos: { "front": (file: "front.jpg", width: "52 cm"), "back": MirrorOf("front") },
    style: Vest(),
    body: Mannequin(),
    fabric: Preset("cotton poplin"),
    stages: [
        Otsu(),
        LaplacianEdges(threshold: 8.0),  // finer than Canny
        GridMesher(),
        Place(ease: "2 cm"),
        BvhCollider(),
        SpringStitcher(
            tugs: 3,            // pull
            seam_distance: "1 mm",
        ),
        Rest(graded: false),
        Refine(parts: 2),
    ],
    qualities: [Quality(name: "Draft", max_error: "20 mm", set: ["stages.Rest.graded=true", "stages.Refine.parts=1"])],
)
"#;

#[test]
fn an_old_file_is_refused_with_the_command_that_mends_it_and_then_valid() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("old.ron");
    let name = file.display().to_string();
    fs::write(&file, OLD).unwrap();
    fs::copy(pipeline("samples/vest/front.jpg"), dir.path().join("front.jpg")).unwrap();

    let refused = toile(&["validate", &name, "--json"]);
    assert_eq!(refused.code, 3);
    for words in [
        "the stage `LaplacianEdges` is now called `Laplacian`",
        "the stage `Vest` is now `Outline(style: Vest)`",
        "the stage `Place` is now called `Arrange`",
        "the parameter `tugs` was removed: seams close at the speed `closing`",
        "`toile migrate` rewrites the file to the new names",
    ] {
        assert!(refused.out.contains(words), "{words} is missing in {}", refused.out);
    }

    let changes = format!(
        "{name}: line 4: stage Vest -> Outline(style: Vest)\n\
         {name}: line 9: stage LaplacianEdges -> Laplacian\n\
         {name}: line 11: stage Place -> Arrange\n\
         {name}: line 11: Arrange: ease removed: pieces start flat, 4 cm off the trunk and as high as their shoulder seams need\n\
         {name}: line 14: SpringStitcher: tugs removed: seams close at the speed `closing`\n\
         {name}: line 17: stage Rest -> StaticEquilibrium\n\
         {name}: line 17: StaticEquilibrium: graded -> bending_continuation\n\
         {name}: line 18: stage Refine -> Subdivide\n\
         {name}: line 20: quality Draft: stages.Rest.graded=true -> stages.StaticEquilibrium.bending_continuation=true\n\
         {name}: line 20: quality Draft: stages.Refine.parts=1 -> stages.Subdivide.parts=1\n"
    );
    let check = toile(&["migrate", "--check", &name]);
    assert_eq!((check.code, check.out.as_str()), (4, changes.as_str()));
    assert_eq!(fs::read_to_string(&file).unwrap(), OLD, "a check writes nothing");

    let migrated = toile(&["migrate", &name]);
    assert_eq!((migrated.code, migrated.out.as_str()), (0, changes.as_str()));
    let new = fs::read_to_string(&file).unwrap();
    assert_eq!(
        new,
        OLD.replace("LaplacianEdges", "Laplacian")
            .replace("            tugs: 3,            // pull", "            // pull")
            .replace("Rest", "StaticEquilibrium")
            .replace("graded", "bending_continuation")
            .replace("Refine", "Subdivide")
            .replace("Place(ease: \"2 cm\")", "Arrange()")
            .replace("Vest()", "Outline(style: Vest)")
    );
    assert_eq!(toile(&["validate", &name]).code, 0, "{}", toile(&["validate", &name]).err);
    assert_eq!(toile(&["migrate", &name]).out, format!("{name}: up to date\n"));
}

#[test]
fn the_shipped_pipelines_are_up_to_date() {
    for name in PIPELINES {
        let answer = toile(&["migrate", "--check", &pipeline(name)]);
        assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    }
}

/// The pipelines as they were shipped on two days, beside the samples of today.
#[test]
fn the_pipelines_that_were_shipped_before_are_brought_to_the_new_names() {
    let dir = tempfile::tempdir().unwrap();
    let samples = pipeline("samples");
    for (day, files) in [("2026-11-25", 7), ("2026-11-27", 22)] {
        let before = fs::read_dir(root().join("tests/migrated").join(day)).unwrap();
        let before: Vec<_> = before.map(|entry| entry.unwrap().path()).collect();
        assert_eq!(before.len(), files, "{day}");
        for file in before {
            let name = dir.path().join(file.file_name().unwrap()).display().to_string();
            let text = fs::read_to_string(&file).unwrap();
            fs::write(&name, text.replace("\"samples/", &format!("\"{samples}/"))).unwrap();
            let migrated = toile(&["migrate", &name]);
            assert_eq!(migrated.code, 0, "{day} {}{}", migrated.out, migrated.err);
            let valid = toile(&["validate", &name]);
            assert_eq!(valid.code, 0, "{day} {}{}", valid.out, valid.err);
            assert_eq!(toile(&["migrate", &name]).out, format!("{name}: up to date\n"));
        }
    }
}

#[test]
fn what_validate_refuses_is_not_called_up_to_date() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("new.ron");
    let name = file.display().to_string();
    let new = OLD
        .replace("LaplacianEdges", "Laplacian")
        .replace("            tugs: 3,            // pull\n", "")
        .replace("Rest", "StaticEquilibrium")
        .replace("graded", "bending_continuation")
        .replace("Refine", "Subdivide")
        .replace("Place(ease: \"2 cm\")", "Arrange(clearance: \"2 cm\")")
        .replace("Vest()", "Outline(style: Vest)");
    fs::copy(pipeline("samples/vest/front.jpg"), dir.path().join("front.jpg")).unwrap();
    for (right, wrong, words) in [
        ("Otsu()", "Otzu()", "unknown stage `Otzu`"),
        ("\"cotton poplin\"", "\"coton poplin\"", "there is no fabric preset \"coton poplin\""),
        ("clearance: \"2 cm\"", "clearance: 2", "the length 2 has no unit"),
    ] {
        fs::write(&file, new.replace(right, wrong)).unwrap();
        for more in [&["migrate", "--check", &name][..], &["migrate", &name]] {
            let answer = toile(more);
            assert_eq!((answer.code, answer.out.as_str()), (3, ""), "{}", answer.err);
            assert!(answer.err.contains(words), "{}", answer.err);
        }
        assert_eq!(toile(&["validate", &name]).code, 3);
    }
    // An old file with such a fault is rewritten, and the fault is reported.
    fs::write(&file, OLD.replace("Otsu()", "Otzu()")).unwrap();
    let answer = toile(&["migrate", &name]);
    assert_eq!(answer.code, 3);
    assert!(answer.out.contains("line 9: stage LaplacianEdges -> Laplacian"), "{}", answer.out);
    assert!(answer.err.contains("unknown stage `Otzu`"), "{}", answer.err);
}

#[test]
fn what_is_no_pipeline_is_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("broken.ron");
    fs::write(&file, "(stages: [").unwrap();
    let name = file.display().to_string();
    assert_eq!(toile(&["migrate", &name]).code, 3);
    let missing = dir.path().join("none.ron").display().to_string();
    let answer = toile(&["migrate", &missing]);
    assert!(
        answer.err.starts_with(&format!("error: cannot read the pipeline \"{missing}\": ")),
        "{}",
        answer.err
    );
    assert_eq!((answer.code, fs::read_to_string(&file).unwrap().as_str()), (3, "(stages: ["));
}
