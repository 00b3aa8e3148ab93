//! Lists the files of the page, so that each becomes part of the program.

// What it prints is for cargo.
#![allow(clippy::print_stdout)]

use std::io;
use std::path::{Path, PathBuf};

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=page");
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join("page");
    let mut files = Vec::new();
    gather(&root, &root, &mut files)?;
    files.sort();
    let entry = |path: &String| {
        format!("    ({path:?}, include_bytes!({:?})),\n", root.join(path).display().to_string())
    };
    let entries: String = files.iter().map(entry).collect();
    let text = format!(
        "/// The page's files: path and content.\npub(super) const FILES: &[(&str, &[u8])] = &[\n{entries}];\n"
    );
    let out = PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    std::fs::write(out.join("page_files.rs"), text)
}

/// All files below a folder, as paths from the root with `/` between the names.
fn gather(root: &Path, folder: &Path, files: &mut Vec<String>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            println!("cargo:rerun-if-changed={}", path.display());
            gather(root, &path, files)?;
        } else if let Ok(below) = path.strip_prefix(root) {
            files.push(below.to_string_lossy().replace('\\', "/"));
        }
    }
    Ok(())
}
