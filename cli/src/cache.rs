//! `toile cache`, and the cache that runs use.

use crate::args::{CacheArgs, CacheChoice};
use crate::{Streams, exit};
use serde_json::json;
use std::env::var_os;
use std::path::PathBuf;
use std::sync::Arc;
use toile_pipeline::cache::{Bytes, Cache, DEFAULT_LIMIT, default_folder};

/// The cache that a command uses; none where it is switched off or has no place.
pub(crate) fn chosen(choice: &CacheChoice, streams: &mut Streams<'_>) -> Option<Arc<Cache>> {
    let (cache, told) = found(choice);
    told.into_iter().for_each(|words| streams.warn(words));
    cache
}

/// The cache that a command uses, and warnings about it.
pub(crate) fn found(choice: &CacheChoice) -> (Option<Arc<Cache>>, Vec<String>) {
    let mut told = Vec::new();
    if choice.no_cache {
        return (None, told);
    }
    let cache = at(choice.cache_dir.clone());
    if cache.is_none() {
        told.push(
            "there is no place for a cache (neither TOILE_CACHE nor HOME is set); the run goes on without it"
                .into(),
        );
    }
    (cache.map(|cache| Arc::new(cache.with_limit(limit(&mut told)))), told)
}

/// The cache in a folder, or in that of the environment.
pub(crate) fn at(folder: Option<PathBuf>) -> Option<Cache> {
    let path = |name| var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
    let toile = folder.or_else(|| path("TOILE_CACHE"));
    default_folder(toile, path("XDG_CACHE_HOME"), path("HOME")).map(|folder| Cache::new(&folder))
}

fn limit(told: &mut Vec<String>) -> u64 {
    let Some(text) = var_os("TOILE_CACHE_LIMIT") else { return DEFAULT_LIMIT };
    match text.to_string_lossy().parse::<Bytes>() {
        Ok(bytes) => bytes.0,
        Err(e) => {
            told.push(format!("TOILE_CACHE_LIMIT: {e}"));
            DEFAULT_LIMIT
        }
    }
}

/// Shows the cache, makes room in it or empties it.
pub(crate) fn cache(args: &CacheArgs, streams: &mut Streams<'_>) -> u8 {
    let Some(cache) = at(args.cache_dir.clone()) else {
        streams.tell("error: there is no place for a cache; set TOILE_CACHE to a folder");
        return exit::INVALID;
    };
    let freed = match (args.clear, args.prune) {
        (true, _) => cache.clear().map(Some),
        (false, Some(limit)) => cache.prune(limit.0).map(Some),
        (false, None) => Ok(None),
    };
    match freed.and_then(|freed| Ok((freed, cache.usage()?))) {
        Err(e) => {
            streams.tell(format!("error: the cache \"{}\" cannot be used: {e}", cache.folder().display()));
            exit::INVALID
        }
        Ok((freed, usage)) if args.json => {
            streams.say(json!({
                "folder": cache.folder().display().to_string(), "runs": usage.runs,
                "artifacts": usage.artifacts, "bytes": usage.bytes, "freed_bytes": freed,
            }));
            exit::DONE
        }
        Ok((freed, usage)) => {
            if let Some(freed) = freed {
                streams.say(format!("freed {}", Bytes(freed)));
            }
            streams.say(format!(
                "{}: {} runs of stages, {} artifacts, {}",
                cache.folder().display(),
                usage.runs,
                usage.artifacts,
                Bytes(usage.bytes)
            ));
            exit::DONE
        }
    }
}
