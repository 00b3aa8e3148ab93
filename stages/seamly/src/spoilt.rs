//! Spoilt files: none panics, and none takes long.
#![allow(clippy::unwrap_used)]

use super::{Grade, LengthUnit, MeasurementTable, PatternHead, drafted};
use proptest::prelude::*;
use std::time::{Duration, Instant};

const PATTERN: &str = include_str!("../../../pipelines/samples/pattern/skirt.sm2d");
const MEASUREMENTS: &str = include_str!("../../../pipelines/samples/pattern/body.smis");
const BODICE: &str = include_str!("../../../pipelines/samples/pattern/bodice.val");

/// A way to spoil a text.
#[derive(Debug, Clone)]
enum Spoil {
    /// Takes out some characters.
    Cut(usize, usize),
    /// Puts words in.
    Put(usize, &'static str),
    /// Writes the text of one attribute into another.
    Swap(usize, usize),
}

fn spoil() -> impl Strategy<Value = Spoil> {
    let words = [
        "0",
        "-1",
        "1e300",
        "-1e300",
        "1/0",
        "\"",
        "<",
        "/>",
        "Line_A_B",
        "#length",
        "CurrentLength",
        "é",
        "(",
        "9999999999",
        "NaN",
        "1e-300",
        " id=\"1\"",
        "<point/>",
        "waist_circ*1e9",
        "-(2)^0.5",
    ];
    prop_oneof![
        (0usize..60_000, 1usize..60).prop_map(|(at, n)| Spoil::Cut(at, n)),
        (0usize..60_000, proptest::sample::select(words.to_vec())).prop_map(|(at, w)| Spoil::Put(at, w)),
        (0usize..4_000, 0usize..4_000).prop_map(|(a, b)| Spoil::Swap(a, b)),
    ]
}

fn spoilt(text: &str, all: &[Spoil]) -> String {
    let mut text = text.to_owned();
    for one in all {
        let mut chars: Vec<char> = text.chars().collect();
        let n = chars.len().max(1);
        match one {
            Spoil::Cut(at, count) => {
                let at = at % n;
                chars.drain(at..(at + count).min(chars.len()));
                text = chars.into_iter().collect();
            }
            Spoil::Put(at, words) => {
                let at = at % n;
                text =
                    chars[..at].iter().collect::<String>() + words + &chars[at..].iter().collect::<String>();
            }
            Spoil::Swap(a, b) => {
                let parts: Vec<&str> = text.split('"').collect();
                let values = (parts.len() / 2).max(1);
                let (a, b) = (2 * (a % values) + 1, 2 * (b % values) + 1);
                let mut swapped = parts.clone();
                if a < parts.len() && b < parts.len() {
                    swapped.swap(a, b);
                }
                text = swapped.join("\"");
            }
        }
    }
    text
}

fn read(pattern: &str, measurements: &str) {
    let begin = Instant::now();
    let table =
        MeasurementTable::read(measurements.as_bytes(), Grade::default(), LengthUnit::Centimetre).ok();
    let _ = PatternHead::read(pattern.as_bytes());
    match drafted(pattern.as_bytes(), table) {
        Ok(drafted) => assert!(!drafted.pieces.is_empty()),
        Err(all) => {
            assert!(!all.is_empty());
            all.iter().for_each(|f| assert!(!f.to_string().is_empty() && !f.remedy().is_empty()));
        }
    }
    assert!(begin.elapsed() < Duration::from_secs(20));
}

#[test]
fn the_samples_are_read_as_they_are() {
    for pattern in [PATTERN, BODICE] {
        let table = MeasurementTable::read(MEASUREMENTS.as_bytes(), Grade::default(), LengthUnit::Centimetre);
        let drafted = drafted(pattern.as_bytes(), Some(table.unwrap())).unwrap();
        assert!(drafted.warnings.is_empty(), "{:?}", drafted.warnings);
    }
}

proptest! {
    #[test]
    fn no_spoilt_pattern_panics(all in proptest::collection::vec(spoil(), 1..6), bodice in any::<bool>()) {
        read(&spoilt(if bodice { BODICE } else { PATTERN }, &all), MEASUREMENTS);
    }

    #[test]
    fn no_spoilt_measurements_panic(all in proptest::collection::vec(spoil(), 1..6)) {
        read(PATTERN, &spoilt(MEASUREMENTS, &all));
    }
}
