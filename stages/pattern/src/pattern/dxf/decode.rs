//! The letters of a DXF: in which encoding a file is, by its header.
//!
//! From release 2007 on (`$ACADVER` AC1021) a file is UTF-8, before that in the code page that
//! `$DWGCODEPAGE` names. Files say what is not so: text that is UTF-8 is read as that where the
//! code page has one byte per letter, and where none is named. What is neither is read as
//! Windows-1252, with a warning.

use super::super::letters::encoding;
use encoding_rs::{Encoding, WINDOWS_1252};
use toile_core::Remarks;

/// The first release in UTF-8.
const UNICODE: &str = "AC1021";
/// The header stands within the first lines.
const HEADER_LINES: usize = 4_000;

/// The text of a file, and a remark on how it was read where that is not certain.
pub(super) fn text(bytes: &[u8], told: &mut Remarks) -> String {
    if bytes.is_ascii() {
        return String::from_utf8_lossy(bytes).into_owned();
    }
    let utf8 = std::str::from_utf8(bytes).ok();
    let (version, page) = (header(bytes, "$ACADVER"), header(bytes, "$DWGCODEPAGE"));
    let unicode = version.is_some_and(|v| v.as_str() >= UNICODE);
    let named = page.as_deref().and_then(encoding);
    let one_byte = named.is_none_or(Encoding::is_single_byte);
    if let Some(text) = utf8.filter(|_| unicode || one_byte) {
        return text.strip_prefix('\u{feff}').unwrap_or(text).to_owned();
    }
    let (text, used, wrong) = named.unwrap_or(WINDOWS_1252).decode(bytes);
    match (&page, named, utf8) {
        // Text that is not valid in its code page, but is valid UTF-8, is read as UTF-8.
        (_, Some(_), Some(text)) if wrong => return text.to_owned(),
        (Some(page), Some(_), _) if wrong => told
            .warnings
            .push(format!("some letters are not in the code page {page} that the file names: they are read as \u{fffd}")),
        (Some(page), Some(_), _) => told.notes.push(format!("names are read in the file's code page, {page}")),
        (Some(page), None, _) => told.warnings.push(format!(
            "the file's code page, \"{page}\", is not known: names are read as {}; look whether they are right",
            used.name()
        )),
        (None, _, _) => told.warnings.push(format!(
            "the file does not say its code page: names are read as {}; look whether they are right",
            used.name()
        )),
    }
    text.into_owned()
}

/// The value of a variable of the header.
fn header(bytes: &[u8], variable: &str) -> Option<String> {
    let mut lines = bytes.split(|b| *b == b'\n').take(HEADER_LINES).map(<[u8]>::trim_ascii);
    lines.find(|line| *line == variable.as_bytes())?;
    lines.nth(1).map(|value| String::from_utf8_lossy(value).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(version: &str, page: &str, name: &[u8]) -> Vec<u8> {
        let head = format!("  9\n$ACADVER\n  1\n{version}\n  9\n$DWGCODEPAGE\n  3\n{page}\n  1\n");
        [head.as_bytes(), name, b"\n"].concat()
    }

    #[test]
    fn letters_are_those_of_the_code_page() {
        for (page, name) in [
            ("ANSI_936", "前片"),
            ("ansi_932", "前身頃"),
            ("ANSI_949", "앞판"),
            ("ANSI_950", "前片腰頭"),
            ("ANSI_1251", "Перед"),
            ("ANSI_1250", "Przód"),
            ("ANSI_1253", "Εμπρός"),
            ("ANSI_1255", "קדמי"),
            ("ANSI_1256", "أمام"),
            ("ANSI_874", "หน้า"),
            ("DOS866", "Перед"),
            ("gb2312", "后片"),
        ] {
            let page_of = encoding(page).unwrap_or(WINDOWS_1252);
            let (bytes, _, wrong) = page_of.encode(name);
            assert!(!wrong, "{page}");
            let mut told = Remarks::default();
            let read = text(&file("AC1009", page, &bytes), &mut told);
            assert!(read.contains(name), "{page}: {read}");
            assert_eq!(told.notes, [format!("names are read in the file's code page, {page}")]);
        }
    }

    #[test]
    fn what_is_utf_8_is_read_as_that() {
        for (version, page) in [("AC1027", "ANSI_936"), ("AC1009", "ANSI_1252"), ("AC1009", "nothing")] {
            let mut told = Remarks::default();
            assert!(text(&file(version, page, "Rücken 前".as_bytes()), &mut told).contains("Rücken 前"));
            assert_eq!(told, Remarks::default());
        }
    }

    #[test]
    fn a_code_page_that_is_missing_or_not_known_is_told() {
        let warned = |bytes: &[u8]| {
            let mut told = Remarks::default();
            let read = text(bytes, &mut told);
            assert!(read.contains("Rücken"), "{read}");
            told.warnings
        };
        assert_eq!(
            warned(b"  1\nR\xfccken\n"),
            [
                "the file does not say its code page: names are read as windows-1252; look whether they are right"
            ]
        );
        assert_eq!(
            warned(&file("AC1009", "dos850", b"R\xfccken")),
            [
                "the file's code page, \"dos850\", is not known: names are read as windows-1252; look whether they are right"
            ]
        );
    }
}
