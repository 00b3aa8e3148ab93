//! Which garments of a manifest are run: those of the share that are not done, or those that are
//! asked for.

use super::folder::garment;
use super::manifest::GarmentLine;
use super::mirror::Mirror;
use super::record::{FileDigests, GarmentRecord};
use super::tally::counted;
use crate::args::{BatchArgs, Shard};
use crate::live::reads::look;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use toile_core::artifact::{Digest, Digester};
use toile_core::{Registry, StageError};
use toile_pipeline::plugin::plugin_files;
use toile_pipeline::{Override, plugins_asked};

/// What is counted up where records, or what goes into them, change their meaning.
const VERSION: usize = 1;

/// The garments of a manifest, and which of them are run.
pub(crate) struct BatchPlan {
    /// All of the manifest, in its order.
    pub(crate) garments: Vec<GarmentLine>,
    /// For each the digest of all that goes into it but the files' content.
    pub(crate) tickets: Vec<Digest>,
    /// The manifest's folder.
    pub(crate) folder: PathBuf,
    /// Number of garments of the share.
    pub(crate) share: usize,
    /// Number of garments of the share that are not run, since they are done or not asked for.
    pub(crate) not_run: usize,
    /// Places of the garments that are run, in order.
    pub(crate) run: Vec<usize>,
}

impl BatchPlan {
    /// By what is done in the output folder, or in the store.
    ///
    /// Errors: the pipeline cannot be read; no garment has ended with the fault that is asked for.
    pub(crate) fn new(
        args: &BatchArgs,
        folder: &Path,
        out: &Path,
        garments: Vec<GarmentLine>,
        registry: &Registry,
        mirror: &Mirror,
    ) -> Result<Self, StageError> {
        let common = common(args, registry)?;
        let tickets: Vec<Digest> = garments.iter().map(|g| ticket(&common, &g.set)).collect();
        let share: Vec<usize> = (0..garments.len()).filter(|&place| args.shard.has(place)).collect();
        let asked: Vec<usize> = share
            .iter()
            .copied()
            .filter(|&place| args.only.is_empty() || args.only.contains(&garments[place].id))
            .collect();
        let files = FileDigests::seen_from(folder);
        let records = |place: usize| {
            let id = &garments[place].id;
            GarmentRecord::read(&garment(out, id)).into_iter().chain(mirror.record(id))
        };
        let runs = |place: &usize| match (&args.retry_only[..], &args.only[..]) {
            ([], []) => !records(*place).any(|r| r.is_of(&tickets[*place], &files)),
            ([], _) => true,
            (kinds, _) => {
                records(*place).filter_map(|r| r.line.fault.fault).any(|fault| kinds.contains(&fault))
            }
        };
        let run: Vec<usize> = asked.par_iter().copied().filter(runs).collect();
        let not_run = share.len() - run.len();
        Ok(BatchPlan { tickets, folder: folder.to_owned(), share: share.len(), not_run, run, garments })
    }

    /// The garments of the share that are done in the output folder, with their records.
    pub(crate) fn done<'a>(
        &'a self,
        out: &'a Path,
        shard: Shard,
    ) -> impl Iterator<Item = GarmentRecord> + 'a {
        let files = FileDigests::seen_from(&self.folder);
        let is_run: BTreeSet<usize> = self.run.iter().copied().collect();
        let left = move |place: &usize| shard.has(*place) && !is_run.contains(place);
        (0..self.garments.len()).filter(left).filter_map(move |place| {
            let record = GarmentRecord::read(&garment(out, &self.garments[place].id))?;
            record.is_of(&self.tickets[place], &files).then_some(record)
        })
    }

    /// `200 garments, 100 in this share: 20 are run, 80 are not`.
    pub(crate) fn words(&self) -> String {
        let all = self.garments.len();
        let share = if self.share == all { String::new() } else { format!(", {} in this share", self.share) };
        format!("{}{share}: {} to run, {} done or not asked for", counted(all), self.run.len(), self.not_run)
    }
}

/// What goes into every garment.
fn common(args: &BatchArgs, registry: &Registry) -> Result<Digest, StageError> {
    let text = toile_core::read_text(&args.pipeline).map_err(|e| {
        StageError::invalid(format!("cannot read the pipeline \"{}\": {e}", args.pipeline.display()))
    })?;
    let mut d = Digester::new();
    d.count(VERSION).text(env!("TOILE_VERSION")).text(&text);
    let folder = args.pipeline.parent().unwrap_or(Path::new(""));
    let asked = plugins_asked(&text).into_iter().map(|p| folder.join(p.file));
    let plugins = registry.plugins().iter().map(|p| PathBuf::from(&p.file)).chain(asked);
    for file in plugins.flat_map(|p| plugin_files(&p)) {
        d.bytes(&look(&file, None).and_then(|l| l.content).map_or([0; 32], |c| c.0));
    }
    for text in [&args.overrides.quality, &args.until] {
        d.text(text.as_deref().unwrap_or_default());
    }
    d.count(usize::from(args.no_verify)).count(args.keep.len());
    for name in &args.keep {
        d.text(name);
    }
    feed(&mut d, &args.overrides.set);
    Ok(d.finish())
}

/// What goes into one garment, but the content of its files.
fn ticket(common: &Digest, set: &[Override]) -> Digest {
    let mut d = Digester::new();
    d.bytes(&common.0);
    feed(&mut d, set);
    d.finish()
}

fn feed(d: &mut Digester, set: &[Override]) {
    d.count(set.len());
    for o in set {
        d.text(&o.path).text(&o.value);
    }
}
