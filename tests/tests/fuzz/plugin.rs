//! Plugin files: a library that was cut short, or whose headers are spoilt, is refused with a
//! reason.
//!
//! Each case is a process of its own, since the system's loader may end it. What lies in a
//! library's code is not touched: a plugin is code that its user trusts.

use crate::dice::Dice;
use crate::{HEAP, MAX_BYTES, fuzz, spoil};
use std::path::Path;
use std::process::Command;
use toile_pipeline::plugin::load_plugin;
use toile_tests::plugins::compiled;

/// Names the library for the process that opens it.
const FILE: &str = "FUZZ_PLUGIN_FILE";

/// A library as an interrupted link or copy leaves it, or with a spoilt header: its first bytes say
/// what kind of file it is and where its tables lie.
fn spoilt(library: &[u8], dice: &mut Dice) -> Vec<u8> {
    const HEADER: usize = 64;
    match dice.below(4) {
        0 | 1 => library[..dice.below(library.len())].to_vec(),
        2 => {
            let head = spoil::binary(&[library[..HEADER].to_vec()], dice);
            [&head, &library[HEADER..]].concat()
        }
        // Disks hand out whole blocks: what was not written yet is missing from the end.
        _ => library[..dice.below(library.len()) / 512 * 512].to_vec(),
    }
}

#[test]
fn plugin_files() {
    let dir = tempfile::tempdir().unwrap();
    let library = std::fs::read(compiled("plugins/c/invert.c", dir.path(), &[]).unwrap()).unwrap();
    let file = dir.path().join("fuzz.so");
    fuzz(
        "plugin",
        40,
        |dice| spoilt(&library, dice),
        |bytes| {
            std::fs::write(&file, bytes).unwrap();
            opened(&file)
        },
    );
}

/// Opens the library in another process, which must come to its end by itself.
fn opened(file: &Path) -> Result<(), String> {
    let mut child = Command::new(std::env::current_exe().unwrap());
    child.args(["--exact", "plugin::opens_a_library", "--ignored"]).env(FILE, file);
    let out = child.output().map_err(|e| e.to_string())?;
    match out.status.success() {
        true => Ok(()),
        false => Err(format!("{}: {}", out.status, String::from_utf8_lossy(&out.stdout))),
    }
}

#[test]
#[ignore = "the other process of plugin_files"]
fn opens_a_library() {
    let Some(file) = std::env::var_os(FILE) else { return };
    if let Err(refused) = load_plugin(&mut toile::registry(), Path::new(&file), None) {
        assert!(!refused.reason.is_empty());
    }
    assert!(HEAP.peak_usage() < MAX_BYTES, "it held {} MiB", HEAP.peak_usage() >> 20);
}
