//! A bucket of an object store, by the crate `object_store`: blocking calls, each of which works on
//! several files at a time.
//!
//! Requests that fail are tried again as the crate sees fit (ten times within three minutes), then
//! refused with their place.

use super::place::StorePlace;
use super::version::{FileVersion, StoreListing};
use futures_util::stream::{self, StreamExt, TryStreamExt};
use object_store::aws::AmazonS3Builder;
use object_store::azure::MicrosoftAzureBuilder;
use object_store::gcp::GoogleCloudStorageBuilder;
use object_store::path::Path as Key;
use object_store::{Error, ObjectMeta, ObjectStore, ObjectStoreExt, PutMode, PutOptions, UpdateVersion};
use std::path::PathBuf;
use std::sync::Arc;
use toile_core::StageError;
use tokio::runtime::{Builder, Runtime};

/// Requests at a time.
const AT_A_TIME: usize = 16;
/// Letters of what the crate says of an error.
const MOST_WORDS: usize = 400;
/// Where machines of a cloud ask for credentials when the environment has none.
const MACHINES: [&str; 2] = ["169.254.169.254", "metadata.google.internal"];

/// A bucket.
pub(super) struct Bucket {
    store: Arc<dyn ObjectStore>,
    runtime: Runtime,
    place: StorePlace,
}

/// What a request was for.
#[derive(Clone, Copy)]
enum Does {
    Read,
    Write,
}

impl Bucket {
    /// The bucket of a place, with what the environment says of credentials and servers.
    ///
    /// Errors: what the environment says is faulty.
    pub(super) fn open(place: &StorePlace) -> Result<Self, StageError> {
        let url = place.of_bucket();
        let store: Result<Arc<dyn ObjectStore>, Error> = match place.scheme() {
            "gs" => GoogleCloudStorageBuilder::from_env().with_url(url).build().map(|s| Arc::new(s) as _),
            "az" | "abfs" => {
                MicrosoftAzureBuilder::from_env().with_url(url).build().map(|s| Arc::new(s) as _)
            }
            _ => AmazonS3Builder::from_env().with_url(url).build().map(|s| Arc::new(s) as _),
        };
        let store = store.map_err(|e| refused(place, place.key(), Does::Read, &e))?;
        Self::of(store, place)
    }

    pub(super) fn of(store: Arc<dyn ObjectStore>, place: &StorePlace) -> Result<Self, StageError> {
        let runtime = Builder::new_current_thread().enable_all().build().map_err(|e| {
            StageError::invalid(format!("the system gives no means to wait for a store: {e}"))
        })?;
        Ok(Bucket { store, runtime, place: place.clone() })
    }

    /// The content of a file; none where there is no such file.
    pub(super) fn read(&self, key: &str) -> Result<Option<Vec<u8>>, StageError> {
        Ok(self.read_all(&[key.to_owned()])?.pop().flatten())
    }

    /// The content of files, in their order.
    pub(super) fn read_all(&self, keys: &[String]) -> Result<Vec<Option<Vec<u8>>>, StageError> {
        let all = stream::iter(keys).map(|key| async move {
            let refused = |e| refused(&self.place, key, Does::Read, &e);
            match self.store.get(&self.key(key)?).await {
                Err(Error::NotFound { source, .. }) if !is_no_bucket(&source.to_string()) => Ok(None),
                found => found.map_err(refused)?.bytes().await.map(|b| Some(b.to_vec())).map_err(refused),
            }
        });
        self.runtime.block_on(all.buffered(AT_A_TIME).try_collect())
    }

    /// All files below a folder, however deep.
    pub(super) fn below(&self, folder: &str) -> Result<StoreListing, StageError> {
        let prefix = self.key(folder)?;
        let all = self.store.list(Some(&prefix)).map_ok(|meta| listed(&meta)).try_collect();
        self.runtime.block_on(all).map_err(|e| refused(&self.place, folder, Does::Read, &e))
    }

    /// The files that lie in a folder itself.
    pub(super) fn in_folder(&self, folder: &str) -> Result<StoreListing, StageError> {
        let prefix = self.key(folder)?;
        let found = self.runtime.block_on(self.store.list_with_delimiter(Some(&prefix)));
        let found = found.map_err(|e| refused(&self.place, folder, Does::Read, &e))?;
        Ok(found.objects.iter().map(listed).collect())
    }

    /// The state of a file; none where there is no such file.
    pub(super) fn version(&self, key: &str) -> Result<Option<FileVersion>, StageError> {
        match self.runtime.block_on(self.store.head(&self.key(key)?)) {
            Err(Error::NotFound { .. }) => Ok(None),
            found => {
                found.map(|meta| Some(listed(&meta).1)).map_err(|e| refused(&self.place, key, Does::Read, &e))
            }
        }
    }

    /// Sends files of this machine: the key and the path of each.
    pub(super) fn send_all(&self, files: &[(String, PathBuf)]) -> Result<(), StageError> {
        let all = stream::iter(files).map(|(key, path)| async move {
            let bytes = std::fs::read(path)
                .map_err(|e| StageError::invalid(format!("cannot read \"{}\": {e}", path.display())))?;
            let sent = self.store.put(&self.key(key)?, bytes.into()).await;
            sent.map(drop).map_err(|e| refused(&self.place, key, Does::Write, &e))
        });
        self.runtime.block_on(all.buffer_unordered(AT_A_TIME).try_collect())
    }

    /// Sends a file where it is still in the state that it was in, none for one that was not there;
    /// whether it was. A store that cannot tell takes the file as it is.
    pub(super) fn send_if(
        &self,
        key: &str,
        bytes: Vec<u8>,
        was: Option<FileVersion>,
    ) -> Result<bool, StageError> {
        let mode = was.map_or(PutMode::Create, |was| {
            PutMode::Update(UpdateVersion { e_tag: was.e_tag, version: was.version })
        });
        let place = self.key(key)?;
        let put = |mode: PutMode| {
            let options = PutOptions { mode, ..PutOptions::default() };
            self.runtime.block_on(self.store.put_opts(&place, bytes.clone().into(), options))
        };
        let sent = match put(mode) {
            Err(Error::AlreadyExists { .. } | Error::Precondition { .. }) => return Ok(false),
            Err(Error::NotImplemented { .. } | Error::NotSupported { .. }) => put(PutMode::Overwrite),
            sent => sent,
        };
        sent.map(|_| true).map_err(|e| refused(&self.place, key, Does::Write, &e))
    }

    /// Removes files; one that is gone already is removed.
    pub(super) fn remove_all(&self, keys: &[String]) -> Result<(), StageError> {
        let all = stream::iter(keys).map(|key| async move {
            match self.store.delete(&self.key(key)?).await {
                Ok(()) | Err(Error::NotFound { .. }) => Ok(()),
                Err(e) => Err(refused(&self.place, key, Does::Write, &e)),
            }
        });
        self.runtime.block_on(all.buffer_unordered(AT_A_TIME).try_collect())
    }

    fn key(&self, key: &str) -> Result<Key, StageError> {
        Key::parse(key).map_err(|e| refused(&self.place, key, Does::Read, &e.into()))
    }
}

fn listed(meta: &ObjectMeta) -> (String, FileVersion) {
    let version = FileVersion { e_tag: meta.e_tag.clone(), version: meta.version.clone() };
    (meta.location.to_string(), version)
}

/// Whether a store says that it has no such bucket, and not no such file.
fn is_no_bucket(words: &str) -> bool {
    ["NoSuchBucket", "ContainerNotFound", "bucket does not exist", "FilesystemNotFound"]
        .iter()
        .any(|said| words.contains(said))
}

/// The error of a place, with what may be done about it.
fn refused(place: &StorePlace, key: &str, does: Does, e: &Error) -> StageError {
    let words = in_words(e);
    if is_no_bucket(&words) {
        let bucket = place.of_bucket();
        return StageError::invalid(format!("there is no bucket \"{bucket}\""))
            .hint("make it with the tools of the store, or name another");
    }
    let does = match does {
        Does::Read => "read",
        Does::Write => "write",
    };
    let full = place.other(key);
    let (name, is_denied) = (full.trim_end_matches('/'), is_denied(e, &words));
    let error = StageError::invalid(format!("cannot {does} \"{name}\": {words}"));
    match is_denied {
        true => error.hint(format!("give the store's credentials in the environment: {}", variables(place))),
        false => error.hint("what was done is kept: start the batch again when the store answers"),
    }
}

fn is_denied(e: &Error, words: &str) -> bool {
    matches!(e, Error::PermissionDenied { .. } | Error::Unauthenticated { .. })
        || MACHINES.iter().any(|machine| words.contains(machine))
}

/// What the environment has to name.
fn variables(place: &StorePlace) -> &'static str {
    match place.scheme() {
        "gs" => "GOOGLE_APPLICATION_CREDENTIALS",
        "az" | "abfs" => "AZURE_STORAGE_ACCOUNT_NAME and AZURE_STORAGE_ACCOUNT_KEY",
        _ => "AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY and AWS_REGION",
    }
}

/// What the crate says, on one line, with the innermost cause.
fn in_words(e: &Error) -> String {
    let mut words = e.to_string();
    let mut cause: &dyn std::error::Error = e;
    while let Some(inner) = cause.source() {
        cause = inner;
    }
    let last = cause.to_string();
    if !words.contains(&last) {
        words = format!("{words}: {last}");
    }
    let line = words.split_whitespace().collect::<Vec<_>>().join(" ");
    line.chars().take(MOST_WORDS).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::path::Path;

    fn place(text: &str) -> StorePlace {
        StorePlace::named(Path::new(text)).unwrap().unwrap()
    }

    #[test]
    fn errors_name_the_place_and_what_to_type() {
        let told = |text: &str, does: Does, e: Error| {
            let e = refused(&place(text), "out/a.obj", does, &e);
            (e.message, e.hint.unwrap())
        };
        let generic = |words: &str| Error::Generic { store: "S3", source: words.to_owned().into() };
        assert_eq!(
            told("s3://set/out", Does::Write, generic("connection\n refused")),
            (
                "cannot write \"s3://set/out/a.obj\": Generic S3 error: connection refused".into(),
                "what was done is kept: start the batch again when the store answers".into(),
            )
        );
        let denied = |source: &str| Error::PermissionDenied {
            path: "out/a.obj".into(),
            source: source.to_owned().into(),
        };
        let (words, help) = told("s3://set/out", Does::Read, denied("AccessDenied"));
        assert!(words.starts_with("cannot read \"s3://set/out/a.obj\": "), "{words}");
        assert_eq!(
            help,
            "give the store's credentials in the environment: AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY and AWS_REGION"
        );
        let (_, help) = told("gs://set", Does::Read, generic("error for http://metadata.google.internal/x"));
        assert_eq!(help, "give the store's credentials in the environment: GOOGLE_APPLICATION_CREDENTIALS");
        let (_, help) = told("az://set", Does::Read, denied("no"));
        assert!(help.ends_with("AZURE_STORAGE_ACCOUNT_NAME and AZURE_STORAGE_ACCOUNT_KEY"), "{help}");
        assert_eq!(
            told("s3://set/out", Does::Read, generic("<Code>NoSuchBucket</Code>")),
            (
                "there is no bucket \"s3://set\"".into(),
                "make it with the tools of the store, or name another".into()
            )
        );
    }
}
