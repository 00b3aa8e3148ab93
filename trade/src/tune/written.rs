//! The tuned pipeline file: the proved setting in its place, and what was measured in lines of
//! comment on top.

use super::{Prover, SettingProof, Wish, overrides};
use crate::knobs::slot::setting_words;
use crate::record::{Clock, Machine, Point};
use toile_core::StageError;
use toile_pipeline::without_qualities;

/// Begins each line that tuning puts on top of a pipeline file.
pub const MARK: &str = "// toile tune:";

impl Prover<'_> {
    /// The pipeline file with the proved setting in its place, comments and order kept, and the
    /// figures on top. Its named qualities are left out: they were measured on the file as it was.
    ///
    /// Errors: the setting does not fit the file any more.
    pub fn tuned(&self, wish: &Wish, proof: &SettingProof, date: &str) -> Result<String, StageError> {
        let point = &self.trade.points[proof.point];
        let pipeline = self.load(&overrides(&point.overrides))?;
        let text = without_qualities(&pipeline.text).map_err(|f| StageError::invalid(f.message))?;
        Ok(commented(&text, &self.comments(wish, proof, point, date)))
    }

    fn comments(&self, wish: &Wish, proof: &SettingProof, point: &Point, date: &str) -> Vec<String> {
        let (m, d, machine) = (&proof.fresh, &proof.fresh.errors.distance_mm, Machine::here());
        let mut lines = vec![
            format!(
                "{date}, toile {}, {}, {} cores: {}.",
                env!("CARGO_PKG_VERSION"),
                machine.system,
                machine.cores,
                wish.words()
            ),
            format!("set {}.", setting_words(&point.setting)),
            format!(
                "a fresh run{} took {:.2} s ({:.2} s of processor time); 95 % of its surface within {:.2} mm of the reference, mean {:.2} mm, worst {:.2} mm.",
                self.trade.until.as_ref().map_or_else(String::new, |stage| format!(" up to {stage}")),
                m.time(Clock::Wall),
                m.time(Clock::Cpu),
                d.p95,
                d.mean,
                d.max
            ),
        ];
        lines.extend(proof.starts_in_words(wish).map(|words| format!("{words}.")));
        if let Some(finest) = self.trade.reference.levels.last() {
            let floor = self.trade.reference.floor_mm();
            let floor = floor.map_or_else(String::new, |f| format!(", itself known to {f:.2} mm"));
            lines.push(format!("the reference: {} triangles{floor}.", finest.triangles));
        }
        lines
    }
}

/// A pipeline's text with lines of comment on top, in the place of those of an earlier tuning.
pub(super) fn commented(text: &str, lines: &[String]) -> String {
    let (mark, rest) = match text.strip_prefix('\u{feff}') {
        Some(rest) => ("\u{feff}", rest),
        None => ("", text),
    };
    let own: String = rest.split_inclusive('\n').filter(|l| !l.starts_with(MARK)).collect();
    let lines: String = lines.iter().map(|l| format!("{MARK} {l}\n")).collect();
    format!("{mark}{lines}{own}")
}
