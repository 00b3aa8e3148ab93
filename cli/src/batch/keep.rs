//! What came of a garment, put into its place with its record.

use super::child::leave_reason;
use super::folder::{BatchFolder, contents, emptied};
use super::mirror::Mirror;
use super::overrides;
use super::plan::BatchPlan;
use super::pool::{AfterGarment, EndedGarment, GarmentEnd, Garments};
use super::record::{self, CostLine, FileDigests, GarmentRecord, ReadFiles, ResultLine, relative};
use super::task::{GarmentAnswer, GarmentTask};
use crate::args::BatchArgs;
use crate::trading::costs::KnownCosts;
use crate::validate::open;
use crate::verify::write_text;
use crate::{Streams, at_hand, cache};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toile_core::Registry;
use toile_core::cost::Predicted;
use toile_trade::cost::{predict, total};

/// Makes the tasks of garments and keeps what comes of them.
pub(crate) struct GarmentKeeper<'a, 'b> {
    args: &'a BatchArgs,
    plan: &'a BatchPlan,
    folder: &'a BatchFolder,
    registry: &'a Registry,
    streams: &'a mut Streams<'b>,
    /// What garments are expected to take; none where one runs at a time.
    costs: Option<KnownCosts>,
    cache_dir: Option<PathBuf>,
    /// Garments that are through.
    through: usize,
    mirror: &'a Mirror,
    /// How often garments were run again for a file that they lacked, by their places.
    again: BTreeMap<usize, usize>,
}

/// How often a garment is run again for files that it lacked: each may name the next.
const MOST_AGAIN: usize = 8;

impl<'a, 'b> GarmentKeeper<'a, 'b> {
    pub(crate) fn new(
        args: &'a BatchArgs,
        plan: &'a BatchPlan,
        folder: &'a BatchFolder,
        registry: &'a Registry,
        streams: &'a mut Streams<'b>,
        forecasts: bool,
        mirror: &'a Mirror,
    ) -> Self {
        // Each garment's process takes the cache by its full path: it works in another folder.
        let full =
            |cache: std::sync::Arc<toile_pipeline::cache::Cache>| std::path::absolute(cache.folder()).ok();
        let cache_dir = cache::chosen(&args.cache, streams).and_then(full);
        let costs = forecasts.then(|| KnownCosts::of(&args.cache, Some(1)));
        let (through, again) = Default::default();
        GarmentKeeper { args, plan, folder, registry, streams, costs, cache_dir, through, mirror, again }
    }

    /// The record of a garment whose process answered.
    fn answered(&self, place: usize, answer: GarmentAnswer, seconds: f64, peak: u64) -> GarmentRecord {
        let (garment, ticket) = (&self.plan.garments[place], self.plan.tickets[place]);
        let line = ResultLine {
            id: garment.id.clone(),
            inputs: record::inputs(&ticket, &answer.reads),
            exit: answer.exit,
            fault: answer.fault,
            quality: answer.quality,
            certificate: answer.certificate,
            files: answer.contents.files,
            result: answer.contents.result,
            version: env!("TOILE_VERSION").to_owned(),
        };
        let peak_bytes = answer.peak_bytes.or((peak > 0).then_some(peak));
        let costs = CostLine { id: garment.id.clone(), seconds, peak_bytes, bytes: answer.contents.bytes };
        let set = garment.set.iter().map(|o| (o.path.clone(), o.value.clone())).collect();
        GarmentRecord { ticket, set, reads: answer.reads, line, costs }
    }

    /// What stands for the answer of a process that gave none: what it had written is nothing
    /// whole, and goes.
    fn broken(&self, place: usize, exit: u8, fault: record::GarmentFault) -> Result<GarmentAnswer, String> {
        let folder = self.folder.garment_at_work(&self.plan.garments[place].id);
        emptied(&folder).map_err(|e| e.to_string())?;
        leave_reason(&folder, &fault)?;
        Ok(GarmentAnswer {
            exit,
            fault,
            quality: Value::Null,
            certificate: Value::Null,
            reads: self.named_files(place),
            contents: contents(&folder).map_err(|e| e.to_string())?,
            peak_bytes: None,
            unwritten: None,
            cancelled: false,
        })
    }

    /// The files that the manifest names: what is known of a process that does not tell what it
    /// read.
    fn named_files(&self, place: usize) -> ReadFiles {
        let files = FileDigests::seen_from(&self.plan.folder);
        let found = at_hand::found_from(&self.plan.folder, &self.plan.garments[place].set);
        let named = found.iter().filter_map(at_hand::named);
        let seen =
            |file: &str| relative(&self.plan.folder.join(file), &self.plan.folder).display().to_string();
        named.map(seen).map(|file| (file.clone(), files.of(&file))).collect()
    }

    fn tell(&mut self, record: &GarmentRecord) {
        self.through += 1;
        let count = format!("[{}/{}]", self.through, self.plan.run.len());
        let (id, seconds) = (&record.line.id, record.costs.seconds);
        let fault = &record.line.fault;
        self.streams.notice(match (&fault.fault, &fault.message) {
            (None, _) => format!("{count} {id}: good, {seconds:.1} s"),
            (Some(kind), message) => {
                format!("{count} {id}: {kind}: {}, {seconds:.1} s", message.as_deref().unwrap_or_default())
            }
        });
    }
}

impl Garments for GarmentKeeper<'_, '_> {
    fn expected(&mut self, place: usize) -> u64 {
        let Some(known) = &self.costs else { return 0 };
        let own = overrides(self.args, &self.plan.folder, &self.plan.garments[place]);
        // A pipeline that does not load takes nothing.
        let Ok(pipeline) = open(&self.args.pipeline, &own, self.registry) else { return 0 };
        let forecasts = predict(&pipeline, known.costs());
        let stages: Vec<&Predicted> = forecasts.iter().map(|f| &f.predicted).collect();
        total(&stages).peak_bytes.map_or(0, |peak| peak.high.clamp(0.0, 1e18) as u64)
    }

    fn task(&mut self, place: usize, threads: u16) -> Result<GarmentTask, String> {
        let garment = &self.plan.garments[place];
        let own = overrides(self.args, &self.plan.folder, garment);
        Ok(GarmentTask {
            pipeline: std::path::absolute(&self.args.pipeline).map_err(|e| e.to_string())?,
            folder: self.plan.folder.clone(),
            out: self.folder.work(&garment.id).map_err(|e| e.to_string())?,
            quality: own.quality,
            set: own.set.into_iter().map(|o| (o.path, o.value)).collect(),
            until: self.args.until.clone(),
            cache_dir: self.cache_dir.clone(),
            threads,
            max_time: self.args.max_time,
            keep: self.args.keep.clone(),
            verify: !self.args.no_verify,
        })
    }

    fn ended(&mut self, garment: EndedGarment) -> Result<AfterGarment, String> {
        let EndedGarment { place, end, seconds, peak } = garment;
        let id = self.plan.garments[place].id.clone();
        let answer = match end {
            GarmentEnd::Answered(answer) => *answer,
            GarmentEnd::Broken(exit, fault) => self.broken(place, exit, fault)?,
        };
        if let Some(why) = answer.unwritten {
            return Err(format!("the garment \"{id}\" cannot be kept: {why}"));
        }
        if self.mirror.brings_missing(&answer.reads).map_err(|e| e.to_string())? {
            let again = self.again.entry(place).or_default();
            *again += 1;
            if *again <= MOST_AGAIN {
                return Ok(AfterGarment::Again);
            }
        }
        let record = self.answered(place, answer, seconds, peak);
        let text = serde_json::to_string(&record).map_err(|e| e.to_string())? + "\n";
        write_text(&self.folder.garment_at_work(&id).join(record::FILE), &text).map_err(|e| e.to_string())?;
        self.folder.publish(&id).map_err(|e| e.to_string())?;
        self.tell(&record);
        self.mirror.send(&id).map_err(|e| e.to_string())?;
        Ok(AfterGarment::Kept)
    }
}
