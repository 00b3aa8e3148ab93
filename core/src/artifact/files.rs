//! Finished files.

use super::{Artifact, ArtifactType, Kind, Measures};
use std::path::{Component, Path};

/// One file to be written into the output folder.
#[derive(Debug, Clone)]
pub struct OutputFile {
    /// Path below the output folder, with `/` between its parts.
    pub path: String,
    /// Content.
    pub bytes: Vec<u8>,
}

impl OutputFile {
    /// A file with its content. What the content's buffer holds in reserve, up to as much again
    /// where it was grown by doubling, is given back: files are kept until the end of the run.
    pub fn new(path: impl Into<String>, mut bytes: Vec<u8>) -> Self {
        bytes.shrink_to_fit();
        OutputFile { path: path.into(), bytes }
    }
}

/// The files that a writer stage asks the runner to write. Only the runner touches the disk.
#[derive(Debug, Clone, Default)]
pub struct OutputFiles(pub Vec<OutputFile>);

impl OutputFiles {
    /// One file.
    pub fn one(path: &str, bytes: Vec<u8>) -> Self {
        OutputFiles(vec![OutputFile::new(path, bytes)])
    }
}

impl ArtifactType for OutputFiles {
    const KIND: Kind = Kind("files");
    const IN_SETS: bool = false;
}

impl Artifact for OutputFiles {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.count("files", self.0.len());
        m
    }

    fn check(&self) -> Result<(), String> {
        let inside = |path: &str| {
            let plain = |c: Component<'_>| matches!(c, Component::Normal(_));
            !path.is_empty() && Path::new(path).components().all(plain)
        };
        match self.0.iter().find(|f| !inside(&f.path)) {
            Some(file) => Err(format!("\"{}\" is not a path below the output folder", file.path)),
            None => Ok(()),
        }
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_holds_its_content_and_nothing_in_reserve() {
        let mut grown = Vec::with_capacity(4096);
        grown.extend(b"content");
        let file = OutputFile::new("a/b.txt", grown);
        assert_eq!((file.path.as_str(), file.bytes.as_slice()), ("a/b.txt", b"content".as_slice()));
        assert!(file.bytes.capacity() < 64, "{}", file.bytes.capacity());
    }
}
