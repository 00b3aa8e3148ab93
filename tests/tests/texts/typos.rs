//! Typical slips in every shipped pipeline: each is one fault, at its place, with the name that was
//! meant.

use serde_json::Value;
use std::fs;
use toile_tests::{PIPELINES, pipeline, toile};

/// What stands in the file, the slip with `^` before the place of its fault, what is said, and the
/// hint's beginning.
type Slip = (&'static str, &'static str, &'static str, &'static str);

const SLIPS: [Slip; 32] = [
    // names of stages, parameters, fields and choices
    ("Otsu()", "^Otzu()", "unknown stage `Otzu`", "did you mean `Otsu`?"),
    ("Neckline()", "^Nekcline()", "unknown stage `Nekcline`", "did you mean `Neckline`?"),
    ("PlaneSmoother(", "^PlaneSmother(", "unknown stage `PlaneSmother`", "did you mean `PlaneSmoother`?"),
    ("Subdivide(parts", "^Subdvide(parts", "unknown stage `Subdvide`", "did you mean `Subdivide`?"),
    ("GarmentObj(", "^GarmentOjb(", "unknown stage `GarmentOjb`", "did you mean `GarmentObj`?"),
    ("style: Outline(", "style: ^Outlne(", "unknown stage `Outlne`", "did you mean `Outline`?"),
    ("body: Mannequin(", "body: ^Manequin(", "unknown stage `Manequin`", "did you mean `Mannequin`?"),
    ("smooth: 1", "^smoth: 1", "unknown parameter `smoth`", "did you mean `smooth`?"),
    ("hysteresis: true", "^hysterisis: true", "unknown parameter `hysterisis`", "did you mean `hysteresis`?"),
    ("Scene(file:", "Scene(^fiel:", "unknown parameter `fiel`", "did you mean `file`?"),
    ("stages: [", "^stagse: [", "unknown field `stagse`", "did you mean `stages`?"),
    ("fabric: Preset", "^fabirc: Preset", "unknown field `fabirc`", "did you mean `fabric`?"),
    ("texture: Check", "texture: ^Chekc", "`texture` must be ", "did you mean `Check`?"),
    // values
    ("edge: \"16 mm\"", "edge: ^16", "`edge`: the length 16 has no unit; write \"16 mm\" or \"16 cm\"", ""),
    ("smooth: 1", "smooth: ^9", "`smooth` is 9, above its greatest value ", ""),
    ("smooth: 1", "smooth: ^\"1\"", "`smooth` must be a number, found `\"1\"`", ""),
    ("hysteresis: true", "hysteresis: ^yes", "`hysteresis` must be true | false, found `yes`", ""),
    // what lies outside the file
    ("/front.jpg\"", "/fornt.jpg\"", "Photos: cannot read ", ""),
    (
        "file: \"samples/scene/skirt.json\"",
        "file: ^\"samples/scene/skrit.json\"",
        "Scene: cannot read \"samples/scene/skrit.json\": no such file",
        "did you mean \"samples/scene/skirt.json\"?",
    ),
    (
        "name: \"cotton ",
        "name: ^\"coton ",
        "Preset: there is no fabric preset \"coton ",
        "did you mean \"cotton ",
    ),
    (
        "\"back\":  MirrorOf(\"front\")",
        "\"back\":  ^MirrorOf(\"frnt\")",
        "Photos: photo \"back\" is to mirror \"frnt\", which does not exist",
        "did you mean \"front\"?",
    ),
    ("\"172 cm\"", "^\"172 mm\"", "`height` is 17.2 cm, below its least value 80 cm", ""),
    // commas, colons, quotes and brackets
    ("edge: \"16 mm\"),", "edge: \"16 mm\")^", "a comma is missing after `GridMesher(...)`", ""),
    ("height: \"172 cm\",", "height: \"172 cm\"^", "a comma is missing after `\"172 cm\"`", ""),
    ("smooth: 1", "smooth^ 1", "a colon is missing after `smooth`", "write `smooth: ...`"),
    ("edge: \"16 mm\"", "edge: ^\"16 mm", "this text is never closed", "write `\"` at its end"),
    ("edge: \"16 mm\"", "edge: ^16 mm", "`16 mm` is a text and stands in quotes", "write `\"16 mm\"`"),
    ("Glb()", "^Glb", "`Glb` needs brackets", "write `Glb()`"),
    ("(smooth: 1)", "^(smooth: 1", "this `(` is never closed", "write `)` before `"),
    // what stands twice, and settings of qualities
    ("\"back\":", "^\"front\":", "the key \"front\" is given twice", ""),
    (
        "height: \"172 cm\",",
        "height: \"172 cm\", ^height: \"172 cm\",",
        "the field `height` is given twice",
        "",
    ),
    (
        "[\"stages.Subdivide.parts",
        "[^\"stages.Subdivid.parts",
        "quality `",
        "did you mean `stages.Subdivide.parts`?",
    ),
];

/// The place of `^` and the text without it; none where the slip has none.
fn marked(slip: &str) -> (Option<usize>, String) {
    (slip.find('^'), slip.replacen('^', "", 1))
}

fn validated(text: &str, dir: &std::path::Path) -> (u8, Vec<Value>) {
    let file = dir.join("slip.ron");
    fs::write(&file, text).unwrap();
    let answer = toile(&["validate", "--json", &file.display().to_string()]);
    let said: Value = serde_json::from_str(&answer.out).unwrap();
    (answer.code, said["faults"].as_array().unwrap().clone())
}

#[test]
fn each_slip_is_one_fault_at_its_place_with_the_name_that_was_meant() {
    let dir = tempfile::tempdir().unwrap();
    let samples = fs::canonicalize(pipeline("samples")).unwrap();
    std::os::unix::fs::symlink(samples, dir.path().join("samples")).unwrap();
    let (mut tried, mut wrong) = ([0; SLIPS.len()], Vec::new());
    for name in PIPELINES {
        let whole = fs::read_to_string(pipeline(name)).unwrap();
        assert_eq!(validated(&whole, dir.path()), (0, Vec::new()), "{name}");
        // The head of a file is comments, which say how to run it.
        let head = whole.find("\n(\n").unwrap();
        for (i, (right, slip, message, hint)) in SLIPS.iter().enumerate() {
            let Some(at) = whole[head..].find(right).map(|at| head + at) else { continue };
            let (mark, slip) = marked(slip);
            let text = format!("{}{slip}{}", &whole[..at], &whole[at + right.len()..]);
            let (code, faults) = validated(&text, dir.path());
            let said = |key: &str| faults[0][key].as_str().unwrap_or("").to_owned();
            let place = mark.map(|mark| {
                let before = &text[..at + mark];
                let line = before.matches('\n').count() + 1;
                (line, before.rsplit('\n').next().unwrap().chars().count() + 1)
            });
            let found = faults
                .first()
                .map(|f| (f["line"].as_u64().unwrap() as usize, f["column"].as_u64().unwrap() as usize));
            let is_right = code == 3
                && faults.len() == 1
                && said("message").starts_with(message)
                && said("hint").starts_with(hint)
                && (place.is_none() || place == found);
            if !is_right {
                wrong.push(format!(
                    "{name}: {right} -> {slip}: {code}, wanted {place:?} {message}; {hint}\n  {faults:#?}"
                ));
            }
            tried[i] += 1;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let untried: Vec<&str> = SLIPS.iter().zip(tried).filter(|(_, n)| *n == 0).map(|(s, _)| s.0).collect();
    assert!(untried.is_empty(), "no pipeline has {untried:?}");
}
