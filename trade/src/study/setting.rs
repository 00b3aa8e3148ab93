//! One setting: its runs, and its figures against the reference.

use super::Study;
use crate::digest::{digest, garment_digest};
use crate::errors::{compare, ease};
use crate::knobs::slot::{Setting, setting_words};
use crate::measure::{Missed, Ran};
use crate::page::pictures;
use crate::record::{Measured, Point, SettingOutcome};
use toile_core::StageError;
use toile_core::artifact::Digester;
use toile_pipeline::{Pipeline, write_files};

impl Study<'_> {
    /// Measures a setting; none where it makes a pipeline that was measured already, which is then
    /// noted as known.
    pub(super) fn measure(&mut self, setting: Setting) -> Result<Option<Point>, StageError> {
        let pipeline = match self.source.load(&self.board.overrides(&setting)) {
            Ok(pipeline) => pipeline,
            Err(faults) => {
                let key = Digester::new().text(&setting_words(&setting)).finish().short();
                let outcome =
                    SettingOutcome::Failed { code: "invalid_pipeline".into(), message: faults.to_string() };
                return Ok(Some(self.point(key, setting, outcome)));
            }
        };
        let key = digest(&pipeline, &[]);
        if let Some(known) = self.store.lines.iter().find(|p| p.key == key) {
            let same = self.point(key, setting, known.outcome.clone());
            self.store.add(same)?;
            return Ok(None);
        }
        let outcome = self.outcome(&pipeline, &key)?;
        Ok(outcome.map(|outcome| self.point(key, setting, outcome)))
    }

    fn point(&self, key: String, setting: Setting, outcome: SettingOutcome) -> Point {
        let overrides = self.board.overrides(&setting).into_iter().map(|o| (o.path, o.value)).collect();
        Point { key, setting, overrides, outcome }
    }

    /// What comes of a setting, whose pictures are written; none where the budget ends, which says
    /// nothing of it.
    fn outcome(&self, pipeline: &Pipeline, key: &str) -> Result<Option<SettingOutcome>, StageError> {
        Ok(Some(match self.runs(pipeline) {
            Ok((ran, measured)) => {
                write_files(&self.options.out, &pictures(key, &ran))?;
                SettingOutcome::Measured(Box::new(measured))
            }
            Err(Missed::Cancelled) => return Err(Missed::Cancelled.into()),
            Err(Missed::Failed(e)) => SettingOutcome::Failed { code: e.code.to_string(), message: e.message },
            Err(Missed::OverLimit(_)) if self.left().is_zero() => return Ok(None),
            Err(Missed::OverLimit(seconds)) => SettingOutcome::OverLimit { seconds },
        }))
    }

    /// Runs a setting as often as asked, fewer times where the budget ends.
    fn runs(&self, pipeline: &Pipeline) -> Result<(Ran, Measured), Missed> {
        let limit = self.options.limit().min(self.left());
        let first = self.options.bench.run(pipeline, Some(limit), None)?;
        let mut measured = measured(&first, &self.found.ran).map_err(Missed::Failed)?;
        let digest = garment_digest(&first.garment);
        for _ in 1..self.options.repeats {
            if self.left().as_secs_f64() < first.wall_s {
                break;
            }
            let again = self.options.bench.run(pipeline, None, None)?;
            measured.wall_s.push(again.wall_s);
            measured.cpu_s.push(again.cpu_s);
            measured.repeatable &= garment_digest(&again.garment) == digest;
        }
        Ok((first, measured))
    }

    pub(super) fn words(&self, point: &Point) -> String {
        let what = if point.setting.is_empty() { "as it is".into() } else { setting_words(&point.setting) };
        let clock = self.options.clock;
        let came = match &point.outcome {
            SettingOutcome::Measured(m) => format!(
                "{:.2} s {}, 95 % within {:.2} mm{}",
                m.time(clock),
                clock.as_str(),
                m.errors.distance_mm.p95,
                if m.sound { "" } else { ", misses a quality limit" }
            ),
            SettingOutcome::Failed { message, .. } => format!("fails: {message}"),
            SettingOutcome::OverLimit { seconds } => format!("stopped after {seconds:.0} s"),
        };
        format!("setting {} ({what}): {came}", self.store.lines.len() + 1)
    }
}

/// The figures of a run against the reference.
///
/// Errors: garments that cannot be compared.
pub(crate) fn measured(ran: &Ran, reference: &Ran) -> Result<Measured, StageError> {
    let missed = |ran: &Ran| ran.figures.as_ref().map(|f| f.shortfalls.clone()).unwrap_or_default();
    let (known, shortfalls) = (missed(reference), missed(ran));
    Ok(Measured {
        wall_s: vec![ran.wall_s],
        cpu_s: vec![ran.cpu_s],
        peak_memory_bytes: ran.peak_memory_bytes,
        stages_s: ran.stages_s.clone(),
        triangles: ran.garment.triangles.len(),
        errors: compare(ran, reference)?,
        ease_mm: ease(ran),
        sound: shortfalls.iter().all(|s| known.iter().any(|k| k.code == s.code)),
        shortfalls: shortfalls.into_iter().map(|s| (s.code.to_string(), s.message)).collect(),
        repeatable: true,
    })
}
