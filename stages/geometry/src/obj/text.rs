//! Bytes of a text file as lines, whatever wrote them.
//!
//! A byte order mark is skipped, UTF-16 is recoded by its mark, lines end in LF, CR LF or CR. Other
//! encodings (Latin-1, Shift-JIS) need nothing: all that is read are digits and two letters, and
//! what stands in comments and names is passed over as bytes.

use std::borrow::Cow;

/// The bytes without a byte order mark, in UTF-8 where the mark says UTF-16.
#[must_use]
pub fn decode(bytes: &[u8]) -> Cow<'_, [u8]> {
    let wide = |rest: &[u8], unit: fn([u8; 2]) -> u16| {
        let units = rest.chunks_exact(2).map(|b| unit([b[0], b[1]]));
        let text: String =
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        Cow::Owned(text.into_bytes())
    };
    match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => Cow::Borrowed(rest),
        [0xFF, 0xFE, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => wide(rest, u16::from_be_bytes),
        _ => Cow::Borrowed(bytes),
    }
}

/// The lines of a text with their numbers, counted from 1; `v` and `f` lines that end in `\` with
/// those that continue them.
///
/// Other lines are not continued: a comment or a name may end in `\` (`# C:\bodies\`) and must not
/// swallow the vertex below it.
pub(super) struct NumberedLines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> NumberedLines<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { rest: text, number: 0 }
    }

    /// The next line as it stands in the file.
    fn physical(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let end = self.rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(self.rest.len());
        let (line, ending) = self.rest.split_at(end);
        self.rest = ending.strip_prefix(b"\r\n").unwrap_or(ending.get(1..).unwrap_or_default());
        Some(line)
    }
}

impl<'a> Iterator for NumberedLines<'a> {
    type Item = (usize, Cow<'a, [u8]>);

    fn next(&mut self) -> Option<Self::Item> {
        let line = self.physical()?.trim_ascii();
        let number = self.number;
        let is_read = |begun: &&[u8]| matches!(words(begun).next(), Some(b"v" | b"f"));
        let Some(mut begun) = line.strip_suffix(b"\\").filter(is_read) else {
            return Some((number, Cow::Borrowed(line)));
        };
        let mut whole = Vec::new();
        loop {
            whole.extend_from_slice(begun);
            whole.push(b' ');
            let Some(next) = self.physical().map(<[u8]>::trim_ascii) else { break };
            let Some(more) = next.strip_suffix(b"\\") else {
                whole.extend_from_slice(next);
                break;
            };
            begun = more;
        }
        Some((number, Cow::Owned(whole)))
    }
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|b| b.is_ascii_whitespace() || *b == 0x0B).filter(|w| !w.is_empty())
}
