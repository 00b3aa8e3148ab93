//! Stability maps and the two drivers, from the command line.
#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::fs;

/// What the program answered.
struct Answer {
    code: u8,
    out: String,
    err: String,
}

fn lab(arguments: &[&str]) -> Answer {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let code = toile_lab::command([&["toile-lab"], arguments].concat(), &mut out, &mut err);
    Answer { code, out: String::from_utf8(out).unwrap(), err: String::from_utf8(err).unwrap() }
}

/// The message of a call that is refused.
fn refused(arguments: &[&str]) -> String {
    let answer = lab(arguments);
    assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{arguments:?}");
    answer.err
}

#[test]
fn a_map_is_tables_pictures_and_data() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("map").display().to_string();
    let small = ["--cells", "3", "--along", "4", "--limit", "0.02", "--out", &out];
    let solvers = ["--solver", "explicit", "--solver", "xpbd", "--solver", "rest"];
    let answer = lab(&[&["stability", "--map"], &small[..], &solvers].concat());
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(
        answer.out.contains("central differences: limit 2/omega_max")
            && answer.out.contains("| StaticEquilibrium")
    );
    assert_eq!(answer.err, format!("21 cells; pictures, map.csv and map.json in {out}\n"));
    let mut names: Vec<String> =
        fs::read_dir(&out).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let wanted = [
        "explicit.png",
        "explicit.svg",
        "map.csv",
        "map.json",
        "rest.png",
        "rest.svg",
        "xpbd.png",
        "xpbd.svg",
    ];
    assert_eq!(names, wanted);
    let csv = fs::read_to_string(format!("{out}/map.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 2 * 9 + 3);
    let json: Value = serde_json::from_str(&fs::read_to_string(format!("{out}/map.json")).unwrap()).unwrap();
    assert_eq!(json["cells"].as_array().unwrap().len(), 21);
    assert_eq!(json["quickest"].as_array().unwrap().len(), 9);
    let refused = json["cells"].as_array().unwrap().iter().filter(|c| c["outcome"] == "refused");
    assert!(refused.clone().count() > 0 && refused.clone().all(|c| c["error_name"] == "TimeStepUnstable"));
}

#[test]
fn a_map_says_what_is_wrong_with_its_flags() {
    let map = |more: &[&str]| refused(&[&["stability", "--map"], more].concat());
    let solvers = "explicit, unguarded, implicit, gradients, xpbd, projective, rest";
    assert_eq!(map(&["--solver", "magic"]), format!("error: there is no `magic`; there are {solvers}\n"));
    let share = "`2` is no share; write a number above 0 and at most 1, like 0.001";
    assert!(map(&["--max-error", "2"]).contains(share));
    assert!(map(&["--cells", "1"]).contains("1 is not in 2..=60"));
    assert!(map(&["--along", "65"]).contains("65 is not in 2..=64"));
    let time = "`3s` is no time; write seconds above 0, like 10";
    assert!(map(&["--limit", "3s"]).contains(time));
    assert!(map(&["friction"]).contains("the argument '--map' cannot be used with '[AXES]...'"));
    let needs = refused(&["stability", "--cells", "5"]);
    assert!(needs.contains("the following required arguments were not provided:\n  --map"), "{needs}");
}

#[test]
fn drivers_are_a_table_and_data() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("drivers").display().to_string();
    let arguments = ["drivers", "static", "--out", &out];
    let answer = lab(&arguments);
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    assert!(
        answer.out.contains("| static Newton on springs |")
            && answer.out.contains("| catenary | particles | StaticEquilibrium")
    );
    let csv = fs::read_to_string(format!("{out}/drivers.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 3 * 6);
    let json: Value = serde_json::from_str(&lab(&[&arguments[..], &["--json"]].concat()).out).unwrap();
    assert_eq!(json["fits"].as_array().unwrap().len(), 3);
    assert!(json["fits"][0]["error"]["exponent"].as_f64().unwrap() < -1.0);
    let ways = "central differences, central differences on springs, implicit Euler (factor), implicit Euler (factor) on springs, \
                implicit Euler (gradients), XPBD, projective dynamics (10 turns), static Newton, static Newton on springs, StaticEquilibrium";
    assert_eq!(refused(&["drivers", "luck"]), format!("error: there is no `luck`; there are {ways}\n"));
    assert!(refused(&["drivers", "--limit", "0"]).contains("`0` is no time"));
}

#[test]
fn the_engine_is_held_against_references_and_extremes() {
    let answer = lab(&["accuracy", "E4", "--mesh", "equilateral", "--along", "40", "--json"]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let report: Value = serde_json::from_str(&answer.out).unwrap();
    assert!(report["rows"][0]["error"].as_f64().unwrap() < 0.002, "{report}");
    let answer = lab(&["stability", "one_triangle_panel"]);
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    assert!(answer.out.contains("one_triangle_panel"));
}

#[test]
fn an_unknown_test_or_axis_is_named_with_those_that_there_are() {
    let answer = lab(&["accuracy", "E9"]);
    assert_eq!(answer.code, 2);
    assert!(
        answer.err.starts_with("error: there is no `E9`; there are E1 cantilever, E2 stretch, "),
        "{}",
        answer.err
    );
    let answer = lab(&["stability", "luck"]);
    assert!(answer.err.starts_with("error: there is no `luck`; there are "), "{}", answer.err);
}
