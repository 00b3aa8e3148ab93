//! Every text of the built-in stages, read from their sources: none has a word of the engine.
//!
//! The errors of the engine itself, word for word, stand in stages/drape/src/engine/words/tests.rs.

use std::fs;
use std::path::{Path, PathBuf};
use toile_tests::root;

/// Words that only who knows the engine understands. A parameter's name stands in backticks, and
/// may be one of them.
const ENGINE_WORDS: [&str; 15] = [
    " lay,",
    "smoother lay",
    "coarsest",
    "mesh level",
    " n/m",
    " n a metre",
    "residual",
    "newton",
    "factoriz",
    "stiffness",
    "hinge",
    "vertex",
    "vertices",
    "degenerate",
    "converge",
];

/// Where such a word is the user's own: it stands in the file that they gave, or in the one that is
/// written.
const OWN_WORDS: [(&str, &str, &str); 15] = [
    ("flat/sheet.rs", "vertex", "the mesh to flatten is the user's"),
    ("flat/file/read_glb.rs", "vert", "the mesh to flatten is the user's"),
    ("place/sew.rs", "vertices", "seams of meshes that the user wired"),
    ("fabric/sheet.rs", "stiffness", "title of a paper, and a fabric given by its curve"),
    ("fabric/sheet.rs", "n/m", "a fabric given by its curve"),
    ("pattern/garment_code/", "vert", "GarmentCode's own key"),
    ("write/check.rs", "vertex", "a model of the user's own stage"),
    ("write/ply.rs", "vert", "the file's format"),
    ("write/usdz/scene.rs", "vertex", "the file's format"),
    ("write/frames/usdz.rs", "vert", "the file's format"),
    ("write/reporting/data.rs", "vertices", "a heading of figures"),
    ("drape/asleep.rs", "vertices", "what a decision saves, for `explain`"),
    ("drape/static_equilibrium.rs", "newton", "source of the method"),
    ("texture/photo_texturer.rs", "vertex", "a garment of the user's own stage"),
    ("collide/body_check.rs", "vert", "the body's mesh is the user's"),
];

/// The crates that hold the built-in stages.
const CRATES: [&str; 6] = ["image", "views", "pattern", "body", "drape", "output"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        match path.is_dir() {
            true if name == "tests" => {}
            true => sources(&path, found),
            false if name.ends_with(".rs") && !name.ends_with("tests.rs") => found.push(path),
            false => {}
        }
    }
}

/// Text literals of a source with their lines, without comments and attributes, continued lines
/// joined.
fn literals(code: &str) -> Vec<(usize, String)> {
    let bytes: Vec<char> = code.chars().collect();
    let (mut found, mut i, mut line) = (Vec::new(), 0, 1);
    while i < bytes.len() {
        match bytes[i] {
            '\n' => line += 1,
            '/' if bytes.get(i + 1) == Some(&'/') => {
                while i + 1 < bytes.len() && bytes[i + 1] != '\n' {
                    i += 1;
                }
            }
            '\'' if bytes.get(i + 1) == Some(&'\\') => i += 3,
            '\'' if bytes.get(i + 2) == Some(&'\'') => i += 2,
            '"' => {
                let (from, mut text) = (line, String::new());
                i += 1;
                while bytes[i] != '"' {
                    if bytes[i] == '\\' && bytes[i + 1] == '\n' {
                        while bytes[i + 1].is_whitespace() {
                            line += usize::from(bytes[i + 1] == '\n');
                            i += 1;
                        }
                    } else {
                        if bytes[i] == '\\' {
                            i += 1;
                        }
                        line += usize::from(bytes[i] == '\n');
                        text.push(bytes[i]);
                    }
                    i += 1;
                }
                found.push((from, text));
            }
            _ => {}
        }
        i += 1;
    }
    found
}

/// A text of several words, without what stands in backticks; none of names and keys.
fn prose(text: &str) -> Option<String> {
    let prose = text.split('`').step_by(2).collect::<String>().to_lowercase();
    (text.matches(' ').count() >= 2).then_some(prose)
}

#[test]
fn literals_are_read_as_the_compiler_reads_them() {
    let code =
        "// \"no\"\nlet c = '\"'; let e = '\\'';\nf(\"the cloth \\\n    is `stiff`\", \"say \\\"so\\\"\");";
    let expected = [(3, "the cloth is `stiff`".to_owned()), (4, "say \"so\"".to_owned())];
    assert_eq!(literals(code), expected);
    assert_eq!(prose("the cloth is `stiff`").unwrap(), "the cloth is ");
}

#[test]
fn stages_speak_of_the_garment_not_of_the_engine() {
    let folders = CRATES.map(|name| root().join("stages").join(name).join("src"));
    let mut files = Vec::new();
    folders.iter().for_each(|folder| sources(folder, &mut files));
    let (mut texts, mut wrong, mut used) = (0, Vec::new(), [false; OWN_WORDS.len()]);
    for file in &files {
        let text = fs::read_to_string(file).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        let below = folders.iter().find_map(|folder| file.strip_prefix(folder).ok()).unwrap();
        let place = below.to_string_lossy().replace('\\', "/");
        for (line, text) in literals(code) {
            let Some(prose) = prose(&text) else { continue };
            texts += 1;
            for word in ENGINE_WORDS.iter().filter(|w| prose.contains(**w)) {
                let own =
                    OWN_WORDS.iter().position(|(at, own, _)| place.starts_with(at) && word.contains(own));
                match own {
                    Some(k) => used[k] = true,
                    None => wrong.push(format!("{place}:{line}: `{word}` stands in: {text}")),
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(texts > 1000, "{texts} texts were read");
    let idle: Vec<&str> =
        OWN_WORDS.iter().zip(used).filter(|(_, used)| !used).map(|((at, ..), _)| *at).collect();
    assert!(idle.is_empty(), "no such word stands there any more: {idle:?}");
}
