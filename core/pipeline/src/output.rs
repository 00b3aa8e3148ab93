//! Writing finished files: all or none, each one whole.

use crate::beside;
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Component, Path, PathBuf};
use tempfile::NamedTempFile;
use toile_core::artifact::OutputFile;
use toile_core::{ErrorCode, StageError};

/// Writes files below `dir`: each under a temporary name beside its place, then all are renamed, so
/// that a stop or a full disk leaves no partial file and, unless a rename fails, no partial set.
/// Temporary files of a program that was killed are removed.
///
/// A file that was there keeps its permissions.
///
/// Errors: a path that leaves `dir` or stands twice, or the system's refusal, with the path named.
pub fn write_files(dir: &Path, files: &[OutputFile]) -> Result<Vec<PathBuf>, StageError> {
    let mut paths = BTreeSet::new();
    if let Some(twice) = files.iter().find(|f| !paths.insert(&f.path)) {
        return Err(StageError::invalid(format!("two files would be written as \"{}\"", twice.path)));
    }
    let folders: BTreeSet<PathBuf> =
        files.iter().filter_map(|f| Some(dir.join(&f.path).parent()?.to_owned())).collect();
    folders.iter().for_each(|folder| beside::sweep(folder));
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
    let mut temp = beside::new_in(folder).map_err(|e| refused(folder, &e))?;
    temp.write_all(&file.bytes).map_err(|e| refused(&path, &e))?;
    permit(temp.as_file(), &path).map_err(|e| refused(&path, &e))?;
    Ok((temp, path))
}

/// Temporary files are private to the user; finished ones are not: as the file was, or readable by
/// all.
#[cfg(unix)]
fn permit(file: &fs::File, path: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    let was = fs::metadata(path).map(|m| m.permissions());
    file.set_permissions(was.unwrap_or_else(|_| fs::Permissions::from_mode(0o644)))
}

#[cfg(not(unix))]
fn permit(_file: &fs::File, _path: &Path) -> std::io::Result<()> {
    Ok(())
}

/// That files can be written below `dir`, without making it: a run is refused before it has begun.
///
/// Errors: as [`write_files`].
pub fn check_folder(dir: &Path) -> Result<(), StageError> {
    let there = dir.ancestors().map(|a| if a.as_os_str().is_empty() { Path::new(".") } else { a });
    let there = there.into_iter().find(|a| a.exists()).unwrap_or(Path::new("."));
    tempfile::tempfile_in(there).map(drop).map_err(|e| refused(dir, &e))
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
    fn what_a_killed_program_left_is_swept() {
        let dir = tempfile::tempdir().unwrap();
        let left = [".toile-a1B2c3.tmp", "deep/.toile-a1B2c3.tmp"].map(|name| dir.path().join(name));
        fs::create_dir(dir.path().join("deep")).unwrap();
        left.iter().for_each(|path| fs::write(path, "half").unwrap());
        write_files(dir.path(), &[file("a.txt"), file("deep/b.txt")]).unwrap();
        assert!(left.iter().all(|path| !path.exists()));
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_path_that_stands_twice_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let e = write_files(dir.path(), &[file("a.txt"), file("b.txt"), file("a.txt")]).unwrap_err();
        assert_eq!(e.message, "two files would be written as \"a.txt\"");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn a_file_that_was_there_keeps_its_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        fs::write(&path, "before").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
        write_files(dir.path(), &[file("a.txt"), file("b.txt")]).unwrap();
        let mode = |name: &str| fs::metadata(dir.path().join(name)).unwrap().permissions().mode() & 0o777;
        assert_eq!((mode("a.txt"), mode("b.txt")), (0o600, 0o644));
    }

    #[test]
    fn a_folder_that_cannot_be_is_refused_before_anything_is_made() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("file"), "x").unwrap();
        check_folder(&dir.path().join("new/er")).unwrap();
        let e = check_folder(&dir.path().join("file/out")).unwrap_err();
        let name = dir.path().join("file/out").display().to_string();
        assert!(e.message.starts_with(&format!("cannot write \"{name}\": ")), "{}", e.message);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn one_bad_path_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let e = write_files(dir.path(), &[file("a.txt"), file("../b.txt")]).unwrap_err();
        assert_eq!(e.message, "\"../b.txt\" is no path below the output folder");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
