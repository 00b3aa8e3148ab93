//! `toile new-stage NAME [--role ROLE]`: a crate with one stage that builds, loads, and has a test
//! and a benchmark.
//!
//! A template a role stands in `new_stage/`; `NAME` and `CRATE` in it become the stage's and the
//! crate's names. The crate depends on toile-core by its folder: that of `--core`, or the source
//! tree that this program was built from.

use crate::{Streams, exit};
use std::path::{Path, PathBuf};
use toile_core::artifact::OutputFile;
use toile_core::{Registry, Role, Section, SectionValue};
use toile_pipeline::plugin::library_of;
use toile_pipeline::write_files;

/// The library and its tests, and what they need beside toile-core.
fn template(role: Role) -> (&'static str, &'static str) {
    match role {
        Role::Reader => (include_str!("new_stage/reader.txt"), PNG),
        Role::Denoiser => (include_str!("new_stage/denoiser.txt"), IMAGE),
        Role::Panorama => (include_str!("new_stage/panorama.txt"), IMAGE),
        Role::ViewInterpolator => (include_str!("new_stage/view_interpolator.txt"), IMAGE),
        Role::Binariser => (include_str!("new_stage/binariser.txt"), IMAGE),
        Role::EdgeDetector => (include_str!("new_stage/edge_detector.txt"), ""),
        Role::Style => (include_str!("new_stage/style.txt"), ""),
        Role::Mesher => (include_str!("new_stage/mesher.txt"), ""),
        Role::Smoother => (include_str!("new_stage/smoother.txt"), ""),
        Role::Body => (include_str!("new_stage/body.txt"), ""),
        Role::Fabric => (include_str!("new_stage/fabric.txt"), ""),
        Role::Placement => (include_str!("new_stage/placement.txt"), ""),
        Role::Collider => (include_str!("new_stage/collider.txt"), ""),
        Role::Stitcher => (include_str!("new_stage/stitcher.txt"), ""),
        Role::Draper => (include_str!("new_stage/draper.txt"), ""),
        Role::Flattener => (include_str!("new_stage/flattener.txt"), ""),
        Role::Texturer => (include_str!("new_stage/texturer.txt"), ""),
        Role::Writer => (include_str!("new_stage/writer.txt"), ""),
    }
}

/// The benchmark, alike for every role.
const BENCH: &str = include_str!("new_stage/bench.txt");

const IMAGE: &str = "image = { version = \"0.25\", default-features = false }\n";
const PNG: &str = "image = { version = \"0.25\", default-features = false, features = [\"png\"] }\n";

/// The crate of toile-core in the source tree that this program was built from.
const BUILT_FROM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../core");

/// The longest name: it becomes a folder's and a crate's.
const MAX_NAME: usize = 48;

/// What is requested.
#[derive(Debug)]
pub(crate) struct AskedStage<'a> {
    pub(crate) name: &'a str,
    pub(crate) role: Option<&'a str>,
    pub(crate) dir: Option<&'a Path>,
    pub(crate) core: Option<&'a Path>,
}

/// Writes the crate.
pub(crate) fn new_stage(asked: &AskedStage<'_>, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    match written(asked, registry) {
        Ok(WrittenCrate { folder, name, role }) => {
            let show = folder.display();
            let library = Path::new("target/release").join(library_of(&name));
            streams.say(format!("wrote {show}, the {} {name}", role.as_str()));
            streams.say(format!("  cd {show} && cargo test && cargo build --release"));
            streams.say(format!("  toile stage {name} --plugin {}", folder.join(&library).display()));
            streams.say("in a pipeline:");
            streams.say(format!("    plugins: [{}],", text(&full(&folder).join(&library))));
            streams.say(format!("    {}", placed(&name, role, registry)));
            exit::DONE
        }
        Err((code, message)) => {
            streams.tell(format!("error: {message}"));
            code
        }
    }
}

/// The path from the root, so that it holds for a pipeline anywhere.
fn full(folder: &Path) -> PathBuf {
    let full = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    full.components().collect()
}

/// A path as text of a pipeline.
fn text(path: &Path) -> String {
    format!("{:?}", path.display().to_string())
}

/// Where the stage stands in a pipeline: in the field of its role where there is one, else among
/// the stages.
fn placed(name: &str, role: Role, registry: &Registry) -> String {
    let of_role = |s: &&Section| matches!(s.holds, SectionValue::Stage(held) if held == role);
    let fields: Vec<&Section> = registry.sections().iter().filter(of_role).collect();
    match fields[..] {
        [section] => format!("{}: {name}(),", section.field),
        _ => format!("stages: [..., {name}(), ...],"),
    }
}

/// The crate that was written.
struct WrittenCrate {
    folder: PathBuf,
    name: String,
    role: Role,
}

type Refusal = (u8, String);

fn usage(message: String) -> Refusal {
    (exit::USAGE, message)
}

fn written(asked: &AskedStage<'_>, registry: &Registry) -> Result<WrittenCrate, Refusal> {
    let name = stage_name(asked.name, registry)?;
    let role = role(asked.role, &name)?;
    let (source, dependencies) = template(role);
    check_own_names(&name, source)?;
    let parent = asked.dir.map_or_else(|| PathBuf::from("."), Path::to_owned);
    let folder = parent.join(kebab(&name));
    if folder.exists() {
        return Err(usage(format!("{} is there already; choose another name or `--dir`", folder.display())));
    }
    let core = core_dependency(asked.core, Path::new(BUILT_FROM))?;
    write_files(&folder, &files(&name, source, &manifest(&name, dependencies, &core)))
        .map_err(|e| (exit::INVALID, format!("cannot write {}: {e}", folder.display())))?;
    Ok(WrittenCrate { folder, name, role })
}

/// A role as it is written on the command line: `edge-detector`.
fn role_word(role: Role) -> String {
    role.as_str().replace(' ', "-")
}

/// The role of that word; without one that which the stage's name ends with, like `FineMesher`,
/// else a binariser.
fn role(asked: Option<&str>, name: &str) -> Result<Role, Refusal> {
    let Some(asked) = asked else {
        let last = |role: &Role| kebab(name).ends_with(&format!("-{}", role_word(*role)));
        return Ok(Role::ALL.into_iter().find(last).unwrap_or(Role::Binariser));
    };
    let wanted = asked.trim().to_lowercase().replace([' ', '_'], "-");
    if let Some(role) = Role::ALL.into_iter().find(|r| role_word(*r) == wanted) {
        return Ok(role);
    }
    let words = Role::ALL.map(role_word);
    Err(usage(match toile_core::nearest(&wanted, words.iter().map(String::as_str)) {
        Some(near) => format!("there is no role \"{asked}\"; did you mean {near}?"),
        None => format!("there is no role \"{asked}\"; there are {}", words.join(", ")),
    }))
}

/// Words that Rust or Cargo do not take for a crate, and crates that the new one depends on.
const RESERVED: [&str; 64] = [
    "abstract",
    "alloc",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "const",
    "continue",
    "core",
    "crate",
    "criterion",
    "do",
    "dyn",
    "else",
    "enum",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "image",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "proc_macro",
    "pub",
    "ref",
    "return",
    "self",
    "stage",
    "static",
    "std",
    "struct",
    "super",
    "test",
    "toile",
    "toile_core",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
    "build",
    "deps",
    "examples",
];

/// The stage's name: `FineMesher`, also where `fine_mesher` or `fine-mesher` is requested.
fn stage_name(asked: &str, registry: &Registry) -> Result<String, Refusal> {
    let refused =
        || usage(format!("\"{asked}\" cannot name a stage; write a name like FineMesher or fine_mesher"));
    let name = camel(asked).ok_or_else(refused)?;
    if name.len() < 2 || name.len() > MAX_NAME || RESERVED.contains(&snake(&name).as_str()) {
        return Err(refused());
    }
    let taken = registry.named(&name).next().map(|card| card.role.as_str());
    match taken {
        Some(role) => Err(usage(format!("there is a {role} `{name}` already; choose another name"))),
        None => Ok(name),
    }
}

/// `fine_mesher` and `fine-mesher` as `FineMesher`, which stays as it is; nothing for what is
/// neither.
fn camel(asked: &str) -> Option<String> {
    let letters = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric());
    if letters(asked) && asked.starts_with(|c: char| c.is_ascii_uppercase()) {
        return Some(asked.to_owned());
    }
    let lower = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    let words: Vec<&str> = asked.split(['_', '-']).collect();
    let sound = words.iter().all(|w| letters(w) && w.chars().all(lower));
    let capital = |word: &&str| word[..1].to_uppercase() + &word[1..];
    (sound && asked.starts_with(|c: char| c.is_ascii_lowercase()))
        .then(|| words.iter().map(capital).collect())
}

/// Refuses a name that the crate's own code means something else by, such as `Photo`.
fn check_own_names(name: &str, source: &str) -> Result<(), Refusal> {
    let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    let mut words = code.flat_map(|line| line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'));
    match words.any(|word| word == name) {
        true => Err(usage(format!("the crate needs `{name}` for something else; choose another name"))),
        false => Ok(()),
    }
}

/// The line that names toile-core by its folder: the one that is requested, else that of the source
/// tree.
fn core_dependency(asked: Option<&Path>, built_from: &Path) -> Result<String, Refusal> {
    let path = asked.unwrap_or(built_from);
    if !path.join("Cargo.toml").is_file() {
        let message = match asked {
            Some(_) => format!("there is no crate in {}", path.display()),
            None => format!(
                "the source tree that this program was built from is gone from {}; name toile's folder `core` by `--core`",
                path.display()
            ),
        };
        return Err((exit::INVALID, message));
    }
    let full =
        path.canonicalize().map_err(|e| (exit::INVALID, format!("cannot read {}: {e}", path.display())))?;
    Ok(format!("path = {:?}", full.display().to_string()))
}

/// `FineMesher` as `fine-mesher`.
fn kebab(name: &str) -> String {
    let mut out = String::new();
    for (i, c) in name.char_indices() {
        if i > 0 && c.is_ascii_uppercase() {
            out.push('-');
        }
        out.push(c.to_ascii_lowercase());
    }
    out
}

/// `FineMesher` as `fine_mesher`.
fn snake(name: &str) -> String {
    kebab(name).replace('-', "_")
}

fn files(name: &str, source: &str, manifest: &str) -> [OutputFile; 5] {
    let (source, test) = source.split_once("//// tests\n").unwrap_or((source, ""));
    let fill = |text: &str| text.replace("NAME", name).replace("CRATE", &snake(name));
    [
        ("Cargo.toml", manifest.to_owned()),
        ("src/lib.rs", fill(source)),
        ("tests/stage.rs", fill(test)),
        ("benches/stage.rs", fill(BENCH)),
        (".gitignore", "target\n".to_owned()),
    ]
    .map(|(path, text)| OutputFile::new(path, text.into_bytes()))
}

fn manifest(name: &str, dependencies: &str, core: &str) -> String {
    let package = kebab(name);
    // Whoever looks at pixels takes toile-core's pictures as those of `image`.
    let features = if dependencies.is_empty() { "" } else { ", features = [\"image\"]" };
    format!(
        "[package]\nname = \"{package}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
         # A workspace of its own, wherever the folder lies.\n[workspace]\n\n\
         # cdylib to be loaded, rlib to be linked in.\n[lib]\ncrate-type = [\"cdylib\", \"rlib\"]\n\n\
         [dependencies]\ntoile-core = {{ {core}{features} }}\n{dependencies}\n\
         [dev-dependencies]\ntoile-core = {{ {core}, features = [\"testkit\"] }}\n\
         criterion = {{ version = \"0.8\", default-features = false }}\n\n\
         [[bench]]\nname = \"stage\"\nharness = false\n"
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_stage_is_named_in_either_way() {
        let names = ["FineMesher", "fine_mesher", "fine-mesher", "my_otsu", "my_2nd", "K"].map(camel);
        let wanted = ["FineMesher", "FineMesher", "FineMesher", "MyOtsu", "My2nd", "K"];
        assert_eq!(names, wanted.map(|n| Some(n.to_owned())));
        for none in ["", "fine mesher", "Fine-Mesher", "fine_Mesher", "_fine", "fine__mesher", "1st", "é"] {
            assert_eq!(camel(none), None, "{none}");
        }
    }

    #[test]
    fn the_role_is_the_one_that_the_name_ends_with() {
        let of = |name: &str| role(None, name).map(role_word).map_err(|e| e.1);
        assert_eq!(of("FineMesher"), Ok("mesher".into()));
        assert_eq!(of("MyEdgeDetector"), Ok("edge-detector".into()));
        assert_eq!(of("MyOtsu"), Ok("binariser".into()));
        assert_eq!(of("Somebody"), Ok("binariser".into()));
    }

    #[test]
    fn without_a_source_tree_the_core_must_be_named() {
        let dir = std::env::temp_dir().join("toile-no-such-tree");
        let (code, message) = core_dependency(None, &dir).unwrap_err();
        assert_eq!(code, 3);
        assert_eq!(
            message,
            format!(
                "the source tree that this program was built from is gone from {}; name toile's folder `core` by `--core`",
                dir.display()
            )
        );
    }
}
