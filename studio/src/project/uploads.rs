//! Files that a user gives: names, and where they lie.

use crate::fault::StudioFault;
use std::io::Write;
use std::path::Path;

/// The longest name, bytes.
const LONGEST: usize = 120;
/// The most numbers that are tried behind a name that is taken.
const MOST_NUMBERS: usize = 1000;

/// Whether a text is a plain file name.
///
/// Errors: it is none; the fault says what one is.
pub(super) fn check_name(name: &str) -> Result<(), StudioFault> {
    let fit = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    let is_name = !name.is_empty()
        && name.len() <= LONGEST
        && name.chars().all(fit)
        && !name.starts_with('.')
        && name.trim() == name
        && !name.ends_with('.');
    match is_name {
        true => Ok(()),
        false => Err(StudioFault::new("bad_name", format!("\"{name}\" is no plain file name"))
            .hint("letters, digits, `-`, `_`, `.` and spaces, no dot in front")),
    }
}

/// Keeps bytes under a name in a folder; a name that is taken by other bytes gets a number. Gives
/// the name.
///
/// Errors: the name is none, or the system's.
pub(super) fn keep(folder: &Path, name: &str, bytes: &[u8]) -> Result<String, StudioFault> {
    check_name(name)?;
    let (stem, ending) = match name.rfind('.') {
        Some(dot) => name.split_at(dot),
        None => (name, ""),
    };
    let refused = |e: &std::io::Error| StudioFault::file("write", &folder.join(name), e);
    let mut temp = tempfile::Builder::new()
        .prefix(".upload-")
        .suffix(".tmp")
        .tempfile_in(folder)
        .map_err(|e| refused(&e))?;
    temp.write_all(bytes).and_then(|()| temp.as_file().sync_data()).map_err(|e| refused(&e))?;
    permit(temp.as_file()).map_err(|e| refused(&e))?;
    for number in 1..=MOST_NUMBERS {
        let tried = if number == 1 { name.to_owned() } else { format!("{stem}-{number}{ending}") };
        let path = folder.join(&tried);
        // That name is the pipeline's own.
        if tried == super::PIPELINE {
            continue;
        }
        if std::fs::metadata(&path).is_ok_and(|m| m.is_file() && m.len() == bytes.len() as u64)
            && std::fs::read(&path).is_ok_and(|there| there == bytes)
        {
            return Ok(tried);
        }
        match temp.persist_noclobber(&path) {
            Ok(_) => return Ok(tried),
            Err(e) if e.error.kind() == std::io::ErrorKind::AlreadyExists => temp = e.file,
            Err(e) => return Err(refused(&e.error)),
        }
    }
    Err(StudioFault::new("bad_name", format!("the name \"{name}\" is taken {MOST_NUMBERS} times")))
}

/// Temporary files are private to the user; these are not.
#[cfg(unix)]
fn permit(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn permit(_file: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}
