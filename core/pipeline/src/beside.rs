//! Files on their way: written beside their place under a name of their own, then renamed.
//!
//! A program that is killed leaves such a file behind. Each is locked while its program works on
//! it, and the system takes the lock from a program that ends in whatever way; so a file that can
//! be locked is one that nobody will finish, and [`sweep`] takes it away. On a file system without
//! locks nothing is swept.

use std::fs::File;
use std::io;
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// What the names of such files begin with.
const PREFIX: &str = ".toile-";
/// What the names of such files end with.
const SUFFIX: &str = ".tmp";

/// A new file in a folder, locked.
pub(crate) fn new_in(folder: &Path) -> io::Result<NamedTempFile> {
    loop {
        let file = Builder::new().prefix(PREFIX).suffix(SUFFIX).tempfile_in(folder)?;
        let locked = file.as_file().lock().is_ok();
        // Between the two calls another program may have taken it for one that was left.
        if !locked || file.path().exists() {
            return Ok(file);
        }
    }
}

/// Whether a file of that name was on its way.
pub(crate) fn is_on_its_way(name: &str) -> bool {
    name.starts_with(PREFIX) && name.ends_with(SUFFIX)
}

/// Takes away what programs that were killed have left in a folder.
pub(crate) fn sweep(folder: &Path) {
    let Ok(listing) = std::fs::read_dir(folder) else { return };
    let left = listing.flatten().filter(|e| e.file_name().to_str().is_some_and(is_on_its_way));
    left.for_each(|entry| remove_if_left(&entry.path()));
}

/// Takes one away, unless a program still works on it.
pub(crate) fn remove_if_left(path: &Path) {
    // A link is not followed, nor is a pipe waited for.
    if !path.symlink_metadata().is_ok_and(|m| m.is_file()) {
        return;
    }
    if let Ok(file) = File::open(path)
        && file.try_lock().is_ok()
    {
        // Removed while it is locked, see `new_in`.
        let _ = std::fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_a_killed_program_left_is_swept_and_what_is_being_written_is_not() {
        let dir = tempfile::tempdir().unwrap();
        let at_work = new_in(dir.path()).unwrap();
        let left = dir.path().join(".toile-Ab12Cd.tmp");
        let others = [".tmpAb12Cd", "notes.tmp", "toile.txt"].map(|name| dir.path().join(name));
        others.iter().chain([&left]).for_each(|path| std::fs::write(path, "x").unwrap());
        sweep(dir.path());
        assert!(!left.exists() && at_work.path().exists());
        assert!(others.iter().all(|path| path.exists()));
    }
}
