//! Numbers, lists, names and texts of a USDA document.

use std::fmt::Write;

/// Decimals of unit vectors and shares: a hundredth of a degree.
pub(in crate::write) const UNIT: usize = 4;

/// A number with so many decimals at most: as short as it can be, without a minus before zero.
pub(in crate::write) fn number(value: f64, decimals: usize) -> String {
    let mut text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    if text == "-0" { "0".to_owned() } else { text }
}

/// A share of one, such as a colour or roughness, to four decimals.
pub(in crate::write) fn share(value: f32) -> String {
    number(f64::from(value), UNIT)
}

/// `(1, 2, 3)`.
pub(in crate::write) fn tuple(values: &[f64], decimals: usize) -> String {
    let numbers: Vec<String> = values.iter().map(|v| number(*v, decimals)).collect();
    format!("({})", numbers.join(", "))
}

/// `[a, b]`, of as many items as there are.
pub(in crate::write) fn list(items: impl Iterator<Item = String>) -> String {
    let mut text = String::from("[");
    for (i, item) in items.enumerate() {
        let _ = write!(text, "{}{item}", if i == 0 { "" } else { ", " });
    }
    text.push(']');
    text
}

/// A text in quotes; control characters become spaces.
pub(in crate::write) fn quoted(text: &str) -> String {
    let plain = text.replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{}\"", plain.replace(char::is_control, " "))
}

/// Names of prims and variants: ASCII letters, digits and `_`, no digit in front, no two alike.
pub(in crate::write) fn identifiers<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let lettered = |name: &str| {
        let text: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        if text.starts_with(|c: char| c.is_ascii_digit()) { format!("_{text}") } else { text }
    };
    let texts: Vec<String> = names.into_iter().map(lettered).collect();
    crate::file_names::plain_names(texts.iter().map(String::as_str))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written = [0.1 + 0.2, -0.000_000_1, 2.0, 1e-6, -12.5, 100.0].map(|v| number(v, 6));
        assert_eq!(written, ["0.3", "0", "2", "0.000001", "-12.5", "100"]);
        assert_eq!(number(100.0, 0), "100");
    }

    #[test]
    fn a_text_cannot_leave_its_quotes() {
        assert_eq!(quoted("a \"b\" \\\nc"), "\"a \\\"b\\\" \\\\ c\"");
    }

    #[test]
    fn names_are_identifiers_and_differ() {
        assert_eq!(
            identifiers(["left-front", "left front", "1st", ""]),
            ["left_front", "left_front_2", "_1st", "part"]
        );
    }
}
