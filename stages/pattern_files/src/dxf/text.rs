//! Pairs of a group code and a value, one a line.

use std::fmt::{Display, Write};

/// Tags under construction, as characters of Latin-1.
#[derive(Default)]
pub(super) struct Tags(String);

/// The height of texts, mm.
const HEIGHT: f64 = 5.0;

impl Tags {
    pub(super) fn tag(&mut self, code: i32, value: impl Display) -> &mut Self {
        let _ = write!(self.0, "{code:3}\r\n{value}\r\n");
        self
    }

    pub(super) fn section(&mut self, name: &str) -> &mut Self {
        self.tag(0, "SECTION").tag(2, name)
    }

    pub(super) fn end(&mut self) -> &mut Self {
        self.tag(0, "ENDSEC")
    }

    /// A point, mm, its first coordinate under that code.
    pub(super) fn point(&mut self, code: i32, [x, y]: [f64; 2]) -> &mut Self {
        self.tag(code, number(x)).tag(code + 10, number(y))
    }

    pub(super) fn text(&mut self, layer: i32, at: [f64; 2], text: &str) -> &mut Self {
        self.tag(0, "TEXT").tag(8, layer).point(10, at).tag(40, number(HEIGHT)).tag(1, text)
    }

    /// An open line from point to point, mm.
    pub(super) fn polyline(&mut self, layer: i32, points: &[[f64; 2]]) -> &mut Self {
        self.tag(0, "POLYLINE").tag(8, layer).tag(66, 1).tag(70, 0);
        for p in points {
            self.tag(0, "VERTEX").tag(8, layer).point(10, *p);
        }
        self.tag(0, "SEQEND").tag(8, layer)
    }

    pub(super) fn line(&mut self, layer: i32, a: [f64; 2], b: [f64; 2]) -> &mut Self {
        self.tag(0, "LINE").tag(8, layer).point(10, a).point(11, b)
    }

    /// A point by itself; its thickness is the depth of a notch, mm, its angle the direction of
    /// one, degrees.
    pub(super) fn dot(&mut self, layer: i32, at: [f64; 2], notch: Option<(f64, f64)>) -> &mut Self {
        self.tag(0, "POINT").tag(8, layer).point(10, at);
        if let Some((depth, angle)) = notch {
            self.tag(39, number(depth)).tag(50, number(angle));
        }
        self
    }

    /// The file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.0.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?')).collect()
    }
}

/// A number with six decimals.
fn number(n: f64) -> String {
    let text = format!("{n:.6}");
    if text == "-0.000000" { "0.000000".to_owned() } else { text }
}

/// A text with what a file holds of it: characters beyond sixteen bits become a `_`.
pub(super) fn held(text: &str) -> String {
    text.chars().map(|c| if u32::from(c) < 0x1_0000 { c } else { '_' }).collect()
}

/// A text as it is written: characters that are not of Latin-1, and those that begin codes, as
/// `\U+XXXX`; beyond those a `_`. All that are no ASCII where `ascii` is asked for.
pub(super) fn encoded(text: &str, ascii: bool) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        let code = u32::from(c);
        let plain = if ascii { code < 0x80 } else { code < 0x100 };
        match c {
            '\\' | '%' | '^' => {
                let _ = write!(out, "\\U+{code:04X}");
            }
            _ if plain => out.push(c),
            _ if code < 0x1_0000 => {
                let _ = write!(out, "\\U+{code:04X}");
            }
            _ => out.push('_'),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_latin_letters_and_escape_others() {
        assert_eq!(encoded("Ärmel 50%", false), "Ärmel 50\\U+0025");
        assert_eq!(encoded("Ärmel", true), "\\U+00C4rmel");
        assert_eq!(encoded("袖 \u{1f457} a\\b", false), "\\U+8896 _ a\\U+005Cb");
    }
}
