//! Gives the program the commit that it was built from; a source tree without git gives the version
//! alone.

// What it prints is for cargo.
#![allow(clippy::print_stdout)]

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let version = std::env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let words = commit().map_or_else(|| version.clone(), |commit| format!("{version} (commit {commit})"));
    println!("cargo:rustc-env=TOILE_VERSION={words}");
}

/// The commit of this source tree; none where it is not a git tree of its own, or there is no git.
fn commit() -> Option<String> {
    // Sources copied into another project's repository do not have that repository's commit.
    git(&["ls-files", "--error-unmatch", "build.rs"])?;
    let head = git(&["rev-parse", "--git-path", "HEAD"])?;
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    let branch = branch.and_then(|name| git(&["rev-parse", "--git-path", &name]));
    let packed = git(&["rev-parse", "--git-path", "packed-refs"]);
    // One that is not there would count as changed in every build.
    for file in [Some(head), branch, packed].into_iter().flatten().filter(|file| Path::new(file).exists()) {
        println!("cargo:rerun-if-changed={file}");
    }
    git(&["rev-parse", "--short=12", "HEAD"])
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|o| o.status.success())?;
    String::from_utf8(output.stdout).ok().map(|text| text.trim().to_owned())
}
