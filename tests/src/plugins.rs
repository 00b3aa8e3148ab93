//! Plugins for the tests: those that are built with them, and those of C, compiled here.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use toile_core::{Cancel, Listener, Registry};
use toile_pipeline::{Override, RunOptions, RunResult, load, run};

/// The library of a plugin crate that the tests depend on, such as `toile_faulty`: cargo puts it
/// beside the tests' programs, which lie in `deps`, as examples do not.
pub fn library(name: &str) -> PathBuf {
    let file = format!("{}{name}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let program = std::env::current_exe().unwrap_or_default();
    let beside = program.parent().map(|dir| dir.join(&file));
    let in_deps = program.ancestors().nth(2).map(|dir| dir.join("deps").join(&file));
    beside.into_iter().chain(in_deps).find(|path| path.is_file()).unwrap_or_else(|| PathBuf::from(file))
}

/// The shipped vest sewn and draped against `SdfCollider`, which is asked in the solver's inner
/// loop.
///
/// Errors: what the loader or a stage says.
pub fn vest_on_sdf(registry: &Registry) -> Result<RunResult, Box<dyn Error>> {
    let file = crate::pipeline("vest.ron");
    let base = Path::new(&file).parent().unwrap_or(Path::new("."));
    let swapped: Override = "stages.BvhCollider=SdfCollider()".parse()?;
    let pipeline = load(&std::fs::read_to_string(&file)?, &file, base, registry, &[swapped])?;
    let options = RunOptions { until: Some("StaticEquilibrium".into()), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    Ok(run(&pipeline, &options, &Cancel::new(), &listener)?)
}

/// Compiles a C source of the repository as a plugin into `dir`; gives the library.
///
/// Errors: what the compiler says.
pub fn compiled(source: &str, dir: &Path, flags: &[&str]) -> Result<PathBuf, String> {
    let out =
        dir.join(format!("lib{}{}", flags.concat().replace(['=', '-'], "_"), std::env::consts::DLL_SUFFIX));
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let made = Command::new(&compiler)
        .args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC"])
        .args(flags)
        .arg("-I")
        .arg(crate::root().join("core/include"))
        .arg("-o")
        .arg(&out)
        .arg(crate::root().join(source))
        .output()
        .map_err(|e| format!("there is no C compiler `{compiler}`: {e}"))?;
    match made.status.success() {
        true => Ok(out),
        false => Err(String::from_utf8_lossy(&made.stderr).into_owned()),
    }
}
