//! What the tiny network sees, and what is made of it.

use crate::kit::{NOT, boxed, check, seen, tiny, values};
use image::{Rgb, RgbImage};
use toile_recognise::{GRID, GarmentKind, Landmark, Lie, Limb, Part, PartsNetwork, SIDE, see};

#[test]
fn what_is_light_is_garment() {
    let photo = boxed(300, 300, (100, 50, 200, 250));
    let seen = seen(&photo);
    assert!(seen.probability(Part::Body, 150.0, 150.0) > 0.99);
    assert!(seen.probability(Part::Ground, 20.0, 150.0) > 0.99);
    let mask = seen.mask(300, 300);
    let wrong = mask.iter().zip(photo.pixels()).filter(|(share, pixel)| (**share > 0.5) != (pixel.0[0] > 99));
    assert!(wrong.count() < 600, "a border of 600 px is off by less than 1 px");
}

#[test]
fn the_parts_of_a_picture_are_those_of_its_places() {
    let seen = seen(&boxed(90, 60, (20, 10, 50, 40)));
    let parts = seen.part_map(90, 60);
    let mask = seen.mask(90, 60);
    for (at, part) in parts.iter().enumerate() {
        let (x, y) = ((at % 90) as f64, (at / 90) as f64);
        let best = Part::ALL.into_iter().all(|p| seen.probability(p, x, y) <= seen.probability(*part, x, y));
        assert!(best, "{x} {y} {part}");
        let garment: f64 =
            Part::ALL.into_iter().filter(|p| p.is_garment()).map(|p| seen.probability(p, x, y)).sum();
        assert!((garment - f64::from(mask[at])).abs() < 1e-5, "{x} {y}");
    }
    assert!(parts.contains(&Part::Ground) && parts.contains(&Part::Body));
}

#[test]
fn hanger_and_ground_are_no_garment() {
    let mut net = tiny();
    *values(&mut net, "part_shift") = crate::kit::but::<11>(NOT, &[(0, 0.0), (10, 0.0), (8, 0.0), (2, 0.0)]);
    let seen = PartsNetwork::load_other(&net.file()).unwrap().see(&boxed(40, 40, (0, 0, 1, 1)), 1).unwrap();
    assert!(seen.mask(4, 4).iter().all(|share| (share - 0.5).abs() < 1e-3));
    // Of equal parts the first.
    assert!(seen.part_map(4, 4).iter().all(|part| *part == Part::Ground));
}

#[test]
fn a_garment_that_the_frame_cuts_is_whole_at_the_frame() {
    for (width, height) in [(400, 100), (100, 400), (37, 300)] {
        let seen = seen(&RgbImage::from_pixel(width, height, Rgb([250; 3])));
        assert!(seen.mask(width as usize, height as usize).iter().all(|share| *share > 0.99));
        assert!(seen.map(Part::Ground)[0] > 0.9, "the black beside the photo");
    }
}

#[test]
fn kinds_come_likeliest_first() {
    let seen = seen(&boxed(10, 10, (0, 0, 5, 5)));
    let kinds: Vec<GarmentKind> = seen.kinds().iter().take(3).map(|kind| kind.0).collect();
    assert_eq!(kinds, [GarmentKind::Trousers, GarmentKind::Shirt, GarmentKind::Tshirt]);
    let sum = 2f64.exp() + 1f64.exp() + 10.0;
    assert!((seen.kinds()[0].1 - 2f64.exp() / sum).abs() < 1e-6);
    assert_eq!(seen.kinds().len(), 12);
}

#[test]
fn limbs_and_flags_are_in_their_order() {
    let seen = seen(&boxed(10, 10, (0, 0, 5, 5)));
    let first = Limb::ALL.map(|limb| seen.limb(limb)[0].0);
    assert_eq!(first, [Lie::Apart, Lie::Folded, Lie::Absent, Lie::Absent]);
    assert_eq!(seen.limb(Limb::LegLeft)[1].0, Lie::Over);
    assert!((seen.limb(Limb::SleeveLeft)[0].1 - 5f64.exp() / (5f64.exp() + 4.0)).abs() < 1e-6);
    let logistic = |logit: f64| 1.0 / (1.0 + (-logit).exp());
    assert!((seen.hanger() - logistic(-2.0)).abs() < 1e-6);
    assert!((seen.flat() - 0.5).abs() < 1e-6);
    assert!((seen.whole() - logistic(2.0)).abs() < 1e-6);
}

#[test]
fn names_are_those_of_training() {
    assert_eq!(Part::ALL.map(Part::name)[2..4], ["sleeve_left", "sleeve_right"]);
    assert_eq!(GarmentKind::Onepiece.to_string(), "onepiece");
    assert_eq!(Landmark::ALL.map(Landmark::name)[19], "leg_right_inner");
    assert_eq!(Lie::ALL.map(Lie::name), ["absent", "apart", "beside", "over", "folded"]);
    assert_eq!(Limb::ALL.map(Limb::name), ["sleeve_left", "sleeve_right", "leg_left", "leg_right"]);
}

#[test]
fn channels_are_red_green_blue() {
    let mut net = tiny();
    let slopes = values(&mut net, "part_slopes");
    let cell = slopes.len() / 33;
    slopes.iter_mut().enumerate().for_each(|(i, slope)| {
        *slope = if i / cell == 3 { 20.0 / cell as f32 } else { 0.0 };
    });
    let network = PartsNetwork::load_other(&net.file()).unwrap();
    let is_body = |pixel: [u8; 3]| {
        let photo = RgbImage::from_pixel(30, 20, Rgb(pixel));
        network.see(&photo, 1).unwrap().part_map(1, 1) == [Part::Body]
    };
    assert_eq!([[250, 20, 20], [20, 250, 20], [20, 20, 250]].map(is_body), [true, false, false]);
}

#[test]
fn one_pixel_is_a_photo() {
    let light = seen(&RgbImage::from_pixel(1, 1, Rgb([255; 3])));
    assert_eq!(light.part_map(2, 2), [Part::Body; 4]);
    assert_eq!(check(&light, (1, 1)), Ok(()));
    let own = see(&RgbImage::from_pixel(1, 1, Rgb([90; 3])), 1).unwrap();
    assert_eq!(check(&own, (1, 1)), Ok(()));
}

#[test]
fn levels_are_means_of_areas() {
    // Stripes of one pixel: each cell is as light as their mean.
    let stripes = RgbImage::from_fn(6 * SIDE as u32, 400, |x, _| Rgb([if x % 2 == 0 { 255 } else { 0 }; 3]));
    let seen = seen(&stripes);
    let middle = seen.probability(Part::Body, 500.0, 200.0);
    assert!((middle - 0.5).abs() < 1e-3, "{middle}");
    assert_eq!(seen.map(Part::Body).len(), GRID * GRID);
}
