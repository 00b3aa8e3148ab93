//! How the garments of a manifest stand.

use super::record::ResultLine;
use std::collections::BTreeMap;

/// How all garments of a manifest stand, and those of a share.
#[derive(Debug)]
pub(crate) struct Tallies {
    pub(crate) all: BatchTally,
    pub(crate) share: BatchTally,
}

/// How the garments of a manifest stand.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct BatchTally {
    /// Garments of the manifest.
    pub(crate) garments: usize,
    /// Those without fault.
    pub(crate) good: usize,
    /// Number of garments by fault.
    pub(crate) faults: BTreeMap<String, usize>,
}

impl BatchTally {
    /// Of the lines of a manifest of so many garments.
    pub(crate) fn of<'a>(lines: impl IntoIterator<Item = &'a ResultLine>, garments: usize) -> Self {
        let mut tally = BatchTally { garments, ..BatchTally::default() };
        for line in lines {
            match &line.fault.fault {
                Some(kind) => *tally.faults.entry(kind.clone()).or_insert(0) += 1,
                None => tally.good += 1,
            }
        }
        tally
    }

    /// Garments that have yet to be run.
    pub(crate) fn left(&self) -> usize {
        self.garments - self.good - self.faults.values().sum::<usize>()
    }

    /// `200 garments: 196 good, 3 timeout, 1 not run yet`.
    pub(crate) fn words(&self) -> String {
        let faults = self.faults.iter().map(|(kind, count)| format!(", {count} {kind}")).collect::<String>();
        let left = match self.left() {
            0 => String::new(),
            n => format!(", {n} not run yet"),
        };
        format!("{}: {} good{faults}{left}", counted(self.garments), self.good)
    }
}

/// A number of garments in words.
pub(crate) fn counted(garments: usize) -> String {
    if garments == 1 { "1 garment".into() } else { format!("{garments} garments") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tally_counts_faults_by_their_kind_and_what_is_left() {
        let faults = BTreeMap::from([("crashed".to_owned(), 1), ("timeout".to_owned(), 3)]);
        let tally = BatchTally { garments: 10, good: 4, faults };
        assert_eq!(tally.words(), "10 garments: 4 good, 1 crashed, 3 timeout, 2 not run yet");
        assert_eq!(
            BatchTally { garments: 2, good: 2, ..BatchTally::default() }.words(),
            "2 garments: 2 good"
        );
    }
}
