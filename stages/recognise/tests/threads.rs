//! The same bits for any number of threads, with the program's own network.

use crate::spoilt::picture;
use toile_recognise::{Part, SeenGarment, see};

fn bits(seen: &SeenGarment) -> Vec<u64> {
    let maps = Part::ALL.iter().flat_map(|part| seen.map(*part)).map(|share| u64::from(share.to_bits()));
    let marks =
        seen.landmarks().iter().flat_map(|mark| [mark.place.x, mark.place.y, mark.presence, mark.share]);
    let kinds = seen.kinds().iter().map(|kind| kind.1);
    let limbs = toile_recognise::Limb::ALL.into_iter().flat_map(|limb| seen.limb(limb).map(|lie| lie.1));
    let rest = marks.chain(kinds).chain(limbs).chain([seen.hanger(), seen.flat(), seen.whole()]);
    maps.chain(rest.map(f64::to_bits)).collect()
}

#[test]
fn it_gives_the_same_bits_for_any_number_of_threads() {
    for case in 0..4 {
        let photo = picture(case);
        let first = bits(&see(&photo, 1).unwrap());
        assert!([0, 1, 2, 3, 5, 8].into_iter().all(|threads| bits(&see(&photo, threads).unwrap()) == first));
    }
}

#[test]
fn pictures_have_the_same_bits_for_any_number_of_threads() {
    let seen = see(&picture(1), 1).unwrap();
    let made = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (seen.mask(301, 203), seen.part_map(301, 203)))
    };
    let first = made(1);
    assert!([2, 3, 5].into_iter().all(|threads| made(threads) == first));
}
