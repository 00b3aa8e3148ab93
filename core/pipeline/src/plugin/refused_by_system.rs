//! Why the system does not load a library: the loader's own words, and what they ask of the user.

use std::error::Error;
use std::path::Path;

/// A library that the system looks for among those of the plugin and does not find.
const NO_LIBRARY: &str = ": cannot open shared object file";

/// The loader's words about a library that was loaded from `from` and is named `file`, and a
/// remedy.
pub(super) fn worded(e: &libloading::Error, from: &Path, file: &Path) -> (String, Option<String>) {
    let mut deepest: &dyn Error = e;
    while let Some(source) = deepest.source() {
        deepest = source;
    }
    let words = bare(&deepest.to_string(), from, file);
    let hint = remedy(&words, file);
    (format!("the system cannot load it: {words}"), Some(hint))
}

/// The loader's words without the path that the message already has; a copy's path becomes that of
/// the file.
fn bare(words: &str, from: &Path, file: &Path) -> String {
    let path = from.display().to_string();
    let rest = words.strip_prefix(&path).and_then(|rest| rest.strip_prefix(": ")).unwrap_or(words);
    rest.replace(&path, &file.display().to_string())
}

/// What the user may do.
fn remedy(words: &str, file: &Path) -> String {
    if let Some(function) = missing_function(words) {
        return format!(
            "it calls `{function}`, which none of the libraries has that it is linked to: link that one as well (`cc ... -lNAME`), and build it again"
        );
    }
    if let Some(library) = missing_library(words) {
        return match file.parent().filter(|folder| folder.join(library).is_file()) {
            Some(folder) => format!(
                "{library} lies beside it, where the system does not look: start with {}={}",
                search_path(),
                folder.display()
            ),
            None => format!(
                "it needs {library}: install that, or tell the system its folder, {}=FOLDER",
                search_path()
            ),
        };
    }
    if words.contains("version `") && words.contains("not found") {
        return "it was built on a newer system than this one: build it here".to_owned();
    }
    if words.contains("failed to map segment") || words.contains("Operation not permitted") {
        return "its folder may not hold programs (noexec): copy it to another folder".to_owned();
    }
    "is it a library for this machine?".to_owned()
}

/// The function that a library lacks, in the words of glibc, musl and macOS.
fn missing_function(words: &str) -> Option<&str> {
    let after = |mark: &str| words.split_once(mark).map(|(_, rest)| rest);
    let named = after("undefined symbol: ")
        .or_else(|| after("Symbol not found: _"))
        .or_else(|| after("symbol not found in flat namespace '_"))
        .or_else(|| words.strip_suffix(": symbol not found")?.rsplit(": ").next())?;
    let is_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '$' | '@');
    let end = named.find(|c| !is_name(c)).unwrap_or(named.len());
    Some(&named[..end]).filter(|name| !name.is_empty())
}

/// The library that the system does not find, in the words of glibc, musl and macOS.
fn missing_library(words: &str) -> Option<&str> {
    let named = words.split_once(NO_LIBRARY).map(|(name, _)| name).or_else(|| {
        let rest = words.strip_prefix("Error loading shared library ")?;
        rest.split_once(": No such file").map(|(name, _)| name)
    });
    let named = named.or_else(|| {
        let rest = words.split_once("Library not loaded: ").map(|(_, rest)| rest)?;
        rest.split_whitespace().next()
    })?;
    Some(named.rsplit(": ").next().unwrap_or(named)).filter(|name| !name.is_empty())
}

/// The variable that names folders of libraries.
fn search_path() -> &'static str {
    match std::env::consts::OS {
        "windows" => "PATH",
        "macos" => "DYLD_LIBRARY_PATH",
        _ => "LD_LIBRARY_PATH",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "/opt/libinvert.so";

    fn told(words: &str) -> (String, String) {
        let words = bare(words, Path::new("/tmp/toile-plugin-1.so"), Path::new(FILE));
        let hint = remedy(&words, Path::new(FILE));
        (words, hint)
    }

    #[test]
    fn a_missing_function_is_named_in_the_words_of_each_loader() {
        let hint = "it calls `helper`, which none of the libraries has that it is linked to: link that one as well (`cc ... -lNAME`), and build it again";
        for (words, kept) in [
            ("/tmp/toile-plugin-1.so: undefined symbol: helper", "undefined symbol: helper"),
            (
                "/usr/lib/libother.so: undefined symbol: helper, version V_2",
                "/usr/lib/libother.so: undefined symbol: helper, version V_2",
            ),
            (
                "Error relocating /tmp/toile-plugin-1.so: helper: symbol not found",
                "Error relocating /opt/libinvert.so: helper: symbol not found",
            ),
            (
                "dlopen(/tmp/toile-plugin-1.so, 0x0002): symbol not found in flat namespace '_helper'",
                "dlopen(/opt/libinvert.so, 0x0002): symbol not found in flat namespace '_helper'",
            ),
        ] {
            assert_eq!(told(words), (kept.to_owned(), hint.to_owned()));
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_missing_library_is_named() {
        let words = "libhelper.so: cannot open shared object file: No such file or directory";
        let hint =
            "it needs libhelper.so: install that, or tell the system its folder, LD_LIBRARY_PATH=FOLDER";
        assert_eq!(told(words), (words.to_owned(), hint.to_owned()));
        let musl = "Error loading shared library libhelper.so: No such file or directory (needed by /tmp/toile-plugin-1.so)";
        assert_eq!(told(musl).1, hint);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_library_beside_the_plugin_is_told_with_its_folder() -> std::io::Result<()> {
        let dir = tempfile::tempdir()?;
        std::fs::write(dir.path().join("libhelper.so"), b"")?;
        let words = "libhelper.so: cannot open shared object file: No such file or directory";
        let hint = remedy(words, &dir.path().join("libinvert.so"));
        let folder = dir.path().display();
        assert_eq!(
            hint,
            format!(
                "libhelper.so lies beside it, where the system does not look: start with LD_LIBRARY_PATH={folder}"
            )
        );
        Ok(())
    }

    #[test]
    fn other_words_have_their_remedy() {
        let newer = "/lib/libc.so.6: version `GLIBC_2.99' not found (required by /tmp/toile-plugin-1.so)";
        assert_eq!(told(newer).1, "it was built on a newer system than this one: build it here");
        let no_exec = "/tmp/toile-plugin-1.so: failed to map segment from shared object";
        assert_eq!(
            told(no_exec),
            (
                "failed to map segment from shared object".to_owned(),
                "its folder may not hold programs (noexec): copy it to another folder".to_owned()
            )
        );
        assert_eq!(told("something else").1, "is it a library for this machine?");
    }
}
