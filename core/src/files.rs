//! Reading files that somebody names: ordinary files alone.
//!
//! A pipe gives nothing until somebody writes into it, a device may give bytes for ever, and both
//! may stand where a file is expected, as links too. So the kind is looked at before a file is
//! opened, and no more is read than a file may hold.

use std::fs::{File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The largest file that a stage may read, bytes.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// What is said of a file that is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoFile {
    /// It is a folder.
    Folder,
    /// It is a pipe, a socket or a device.
    Special,
}

impl std::fmt::Display for NoFile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            NoFile::Folder => "it is not a file",
            NoFile::Special => "it is a pipe or a device, not a file",
        })
    }
}

impl std::error::Error for NoFile {}

/// The content of an ordinary file of at most [`MAX_FILE_BYTES`].
///
/// # Errors
/// The system's, or in words of this program that it is no file or too large.
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let size = ordinary(path)?.len();
    if size > MAX_FILE_BYTES {
        return Err(too_large(size));
    }
    let mut bytes = Vec::with_capacity(size as usize);
    // A file may grow while it is read, and some that hold much say that they are empty.
    File::open(path)?.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

/// The content of an ordinary file as text.
///
/// # Errors
/// As [`read_file`]; also where it is no text.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_file(path)?)
        .map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8 text"))
}

/// What the system says of an ordinary file.
///
/// # Errors
/// The system's, and [`NoFile`].
pub fn ordinary(path: &Path) -> io::Result<Metadata> {
    let meta = std::fs::metadata(path)?;
    match (meta.is_file(), meta.is_dir()) {
        (true, _) => Ok(meta),
        (false, true) => Err(io::Error::new(ErrorKind::InvalidInput, NoFile::Folder)),
        (false, false) => Err(io::Error::new(ErrorKind::InvalidInput, NoFile::Special)),
    }
}

fn too_large(bytes: u64) -> io::Error {
    io::Error::new(ErrorKind::InvalidInput, format!("it has {bytes} bytes, the limit is {MAX_FILE_BYTES}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_folder_is_no_file() {
        let dir = tempfile::tempdir().unwrap();
        assert_eq!(read_file(dir.path()).unwrap_err().to_string(), "it is not a file");
        std::fs::write(dir.path().join("a"), [0xFF]).unwrap();
        assert_eq!(read_file(&dir.path().join("a")).unwrap(), [0xFF]);
        assert_eq!(read_text(&dir.path().join("a")).unwrap_err().to_string(), "it is not UTF-8 text");
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_links_to_them_are_not_read() {
        let dir = tempfile::tempdir().unwrap();
        let link = dir.path().join("zero");
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        for path in [Path::new("/dev/zero"), &link] {
            assert_eq!(read_file(path).unwrap_err().to_string(), "it is a pipe or a device, not a file");
        }
    }
}
