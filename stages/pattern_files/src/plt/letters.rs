//! Letters of single strokes, drawn for this writer.
//!
//! Method: each letter is a few polylines on a grid of 7 by 10 points; letters with accents are put
//! together from a letter and an accent. A letter is as wide as that of Helvetica, so that words
//! that are laid out for pages fit on plots, too. The instruction `LB`, by which a plotter draws
//! letters of its own, is not used: cutters have none, and plotters differ in their letters, in
//! their sizes and in the turns that they take.
//!
//! Limits: Latin letters of most languages of Europe; others become a question mark. Bold text is
//! set wider, its strokes are the same.

use crate::font;

/// The height of capitals, as a share of the size (Adobe's metrics of Helvetica).
const CAPITALS: f64 = 0.718;
/// Capitals stand from this row of the grid to that.
const BASE: f64 = 2.0;
const TOP: f64 = 8.0;
/// The last column of the grid.
const RIGHT: f64 = 6.0;
/// White on each side of a letter, as a share of its width.
const SIDE: f64 = 0.12;
/// How far the accents of capitals stand above those of small letters, rows.
const RAISED: f64 = 2.0;

/// Letters by their strokes, each a list of points: a digit for the column, a digit for the row.
const LETTERS: &[(char, &str)] = &[
    (' ', ""),
    ('!', "3834 3332"),
    ('"', "1816 5856"),
    ('#', "2228 4248 0464 0666"),
    ('$', "675818070615556463521203 3931"),
    ('%', "0268 0718271607 4354635243"),
    ('&', "621617283847460403123265"),
    ('\'', "3836"),
    ('(', "48262341"),
    (')', "28464321"),
    ('*', "3834 1755 1557"),
    ('+', "3733 1555"),
    (',', "3321"),
    ('-', "1555"),
    ('.', "3332"),
    ('/', "0268"),
    ('0', "125263675818070312"),
    ('1', "173832"),
    ('2', "07185867660262"),
    ('3', "07185867665525 556463521203"),
    ('4', "42480464"),
    ('5', "680805556463521203"),
    ('6', "675818070312526364551504"),
    ('7', "086822"),
    ('8', "15060718586766551504031252636455"),
    ('9', "031252636758180706155566"),
    (':', "3635 3332"),
    (';', "3635 3321"),
    ('<', "571553"),
    ('=', "1656 1454"),
    ('>', "175513"),
    ('?', "07185867663534 3332"),
    ('@', "4626244446 446467581807031252"),
    ('A', "023862 1454"),
    ('B', "0545565748080252636445"),
    ('C', "6758280604225263"),
    ('D', "02084866644202"),
    ('E', "62020868 0545"),
    ('F', "020868 0545"),
    ('G', "67582806042252636535"),
    ('H', "0208 6268 0565"),
    ('I', "3238"),
    ('J', "585342120304"),
    ('K', "0208 6805 2662"),
    ('L', "080262"),
    ('M', "0208346862"),
    ('N', "02086268"),
    ('O', "224264664828060422"),
    ('P', "02085867665505"),
    ('Q', "224264664828060422 4462"),
    ('R', "02085867665505 3562"),
    ('S', "675818070615556463521203"),
    ('T', "0868 3832"),
    ('U', "080312526368"),
    ('V', "083268"),
    ('W', "0812365268"),
    ('X', "0268 0862"),
    ('Y', "083568 3532"),
    ('Z', "08680262"),
    ('[', "48282141"),
    ('\\', "0862"),
    (']', "28484121"),
    ('^', "163856"),
    ('_', "0161"),
    ('`', "2847"),
    ('a', "6662 6546260503224263"),
    ('b', "0802 0526466563422203"),
    ('c', "6546260503224263"),
    ('d', "6862 6546260503224263"),
    ('e', "04646546260503225263"),
    ('f', "58483732 1656"),
    ('g', "6661501001 6546260503224263"),
    ('h', "0802 0526466562"),
    ('i', "3632 3837"),
    ('j', "46413020 4847"),
    ('k', "0802 6603 2462"),
    ('l', "3832"),
    ('m', "0602 0516263532 3546566562"),
    ('n', "0602 0526466562"),
    ('o', "224263654626050322"),
    ('p', "0600 0526466563422203"),
    ('q', "6660 6546260503224263"),
    ('r', "1612 143656"),
    ('s', "65561605145463521203"),
    ('t', "38334252 1656"),
    ('u', "0603224263 6662"),
    ('v', "063266"),
    ('w', "0612355266"),
    ('x', "0266 0662"),
    ('y', "0632 6620"),
    ('z', "06660262"),
    ('{', "48383625343141"),
    ('|', "3831"),
    ('}', "28383645343121"),
    ('~', "041525445465"),
    ('¡', "3632 3837"),
    ('£', "57483827231262 1545"),
    ('«', "361432 561452"),
    ('°', "2738473627"),
    ('·', "3534"),
    ('»', "163412 365432"),
    ('¿', "3837 36350403125263"),
    ('×', "1357 1753"),
    ('ß', "02071848574635 3564635232"),
    ('Æ', "02383262 3868 3555 1434"),
    ('Ð', "02084866644202 0535"),
    ('Ø', "224264664828060422 0268"),
    ('æ', "3526160503122233 3632 34646556463533425263"),
    ('ø', "224263654626050322 0266"),
    ('đ', "6862 6546260503224263 4767"),
    ('ı', "3632"),
    ('Ł', "080262 0435"),
    ('ł', "3832 1446"),
    ('Œ', "682806042262 3832 3555"),
    ('œ', "3526160503122233 34646556463533425263"),
    ('–', "0565"),
    ('—', "0565"),
    ('‘', "3827"),
    ('’', "3827"),
    ('‚', "3322"),
    ('“', "2817 5847"),
    ('”', "2817 5847"),
    ('„', "2312 5342"),
    ('•', "2444462624"),
    ('…', "0302 3332 6362"),
    ('€', "6758280604225263 0444 0646"),
];

/// Accents over small letters by their strokes, and the letters that have them, each with the one
/// that it stands on.
const ACCENTS: &[(&str, &str)] = &[
    ("2748", "ÁAÉEÍIÓOÚUÝYáaéeíıóoúuýyĆCćcŃNńnŚSśsŹZźzĹLĺl"),
    ("4728", "ÀAÈEÌIÒOÙUàaèeìıòoùu"),
    ("173857", "ÂAÊEÎIÔOÛUâaêeîıôoûu"),
    ("17284758", "ÃAÑNÕOãañnõo"),
    ("1718 5758", "ÄAËEÏIÖOÜUŸYäaëeïıöoüuÿy"),
    ("2738473627", "ÅAåaŮUůu"),
    ("183758", "ŠSšsŽZžzČCčcŘRřrĚEěeŇNňnĎDďdŤTťt"),
    ("1728 4758", "ŐOőoŰUűu"),
    ("18275758", "ĂAăaĞGğg"),
    ("3738", "ŻZżzİI"),
];

/// What hangs below a letter, capital or small.
const BELOW: &[(&str, &str)] = &[("324120", "ÇCçcŞSşsȘSșsȚTțt"), ("524150", "ĄAąaĘEęe")];

/// Whether all letters of a text are among these.
pub(super) fn holds(text: &str) -> bool {
    text.chars().all(|c| strokes_of(c).is_some())
}

/// A text as lines, from the start of its base line, in the unit of the size.
pub(super) fn strokes(text: &str, size: f64, bold: bool) -> Vec<Vec<[f64; 2]>> {
    let mut out = Vec::new();
    let mut x = 0.0;
    for c in text.chars() {
        let wide = font::width(c.encode_utf8(&mut [0; 4]), size, bold);
        let known = if c.is_control() { strokes_of(' ') } else { strokes_of(c).or_else(|| strokes_of('?')) };
        let to = |[column, row]: [f64; 2]| {
            let across = SIDE + (1.0 - 2.0 * SIDE) * column / RIGHT;
            [x + across * wide, (row - BASE) / (TOP - BASE) * CAPITALS * size]
        };
        let lines = known.unwrap_or_default().into_iter();
        out.extend(lines.map(|line| line.into_iter().map(to).collect::<Vec<_>>()));
        x += wide;
    }
    out
}

/// The strokes of a letter on the grid.
fn strokes_of(c: char) -> Option<Vec<Vec<[f64; 2]>>> {
    if let Some((_, text)) = LETTERS.iter().find(|(known, _)| *known == c) {
        return Some(grid(text, 0.0));
    }
    let up = if c.is_uppercase() { RAISED } else { 0.0 };
    let (accent, base) = put_together(c, ACCENTS)
        .map(|(accent, base)| (grid(accent, up), base))
        .or_else(|| put_together(c, BELOW).map(|(accent, base)| (grid(accent, 0.0), base)))?;
    let (_, text) = LETTERS.iter().find(|(known, _)| *known == base)?;
    Some([grid(text, 0.0), accent].concat())
}

/// The accent of a letter, and the letter without it.
fn put_together(c: char, of: &[(&'static str, &str)]) -> Option<(&'static str, char)> {
    of.iter().find_map(|(accent, pairs)| {
        let mut pairs = pairs.chars();
        while let (Some(whole), Some(base)) = (pairs.next(), pairs.next()) {
            if whole == c {
                return Some((*accent, base));
            }
        }
        None
    })
}

/// Strokes from their digits, so many rows higher.
fn grid(text: &str, up: f64) -> Vec<Vec<[f64; 2]>> {
    let digit = |b: u8| f64::from(b.wrapping_sub(b'0'));
    let line =
        |digits: &str| digits.as_bytes().chunks_exact(2).map(|p| [digit(p[0]), digit(p[1]) + up]).collect();
    text.split_whitespace().map(line).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_letter_is_strokes_on_the_grid() {
        for (text, of) in LETTERS.iter().map(|(c, t)| (*t, *c)).chain(ACCENTS.iter().map(|(t, _)| (*t, '´')))
        {
            for line in text.split_whitespace() {
                assert!(line.len() >= 4 && line.len() % 2 == 0, "{of}: {line}");
                assert!(line.bytes().step_by(2).all(|b| (b'0'..=b'6').contains(&b)), "{of}: {line}");
                assert!(line.bytes().all(|b| b.is_ascii_digit()), "{of}: {line}");
            }
        }
        for (_, pairs) in ACCENTS.iter().chain(BELOW) {
            assert!(pairs.chars().count() % 2 == 0 && holds(pairs), "{pairs}");
        }
        assert!((' '..='~').all(|c| holds(&c.to_string())));
        assert!(!holds("袖"));
    }

    #[test]
    fn a_text_is_as_wide_as_that_of_pages() {
        let text = "Ärmel 2 – ½ 袖\n";
        let right = strokes(text, 5.0, false).concat().iter().map(|p| p[0]).fold(0.0, f64::max);
        assert!(right < font::width(text, 5.0, false));
        let tall = strokes("H", 10.0, false).concat().iter().map(|p| p[1]).fold(0.0, f64::max);
        assert!((tall - 7.18).abs() < 1e-9);
        assert_eq!(strokes("袖", 5.0, false).len(), strokes("?", 5.0, false).len());
    }
}
