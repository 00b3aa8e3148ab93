//! The measurements that a pattern is drafted with.

use super::super::faults::refused;
use super::SeamlyPattern;
use super::damage::DraftDamage;
use std::path::Path;
use toile_core::Remarks;
use toile_core::prelude::*;
use toile_seamly::{MeasurementTable, PatternHead, SeamlyFault};

/// The measurements of the file that the stage names, else of the one that the pattern names; none
/// where that one is not there, which is an error once the pattern needs a measurement.
pub(super) fn table(
    stage: &SeamlyPattern,
    head: &PatternHead,
    told: &mut Remarks,
    cx: &Context,
) -> Result<Option<MeasurementTable>, StageError> {
    let grade = stage.grade(head);
    let path = match stage.measurements.is_empty() {
        false => Some(stage.measurements.clone()),
        true => head.measurements.as_deref().and_then(|named| beside(&stage.file, named, cx)),
    };
    let Some(path) = path else {
        if let Some(named) = &head.measurements {
            told.notes.push(format!("the pattern's file of measurements, \"{named}\", is not there"));
        }
        let asked = [("size", grade.size), ("height", grade.height)];
        return match asked.into_iter().find(|(_, value)| value.is_some()) {
            Some((what, _)) => {
                let fault = DraftDamage::draft(SeamlyFault::OneSize { what }, head.measurements.as_deref());
                Err(refused(&stage.file, vec![fault.fault()]))
            }
            None => Ok(None),
        };
    };
    let bytes = cx.read(&path).map_err(|e| e.at("measurements"))?;
    let table = MeasurementTable::read(&bytes, grade, head.unit).map_err(|f| {
        let mut fault = DraftDamage::draft(f, None).fault();
        if fault.param == "file" {
            fault.param = "measurements";
        }
        refused(&path, vec![fault])
    })?;
    told.notes.push(format!("the measurements are those of \"{path}\""));
    Ok(Some(table))
}

/// A file that a pattern names, where it is there: as the pattern says, or in its own folder.
fn beside(pattern: &str, named: &str, cx: &Context) -> Option<String> {
    let folder = Path::new(pattern).parent().unwrap_or(Path::new(""));
    let plain = named.replace('\\', "/");
    let own = Path::new(&plain).file_name().map(|name| folder.join(name));
    let all = [Some(folder.join(&plain)), own];
    all.into_iter().flatten().map(|p| p.display().to_string()).find(|p| cx.look(p).is_ok())
}
