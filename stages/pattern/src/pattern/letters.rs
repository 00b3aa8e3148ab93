//! The letters of a drawing: encodings by the names that programs and people give them.

use encoding_rs::{Encoding, UTF_8};
use thiserror::Error;

/// The encoding of a name: `ANSI_936`, `dos932`, `GB2312`, `windows-1252`, `UTF-8`.
pub(super) fn encoding(name: &str) -> Option<&'static Encoding> {
    let small = name.trim().to_ascii_lowercase();
    let digits: String = small.chars().filter(char::is_ascii_digit).collect();
    let label = match digits.as_str() {
        _ if small.contains("iso") || small.contains("8859") => small.replace('_', "-"),
        "932" => "shift_jis".into(),
        "936" | "2312" | "18030" => "gb18030".into(),
        "949" | "5601" => "euc-kr".into(),
        "950" => "big5".into(),
        "874" => "windows-874".into(),
        "866" => "ibm866".into(),
        "65001" => "utf-8".into(),
        page if page.starts_with("125") => format!("windows-{page}"),
        _ => small,
    };
    Encoding::for_label(label.as_bytes()).filter(|e| *e != UTF_8 || label.contains("utf"))
}

/// Why the letters of a file cannot be read as asked.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum LettersFault {
    #[error("there is no encoding \"{name}\"")]
    Unknown { name: String },
    #[error("it is not text in \"{name}\"")]
    Other { name: String },
}

impl LettersFault {
    /// What the user may do about it.
    pub(super) fn remedy(&self) -> String {
        let usual = "\"utf-8\", \"windows-1252\", \"shift_jis\", \"gb18030\" or \"big5\"";
        match self {
            LettersFault::Unknown { .. } => {
                format!("write one such as {usual}, or leave `encoding` out: the file mostly says it")
            }
            LettersFault::Other { .. } => {
                format!("write another, such as {usual}, or leave `encoding` out: the file mostly says it")
            }
        }
    }
}

/// The text of bytes in the encoding of that name.
///
/// Errors: there is none of that name, or the bytes are no text in it.
pub(super) fn decoded(bytes: &[u8], name: &str) -> Result<String, LettersFault> {
    let name = name.trim().to_owned();
    let Some(found) = encoding(&name) else { return Err(LettersFault::Unknown { name }) };
    let (text, _, wrong) = found.decode(bytes);
    if wrong { Err(LettersFault::Other { name }) } else { Ok(text.into_owned()) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::{any, proptest};

    #[test]
    fn an_encoding_that_there_is_none_of_is_refused_with_some_that_there_are() {
        let fault = decoded(b"front", "latin 9000").unwrap_err();
        assert_eq!(fault.to_string(), "there is no encoding \"latin 9000\"");
        assert_eq!(
            fault.remedy(),
            "write one such as \"utf-8\", \"windows-1252\", \"shift_jis\", \"gb18030\" or \"big5\", or leave `encoding` out: the file mostly says it"
        );
        let fault = decoded(b"R\xfccken", "utf-8").unwrap_err();
        assert_eq!(fault.to_string(), "it is not text in \"utf-8\"");
        assert_eq!(decoded(b"R\xfccken", "ANSI_1252").unwrap(), "Rücken");
        assert_eq!(decoded(&[0x91, 0x4f], "dos932").unwrap(), "前");
    }

    proptest! {
        #[test]
        fn any_bytes_in_any_encoding_are_text_or_refused(
            bytes in proptest::collection::vec(any::<u8>(), 0..64), name in ".{0,16}",
        ) {
            if let Ok(text) = decoded(&bytes, &name) {
                assert!(encoding(&name).is_some() && text.len() <= 3 * bytes.len());
            }
        }
    }
}
