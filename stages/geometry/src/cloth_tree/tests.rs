#![allow(clippy::unwrap_used)]

use super::features::Owned;
use super::*;
use crate::shapes::{sheet, soup};
use crate::volume::{BoundingSphere, KDop, Obb};
use proptest::prelude::*;

#[test]
fn every_vertex_and_edge_has_one_owner() {
    let (x, triangles) = sheet(5, |_, _| 0.0);
    let tree = ClothTree::new(&triangles, &x);
    let count = |of: fn(&Owned) -> &[bool; 3]| tree.features.owns.iter().flat_map(of).filter(|o| **o).count();
    assert_eq!(count(|o| &o.0), x.len());
    // Euler: vertices - edges + faces = 1 for a disc.
    assert_eq!(count(|o| &o.1), x.len() + triangles.len() - 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn cloth_that_rests_has_the_same_pairs_by_all_volumes(
        seed in 0u64..1 << 32, count in 1u32..120, size in 0.02..0.5, reach in 0.0..0.2,
    ) {
        let (x, triangles) = soup(seed, count, size);
        let moves = vec![Vec3::zeros(); x.len()];
        let boxes = ClothTree::new(&triangles, &x).pairs(&x, &moves, reach);
        prop_assert_eq!(&ClothTree::<BoundingSphere>::of(&triangles, &x).pairs(&x, &moves, reach), &boxes);
        prop_assert_eq!(&ClothTree::<Obb>::of(&triangles, &x).pairs(&x, &moves, reach), &boxes);
        prop_assert_eq!(&ClothTree::<KDop<13>>::of(&triangles, &x).pairs(&x, &moves, reach), &boxes);
    }
}
