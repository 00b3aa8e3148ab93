//! DXF as pairs of a group code and a value, with the line of each.
//!
//! Cost: linear. Limits: text form alone (the binary form is refused by name); 32 MB. Bytes that are no UTF-8 are read as
//! Latin-1, as old programs write them.

use super::damage::Damage;

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
    pub(super) fn number(&self) -> Result<f64, Damage> {
        let number = self.value.trim().parse::<f64>().ok().filter(|n| n.abs() <= 1e7);
        number.ok_or_else(|| Damage::Number { value: short(&self.value), line: self.line + 1 })
    }
}

/// The pairs of a file.
pub(super) fn tags(bytes: &[u8]) -> Result<Vec<Tag>, Damage> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err(Damage::Binary);
    }
    if bytes.len() > MOST_BYTES {
        return Err(Damage::Large { bytes: bytes.len(), most: MOST_BYTES });
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.strip_prefix('\u{feff}').unwrap_or(text).to_owned(),
        Err(_) => bytes.iter().map(|b| char::from(*b)).collect(),
    };
    let mut lines = text.lines().enumerate();
    let mut out = Vec::new();
    while let Some((i, code)) = lines.next() {
        if code.trim().is_empty() && out.is_empty() {
            continue;
        }
        let line = i + 1;
        let Ok(number) = code.trim().parse::<i32>() else {
            // What stands behind the end of the file is nobody's.
            let ended = out.last().is_some_and(|t: &Tag| t.code == 0 && t.value == "EOF");
            return if ended { Ok(out) } else { Err(Damage::Code { value: short(code), line }) };
        };
        let Some((_, value)) = lines.next() else { return Err(Damage::Early { line }) };
        out.push(Tag { code: number, value: value.trim_end_matches('\r').to_owned(), line });
    }
    if out.is_empty() { Err(Damage::Early { line: 1 }) } else { Ok(out) }
}

/// A value as it stands in a message.
pub(super) fn short(value: &str) -> String {
    value.trim().chars().take(40).collect()
}
