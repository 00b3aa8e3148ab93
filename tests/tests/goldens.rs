//! Every shipped pipeline agrees with its golden, and every golden can fail.

use std::fs;
use std::path::Path;
use toile_pipeline::golden::{compare, parse};
use toile_tests::{Answer, napkin, pipeline, root, toile};

/// The pipelines from photos that take longest: other pipelines cover the same stages. `.ci/wide`
/// checks these.
const SLOW: [&str; 4] = ["tshirt.ron", "photo.ron", "photo_tee.ron", "photo_vest.ron"];

fn agree(slow: bool) {
    for name in toile_tests::PIPELINES.into_iter().filter(|name| SLOW.contains(name) == slow) {
        let start = std::time::Instant::now();
        let out = root().join("out/goldens").display().to_string();
        let answer = toile(&["golden", "check", &pipeline(name), "--out", &out]);
        assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
        assert!(!answer.out.contains("skipped"), "{}", answer.out);
        println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
    }
}

#[test]
fn shipped_pipelines_agree_with_their_goldens() {
    agree(false);
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_other_shipped_pipelines_agree_with_their_goldens() {
    agree(true);
}

/// Published experiments that take longer than the others.
const LONG: [&str; 3] = ["c_darts", "c_pleats", "t_vest"];

#[test]
fn published_experiments_agree_with_their_goldens() {
    published_agree(false);
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_other_published_experiments_agree_with_their_goldens() {
    published_agree(true);
}

fn published_agree(long: bool) {
    let out = root().join("out/goldens").display().to_string();
    let files = fs::read_dir(root().join("pipelines/published")).unwrap().map(|e| e.unwrap().path());
    let is_long = |p: &std::path::Path| LONG.iter().any(|name| p.file_stem().is_some_and(|s| s == *name));
    let mut files: Vec<_> = files.filter(|p| p.extension().is_some_and(|e| e == "ron")).collect();
    files.retain(|p| is_long(p) == long);
    files.sort();
    assert!(files.len() >= LONG.len(), "{files:?}");
    for file in files {
        let answer = toile(&["golden", "check", &file.display().to_string(), "--out", &out]);
        assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
        assert!(!answer.out.contains("skipped"), "{}", answer.out);
    }
}

#[test]
fn every_measure_of_every_golden_can_fail() {
    for name in toile_tests::PIPELINES {
        let sheet = root().join("pipelines/goldens").join(name.replace(".ron", ".txt"));
        let golden = parse(&std::fs::read_to_string(sheet).unwrap()).unwrap();
        assert!(golden.sections.len() > 5, "{name}");
        for s in 0..golden.sections.len() {
            for m in 0..golden.sections[s].measures.len() {
                let mut now = golden.clone();
                let measure = &mut now.sections[s].measures[m];
                measure.value += 1.01 * measure.tolerance + 1e-5;
                assert_eq!(compare(&golden, &now).first_stage(), Some(golden.sections[s].stage.as_str()));
            }
        }
    }
}

/// Checks the vest against its golden with something changed.
fn changed_vest(set: &str) -> Answer {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().display().to_string();
    toile(&["golden", "check", &pipeline("vest.ron"), "--set", set, "--out", &out])
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_vests_golden_sees_another_fabric() {
    let answer = changed_vest("fabric=Preset(name: \"denim\", hysteresis: true)");
    assert_eq!(answer.code, 4, "{}{}", answer.out, answer.err);
    assert!(answer.err.contains(": first stage that differs: Preset\n"), "{}", answer.err);
    assert!(answer.err.contains("\n  Settle garment: its surface moved by "), "{}", answer.err);
}

#[test]
fn the_vests_golden_sees_a_smoother_that_smooths_less() {
    // It moves the vertices by micrometres, and the folds by a millimetre.
    let answer = changed_vest("stages.PlaneSmoother.lambda=0.4");
    assert_eq!(answer.code, 4, "{}{}", answer.out, answer.err);
    assert!(answer.err.contains(": first stage that differs: StaticEquilibrium\n"), "{}", answer.err);
    assert!(answer.err.contains("\n  StaticEquilibrium garment: its surface moved by "), "{}", answer.err);
    assert!(answer.err.contains("\n  bits move from PlaneSmoother on\n"), "{}", answer.err);
    let field = "\n  otherwise than when it was recorded: PlaneSmoother: lambda 0.5 -> 0.4\n";
    assert!(answer.err.contains(field) && !answer.err.contains("by other code"), "{}", answer.err);
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_vests_golden_sees_a_thinner_body() {
    let thinner = "body=Mannequin(height: \"172 cm\", bust: \"87 cm\", waist: \"69 cm\", hip: \"95 cm\")";
    let answer = changed_vest(thinner);
    assert_eq!(answer.code, 4, "{}{}", answer.out, answer.err);
    assert!(answer.err.contains(": first stage that differs: Mannequin\n"), "{}", answer.err);
    assert!(answer.err.contains("\n  Settle garment: its surface moved by "), "{}", answer.err);
}

/// The napkin with a golden of its own; gives the pipeline file and its sheet's text.
fn recorded(dir: &Path) -> (String, String) {
    napkin::write(dir).unwrap();
    let file = dir.join("napkin.ron").display().to_string();
    let answer = toile(&["golden", "accept", &file]);
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    let sheet = fs::read_to_string(dir.join("goldens/napkin.txt")).unwrap();
    (file, sheet)
}

/// Checks the napkin against an edited sheet.
fn against(dir: &Path, file: &str, sheet: &str) -> Answer {
    fs::write(dir.join("goldens/napkin.txt"), sheet).unwrap();
    toile(&["golden", "check", file, "--out", &dir.join("out").display().to_string()])
}

#[test]
fn a_pipeline_without_a_golden_fails_unless_that_is_allowed() {
    let dir = tempfile::tempdir().unwrap();
    napkin::write(dir.path()).unwrap();
    let file = dir.path().join("napkin.ron").display().to_string();
    let answer = toile(&["golden", "check", &file]);
    let words = format!(
        "error: {file}: it has no golden\n  help: `toile golden accept {file}` records one, `--allow-missing` goes on without\n"
    );
    assert_eq!((answer.code, answer.err), (3, words));
    let answer = toile(&["golden", "check", &file, "--allow-missing"]);
    assert_eq!((answer.code, answer.out), (0, format!("{file}: skipped, it has no golden yet\n")));
}

#[test]
fn the_same_program_gives_the_same_bits_and_others_are_told_apart() {
    let dir = tempfile::tempdir().unwrap();
    let (file, sheet) = recorded(dir.path());
    let same = against(dir.path(), &file, &sheet);
    assert_eq!((same.code, same.out), (0, format!("{file}: agrees with its golden\n")));

    let (head, digest) = sheet.rsplit_once("digest = ").unwrap();
    let other = format!("{head}digest = 0{}", &digest[1..]);
    let other = if other == sheet { format!("{head}digest = 1{}", &digest[1..]) } else { other };
    let moved = against(dir.path(), &file, &other);
    let words = format!(
        "{file}: by other code, or other input: the golden was recorded with this machine's arithmetic\n"
    );
    assert!(moved.code == 0 && moved.out.contains(": bits moved within tolerance\n"), "{}", moved.out);
    assert!(moved.out.contains(&words), "{}", moved.out);

    let line = other.lines().find(|l| l.starts_with("arithmetic = ")).unwrap();
    let elsewhere = against(dir.path(), &file, &other.replace(line, "arithmetic = 0123456789abcdef"));
    let words =
        "the golden was recorded with other arithmetic: another processor or C library, or other code\n";
    assert!(elsewhere.code == 0 && elsewhere.out.contains(words), "{}", elsewhere.out);
    let nowhere = against(dir.path(), &file, &other.replace(line, ""));
    assert!(nowhere.out.contains("the golden does not say with which arithmetic it was recorded\n"));
}

#[test]
fn a_sheet_that_sees_nothing_is_refused_with_its_line() {
    let dir = tempfile::tempdir().unwrap();
    let (file, sheet) = recorded(dir.path());
    let number = 1 + sheet.lines().position(|l| l.starts_with("area = ")).unwrap();
    let area = sheet.lines().nth(number - 1).unwrap();
    let (value, _) = area.split_once(" +- ").unwrap();
    for (tolerance, why) in [
        ("inf", "is so wide that nothing would be seen; the widest here is "),
        ("1e308", "is so wide that nothing would be seen; the widest here is "),
        ("-1", "is negative, so nothing would agree"),
        ("NaN", "is no number"),
    ] {
        let answer = against(dir.path(), &file, &sheet.replacen(area, &format!("{value} +- {tolerance}"), 1));
        assert_eq!(answer.code, 3, "{}", answer.out);
        let words = format!("napkin.txt: line {number}: `area`: the tolerance {tolerance} {why}");
        assert!(answer.err.contains(&words), "{}", answer.err);
    }
}

#[test]
fn a_surface_that_moved_is_told_with_its_stage_figure_and_place() {
    let dir = tempfile::tempdir().unwrap();
    let (file, _) = recorded(dir.path());
    // The cloth comes to rest elsewhere, by more than the tolerance and less than its box shows.
    let out = dir.path().join("out").display().to_string();
    let set = "scene.file=\"moved.json\"";
    let mut scene = napkin::scene();
    scene["material"]["stretch"] = serde_json::json!(50.0);
    fs::write(dir.path().join("moved.json"), scene.to_string()).unwrap();
    let answer = toile(&["golden", "check", &file, "--set", set, "--out", &out]);
    assert_eq!(answer.code, 4, "{}{}", answer.out, answer.err);
    assert!(answer.err.contains(": first stage that differs: StaticEquilibrium\n"), "{}", answer.err);
    let line = answer
        .err
        .lines()
        .find(|l| l.starts_with("  StaticEquilibrium garment: its surface moved by "))
        .unwrap();
    assert!(
        line.contains(" mm at 95 % (tolerance 0.2) and by ") && line.contains("panel \"napkin\" at ("),
        "{line}"
    );
    let field = "\n  otherwise than when it was recorded: Scene: file \"napkin.json\" -> \"moved.json\"\n";
    assert!(answer.err.contains(field) && !answer.err.contains("by other code"), "{}", answer.err);
}
