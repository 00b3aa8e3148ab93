//! Files and photos of any kind: refused in words or answered.

use crate::kit::{given, run, tiny};
use image::{GrayImage, Luma, Rgb, RgbImage};
use proptest::prelude::*;
use toile_core::ErrorCode;
use toile_core::artifact::{Artifact, Photo, Shared};
use toile_core::testkit::shapes;

/// Whatever stands in the file, the run ends in a sound mask or in words.
fn holds(bytes: &[u8]) -> Result<(), TestCaseError> {
    let (dir, stage) = given(bytes);
    let photo = shapes::photo_from(RgbImage::from_fn(20, 30, |x, y| Rgb([(x * y) as u8; 3])));
    match run(&stage, &photo, dir.path()).0 {
        Ok(mask) => prop_assert_eq!(mask.check(), Ok(())),
        Err(e) => prop_assert!(e.code == ErrorCode::PatternLoading && e.hint.is_some(), "{:?}", e),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_bytes_are_refused_in_words(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        holds(&bytes)?;
    }

    #[test]
    fn a_network_that_was_cut_short_is_refused_in_words(end in 0usize..400) {
        let bytes = tiny().file();
        holds(&bytes[..end.min(bytes.len())])?;
    }

    #[test]
    fn a_network_with_a_spoilt_byte_is_refused_or_run(at in 0usize..400, to: u8) {
        let mut bytes = tiny().file();
        let at = at % bytes.len();
        bytes[at] = to;
        holds(&bytes)?;
    }

    #[test]
    fn any_photo_has_a_mask(w in 1u32..50, h in 1u32..50, seed in 0u32..1 << 20, opaque: bool) {
        let at = |x: u32, y: u32, k: u32| (x.wrapping_mul(k * 7919) ^ y.wrapping_mul(seed + k)) as u8;
        let pixels = RgbImage::from_fn(w, h, |x, y| Rgb([1, 3, 5].map(|k| at(x, y, k))));
        let alpha = (!opaque).then(|| Shared::new(GrayImage::from_fn(w, h, |x, y| Luma([at(x, y, 9)]))));
        let (dir, stage) = given(&tiny().file());
        let mask = run(&stage, &Photo { alpha, ..shapes::photo_from(pixels) }, dir.path()).0.unwrap();
        prop_assert_eq!(mask.pixels.dimensions(), (w, h));
        prop_assert_eq!(mask.check(), Ok(()));
    }
}
