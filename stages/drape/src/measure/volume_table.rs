//! `VolumeTable`: what each bounding volume costs on a garment.

use rayon::ThreadPoolBuilder;
use std::cell::Cell;
use std::fmt::Write;
use toile_core::prelude::*;
use toile_geometry::Vec3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::volume::{Aabb, BoundingSphere, BoundingVolume, KDop, Obb};

/// Counts what each bounding volume takes to find where a garment is near itself.
///
/// `volumes.csv` has a row a volume: how many volumes were fitted
/// to triangles and how many put together from two, how many tests of two volumes were made, how
/// many of these found them near, and the pairs of vertices and triangles, and of edges, that were
/// looked at in the end. The pairs are the same for each volume. Around a triangle the oriented box
/// is the tightest, put together from two it is looser than a box along the axes. Fewer tests are
/// not less time: for time turn `BvhCollider.volume` with `toile trade`.
#[stage(
    role = Writer,
    source = "3D garment modelling based on image-based rendering, about 2012; Gottschalk et al. 1996; Klosowski et al. 1998",
    example = "VolumeTable(reach: \"1.5 mm\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct VolumeTable {
    /// How near cloth must be to cloth.
    #[param(default = Length::mm(1.5), min = 1e-5, max = 0.05)]
    reach: Length,
}

#[stage]
impl VolumeTable {
    pub(crate) fn run(&self, garment: &Garment, cx: &Context) -> Result<OutputFiles, StageError> {
        let sheet = Sheet::of(garment);
        // Where the system gives no threads, this one does all the work.
        let pool = ThreadPoolBuilder::new().num_threads(1).build().ok();
        let reach = self.reach.metres();
        let mut csv = String::from("volume,fitted,put_together,tests,near,pairs\n");
        for (name, count) in VOLUMES {
            cx.check()?;
            let (counts, pairs) = match &pool {
                Some(pool) => pool.install(|| count(&sheet, reach)),
                None => count(&sheet, reach),
            };
            let Counts { fitted, merged, tests, near } = counts;
            let _ = writeln!(csv, "{name},{fitted},{merged},{tests},{near},{pairs}");
            cx.figure(&format!("tests_{name}"), tests as f64, "");
        }
        Ok(OutputFiles(vec![OutputFile::new("volumes.csv".to_owned(), csv.into_bytes())]))
    }
}

/// The triangles of a garment, their places, and where they lie flat, piece behind piece.
struct Sheet {
    triangles: Vec<[u32; 3]>,
    at: Vec<Vec3>,
    flat: Vec<Vec3>,
}

impl Sheet {
    fn of(garment: &Garment) -> Self {
        let mut flat = vec![Vec3::zeros(); garment.positions.len()];
        for (k, panel) in garment.panels.iter().enumerate() {
            for v in panel.vertices.clone() {
                let p = garment.rest[v];
                flat[v] = Vec3::new(p.x, p.y, k as f64);
            }
        }
        Sheet {
            triangles: garment.triangles.clone(),
            at: garment.positions.iter().map(|p| p.coords).collect(),
            flat,
        }
    }
}

/// What a search took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Counts {
    fitted: u64,
    merged: u64,
    tests: u64,
    near: u64,
}

thread_local! {
    /// A volume is made without a value that could count, so the thread counts.
    static COUNTS: Cell<Counts> = const { Cell::new(Counts { fitted: 0, merged: 0, tests: 0, near: 0 }) };
}

fn count(change: impl Fn(&mut Counts)) {
    COUNTS.with(|cell| {
        let mut counts = cell.get();
        change(&mut counts);
        cell.set(counts);
    });
}

/// A volume whose use is counted.
#[derive(Debug, Clone, Copy)]
struct CountedVolume<V>(V);

impl<V: BoundingVolume> BoundingVolume for CountedVolume<V> {
    fn fit(points: &[Vec3]) -> Self {
        count(|c| c.fitted += 1);
        Self(V::fit(points))
    }

    fn merge(&self, other: &Self) -> Self {
        count(|c| c.merged += 1);
        Self(self.0.merge(&other.0))
    }

    fn near(&self, other: &Self, reach: f64) -> bool {
        let is_near = self.0.near(&other.0, reach);
        count(|c| {
            c.tests += 1;
            c.near += u64::from(is_near);
        });
        is_near
    }

    fn distance_squared(&self, p: &Vec3) -> f64 {
        self.0.distance_squared(p)
    }

    fn size(&self) -> f64 {
        self.0.size()
    }
}

/// What a search with that volume takes on one thread, and how many pairs it finds.
fn searched<V: BoundingVolume>(sheet: &Sheet, reach: f64) -> (Counts, usize) {
    COUNTS.set(Counts::default());
    let tree = ClothTree::<CountedVolume<V>>::of(&sheet.triangles, &sheet.flat);
    let pairs = tree.pairs(&sheet.at, &vec![Vec3::zeros(); sheet.at.len()], reach);
    (COUNTS.get(), pairs.len())
}

type Search = fn(&Sheet, f64) -> (Counts, usize);

/// The volumes that a collider may have.
const VOLUMES: [(&str, Search); 6] = [
    ("sphere", searched::<BoundingSphere>),
    ("aabb", searched::<Aabb>),
    ("kdop14", searched::<KDop<7>>),
    ("kdop18", searched::<KDop<9>>),
    ("kdop26", searched::<KDop<13>>),
    ("obb", searched::<Obb>),
];

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A wavy sheet of `n` squared cells.
    fn wave(n: u32) -> Sheet {
        let at = |k: u32| {
            let (x, y) = (f64::from(k % (n + 1)), f64::from(k / (n + 1)));
            Vec3::new(0.01 * x, 0.01 * y, 0.02 * (0.7 * x).sin() * (0.5 * y).cos())
        };
        let cell = |k: u32| {
            let (i, j) = (k % n, k / n);
            let v = j * (n + 1) + i;
            [[v, v + 1, v + n + 2], [v, v + n + 2, v + n + 1]]
        };
        let places: Vec<Vec3> = (0..(n + 1) * (n + 1)).map(at).collect();
        Sheet {
            triangles: (0..n * n).flat_map(cell).collect(),
            flat: places.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect(),
            at: places,
        }
    }

    #[test]
    fn every_volume_finds_the_same_pairs_and_a_polytope_makes_fewer_tests_than_a_sphere() {
        let pool = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let sheet = wave(24);
        let found: Vec<(Counts, usize)> =
            VOLUMES.iter().map(|(_, search)| pool.install(|| search(&sheet, 0.012))).collect();
        assert!(found.iter().all(|(_, pairs)| *pairs == found[0].1 && *pairs > 0), "{found:?}");
        assert!(found.iter().all(|(c, _)| c.fitted == sheet.triangles.len() as u64), "{found:?}");
        let tests = |name: &str| {
            let of = VOLUMES.iter().zip(&found).find(|((own, _), _)| *own == name);
            of.map(|(_, (counts, _))| counts.tests).unwrap()
        };
        assert!(tests("kdop26") <= tests("aabb") && tests("aabb") < tests("sphere"), "{found:?}");
    }

    #[test]
    fn counts_are_those_of_one_search() {
        let pool = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let once = || pool.install(|| searched::<Aabb>(&wave(8), 0.004));
        assert_eq!(once(), once());
    }
}
