//! Collections of records as text, and the one that is shipped.
//!
//! The first line says where and with which program the records were made, each further line is one
//! of them. A damaged line loses itself alone.

use super::record::{CostRecord, HostMachine};
use crate::digits::to_digits;
use serde::{Deserialize, Serialize};
use toile_core::cost::Size;

/// The version of this form; raised when old texts cannot be read any more.
const SCHEME: u32 = 2;
/// Longer texts are not looked at, bytes.
pub(super) const LONGEST: usize = 8 << 20;
/// What is shipped, made by `toile bench costs --out`.
const SHIPPED: &str = include_str!("shipped.jsonl");

/// The first line.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct ShippedHeader {
    scheme: u32,
    toile: String,
    host: HostMachine,
    date: String,
}

/// Records of one machine and program.
#[derive(Debug, Clone, PartialEq)]
pub struct Collection {
    /// The program's version.
    pub toile: String,
    /// The machine.
    pub host: HostMachine,
    /// The day, `2026-11-22`.
    pub date: String,
    /// What stages took.
    pub records: Vec<CostRecord>,
    /// Lines that cannot be read.
    pub damaged: usize,
}

impl Collection {
    /// Records of this machine and program, made today.
    pub fn here(records: Vec<CostRecord>) -> Self {
        let toile = env!("CARGO_PKG_VERSION").to_owned();
        Collection { toile, host: HostMachine::here(), date: crate::record::today(), records, damaged: 0 }
    }

    /// As text.
    pub fn to_text(&self) -> String {
        let (toile, host, date) = (self.toile.clone(), self.host.clone(), self.date.clone());
        let head = serde_json::to_string(&ShippedHeader { scheme: SCHEME, toile, host, date });
        let lines = self.records.iter().map(serde_json::to_string);
        // Names and finite numbers: writing them to memory cannot fail.
        std::iter::once(head).chain(lines).filter_map(Result::ok).map(|line| line + "\n").collect()
    }

    /// Without what only this machine's own later runs need, figures to three digits.
    #[must_use]
    pub fn slim(mut self) -> Self {
        for record in &mut self.records {
            record.key.clear();
            record.made = Size::new();
            (record.size, record.foreseen) = (rounded(&record.size), rounded(&record.foreseen));
            record.used.wall_s = to_digits(record.used.wall_s, 3);
            record.used.cpu_s = record.used.cpu_s.map(|s| to_digits(s, 3));
        }
        self
    }
}

/// To five digits.
fn rounded(size: &Size) -> Size {
    size.iter().fold(Size::new(), |all, (q, a)| all.with(q, to_digits(a, 5)))
}

/// Reads a collection.
///
/// Errors: `is damaged`, `is longer than 8 MB` or `was kept by another version` - words that follow
/// the text's name.
pub fn parse(text: &str) -> Result<Collection, &'static str> {
    if text.len() > LONGEST {
        return Err("is longer than 8 MB");
    }
    let mut lines = text.lines();
    let head: ShippedHeader = lines.next().and_then(|l| serde_json::from_str(l).ok()).ok_or("is damaged")?;
    if head.scheme != SCHEME {
        return Err("was kept by another version");
    }
    let read: Vec<Option<CostRecord>> = lines.map(|l| serde_json::from_str(l).ok()).collect();
    let damaged = read.iter().filter(|r| r.is_none()).count();
    let records = read.into_iter().flatten().collect();
    Ok(Collection { toile: head.toile, host: head.host, date: head.date, records, damaged })
}

/// The shipped collection.
pub fn shipped() -> Collection {
    parse(SHIPPED).unwrap_or_else(|_| Collection { date: String::new(), ..Collection::here(Vec::new()) })
}
