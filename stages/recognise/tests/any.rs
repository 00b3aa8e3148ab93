//! Files and photos of any kind: refused in words or answered.

use crate::kit::{boxed, check, tiny};
use image::{Rgb, RgbImage};
use proptest::prelude::*;
use toile_recognise::{PartsNetwork, see};

/// Whatever stands in the file, a photo is answered soundly or the file refused in words.
fn holds(bytes: &[u8]) -> Result<(), TestCaseError> {
    let photo = boxed(30, 20, (5, 5, 20, 15));
    match PartsNetwork::load_other(bytes).and_then(|network| network.see(&photo, 1)) {
        Ok(seen) => prop_assert_eq!(check(&seen, (30, 20)), Ok(())),
        Err(e) => prop_assert!(!e.to_string().is_empty() && e.to_string().chars().count() < 400),
    }
    Ok(())
}

/// A photo whose levels depend on places by a seed.
fn photo(width: u32, height: u32, seed: u32) -> RgbImage {
    let at = |x: u32, y: u32, k: u32| (x.wrapping_mul(k * 7919) ^ y.wrapping_mul(seed + k)) as u8;
    RgbImage::from_fn(width, height, |x, y| Rgb([1, 3, 5].map(|k| at(x, y, k))))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_photo_is_answered(w in 1u32..600, h in 1u32..600, seed in 0u32..1 << 20) {
        let seen = see(&photo(w, h, seed), 1).unwrap();
        prop_assert_eq!(check(&seen, (w, h)), Ok(()));
    }

    #[test]
    fn a_narrow_photo_is_answered(long in 1u32..6000, narrow in 1u32..4, upright: bool, seed in 0u32..1 << 20) {
        let (w, h) = if upright { (narrow, long) } else { (long, narrow) };
        let seen = see(&photo(w, h, seed), 1).unwrap();
        prop_assert_eq!(check(&seen, (w, h)), Ok(()));
    }

    #[test]
    fn any_bytes_are_refused_in_words(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        holds(&bytes)?;
    }

    #[test]
    fn a_network_that_was_cut_short_is_refused_in_words(end in 0usize..1 << 16) {
        let bytes = tiny().file();
        holds(&bytes[..end % bytes.len()])?;
    }

    #[test]
    fn a_network_with_a_spoilt_byte_is_refused_or_run(at in 0usize..1 << 16, to: u8) {
        let mut bytes = tiny().file();
        let at = at % bytes.len();
        bytes[at] = to;
        holds(&bytes)?;
    }
}
