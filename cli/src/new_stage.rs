//! `toile new-stage NAME --role ROLE`: a crate with one stage that builds, loads, and has a test and a benchmark.
//!
//! A template a role stands in `new_stage/`; `NAME` and `CRATE` in it become the stage's and the crate's names.

use crate::{Streams, exit};
use std::path::{Path, PathBuf};
use toile_core::{Registry, Role, write_files};

/// The roles that have a template.
const TEMPLATES: [(&str, Role, Template); 9] = [
    (
        "denoiser",
        Role::Denoiser,
        Template { source: include_str!("new_stage/denoiser.txt"), dependencies: IMAGE },
    ),
    (
        "binariser",
        Role::Binariser,
        Template { source: include_str!("new_stage/binariser.txt"), dependencies: IMAGE },
    ),
    (
        "edge-detector",
        Role::EdgeDetector,
        Template { source: include_str!("new_stage/edge_detector.txt"), dependencies: "" },
    ),
    ("mesher", Role::Mesher, Template { source: include_str!("new_stage/mesher.txt"), dependencies: "" }),
    (
        "smoother",
        Role::Smoother,
        Template { source: include_str!("new_stage/smoother.txt"), dependencies: "" },
    ),
    (
        "stitcher",
        Role::Stitcher,
        Template { source: include_str!("new_stage/stitcher.txt"), dependencies: "" },
    ),
    ("draper", Role::Draper, Template { source: include_str!("new_stage/draper.txt"), dependencies: "" }),
    (
        "collider",
        Role::Collider,
        Template { source: include_str!("new_stage/collider.txt"), dependencies: "" },
    ),
    (
        "texturer",
        Role::Texturer,
        Template { source: include_str!("new_stage/texturer.txt"), dependencies: "" },
    ),
];

const IMAGE: &str = "image = { version = \"0.25\", default-features = false }\n";

/// The longest name: it becomes a folder's and a crate's.
const MAX_NAME: usize = 48;

#[derive(Debug, Clone, Copy)]
struct Template {
    source: &'static str,
    dependencies: &'static str,
}

/// What is asked for.
#[derive(Debug)]
pub(crate) struct Asked<'a> {
    pub(crate) name: &'a str,
    pub(crate) role: &'a str,
    pub(crate) dir: Option<&'a Path>,
    pub(crate) core: Option<&'a Path>,
}

/// Writes the crate.
pub(crate) fn new_stage(asked: &Asked<'_>, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    match written(asked, registry) {
        Ok(folder) => {
            let (show, library) = (folder.display(), snake(asked.name));
            streams.say(format!("wrote {show}"));
            streams.say(format!("  cd {show} && cargo test && cargo build --release"));
            streams
                .say(format!("  toile stage {} --plugin {show}/target/release/lib{library}.so", asked.name));
            exit::DONE
        }
        Err((code, message)) => {
            streams.tell(format!("error: {message}"));
            code
        }
    }
}

type Refusal = (u8, String);

fn usage(message: String) -> Refusal {
    (exit::USAGE, message)
}

fn written(asked: &Asked<'_>, registry: &Registry) -> Result<PathBuf, Refusal> {
    let template = template(asked.role)?;
    check_name(asked.name, registry)?;
    let parent = asked.dir.map_or_else(|| PathBuf::from("."), Path::to_owned);
    let folder = parent.join(kebab(asked.name));
    if folder.exists() {
        return Err(usage(format!("{} is there already; choose another name or `--dir`", folder.display())));
    }
    let core = core_dependency(asked.core)?;
    let files: Vec<(String, Vec<u8>)> = files(asked.name, &template, &core)
        .into_iter()
        .map(|(path, text)| (path.to_owned(), text.into_bytes()))
        .collect();
    let files = files.into_iter().map(|(path, bytes)| toile_core::artifact::OutputFile { path, bytes });
    write_files(&folder, &files.collect::<Vec<_>>())
        .map_err(|e| (exit::INVALID, format!("cannot write {}: {e}", folder.display())))?;
    Ok(folder)
}

fn template(role: &str) -> Result<Template, Refusal> {
    let wanted = role.trim().to_lowercase().replace([' ', '_'], "-");
    if let Some((_, _, template)) = TEMPLATES.iter().find(|(name, ..)| *name == wanted) {
        return Ok(*template);
    }
    let names: Vec<&str> = TEMPLATES.iter().map(|(name, ..)| *name).collect();
    let is_role = Role::ALL.iter().any(|r| r.as_str().replace(' ', "-") == wanted);
    let message = match is_role {
        true => format!("there is no template for a {wanted}; there are {}", names.join(", ")),
        false => match toile_core::pipeline::nearest(&wanted, names.iter().copied()) {
            Some(near) => format!("there is no role \"{role}\"; did you mean {near}?"),
            None => format!("there is no role \"{role}\"; there are {}", names.join(", ")),
        },
    };
    Err(usage(message))
}

/// Names that Rust or Cargo would not take for a crate.
const RESERVED: [&str; 6] = ["Self", "Test", "Core", "Std", "Alloc", "Box"];

fn check_name(name: &str, registry: &Registry) -> Result<(), Refusal> {
    let word =
        name.starts_with(|c: char| c.is_ascii_uppercase()) && name.chars().all(|c| c.is_ascii_alphanumeric());
    if !word || name.len() < 2 || name.len() > MAX_NAME || RESERVED.contains(&name) {
        return Err(usage(format!(
            "\"{name}\" cannot name a stage; write one word that begins with a capital, like FineMesher"
        )));
    }
    match registry.named(name).next() {
        Some(card) => {
            Err(usage(format!("there is a {} `{name}` already; choose another name", card.role.as_str())))
        }
        None => Ok(()),
    }
}

/// The line that names toile-core: by its folder, or by this program's version.
fn core_dependency(core: Option<&Path>) -> Result<String, Refusal> {
    let Some(path) = core else { return Ok(format!("version = \"{}\"", env!("CARGO_PKG_VERSION"))) };
    if !path.join("Cargo.toml").is_file() {
        return Err((exit::INVALID, format!("there is no crate in {}", path.display())));
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

fn files(name: &str, template: &Template, core: &str) -> [(&'static str, String); 5] {
    let (source, rest) = template.source.split_once("//// tests\n").unwrap_or((template.source, ""));
    let (test, bench) = rest.split_once("//// bench\n").unwrap_or((rest, ""));
    let fill = |text: &str| text.replace("NAME", name).replace("CRATE", &snake(name));
    [
        ("Cargo.toml", manifest(name, template.dependencies, core)),
        ("src/lib.rs", fill(source)),
        ("tests/stage.rs", fill(test)),
        ("benches/stage.rs", fill(bench)),
        (".gitignore", "target\n".to_owned()),
    ]
}

fn manifest(name: &str, dependencies: &str, core: &str) -> String {
    let package = kebab(name);
    format!(
        "[package]\nname = \"{package}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
         # A workspace of its own, wherever the folder lies.\n[workspace]\n\n\
         # cdylib to be loaded, rlib to be linked in.\n[lib]\ncrate-type = [\"cdylib\", \"rlib\"]\n\n\
         [dependencies]\ntoile-core = {{ {core} }}\n{dependencies}\n\
         [dev-dependencies]\ntoile-core = {{ {core}, features = [\"testkit\"] }}\n\
         criterion = {{ version = \"0.8\", default-features = false }}\n\n\
         [[bench]]\nname = \"stage\"\nharness = false\n"
    )
}
