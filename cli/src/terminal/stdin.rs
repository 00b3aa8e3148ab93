//! A pipeline from standard input, for which `-` stands: its paths are relative to the current
//! folder.

use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::sync::OnceLock;
use toile_core::{MAX_FILE_BYTES, NoFile, read_text};

/// What messages call it.
const NAME: &str = "standard input";

/// Whether a pipeline is to come from standard input.
pub(crate) fn is_stdin(pipeline: &Path) -> bool {
    pipeline == Path::new("-")
}

/// What a pipeline is called.
pub(crate) fn name(pipeline: &Path) -> String {
    if is_stdin(pipeline) { NAME.to_owned() } else { pipeline.display().to_string() }
}

/// The name of a pipeline's results: its file's without the ending.
pub(crate) fn stem(pipeline: &Path) -> String {
    match is_stdin(pipeline) {
        true => "stdin".to_owned(),
        false => pipeline.file_stem().map_or_else(|| "run".into(), |s| s.to_string_lossy().into_owned()),
    }
}

/// The folder that a pipeline's paths are relative to.
pub(crate) fn folder(pipeline: &Path) -> &Path {
    pipeline.parent().unwrap_or(Path::new("."))
}

/// The text of a pipeline.
///
/// Errors: a sentence.
pub(crate) fn text(pipeline: &Path) -> Result<String, String> {
    if is_stdin(pipeline) {
        return from_stdin();
    }
    read_text(pipeline).map_err(|e| {
        let special = e.get_ref().is_some_and(|inner| matches!(inner.downcast_ref(), Some(NoFile::Special)));
        if special { format!("{e}; `-` reads a pipeline from standard input") } else { e.to_string() }
    })
}

/// Standard input can be read once only, and a command may look at a pipeline twice.
fn from_stdin() -> Result<String, String> {
    static TEXT: OnceLock<Result<String, String>> = OnceLock::new();
    TEXT.get_or_init(|| read(&mut io::stdin().lock()).map_err(|e| e.to_string())).clone()
}

fn read(from: &mut dyn Read) -> io::Result<String> {
    let mut bytes = Vec::new();
    from.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(io::Error::new(
            ErrorKind::InvalidData,
            format!("it has more than {MAX_FILE_BYTES} bytes"),
        ));
    }
    String::from_utf8(bytes).map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8 text"))
}

/// Refuses standard input where a file is needed: `why` continues the sentence.
pub(crate) fn refused(pipeline: &Path, why: &str) -> Result<(), String> {
    match is_stdin(pipeline) {
        true => Err(format!("a pipeline from standard input {why}; name a file")),
        false => Ok(()),
    }
}
