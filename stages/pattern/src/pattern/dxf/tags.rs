//! DXF as pairs of a group code and a value, with the line of each.
//!
//! Cost: linear. Limits: text form alone (the binary form is refused by name); 32 MB.
//! [`super::decode`] finds the letters.

use super::super::letters::decoded;
use super::damage::DxfDamage;
use super::{decode, words};
use toile_core::Remarks;

const MOST_BYTES: usize = 32 << 20;

/// A group code with its value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tag {
    pub code: i32,
    pub value: String,
    /// The line of the code, from 1.
    pub line: usize,
}

impl Tag {
    /// The value as a finite number.
    pub(super) fn number(&self) -> Result<f64, DxfDamage> {
        let number = self.value.trim().parse::<f64>().ok().filter(|n| n.abs() <= 1e7);
        number.ok_or_else(|| DxfDamage::Number { value: short(&self.value), line: self.line + 1 })
    }
}

/// The pairs of a file, whose letters are in `encoding`, or as the file says where that is empty.
pub(super) fn tags(bytes: &[u8], encoding: &str, told: &mut Remarks) -> Result<Vec<Tag>, DxfDamage> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err(DxfDamage::Binary);
    }
    if bytes.len() > MOST_BYTES {
        return Err(DxfDamage::Large { bytes: bytes.len(), most: MOST_BYTES });
    }
    let text = match encoding.trim() {
        "" => decode::text(bytes, told),
        named => decoded(bytes, named).map_err(DxfDamage::Letters)?,
    };
    let mut lines = text.lines().enumerate();
    let mut out = Vec::new();
    while let Some((i, code)) = lines.next() {
        if code.trim().is_empty() && out.is_empty() {
            continue;
        }
        let line = i + 1;
        let Ok(number) = code.trim().parse::<i32>() else {
            // Text after the EOF tag is ignored.
            let ended = out.last().is_some_and(|t: &Tag| t.code == 0 && t.value == "EOF");
            return if ended { Ok(out) } else { Err(DxfDamage::Code { value: short(code), line }) };
        };
        let Some((_, value)) = lines.next() else { return Err(DxfDamage::Early { line }) };
        let value = value.trim_end_matches('\r');
        // Names of blocks and layers; texts are read where they are formed.
        let value = if matches!(number, 2 | 8) { words::letters(value) } else { value.to_owned() };
        out.push(Tag { code: number, value, line });
    }
    if out.is_empty() { Err(DxfDamage::Early { line: 1 }) } else { Ok(out) }
}

/// The number that a variable of the header has.
pub(super) fn variable(tags: &[Tag], name: &str) -> Option<i64> {
    let at = tags.iter().position(|t| t.code == 9 && t.value.trim() == name)?;
    tags.get(at + 1)?.value.trim().parse().ok()
}

/// A value as it stands in a message.
pub(super) fn short(value: &str) -> String {
    value.trim().chars().take(40).collect()
}
