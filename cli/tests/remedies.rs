//! The `--set` lines that messages offer, typed by someone who reads them: each mends what it
//! stands behind.
//!
//! tests/tests/texts/proposals.rs holds what the binariser `Auto` offers.

use crate::own_files::{flat, photo, solid};
use crate::readme::{root, scratch};
use std::path::Path;
use std::process::Command;

/// A run with a fault, and how it is mended.
struct Case<'a> {
    pipeline: &'a str,
    /// The user's own file under the name that `set` has.
    file: Option<(&'a str, Vec<u8>)>,
    set: &'a [&'a str],
    until: &'a str,
    /// The exit code, and what the message says.
    code: i32,
    told: &'a str,
    /// What stands behind `--set` in the message, and is typed.
    offered: &'a [&'a str],
}

/// The exit code and the text of a run, in one line.
fn run(case: &Case<'_>, folder: &Path, set: &[&str]) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    command.current_dir(folder).arg("run").arg(root().join("pipelines").join(case.pipeline));
    command.args(["--until", case.until, "--no-cache", "--out", "out"]);
    command.args(set.iter().flat_map(|s| ["--set", s]));
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap().replace("│ ", "");
    (output.status.code().unwrap(), text.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn mended(case: &Case<'_>) {
    let folder = scratch();
    if let Some((name, bytes)) = &case.file {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let (code, text) = run(case, folder.path(), case.set);
    assert_eq!(code, case.code, "{text}");
    assert!(text.contains(case.told), "{:?} is not told: {text}", case.told);
    for line in case.offered {
        let is_offered =
            [format!("--set '{line}'"), format!("--set {line}")].iter().any(|l| text.contains(l));
        assert!(is_offered, "{line} is not offered: {text}");
    }
    let set: Vec<&str> = case.set.iter().chain(case.offered).copied().collect();
    let (code, after) = run(case, folder.path(), &set);
    assert_eq!(code, 0, "{:?} does not help: {after}", case.offered);
    assert!(!after.contains(case.told), "{:?} is told again: {after}", case.told);
}

const PHOTO: [&str; 2] = ["photos.front.file=\"mine.jpg\"", "photos.front.width=\"76 cm\""];

#[test]
fn a_drawing_in_another_unit() {
    mended(&Case {
        pipeline: "pattern.ron",
        file: Some(("mine.svg", flat::svg(&flat::skirt(3.45, 6.0, 5.0)))),
        set: &["pattern=SvgPattern(file: \"mine.svg\")"],
        until: "SvgPattern",
        code: 3,
        told: "no one wears a garment of that size",
        offered: &["pattern.unit=Centimetres"],
    });
}

#[test]
fn a_cad_file_in_another_unit() {
    mended(&Case {
        pipeline: "pattern.ron",
        file: Some(("mine.dxf", flat::dxf(&flat::skirt(3.45, 6.4, 6.2)))),
        set: &["pattern=DxfPattern(file: \"mine.dxf\")"],
        until: "DxfPattern",
        code: 3,
        told: "no one wears a garment of that size",
        offered: &["pattern.unit=Centimetres"],
    });
}

#[test]
fn a_garment_that_is_not_of_the_stated_kind() {
    mended(&Case {
        pipeline: "photo.ron",
        file: Some(("mine.jpg", photo::slim_tee())),
        set: &[PHOTO[0], PHOTO[1], "style.style=Skirt", "body.style=Skirt"],
        until: "Neckline",
        code: 3,
        told: "does not look like a skirt",
        offered: &["style.style=Auto", "body.style=Auto"],
    });
}

#[test]
fn a_kind_that_is_said_to_the_style_alone() {
    mended(&Case {
        pipeline: "photo.ron",
        file: Some(("mine.jpg", photo::boxy_tee())),
        set: &[PHOTO[0], PHOTO[1], "style.style=TShirt"],
        until: "Neckline",
        code: 0,
        told: "`style` cuts `TShirt`, and `body` measures what it finds itself",
        offered: &["body.style=TShirt"],
    });
}

#[test]
fn landmarks_that_are_said_to_the_style_alone() {
    mended(&Case {
        pipeline: "photo.ron",
        file: Some(("mine.jpg", photo::boxy_tee())),
        set: &[PHOTO[0], PHOTO[1], "style.landmarks={\"armpit_left\": (0.77, 0.376)}"],
        until: "Neckline",
        code: 0,
        told: "`style` is cut by other `landmarks` than `body` measures by",
        offered: &["body.landmarks={\"armpit_left\": (0.77, 0.376)}"],
    });
}

#[test]
fn a_mannequin_that_the_garment_is_too_small_for() {
    mended(&Case {
        pipeline: "photo_skirt.ron",
        file: Some(("mine.jpg", photo::skirt(18.5, 52.0))),
        set: &[
            PHOTO[0],
            "photos.front.width=\"62 cm\"",
            "body=Mannequin(height: \"175 cm\", bust: \"118 cm\", waist: \"108 cm\", hip: \"124 cm\")",
        ],
        until: "Arrange",
        code: 3,
        told: "the garment is too small: its waist measures",
        offered: &["body=Fitting(style: Skirt)"],
    });
}

#[test]
fn a_garment_in_space_in_another_unit() {
    mended(&Case {
        pipeline: "flatten.ron",
        file: Some(("mine.obj", solid::tube([32.0, 24.0], 55.0))),
        set: &["garment.file=\"mine.obj\""],
        until: "Arap",
        code: 3,
        told: "the garment would measure 98.7038 m from corner to corner",
        offered: &["garment.unit=Centimetres"],
    });
}
