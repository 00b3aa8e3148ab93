//! Spoils files: what a hand, a broken program or a bad disk makes of a real one.

use crate::dice::Dice;
use std::ops::Range;

/// Numbers that are written where none such is expected.
const NUMBERS: [&str; 22] = [
    "0",
    "-0",
    "1",
    "-1",
    "0.5",
    "1e308",
    "-1e308",
    "1e999",
    "-1e999",
    "1e-320",
    "inf",
    "-inf",
    "NaN",
    "255",
    "65536",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775808",
    "123456789012345678901234567890123456789012345678901234567890",
    "0x7fffffffffffffff",
];
/// Words and signs that mean something in one of the forms.
const TOKENS: [&str; 30] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "\"",
    "\\",
    "\n",
    "\r\n",
    "\t",
    "//",
    "/*",
    "*/",
    "r#\"",
    "None",
    "Some(",
    "true",
    "null",
    "\u{feff}",
    "\0",
    "\u{202e}",
    "é",
    "\u{10ffff}",
    "v ",
    "f ",
    "f 1//1 -1 0\n",
    " +- ",
];
/// Brackets that are opened this often.
const DEPTHS: [usize; 4] = [10, 130, 2_000, 100_000];

/// A seed, spoilt in one to four ways.
pub(crate) fn text(seeds: &[Vec<u8>], dice: &mut Dice) -> Vec<u8> {
    let mut out = dice.pick(seeds).clone();
    for _ in 0..=dice.below(4) {
        match dice.below(14) {
            0 => out.truncate(dice.below(out.len() + 1)),
            1 => flip(&mut out, dice),
            2 => splice(&mut out, seeds, dice),
            3..=5 => number(&mut out, dice),
            6 => insert(&mut out, TOKENS[dice.below(TOKENS.len())].as_bytes(), dice),
            7 => nest(&mut out, dice),
            8 => doubled_line(&mut out, dice),
            9 => doubled_field(&mut out, dice),
            10 => swap_words(&mut out, dice),
            11 => drop_word(&mut out, dice),
            12 => {
                let gone = dice.range(out.len(), 200);
                out.drain(gone);
            }
            _ => {
                let twice = dice.range(out.len(), 400);
                let copy = out[twice].to_vec();
                insert(&mut out, &copy, dice);
            }
        }
    }
    out
}

/// A seed of numbers that are no text, spoilt in one to four ways.
pub(crate) fn binary(seeds: &[Vec<u8>], dice: &mut Dice) -> Vec<u8> {
    let mut out = dice.pick(seeds).clone();
    for _ in 0..=dice.below(4) {
        match dice.below(6) {
            0 => out.truncate(dice.below(out.len() + 1)),
            1 => flip(&mut out, dice),
            2 => splice(&mut out, seeds, dice),
            3 => {
                let gone = dice.range(out.len(), 64);
                out[gone].fill(0);
            }
            4 => word(&mut out, dice),
            _ => {
                let twice = dice.range(out.len(), 64);
                let copy = out[twice].to_vec();
                insert(&mut out, &copy, dice);
            }
        }
    }
    out
}

fn flip(out: &mut [u8], dice: &mut Dice) {
    let at = dice.below(out.len());
    if let Some(byte) = out.get_mut(at) {
        *byte ^= 1 << dice.below(8);
    }
}

/// The beginning of one file and the end of another.
fn splice(out: &mut Vec<u8>, seeds: &[Vec<u8>], dice: &mut Dice) {
    let other = dice.pick(seeds);
    out.truncate(dice.below(out.len() + 1));
    out.extend_from_slice(&other[dice.below(other.len() + 1)..]);
}

fn insert(out: &mut Vec<u8>, what: &[u8], dice: &mut Dice) {
    let at = dice.below(out.len() + 1);
    out.splice(at..at, what.iter().copied());
}

/// An aligned number of 32 or 64 bits at an edge of what it may be.
fn word(out: &mut [u8], dice: &mut Dice) {
    const EDGES: [u64; 8] = [0, 1, 7, 0xFFFF, 0x7FFF_FFFF, 0xFFFF_FFFF, 0x7FFF_FFFF_FFFF_FFFF, u64::MAX];
    let (size, edge) = (if dice.below(2) == 0 { 4 } else { 8 }, *dice.pick(&EDGES));
    let at = dice.below(out.len() / size) * size;
    if let Some(place) = out.get_mut(at..at + size) {
        place.copy_from_slice(&edge.to_le_bytes()[..size]);
    }
}

/// Where something like a word or a number stands, the first behind a random place.
fn find(out: &[u8], dice: &mut Dice, is: impl Fn(u8) -> bool) -> Option<Range<usize>> {
    let from = dice.below(out.len());
    let start = from + out.get(from..)?.iter().position(|b| is(*b))?;
    let end = start + out[start..].iter().take_while(|b| is(**b)).count();
    Some(start..end)
}

fn number(out: &mut Vec<u8>, dice: &mut Dice) {
    let digit = |b: u8| b.is_ascii_digit() || matches!(b, b'.' | b'-');
    if let Some(at) = find(out, dice, digit) {
        out.splice(at, dice.pick(&NUMBERS).bytes());
    }
}

fn is_word(b: u8) -> bool {
    b.is_ascii_alphanumeric() || b == b'_'
}

fn swap_words(out: &mut Vec<u8>, dice: &mut Dice) {
    let (a, b) = (find(out, dice, is_word), find(out, dice, is_word));
    if let (Some(a), Some(b)) = (a, b) {
        let word = out[a].to_vec();
        out.splice(b, word);
    }
}

fn drop_word(out: &mut Vec<u8>, dice: &mut Dice) {
    if let Some(at) = find(out, dice, is_word) {
        out.drain(at);
    }
}

fn nest(out: &mut Vec<u8>, dice: &mut Dice) {
    let open = *dice.pick(&["(", "[", "{", "[[", "{\"a\":", "Some(", "/*"]);
    let depth = *dice.pick(&DEPTHS);
    insert(out, open.repeat(depth).as_bytes(), dice);
}

fn doubled_line(out: &mut Vec<u8>, dice: &mut Dice) {
    if let Some(line) = find(out, dice, |b| b != b'\n') {
        let copy = [b"\n", &out[line.clone()]].concat();
        out.splice(line.end..line.end, copy);
    }
}

/// A field `name: value,` again, perhaps with another value.
fn doubled_field(out: &mut Vec<u8>, dice: &mut Dice) {
    if let Some(field) = find(out, dice, |b| !matches!(b, b',' | b'\n')) {
        let copy = [b",", &out[field.clone()]].concat();
        out.splice(field.end..field.end, copy);
    }
}
