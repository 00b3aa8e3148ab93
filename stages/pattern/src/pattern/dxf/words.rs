//! What the texts of a DXF say without the codes by which programs write and form them.

use super::super::letters::encoding;

/// A text with its letters: `\U+XXXX` is a letter of Unicode, `\M+nXXXX` one of a code page.
pub(super) fn letters(raw: &str) -> String {
    let mut out = String::with_capacity(raw.len());
    let mut rest = raw;
    while let Some(k) = rest.find('\\') {
        out.push_str(&rest[..k]);
        let tail = &rest[k..];
        let (c, length) = unicode(tail).or_else(|| mif(tail)).unwrap_or(("\\".to_owned(), 1));
        out.push_str(&c);
        rest = &tail[length..];
    }
    out + rest
}

/// The letter of `\U+XXXX` at the start of a text, and the bytes that it takes.
fn unicode(text: &str) -> Option<(String, usize)> {
    let hex = text.strip_prefix("\\U+").or_else(|| text.strip_prefix("\\u+"))?.get(..4)?;
    Some((char::from_u32(u32::from_str_radix(hex, 16).ok()?)?.to_string(), 7))
}

/// The letter of `\M+nXXXX`.
fn mif(text: &str) -> Option<(String, usize)> {
    let code = text.strip_prefix("\\M+").or_else(|| text.strip_prefix("\\m+"))?;
    let page = match code.get(..1)? {
        "1" => "932",
        "2" => "950",
        "3" => "949",
        "5" => "936",
        _ => return None,
    };
    let bytes = u16::from_str_radix(code.get(1..5)?, 16).ok()?.to_be_bytes();
    let (letter, _, wrong) = encoding(page)?.decode(if bytes[0] == 0 { &bytes[1..] } else { &bytes });
    (!wrong).then(|| (letter.into_owned(), 8))
}

/// A TEXT: `%%d` is a degree, `%%c` a diameter, `%%p` plus and minus, `%%nnn` a letter by its
/// number; `%%u` and `%%o` draw lines.
pub(super) fn line(raw: &str) -> String {
    let mut out = String::with_capacity(raw.len());
    let mut rest = raw;
    while let Some(k) = rest.find("%%") {
        out.push_str(&rest[..k]);
        let tail = &rest[k + 2..];
        let number = tail.get(..3).and_then(|n| n.parse::<u8>().ok());
        let first = tail.chars().next().map(|c| c.to_ascii_lowercase());
        let (letter, length) = match (number, first) {
            (Some(n), _) => (Some(char::from(n)), 3),
            (None, Some('d')) => (Some('°'), 1),
            (None, Some('c')) => (Some('Ø'), 1),
            (None, Some('p')) => (Some('±'), 1),
            (None, Some('%')) => (Some('%'), 1),
            (None, Some('u' | 'o' | 'k')) => (None, 1),
            (None, _) => (Some('%'), 0),
        };
        out.extend(letter);
        rest = &tail[length..];
    }
    letters(&(out + rest))
}

/// The lines of an MTEXT, without the codes that form it.
pub(super) fn lines(raw: &str) -> Vec<String> {
    let mut rest = raw;
    // A line's end is a break in it.
    let mut whole = String::new();
    while let Some(c) = rest.chars().next() {
        let tail = &rest[c.len_utf8()..];
        match (c, tail.chars().next()) {
            ('{' | '}', _) => rest = tail,
            ('^', Some('J' | 'M')) => {
                whole.push('\n');
                rest = &tail[1..];
            }
            ('^', Some('I')) => {
                whole.push(' ');
                rest = &tail[1..];
            }
            ('\\', Some(code)) => {
                let after = &tail[code.len_utf8()..];
                let to_end = || after.find(';').map_or("", |k| &after[k + 1..]);
                if let Some((letter, length)) = unicode(rest).or_else(|| mif(rest)) {
                    whole.push_str(&letter);
                    rest = &rest[length..];
                    continue;
                }
                rest = match code {
                    'P' | 'X' | 'N' => {
                        whole.push('\n');
                        after
                    }
                    '~' => {
                        whole.push(' ');
                        after
                    }
                    'L' | 'l' | 'O' | 'o' | 'K' | 'k' => after,
                    // A fraction: both numbers, a bar between them.
                    'S' => {
                        let number = after.split(';').next().unwrap_or("");
                        whole.push_str(&number.replace(['^', '#'], "/"));
                        to_end()
                    }
                    'A' | 'C' | 'c' | 'F' | 'f' | 'H' | 'Q' | 'T' | 'W' | 'p' => to_end(),
                    other => {
                        whole.push(other);
                        after
                    }
                };
            }
            _ => {
                whole.push(c);
                rest = tail;
            }
        }
    }
    whole.split('\n').map(|line| line.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_unicode_and_of_code_pages_are_read() {
        assert_eq!(letters("\\U+524D\\U+7247 a\\b"), "前片 a\\b");
        assert_eq!(letters("\\M+5C7B0\\M+5C6AC"), "前片");
        assert_eq!(letters("\\M+1914F"), "前");
        assert_eq!(letters("\\U+12"), "\\U+12");
        assert_eq!(line("Hem 30%%d %%uup%%u 5%%% \\U+0025"), "Hem 30° up 5% %");
    }

    #[test]
    fn a_text_of_several_lines_loses_its_codes() {
        assert_eq!(
            lines("{\\fArial|b0|i0;Piece Name: \\C1;BACK}\\PSize:~M\\P\\H2.5x;Quantity\\~: 1\\S1/2;"),
            ["Piece Name: BACK", "Size:~M", "Quantity : 11/2"]
        );
        assert_eq!(lines("a\\\\b \\{c\\} \\U+524D"), ["a\\b {c} 前"]);
        assert_eq!(lines(""), [""]);
    }
}
