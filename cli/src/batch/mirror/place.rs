//! Places in object stores, as a command line names them: `s3://bucket/folder/file`.

use std::path::Path;
use toile_core::StageError;

/// What stands before `://`: Amazon's S3 and those that speak as it does, Google's, Azure's twice.
const SCHEMES: [&str; 4] = ["s3", "gs", "az", "abfs"];

/// A file or a folder in an object store.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StorePlace {
    scheme: &'static str,
    bucket: String,
    /// Without `/` at its ends; empty for the whole bucket.
    key: String,
}

impl StorePlace {
    /// The place that an argument names; none where it is a path of this machine.
    ///
    /// Errors: the argument begins as a place and is none.
    pub(crate) fn named(argument: &Path) -> Result<Option<Self>, StageError> {
        let text = argument.to_string_lossy();
        let Some((before, rest)) = text.split_once("://") else { return Ok(None) };
        let Some(scheme) = SCHEMES.into_iter().find(|s| before.eq_ignore_ascii_case(s)) else {
            return Ok(None);
        };
        let (bucket, key) = rest.split_once('/').unwrap_or((rest, ""));
        let key = key.strip_suffix('/').unwrap_or(key);
        if bucket.is_empty() || !(key.is_empty() || is_key(key)) {
            return Err(StageError::invalid(format!("\"{text}\" is no place in an object store"))
                .hint(format!("write it like {scheme}://bucket/folder/set.jsonl")));
        }
        Ok(Some(StorePlace { scheme, bucket: bucket.to_owned(), key: key.to_owned() }))
    }

    #[cfg(feature = "object-store")]
    pub(crate) fn scheme(&self) -> &'static str {
        self.scheme
    }

    /// Its key, empty for the whole bucket.
    pub(crate) fn key(&self) -> &str {
        &self.key
    }

    /// The key of a file below it.
    pub(crate) fn below(&self, name: &str) -> String {
        if self.key.is_empty() { name.to_owned() } else { format!("{}/{name}", self.key) }
    }

    /// The whole bucket.
    pub(crate) fn of_bucket(&self) -> String {
        format!("{}://{}", self.scheme, self.bucket)
    }

    /// Another key of its bucket, as a command line names it.
    pub(crate) fn other(&self, key: &str) -> String {
        format!("{}/{key}", self.of_bucket())
    }
}

impl std::fmt::Display for StorePlace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.other(&self.key).trim_end_matches('/'))
    }
}

/// Whether a text can be the key of a file that also lies on a disk.
pub(crate) fn is_key(text: &str) -> bool {
    text.split('/').all(|part| !["", ".", ".."].contains(&part) && !part.contains(|c: char| c.is_control()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn named(text: &str) -> Result<Option<StorePlace>, StageError> {
        StorePlace::named(Path::new(text))
    }

    #[test]
    fn a_place_is_a_scheme_a_bucket_and_a_key() {
        for (text, bucket, key, shown) in [
            ("s3://set/in/a.jsonl", "set", "in/a.jsonl", "s3://set/in/a.jsonl"),
            ("S3://set/out/", "set", "out", "s3://set/out"),
            ("gs://set", "set", "", "gs://set"),
            ("az://set/", "set", "", "az://set"),
            (
                "abfs://set@x.dfs.core.windows.net/a",
                "set@x.dfs.core.windows.net",
                "a",
                "abfs://set@x.dfs.core.windows.net/a",
            ),
        ] {
            let place = named(text).unwrap().unwrap();
            assert_eq!((&*place.bucket, place.key(), place.to_string()), (bucket, key, shown.to_owned()));
        }
        let place = named("s3://set/out").unwrap().unwrap();
        assert_eq!(place.below("results.jsonl"), "out/results.jsonl");
        assert_eq!(named("s3://set").unwrap().unwrap().below("results.jsonl"), "results.jsonl");
        assert_eq!(place.other("in/a.json"), "s3://set/in/a.json");
    }

    #[test]
    fn other_paths_are_of_this_machine() {
        for path in ["set.jsonl", "/a/b", "s3:/a", "s3", "http://a/b", "C:\\a", "file:///a"] {
            assert_eq!(named(path), Ok(None), "{path}");
        }
    }

    #[test]
    fn what_is_no_place_is_refused_in_words() {
        for text in ["s3://", "s3:///a", "s3://set//a", "s3://set/a/../b", "gs://set/./a", "az://set/a\n"] {
            let e = named(text).unwrap_err();
            assert_eq!(e.message, format!("\"{text}\" is no place in an object store"));
            assert_eq!(e.hint, Some(format!("write it like {}://bucket/folder/set.jsonl", &text[..2])));
        }
    }
}
