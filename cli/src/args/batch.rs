//! Arguments of `toile batch` and `toile manifest`.

use super::amounts::{duration, length};
use super::shared::{CacheChoice, Overrides};
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;
use toile_core::Length;
use toile_pipeline::cache::Bytes;

#[derive(Debug, Clone, Args)]
pub(crate) struct BatchArgs {
    /// The manifest: a garment a line, as `toile manifest` writes it; paths in it are relative to
    /// its folder. It may lie in an object store, like s3://bucket/set.jsonl
    pub(crate) manifest: PathBuf,
    /// The pipeline that every garment is run through
    #[arg(long, value_name = "FILE")]
    pub(crate) pipeline: PathBuf,
    /// Folder for the results; a batch that was stopped goes on in it. It may lie in an object
    /// store, like s3://bucket/out [default: out/NAME]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// Folder of this machine for a batch whose results are sent to an object store [default:
    /// out/NAME]
    #[arg(long, value_name = "DIR")]
    pub(crate) work: Option<PathBuf>,
    /// Run one of so many shares of the manifest, like 3/16; all shares may write one folder
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    pub(crate) shard: Shard,
    /// Take the coarsest quality of the pipeline that keeps this error, like "3 mm"; with
    /// --deadline the finest that is done in time
    #[arg(long, value_name = "LENGTH", value_parser = length, conflicts_with = "quality")]
    pub(crate) max_error: Option<Length>,
    /// Take the finest quality of the pipeline at which all garments are done after this time, by
    /// the times of some of them, and stop then, like 8h (ms, s, m, h)
    #[arg(long, value_name = "TIME", value_parser = duration, conflicts_with_all = ["quality", "check", "only", "retry_only"])]
    pub(crate) deadline: Option<Duration>,
    /// Longest time of a garment, like 120s (ms, s, m, h) [default: none]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub(crate) max_time: Option<Duration>,
    /// Most memory of a garment, like "4 GB" (Linux) [default: that of --memory]
    #[arg(long, value_name = "SIZE")]
    pub(crate) max_memory: Option<Bytes>,
    /// Memory of all garments that run at a time (Linux) [default: nine tenths of what is free]
    #[arg(long, value_name = "SIZE")]
    pub(crate) memory: Option<Bytes>,
    /// Most garments that run at a time [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Keep only these files of a garment, like garment.glb or '*.png'; may be given again
    #[arg(long, value_name = "NAME")]
    pub(crate) keep: Vec<String>,
    /// Stop after this stage and write what it made
    #[arg(long, value_name = "STAGE")]
    pub(crate) until: Option<String>,
    /// Leave out the certificate of `toile verify`
    #[arg(long)]
    pub(crate) no_verify: bool,
    /// Run only this garment, whether it is done or not; may be given again
    #[arg(long, value_name = "ID")]
    pub(crate) only: Vec<String>,
    /// Run only garments that ended with this fault, like timeout, once more; may be given again
    #[arg(long, value_name = "FAULT")]
    pub(crate) retry_only: Vec<String>,
    /// Run the sound lines of a manifest that has faults
    #[arg(long)]
    pub(crate) skip_faulty: bool,
    /// Check the manifest, say what is done already, and run nothing
    #[arg(long)]
    pub(crate) check: bool,
    /// Run nothing, and write the results of all shares, as the last one does at its end
    #[arg(long, conflicts_with_all = ["check", "deadline", "only", "retry_only", "shard"])]
    pub(crate) merge: bool,
    /// Print one JSON object and nothing else: how many garments ended how
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) cache: CacheChoice,
}

#[derive(Debug, Args)]
pub(crate) struct ManifestArgs {
    /// One CSV table with a column `id` and a column for each PATH that is set; or files, a garment
    /// each, also as patterns in quotes, like 'photos/*.jpg'
    #[arg(required = true)]
    pub(crate) sources: Vec<String>,
    /// The value that each file is, like pattern.file or photos.front.file
    #[arg(long, value_name = "PATH")]
    pub(crate) field: Option<String>,
    /// The manifest's file [default: standard output]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

/// One of so many shares, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    pub(crate) number: u32,
    pub(crate) count: u32,
}

impl Shard {
    /// Whether the garment at that place of the manifest, from 0, is of this share.
    pub(crate) fn has(self, place: usize) -> bool {
        place % self.count as usize == self.number as usize - 1
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let fault = || format!("`{text}` is no share; write its number and how many there are, like 3/16");
        let (number, count) = text.split_once('/').ok_or_else(fault)?;
        let parse = |part: &str| part.trim().parse::<u32>().map_err(|_| fault());
        let (number, count) = (parse(number)?, parse(count)?);
        let is_sound = (1..=count).contains(&number) && count <= 1_000_000;
        is_sound.then_some(Shard { number, count }).ok_or_else(fault)
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn a_share_is_a_number_of_a_count() {
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, count: 16 }));
        for wrong in ["", "3", "0/4", "5/4", "1/0", "-1/2", "1/2/3", "1/9999999999"] {
            let words = format!("`{wrong}` is no share; write its number and how many there are, like 3/16");
            assert_eq!(wrong.parse::<Shard>(), Err(words));
        }
    }

    #[test]
    fn every_garment_is_in_one_share() {
        for count in [1_u32, 2, 7, 16] {
            for place in 0..50 {
                let shares = (1..=count).filter(|&number| Shard { number, count }.has(place)).count();
                assert_eq!(shares, 1, "{place} of {count}");
            }
        }
    }
}
