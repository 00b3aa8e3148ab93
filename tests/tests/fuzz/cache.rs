//! Entries of the cache: a run that meets a spoilt one makes it anew, and gives what it gave.

use crate::dice::Dice;
use crate::{fuzz, spoil};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_core::artifact::Digest;
use toile_core::{Cancel, Listener};
use toile_pipeline::cache::Cache;
use toile_pipeline::{Pipeline, RunOptions, load, run};
use toile_tests::napkin;

/// A file with its content.
type Kept = (PathBuf, Vec<u8>);

/// Every file below a folder, in the order of their names.
fn files(folder: &Path) -> Vec<Kept> {
    let mut all = Vec::new();
    let entries = std::fs::read_dir(folder).into_iter().flatten().map(|e| e.unwrap().path());
    for path in entries {
        match path.is_dir() {
            true => all.extend(files(&path)),
            false => all.push((path.clone(), std::fs::read(&path).unwrap())),
        }
    }
    all.sort();
    all
}

fn result(pipeline: &Pipeline, folder: &Path) -> Result<Vec<(String, Option<Digest>)>, String> {
    let listener: Arc<dyn Listener> = Arc::new(());
    let options = RunOptions { cache: Some(Arc::new(Cache::new(folder))), ..RunOptions::default() };
    let run = run(pipeline, &options, &Cancel::new(), &listener).map_err(|e| e.to_string())?;
    Ok(run.results)
}

/// A manifest is trusted if its first line is the digest of the rest. After the body is spoilt, the
/// first line is made right, so that the body is read.
fn sealed(body: &[u8]) -> Vec<u8> {
    [Digest::of(body).hex().as_bytes(), b"\n", body].concat()
}

/// A spoilt store: each file as its place among the files, then its bytes.
fn spoilt(kept: &[Kept], dice: &mut Dice) -> Vec<u8> {
    let at = dice.below(kept.len());
    let (path, bytes) = &kept[at];
    let own = std::slice::from_ref(bytes);
    let deep = dice.below(2) == 0;
    let content = match bytes.iter().position(|b| *b == b'\n').filter(|_| deep && !is_blob(path)) {
        Some(line) => sealed(&spoil::text(&[bytes[line + 1..].to_vec()], dice)),
        None => spoil::binary(own, dice),
    };
    // A blob is trusted if its name is its digest: where it is to be read, it gets a new one, here
    // named by a one.
    let renamed = u8::from(deep && is_blob(path));
    [&(at as u32).to_le_bytes()[..], &[renamed], &content].concat()
}

fn is_blob(path: &Path) -> bool {
    path.components().any(|c| c.as_os_str() == "blobs")
}

/// Writes the store with the spoilt file in its place.
fn lay(kept: &[Kept], case: &[u8]) {
    let (head, content) = case.split_at(5);
    let at = u32::from_le_bytes([head[0], head[1], head[2], head[3]]) as usize;
    for (path, bytes) in kept {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    let path = &kept[at].0;
    if head[4] == 0 {
        return std::fs::write(path, content).unwrap();
    }
    let old = path.file_name().unwrap().to_string_lossy().into_owned();
    let new = Digest::of(content).hex();
    let folder = path.parent().unwrap().with_file_name(&new[..2]);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(&new), content).unwrap();
    for (path, bytes) in kept.iter().filter(|(path, _)| !is_blob(path)) {
        let text = String::from_utf8_lossy(bytes);
        if let Some((_, body)) = text.split_once('\n').filter(|(_, body)| body.contains(&old)) {
            std::fs::write(path, sealed(body.replace(&old, &new).as_bytes())).unwrap();
        }
    }
}

#[test]
fn cache_entries() {
    let dir = tempfile::tempdir().unwrap();
    napkin::write(dir.path()).unwrap();
    let text = "(name: \"fuzz\", scene: Scene(file: \"napkin.json\"), stages: [GarmentObj()])";
    let pipeline = load(text, "fuzz.ron", dir.path(), &toile::registry(), &[]).unwrap();
    let folder = dir.path().join("cache");
    let first = result(&pipeline, &folder).unwrap();
    let kept = files(&folder);
    assert!(kept.iter().filter(|(path, _)| is_blob(path)).count() >= 3, "{kept:?}");
    fuzz(
        "cache",
        150,
        |dice| spoilt(&kept, dice),
        |case| {
            std::fs::remove_dir_all(&folder).unwrap();
            lay(&kept, case);
            let renamed = case[4] == 1;
            let now = result(&pipeline, &folder)?;
            // Content with its own digest is trusted: only content without it is known to be
            // spoilt.
            match renamed || now == first || is_sealed(&kept, case) {
                true => Ok(()),
                false => Err("a spoilt entry changed the result".to_owned()),
            }
        },
    );
}

/// True where the spoilt file is a manifest with the digest of its content.
fn is_sealed(kept: &[Kept], case: &[u8]) -> bool {
    let at = u32::from_le_bytes([case[0], case[1], case[2], case[3]]) as usize;
    let content = &case[5..];
    let line = content.iter().position(|b| *b == b'\n');
    !is_blob(&kept[at].0) && line.is_some_and(|line| content == sealed(&content[line + 1..]))
}
