//! One studio a folder.

use crate::fault::StudioFault;
use std::fs::{File, TryLockError};
use std::path::Path;

/// The folder of what is kept of a project.
pub(super) const KEPT: &str = ".toile-studio";

/// Holds a folder. The system takes the lock from a program that ends in whatever way.
#[derive(Debug)]
pub(super) struct FolderLock {
    _file: File,
}

impl FolderLock {
    /// Takes a folder.
    ///
    /// Errors: another studio holds it, or nothing can be written there.
    pub(super) fn take(folder: &Path) -> Result<Self, StudioFault> {
        let kept = folder.join(KEPT);
        std::fs::create_dir_all(&kept).map_err(|e| StudioFault::file("make the folder", &kept, &e))?;
        let path = kept.join("lock");
        let file = File::options().create(true).truncate(false).write(true).open(&path);
        let file = file.map_err(|e| StudioFault::file("write", &path, &e))?;
        match file.try_lock() {
            Ok(()) => Ok(FolderLock { _file: file }),
            Err(TryLockError::WouldBlock) => {
                let message = format!("the folder \"{}\" is open in another studio", folder.display());
                Err(StudioFault::new("locked", message).hint("close that one first, or open another folder"))
            }
            // A file system without locks: the user alone knows.
            Err(TryLockError::Error(_)) => Ok(FolderLock { _file: file }),
        }
    }
}
