//! The output folder of a batch.
//!
//! ```text
//! garments/ID/    what the garment's run gave, certificate.json, thumb.jpg, record.json; failed/
//! work/           garments that are being run
//! locks/          a file for each share; whoever runs the share holds its lock
//! ```
//!
//! A garment is run in a folder of its own below `work`. Its record is written there last; then the
//! folder is renamed to its place. So what lies in `garments` is whole, whenever the batch is
//! killed.

use crate::args::Shard;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use toile_core::StageError;
use toile_core::artifact::{Digest, Digester};

/// How long a lock is waited for: of a batch that was killed, a process that it was about to start
/// may hold it for a moment.
const PATIENCE: Duration = Duration::from_secs(1);

/// The output folder, held by one share of a batch.
pub(crate) struct BatchFolder {
    root: PathBuf,
    work: PathBuf,
    /// The system gives it back when the program ends, in whatever way.
    _lock: File,
}

impl BatchFolder {
    /// Takes a share of a folder.
    ///
    /// Errors: another batch runs that share or divides the folder in another way; the folder
    /// cannot be written.
    pub(crate) fn open(root: &Path, shard: Shard) -> Result<Self, StageError> {
        let root = std::path::absolute(root).map_err(|e| unwritten(root, &e))?;
        let locks = root.join("locks");
        fs::create_dir_all(&locks).map_err(|e| unwritten(&locks, &e))?;
        let name = share_name(shard);
        let lock = held(&locks.join(&name))?.ok_or_else(|| taken(&root, &name))?;
        // The own lock is held before others are looked at, so that of two one sees the other.
        for entry in fs::read_dir(&locks).map_err(|e| unwritten(&locks, &e))?.flatten() {
            let other = entry.file_name().to_string_lossy().into_owned();
            let divides = other.split_once("-of-").is_some_and(|(_, count)| count != shard.count.to_string());
            if divides && held(&entry.path())?.is_none() {
                return Err(taken(&root, &other));
            }
        }
        let all_work = root.join("work");
        for entry in fs::read_dir(&all_work).into_iter().flatten().flatten() {
            let left = entry.file_name().to_string_lossy().into_owned();
            let of_count = left.contains(&format!("-of-{}-", shard.count));
            if !of_count || left.starts_with(&format!("{name}-")) {
                // What cannot be removed is in nobody's way.
                let _ = fs::remove_dir_all(entry.path());
            }
        }
        let work = all_work.join(format!("{name}-{}", std::process::id()));
        fs::create_dir_all(&work).map_err(|e| unwritten(&work, &e))?;
        Ok(BatchFolder { root, work, _lock: lock })
    }

    /// Its full path.
    pub(crate) fn root(&self) -> &Path {
        &self.root
    }

    /// Where a garment lies, or will lie.
    pub(crate) fn garment(&self, id: &str) -> PathBuf {
        garment(&self.root, id)
    }

    /// An empty folder in which a garment is run.
    ///
    /// Errors: it cannot be made.
    pub(crate) fn work(&self, id: &str) -> Result<PathBuf, StageError> {
        let folder = self.garment_at_work(id);
        emptied(&folder)?;
        Ok(folder)
    }

    /// The folder in which a garment is run.
    pub(crate) fn garment_at_work(&self, id: &str) -> PathBuf {
        self.work.join(id)
    }

    /// Puts a garment that was run into its place.
    ///
    /// Errors: it cannot be renamed.
    pub(crate) fn publish(&self, id: &str) -> Result<(), StageError> {
        let (from, to) = (self.garment_at_work(id), self.garment(id));
        let old = self.work.join(format!(".old-{id}"));
        fs::create_dir_all(self.root.join("garments")).map_err(|e| unwritten(&to, &e))?;
        if to.symlink_metadata().is_ok() {
            fs::rename(&to, &old).map_err(|e| unwritten(&to, &e))?;
        }
        fs::rename(&from, &to).map_err(|e| unwritten(&to, &e))?;
        let _ = fs::remove_dir_all(old);
        Ok(())
    }
}

impl Drop for BatchFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.work);
    }
}

/// Holds what all shares of a folder write, until it is dropped; none on a file system without
/// locks.
pub(crate) fn shared(root: &Path) -> Option<File> {
    let file = File::options().create(true).append(true).open(root.join("locks/results")).ok()?;
    file.lock().ok()?;
    Some(file)
}

/// Where a garment of a folder lies.
pub(crate) fn garment(root: &Path, id: &str) -> PathBuf {
    root.join("garments").join(id)
}

fn share_name(shard: Shard) -> String {
    format!("{}-of-{}", shard.number, shard.count)
}

/// A file with its lock; none where another program holds it and goes on doing so.
fn held(path: &Path) -> Result<Option<File>, StageError> {
    let file = File::options().create(true).append(true).open(path).map_err(|e| unwritten(path, &e))?;
    let until = Instant::now() + PATIENCE;
    loop {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) if Instant::now() < until => std::thread::sleep(PATIENCE / 20),
            Err(TryLockError::WouldBlock) => return Ok(None),
            // A file system without locks protects nobody.
            Ok(()) | Err(TryLockError::Error(_)) => return Ok(Some(file)),
        }
    }
}

fn taken(root: &Path, share: &str) -> StageError {
    let share = share.replace("-of-", "/");
    StageError::invalid(format!("another batch writes \"{}\" now, as share {share}", root.display())).hint(
        "wait for its end, or choose another folder with --out; shares of one count, like 1/2 and 2/2, may write together",
    )
}

/// Makes a folder, or empties the one that is there.
///
/// Errors: the system's refusal.
pub(crate) fn emptied(folder: &Path) -> Result<(), StageError> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(|e| unwritten(folder, &e))?;
    }
    fs::create_dir_all(folder).map_err(|e| unwritten(folder, &e))
}

/// The error of a place that cannot be written.
fn unwritten(path: &Path, e: &std::io::Error) -> StageError {
    StageError::invalid(format!("cannot write \"{}\": {e}", path.display()))
        .hint("choose another folder with --out")
}

/// What lies in a garment's folder.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct FolderContents {
    pub(crate) files: usize,
    pub(crate) bytes: u64,
    /// Of the names of all files, and of the content of those that hold no times.
    pub(crate) result: Digest,
}

/// Looks through a garment's folder.
///
/// Errors: a file that cannot be read.
pub(crate) fn contents(folder: &Path) -> std::io::Result<FolderContents> {
    let mut names = Vec::new();
    below(folder, "", &mut names)?;
    names.sort();
    let (mut d, mut bytes) = (Digester::new(), 0);
    for name in &names {
        let path = folder.join(name);
        bytes += fs::metadata(&path)?.len();
        d.text(name);
        if !holds_times(name) {
            d.bytes(&Digest::of(&toile_core::read_file(&path)?).0);
        }
    }
    Ok(FolderContents { files: names.len(), bytes, result: d.finish() })
}

/// Whether a file tells how long a run took: its metrics, and pages on the run.
fn holds_times(name: &str) -> bool {
    name.ends_with("metrics.json") || name.ends_with(".html")
}

/// The names of all files below a folder.
///
/// Errors: a folder that cannot be read.
pub(crate) fn below(folder: &Path, before: &str, names: &mut Vec<String>) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{before}{}", entry.file_name().to_string_lossy());
        match entry.file_type()?.is_dir() {
            true => below(&entry.path(), &format!("{name}/"), names)?,
            false => names.push(name),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn shard(text: &str) -> Shard {
        text.parse().unwrap()
    }

    fn refusal(root: &Path, share: &str) -> String {
        BatchFolder::open(root, shard(share)).err().unwrap().message
    }

    #[test]
    fn one_batch_writes_a_share_and_shares_of_one_count_write_together() {
        let dir = tempfile::tempdir().unwrap();
        let first = BatchFolder::open(dir.path(), shard("1/2")).unwrap();
        let words =
            |share| format!("another batch writes \"{}\" now, as share {share}", dir.path().display());
        assert_eq!(refusal(dir.path(), "1/2"), words("1/2"));
        assert_eq!(refusal(dir.path(), "1/1"), words("1/2"));
        assert_eq!(refusal(dir.path(), "2/3"), words("1/2"));
        let second = BatchFolder::open(dir.path(), shard("2/2")).unwrap();
        drop((first, second));
        BatchFolder::open(dir.path(), shard("1/1")).unwrap();
    }

    #[test]
    fn a_garment_takes_the_place_of_an_earlier_one_as_a_whole() {
        let dir = tempfile::tempdir().unwrap();
        let folder = BatchFolder::open(dir.path(), shard("1/1")).unwrap();
        for content in ["one", "two"] {
            fs::write(folder.work("a").unwrap().join(format!("{content}.txt")), content).unwrap();
            folder.publish("a").unwrap();
        }
        let names: Vec<_> =
            fs::read_dir(folder.garment("a")).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(names, ["two.txt"]);
        drop(folder);
        assert_eq!(fs::read_dir(dir.path().join("work")).unwrap().count(), 0);
    }

    #[test]
    fn what_a_killed_batch_left_is_swept() {
        let dir = tempfile::tempdir().unwrap();
        let left = ["1-of-2-7", "1-of-1-7", "2-of-2-7"].map(|name| dir.path().join("work").join(name));
        left.iter().for_each(|path| fs::create_dir_all(path.join("a")).unwrap());
        let _folder = BatchFolder::open(dir.path(), shard("1/2")).unwrap();
        assert_eq!(left.each_ref().map(|path| path.exists()), [false, false, true]);
    }

    #[test]
    fn contents_are_the_same_whatever_a_run_took() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("failed")).unwrap();
        fs::write(dir.path().join("failed/a.txt"), "a").unwrap();
        fs::write(dir.path().join("metrics.json"), "1 s").unwrap();
        let first = contents(dir.path()).unwrap();
        assert_eq!((first.files, first.bytes), (2, 4));
        fs::write(dir.path().join("metrics.json"), "12 s").unwrap();
        assert_eq!(contents(dir.path()).unwrap().result, first.result);
        fs::write(dir.path().join("failed/a.txt"), "b").unwrap();
        assert_ne!(contents(dir.path()).unwrap().result, first.result);
    }
}
