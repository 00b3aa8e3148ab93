//! Widths and letters of the two fonts of pages, Helvetica and Helvetica-Bold, which every reader
//! of PDF has; drawings without fonts of their own are laid out by them too.
//!
//! Limits: letters of Western Europe (Windows code page 1252); others become a question mark.
//! Widths are those of the plain font; bold text is taken for a tenth wider.

/// Letters of code page 1252 from 0x80, where it differs from Latin-1; a space where it has none.
const FROM_80: [char; 32] = [
    '€', ' ', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', ' ', 'Ž', ' ', ' ', '‘', '’', '“', '”',
    '•', '–', '—', '˜', '™', 'š', '›', 'œ', ' ', 'ž', 'Ÿ',
];

/// Widths from the space to the tilde, thousandths of the size (Adobe's metrics of Helvetica).
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556,
    556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278,
    500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469,
    556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500,
    278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];
/// Of every other letter.
const OTHER: u16 = 610;

/// A text as bytes of the fonts' encoding.
pub(crate) fn encoded(text: &str) -> Vec<u8> {
    let one = |c: char| match u32::from(c) {
        code @ (0x20..=0x7e | 0xa0..=0xff) => code as u8,
        _ if c.is_control() => b' ',
        _ => FROM_80.iter().position(|k| *k == c && c != ' ').map_or(b'?', |k| 0x80 + k as u8),
    };
    text.chars().map(one).collect()
}

/// Whether all letters of a text are in the fonts.
pub(crate) fn holds(text: &str) -> bool {
    text.chars().all(|c| {
        let code = u32::from(c);
        matches!(code, 0x20..=0x7e | 0xa0..=0xff) || FROM_80.contains(&c)
    })
}

/// How wide a text of that size is, in the unit of the size.
pub(crate) fn width(text: &str, size: f64, bold: bool) -> f64 {
    let one = |c: char| {
        let k = (c as usize).wrapping_sub(0x20);
        f64::from(WIDTHS.get(k).copied().unwrap_or(OTHER))
    };
    let plain: f64 = text.chars().map(one).sum();
    plain * size / 1000.0 * if bold { 1.1 } else { 1.0 }
}

/// A text in lines no wider than that, broken at spaces, and within words that are too long.
pub(crate) fn wrapped(text: &str, size: f64, most: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    let fits = |line: &str| width(line, size, false) <= most;
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let joined = if lines[last].is_empty() { word.to_owned() } else { format!("{} {word}", lines[last]) };
        if fits(&joined) {
            lines[last] = joined;
            continue;
        }
        if !lines[last].is_empty() {
            lines.push(String::new());
        }
        for c in word.chars() {
            let last = lines.len() - 1;
            if !fits(&format!("{}{c}", lines[last])) && !lines[last].is_empty() {
                lines.push(String::new());
            }
            let last = lines.len() - 1;
            lines[last].push(c);
        }
    }
    lines
}

/// A text of one line no wider than that, its end cut off where it is.
pub(crate) fn shortened(text: &str, size: f64, bold: bool, most: f64) -> String {
    if width(text, size, bold) <= most {
        return text.to_owned();
    }
    let mut out = String::new();
    for c in text.chars() {
        if width(&format!("{out}{c}..."), size, bold) > most {
            break;
        }
        out.push(c);
    }
    out.trim_end().to_owned() + "..."
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_the_code_page_are_kept_and_others_asked_for() {
        assert_eq!(encoded("Ä–€"), [0xc4, 0x96, 0x80]);
        assert_eq!(encoded("袖\n"), [b'?', b' ']);
        assert!(holds("Ärmel – 2") && !holds("袖"));
    }

    #[test]
    fn lines_are_no_wider_than_asked() {
        let text = "left_sleeve_front.lower_interface and averyveryverylongnamewithoutanyspace";
        let lines = wrapped(text, 3.0, 30.0);
        assert!(lines.len() > 3 && lines.iter().all(|l| width(l, 3.0, false) <= 30.0), "{lines:?}");
        assert_eq!(shortened("sleeve", 3.0, false, 30.0), "sleeve");
        assert!(shortened(text, 3.0, false, 30.0).ends_with("..."));
    }
}
