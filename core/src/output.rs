//! Writing finished files: all or none, each one whole.

use crate::artifact::OutputFile;
use crate::{ErrorCode, StageError};
use std::fs;
use std::io::Write;
use std::path::{Component, Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes files below `dir`: every one first beside its place, then all are renamed, so that a
/// stop or a full disk leaves no half file and, short of a failing rename, no half set.
///
/// Errors: a path that leaves `dir`, or the system's refusal, with the path named.
pub fn write_files(dir: &Path, files: &[OutputFile]) -> Result<Vec<PathBuf>, StageError> {
    let staged = files.iter().map(|f| stage_file(dir, f)).collect::<Result<Vec<_>, _>>()?;
    staged
        .into_iter()
        .map(|(temp, path)| {
            temp.persist(&path).map_err(|e| refused(&path, &e.error))?;
            Ok(path)
        })
        .collect()
}

fn stage_file(dir: &Path, file: &OutputFile) -> Result<(NamedTempFile, PathBuf), StageError> {
    let relative = Path::new(&file.path);
    if !relative.components().all(|c| matches!(c, Component::Normal(_))) || file.path.is_empty() {
        return Err(StageError::internal(format!("\"{}\" is no path below the output folder", file.path)));
    }
    let path = dir.join(relative);
    let folder = path.parent().unwrap_or(dir);
    fs::create_dir_all(folder).map_err(|e| refused(folder, &e))?;
    let mut temp = NamedTempFile::new_in(folder).map_err(|e| refused(folder, &e))?;
    temp.write_all(&file.bytes).map_err(|e| refused(&path, &e))?;
    readable_by_all(temp.as_file()).map_err(|e| refused(&path, &e))?;
    Ok((temp, path))
}

/// Temporary files are private to the user; finished ones are not.
#[cfg(unix)]
fn readable_by_all(file: &fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_file: &fs::File) -> std::io::Result<()> {
    Ok(())
}

fn refused(path: &Path, e: &std::io::Error) -> StageError {
    StageError::new(ErrorCode::PatternLoading, format!("cannot write \"{}\": {e}", path.display()))
        .hint("choose another folder with --out")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn file(path: &str) -> OutputFile {
        OutputFile { path: path.into(), bytes: b"content".to_vec() }
    }

    #[test]
    fn files_arrive_whole_and_no_other_is_left() {
        let dir = tempfile::tempdir().unwrap();
        write_files(dir.path(), &[file("a.txt"), file("deep/er/b.txt")]).unwrap();
        assert_eq!(fs::read(dir.path().join("deep/er/b.txt")).unwrap(), b"content");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
    }

    #[test]
    fn one_bad_path_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let e = write_files(dir.path(), &[file("a.txt"), file("../b.txt")]).unwrap_err();
        assert_eq!(e.message, "\"../b.txt\" is no path below the output folder");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
