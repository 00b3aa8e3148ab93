//! Pages of every size.

use crate::common::*;
use proptest::prelude::*;
use toile_pattern_files::pdf::{MOST_PAGES, Paper, to_pdf};
use toile_pattern_files::{DrawingOptions, WriteError};

/// Millimetres of a point of PDF.
const POINT: f64 = 25.4 / 72.0;

/// The sizes of a file's pages, mm.
fn boxes(bytes: &[u8]) -> Vec<[f64; 2]> {
    let text = String::from_utf8_lossy(bytes);
    let one = |rest: &str| {
        let (numbers, _) = rest.split_once(']').unwrap();
        let numbers: Vec<f64> = numbers.split_whitespace().map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers[..2], [0.0, 0.0]);
        [numbers[2] * POINT, numbers[3] * POINT]
    };
    text.split("/MediaBox [").skip(1).map(one).collect()
}

fn is_size(found: &[f64; 2], wanted: [f64; 2]) -> bool {
    (0..2).all(|k| (found[k] - wanted[k]).abs() < 1e-3)
}

#[test]
fn pages_have_the_size_that_is_asked_for() {
    let sizes = [
        (Paper::A0, [841.0, 1189.0]),
        (Paper::A1, [594.0, 841.0]),
        (Paper::A2, [420.0, 594.0]),
        (Paper::A3, [297.0, 420.0]),
        (Paper::A4, [210.0, 297.0]),
        (Paper::Letter, [215.9, 279.4]),
        (Paper::Legal, [215.9, 355.6]),
        (Paper::Tabloid, [279.4, 431.8]),
        (Paper::Custom(0.6, 0.9), [600.0, 900.0]),
        (Paper::Custom(0.297, 0.21), [297.0, 210.0]),
    ];
    let mut counts = Vec::new();
    for (paper, size) in sizes {
        let pages = boxes(&to_pdf(&blouse(), paper, &DrawingOptions::default()).unwrap().bytes);
        assert!(pages.iter().all(|page| is_size(page, size)), "{paper:?}: {pages:?}");
        counts.push(pages.len());
    }
    // The first page, the order of sewing, and two with the pieces: the band is wider than one.
    assert_eq!(counts[0], 4);
    assert!(counts[..5].is_sorted(), "{counts:?}");
}

#[test]
fn pages_that_cannot_be_printed_are_refused() {
    let refused = |width: f64, height: f64| {
        let e = to_pdf(&blouse(), Paper::Custom(width, height), &DrawingOptions::default()).unwrap_err();
        (e.to_string(), e.remedy())
    };
    assert_eq!(
        refused(0.148, 0.21),
        (
            "a page of 148 mm by 210 mm is too small for its margins and the test square: 200 mm by 210 mm are the least"
                .into(),
            "take A4, Letter or a larger page"
        )
    );
    assert_eq!(
        refused(0.9, 6.0),
        (
            "a page of 900 mm by 6000 mm is too large: 5080 mm are the most".into(),
            "take A0 or a smaller page"
        )
    );
    assert!(refused(f64::NAN, 1.0).0.starts_with("a page of NaN mm"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_page_of_any_size_is_written_or_refused(width in 0.1..5.4_f64, height in 0.1..5.4_f64) {
        match to_pdf(&blouse(), Paper::Custom(width, height), &DrawingOptions::default()) {
            Ok(written) => {
                let pages = boxes(&written.bytes);
                prop_assert!(pages.iter().all(|page| is_size(page, [width * 1e3, height * 1e3])));
                prop_assert!(pages.len() > 2 && pages.len() <= MOST_PAGES);
            }
            Err(WriteError::SmallPage { .. }) => prop_assert!(width < 0.2 || height < 0.21),
            Err(WriteError::LargePage { .. }) => prop_assert!(width > 5.08 || height > 5.08),
            Err(e) => prop_assert!(false, "{}", e),
        }
    }
}
