#![allow(clippy::unwrap_used)]
use super::*;
use proptest::prelude::*;

fn size(pixels: f64, triangles: f64) -> Size {
    Size::new().with(Quantity::Pixels, pixels).with(Quantity::Triangles, triangles)
}

#[test]
fn entries_of_a_set_add_up_and_ports_of_one_photo_do_not() {
    assert_eq!(size(3.0, 5.0).plus(&size(4.0, 1.0)), size(7.0, 6.0));
    assert_eq!(size(3.0, 5.0).joined(&size(4.0, 1.0)), size(4.0, 5.0));
    let better = Size::new().with(Quantity::Triangles, 9.0);
    assert_eq!(size(3.0, 5.0).corrected(&better), size(3.0, 9.0));
}

#[test]
fn amounts_that_cannot_be_are_not_known() {
    for amount in [f64::NAN, f64::INFINITY, -1.0] {
        assert!(Size::new().with(Quantity::Pixels, amount).is_empty());
    }
    let read: Size = serde_json::from_str("{\"pixels\":-4,\"area\":0.5}").unwrap();
    assert_eq!((read.get(Quantity::Pixels), read.get(Quantity::Area)), (None, Some(0.5)));
}

#[test]
fn a_garment_in_an_upright_frame_is_longer_than_wide() {
    let (square, upright) = (garment_area(1000.0, 1000.0, 0.5), garment_area(1000.0, 1400.0, 0.5));
    assert!((square - 0.745 * 0.25).abs() < 1e-12);
    assert!((upright / square - 1.4).abs() < 1e-12);
    // A strip of a frame says nothing of the garment.
    assert!((garment_area(10.0, 10_000.0, 0.5) / square - 3.0).abs() < 1e-12);
}

#[test]
fn a_range_holds_its_ends() {
    let e = Estimate { value: 2.0, low: 1.0, high: 4.0 };
    assert!(e.holds(1.0) && e.holds(4.0) && !e.holds(0.99) && !e.holds(4.01));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_size_comes_back_from_its_text(pixels in 0u64..1 << 40, triangles in 0u32..) {
        let own = size(pixels as f64, f64::from(triangles));
        prop_assert_eq!(serde_json::from_str::<Size>(&serde_json::to_string(&own).unwrap()).unwrap(), own);
    }
}
