//! `toile migrate`: rewrites old pipeline files to the names that stages and parameters have now.

use crate::args::MigrateArgs;
use crate::{Streams, exit, terminal::stdin};
use std::path::Path;
use toile_core::artifact::OutputFile;
use toile_core::{Registry, read_text};
use toile_pipeline::{Faults, add_implicit, faults, load, migrate, write_files};

/// Rewrites every file that needs it, and says what was changed.
pub(crate) fn run(args: &MigrateArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let codes = args.pipelines.iter().map(|path| one(path, args.check, registry, streams));
    codes.max().unwrap_or(exit::DONE)
}

fn one(path: &Path, check: bool, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    if let Err(e) = stdin::refused(path, "has no file to rewrite") {
        return streams.refuse(false, e);
    }
    let name = path.display().to_string();
    let text = match read_text(path) {
        Ok(text) => text,
        Err(e) => {
            streams.tell(format!("error: cannot read the pipeline \"{name}\": {e}"));
            return exit::INVALID;
        }
    };
    let new = match migrate(&text, &name, registry) {
        Ok(new) => new,
        Err(faults) => {
            streams.fault(&faults);
            return exit::INVALID;
        }
    };
    for change in &new.changes {
        streams.say(format!("{name}: {change}"));
    }
    let base = path.parent().unwrap_or(Path::new("."));
    let left = valid(&new.text, &name, base, registry);
    let code = match (new.changes.is_empty(), check) {
        (true, _) if left.is_err() => exit::INVALID,
        (true, _) => {
            streams.say(format!("{name}: up to date"));
            exit::DONE
        }
        (false, true) => exit::QUALITY,
        (false, false) => match rewrite(path, new.text) {
            Ok(()) => exit::DONE,
            Err(e) => {
                streams.tell(format!("error: {e}"));
                exit::INVALID
            }
        },
    };
    match left {
        Ok(()) => code,
        Err(faults) => {
            streams.fault(&faults);
            exit::INVALID
        }
    }
}

/// Whether `toile validate` would take a text.
fn valid(text: &str, name: &str, base: &Path, registry: &Registry) -> Result<(), Box<Faults>> {
    let mut pipeline = load(text, name, base, registry, &[])?;
    add_implicit(&mut pipeline, registry);
    Ok(faults(&pipeline, |_| true, None)?)
}

/// Writes the file whole or not at all; of a link, the file that it leads to.
fn rewrite(path: &Path, text: String) -> Result<(), String> {
    let path = path.canonicalize().map_err(|e| format!("cannot write \"{}\": {e}", path.display()))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let file = OutputFile { path: name, bytes: text.into_bytes() };
    write_files(folder, &[file]).map(|_| ()).map_err(|e| e.to_string())
}
