//! Damaged meshes: whatever is broken, an answer or an error, never a panic.

use crate::care::{CareOptions, Objective, refine};
use crate::distortion::distortion;
use crate::energy::WovenStiffness;
use crate::flatteners::Placement;
use crate::islands::{islands_by_group, islands_by_seams, islands_by_uv, split_components};
use crate::newton::StoppingLimits;
use crate::shapes::{PlainMesh, bump, cone, cylinder};
use crate::surface::PieceSurface;
use nalgebra::{Point3, Vector3};

/// A sequence of numbers that looks random and is the same in every run (xorshift, Marsaglia 2003).
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % sides.max(1)
    }

    fn share(&mut self) -> f64 {
        self.roll(1 << 20) as f64 / f64::from(1 << 20)
    }
}

fn damaged(dice: &mut Dice) -> PlainMesh {
    let (mut places, mut triangles) = match dice.roll(3) {
        0 => bump(2 + dice.roll(6), 2 + dice.roll(6), 4.0 * dice.share()),
        1 => cylinder(2 + dice.roll(6), 1 + dice.roll(6)),
        _ => cone(1 + dice.roll(4), 3 + dice.roll(8), 5.0 * dice.share()),
    };
    for _ in 0..dice.roll(6) {
        damage(dice, &mut places, &mut triangles);
    }
    (places, triangles)
}

fn damage(dice: &mut Dice, places: &mut [Point3<f64>], triangles: &mut Vec<[u32; 3]>) {
    if triangles.is_empty() {
        return;
    }
    let (t, v) = (dice.roll(triangles.len()), dice.roll(places.len()));
    match dice.roll(11) {
        0 => places[v] = Point3::new(f64::NAN, 0.0, 0.0),
        1 => places[v] = places[dice.roll(places.len())],
        2 => places[v] += Vector3::new(dice.share(), dice.share(), dice.share()) * 3.0,
        3 => places[v] *= 1e30,
        4 => triangles[t].swap(0, 1),
        5 => triangles[t][dice.roll(3)] = dice.roll(places.len() + 1) as u32,
        6 => triangles.push(triangles[t]),
        7 => drop(triangles.swap_remove(t)),
        8 => triangles.iter_mut().flatten().filter(|u| **u as usize == v).for_each(|u| *u = 0),
        9 => places.iter_mut().for_each(|p| p.z *= 1e-9),
        _ => triangles.truncate(t + 1),
    }
}

/// Everything that the crate offers, on one mesh.
fn try_all(dice: &mut Dice, (places, triangles): PlainMesh) {
    let objectives = [
        Objective::Arap,
        Objective::SymmetricDirichlet,
        Objective::Springs,
        Objective::Woven(WovenStiffness::COTTON),
    ];
    let objective = objectives[dice.roll(4)];
    let (placement, newton) =
        (Placement::default(), StoppingLimits { iterations: 30, ..StoppingLimits::default() });
    let groups: Vec<u32> = triangles.iter().map(|_| dice.roll(2) as u32).collect();
    let uv: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| v / 3)).collect();
    let seams = [[dice.roll(9) as u32, dice.roll(9) as u32], [0, 1]];
    let _ = islands_by_uv(&places, &triangles, &uv);
    let _ = islands_by_seams(&places, &triangles, &seams);
    if let Ok(s) = PieceSurface::new(places.clone(), triangles.clone())
        && let Ok(flat) = objective.flatten(&s, newton, &placement)
    {
        assert!(flat.flipped(&s).is_empty());
        assert!(distortion(&s, &flat.points).is_ok());
    }
    for garment in [split_components(&places, &triangles), islands_by_group(&places, &triangles, &groups)] {
        let Ok(garment) = garment else { continue };
        let flats = garment.pieces.iter().map(|p| objective.flatten(&p.surface, newton, &placement));
        if let Ok(mut flats) = flats.collect::<Result<Vec<_>, _>>() {
            let options = CareOptions { newton, ..CareOptions::default() };
            let placements = vec![placement.clone(); flats.len()];
            let _ = refine(&garment, &mut flats, &objective, &placements, options);
        }
    }
}

#[test]
fn damaged_meshes_never_panic() {
    let mut dice = Dice(20);
    for _ in 0..1500 {
        let mesh = damaged(&mut dice);
        try_all(&mut dice, mesh);
    }
}

/// A hundred thousand: `cargo test --release -- --ignored`.
#[test]
#[ignore = "slow: .ci/wide"]
fn a_hundred_thousand_damaged_meshes_never_panic() {
    let mut dice = Dice(94);
    for _ in 0..100_000 {
        let mesh = damaged(&mut dice);
        try_all(&mut dice, mesh);
    }
}
