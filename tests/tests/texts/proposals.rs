//! What messages propose: stages and parameters that there are, and lines that help.

use image::{RgbImage, imageops};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use toile_tests::{pipeline, root, toile};

/// The parameters of each stage; of all of one name where several roles have it.
fn stages() -> BTreeMap<String, Vec<String>> {
    let text = fs::read_to_string(root().join("docs/reference/stages.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let text = |v: &Value| v.as_str().unwrap().to_owned();
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for stage in all["stages"].as_array().unwrap() {
        let params = stage["params"].as_array().unwrap().iter().map(|p| text(&p["name"]));
        found.entry(text(&stage["name"])).or_default().extend(params);
    }
    found
}

/// All sources below a folder.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => sources(&path, found),
            false if path.extension().is_some_and(|e| e == "rs") => found.push(path),
            false => {}
        }
    }
}

/// Calls such as `Neckline(depth: ...)` in a text: the stage, and the parameters that it names
/// outside of any inner parentheses.
fn calls(text: &str) -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices('(') {
        let head = &text[..at];
        let start = head.rfind(|c: char| !c.is_alphanumeric()).map_or(0, |i| i + 1);
        let name = &head[start..];
        if !name.starts_with(|c: char| c.is_ascii_uppercase()) {
            continue;
        }
        let (mut depth, mut own) = (0, String::new());
        for c in text[at..].chars() {
            depth += i32::from("([{".contains(c)) - i32::from(")]}".contains(c));
            if depth == 0 {
                break;
            }
            if depth == 1 {
                own.push(c);
            }
        }
        let key = |part: &str| {
            let (key, _) = part.trim_start_matches('(').split_once(':')?;
            let key = key.trim();
            let is_word = !key.is_empty() && key.chars().all(|c| c.is_ascii_lowercase() || c == '_');
            is_word.then(|| key.to_owned())
        };
        found.push((name.to_owned(), own.split(',').filter_map(key).collect()));
    }
    found
}

#[test]
fn calls_are_read_from_messages() {
    let text =
        "try `Neckline(depth: ...)` or Block(style: Skirt, waist: Gathered(fullness: 2)), not {name}(x: 1)";
    let told: Vec<(String, Vec<String>)> = calls(text);
    let has = |name: &str, keys: &[&str]| told.iter().any(|(n, k)| n == name && k.iter().eq(keys));
    assert!(has("Neckline", &["depth"]) && has("Block", &["style", "waist"]), "{told:?}");
}

#[test]
fn messages_name_stages_and_parameters_that_there_are() {
    let stages = stages();
    let mut files = Vec::new();
    for folder in ["core/src", "stages", "cli/src"] {
        sources(&root().join(folder), &mut files);
    }
    let (mut checked, mut wrong) = (0, Vec::new());
    let is_test = |f: &&PathBuf| {
        f.components().any(|c| c.as_os_str().to_string_lossy().trim_end_matches(".rs").ends_with("tests"))
    };
    // What every stage of a pipeline takes.
    let common = ["id", "from"];
    let below = root().components().count();
    for file in files.iter().filter(|f| !is_test(&&f.components().skip(below).collect())) {
        let text = fs::read_to_string(file).unwrap();
        // Tests below the code make stages of their own.
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        let lines = code.lines().filter(|l| !l.trim_start().starts_with("//") && l.contains('"'));
        for (stage, keys) in lines.flat_map(calls) {
            let Some(known) = stages.get(&stage) else { continue };
            checked += 1;
            for key in keys.iter().filter(|k| !known.contains(k) && !common.contains(&k.as_str())) {
                wrong.push(format!("{}: {stage} has no `{key}`", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(checked > 60, "{checked}");
}

/// The lines that a message offers for pasting.
fn proposed(message: &str) -> Vec<String> {
    let joined = message.split_whitespace().collect::<Vec<&str>>().join(" ").replace("│ ", "");
    joined.split("--set '").skip(1).filter_map(|rest| Some(rest.split_once('\'')?.0.to_owned())).collect()
}

/// A photo that `Auto` refuses is taken with the line that it offers, and the line is not offered
/// again.
fn helps(photo: &RgbImage, reason: &str) {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("mine.png");
    photo.save(&file).unwrap();
    let out = dir.path().join("out").display().to_string();
    let mut sets = vec![
        format!("photos.front.file={:?}", file.display().to_string()),
        "photos.front.width=\"62 cm\"".to_owned(),
    ];
    let path = pipeline("photo_skirt.ron");
    let run = |sets: &[String]| {
        let mut args = vec!["run", &path, "--until", "Auto", "--out", &out];
        sets.iter().for_each(|s| args.extend(["--set", s]));
        toile(&args)
    };
    let first = run(&sets);
    assert_eq!(first.code, 3, "{}{}", first.out, first.err);
    assert!(first.err.contains(reason), "{}", first.err);
    let lines = proposed(&first.err);
    assert!(!lines.is_empty(), "{}", first.err);
    sets.push(lines[0].clone());
    let second = run(&sets);
    let again = proposed(&second.err);
    assert!(!again.contains(&lines[0]), "{} is proposed again: {}", lines[0], second.err);
    assert_eq!(second.code, 0, "{} does not help: {}", lines[0], second.err);
}

fn sample() -> RgbImage {
    image::open(root().join("pipelines/samples/skirt/front.jpg")).unwrap().to_rgb8()
}

#[test]
fn a_garment_that_the_frame_touches_is_taken_with_the_line_that_is_offered() {
    let photo = sample();
    // The hem's last millimetres are cut off.
    helps(&imageops::crop_imm(&photo, 0, 0, photo.width(), 1150).to_image(), "cut by the frame");
}

#[test]
fn a_doubtful_garment_is_taken_with_the_line_that_is_offered() {
    // A garment of its ground's colours, out of focus.
    let pale = RgbImage::from_fn(700, 620, pale);
    helps(&imageops::blur(&pale, 6.0), "lies where the photo");
}

/// A rectangle hardly darker than its noisy ground, with one side that fades.
fn pale(x: u32, y: u32) -> image::Rgb<u8> {
    let inside = (150..550).contains(&x) && (120..520).contains(&y);
    let noise = (x * 7919 + y * 104_729 + x * y * 31) % 23;
    let fade = if inside { 14 * (550 - x) / 400 } else { 0 };
    image::Rgb([150 - fade + noise, 146 - fade + noise, 140 - fade + noise].map(|v| v as u8))
}
