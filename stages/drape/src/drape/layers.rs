//! Garments that are worn over each other, sewn one after the other.
//!
//! Method: the innermost garment is sewn and comes to rest on the body; the next one is sewn on the
//! body as that garment dresses it ([`Dressed`]), and so on outwards; in the end all are let go and
//! come to rest together, cloth on cloth. Cost: that of each garment alone, and of the last state
//! of rest.

use crate::engine::SchemeSurface;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_cloth::contact::collision_surface::CollisionSurface;
use toile_core::prelude::*;
use toile_geometry::facets::Facets;
use toile_geometry::sharp::Sharp;
use toile_geometry::signed_distance::{Nearest, SignedDistance};

/// What is farther behind cloth than this is not inside it, metres.
const BEHIND: f64 = 0.15;
/// A place this near to an open edge lies on it, metres.
const ON_RIM: f64 = 1e-6;

/// The layers of a garment's panels, from the innermost.
pub(super) fn layers(garment: &Garment) -> Vec<u32> {
    let mut all: Vec<u32> = garment.panels.iter().map(|p| p.layer).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// One garment of several.
pub(super) struct Single {
    pub(super) garment: Garment,
    /// For each of its vertices that of the whole.
    of: Vec<usize>,
}

impl Single {
    /// The garment of a layer.
    pub(super) fn of(layer: u32, whole: &Garment) -> Self {
        let mut own = Garment {
            status: SolveStatus { steps: whole.status.steps, ..SolveStatus::default() },
            ..Garment::default()
        };
        let mut of = Vec::new();
        for panel in whole.panels.iter().filter(|p| p.layer == layer) {
            let shift = |v: &u32| v - panel.vertices.start as u32 + of.len() as u32;
            let (vertices, triangles) = (of.len(), own.triangles.len());
            own.triangles
                .extend(whole.triangles[panel.triangles.clone()].iter().map(|t| t.map(|v| shift(&v))));
            let boundary = panel.boundary.iter().map(shift).collect();
            of.extend(panel.vertices.clone());
            own.panels.push(GarmentPanel {
                vertices: vertices..of.len(),
                triangles: triangles..own.triangles.len(),
                boundary,
                ..panel.clone()
            });
        }
        let new: BTreeMap<usize, u32> = of.iter().zip(0..).map(|(v, k)| (*v, k)).collect();
        let at = |v: u32| new.get(&(v as usize)).copied();
        own.pinned = whole.pinned.iter().filter_map(|v| at(*v)).collect();
        own.positions = of.iter().map(|v| whole.positions[*v]).collect();
        own.velocities = vec![Vector3::zeros(); of.len()];
        own.rest = of.iter().map(|v| whole.rest[*v]).collect();
        own.weld = of.iter().zip(0..).map(|(v, k)| at(whole.weld[*v]).unwrap_or(k)).collect();
        let seam = |s: &GarmentSeam| {
            let pairs: Vec<[u32; 2]> = s.pairs.iter().filter_map(|[a, b]| Some([at(*a)?, at(*b)?])).collect();
            (!pairs.is_empty()).then(|| GarmentSeam { pairs, ..s.clone() })
        };
        own.seams = whole.seams.iter().filter_map(seam).collect();
        let start = |s: &GarmentStart| GarmentStart {
            told: s.told.clone(),
            positions: of.iter().map(|v| s.positions[*v]).collect(),
        };
        let others = whole.starts.iter().map(start);
        own.starts = others.filter(|s| s.positions != own.positions).collect();
        Single { garment: own, of }
    }

    /// Puts what came to rest back into the whole.
    pub(super) fn put_back(&self, rested: &Garment, whole: &mut Garment) {
        for (v, (p, w)) in self.of.iter().zip(rested.positions.iter().zip(&rested.weld)) {
            whole.positions[*v] = *p;
            whole.weld[*v] = self.of[*w as usize] as u32;
        }
        whole.status.steps = rested.status.steps;
    }
}

/// The cloth that a body wears already.
#[derive(Debug)]
pub(super) struct Clothes {
    cloth: SignedDistance,
    /// Its open edges, as triangles without area.
    rim: SignedDistance,
}

impl Clothes {
    /// The garments of a whole that are worn under a layer, where they hang.
    pub(super) fn under(layer: u32, whole: &Garment) -> Self {
        let inner = whole.panels.iter().filter(|p| p.layer < layer);
        let triangles: Vec<[u32; 3]> = inner
            .flat_map(|p| &whole.triangles[p.triangles.clone()])
            .map(|t| t.map(|v| whole.weld[v as usize]))
            .collect();
        let points: Vec<Vector3> = whole.positions.iter().map(|p| p.coords).collect();
        let mut sides = BTreeMap::new();
        for [a, b] in triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]) {
            *sides.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
        }
        let rim = sides.into_iter().filter(|(_, uses)| *uses == 1).map(|([a, b], _)| [a, b, b]).collect();
        Clothes {
            cloth: SignedDistance::new(points.clone(), triangles),
            rim: SignedDistance::new(points, rim),
        }
    }

    /// The nearest place of the cloth. Behind it counts as inside, up to [`BEHIND`]; beside an open
    /// edge nothing is inside.
    fn nearest(&self, p: &Vector3, within: f64) -> Option<Nearest> {
        let near = self.cloth.nearest(p, within)?;
        let at_rim = self.rim.nearest(&near.point, ON_RIM).is_some();
        match near.distance < 0.0 {
            true if at_rim => {
                let normal = (p - near.point).try_normalize(0.0).unwrap_or(near.normal);
                Some(Nearest { distance: -near.distance, normal, point: near.point })
            }
            true => (near.distance > -BEHIND).then_some(near),
            false => Some(near),
        }
    }
}

/// A body with the cloth that it wears already, for cloth that is worn over both.
#[derive(Debug)]
pub(super) struct Dressed<'a> {
    pub(super) body: SchemeSurface<'a>,
    pub(super) clothes: Option<&'a Clothes>,
}

impl CollisionSurface for Dressed<'_> {
    fn nearest(&self, points: &[Vector3], within: &[f64]) -> Vec<Option<Nearest>> {
        let of_body = self.body.nearest(points, within);
        let Some(clothes) = self.clothes else { return of_body };
        let both = |((body, p), within): ((Option<Nearest>, &Vector3), &f64)| {
            let cloth = clothes.nearest(p, *within);
            match (body, cloth) {
                (Some(b), Some(c)) => Some(if c.distance < b.distance { c } else { b }),
                (one, other) => one.or(other),
            }
        };
        of_body.into_par_iter().zip(points).zip(within).map(both).collect()
    }

    fn guard(&self, points: &[Vector3], moves: &mut [Vector3], gaps: &[f64]) {
        self.body.guard(points, moves, gaps);
        let Some(clothes) = self.clothes else { return };
        let guard = |((m, p), gap): ((&mut Vector3, &Vector3), &f64)| {
            let entry = clothes.cloth.entry(p, &(*p + *m));
            if let Some(entry) = entry {
                *m = *m * entry.share + entry.normal * *gap;
            }
        };
        moves.par_iter_mut().zip(points).zip(gaps).for_each(guard);
    }

    fn reach(&self, direction: &Vector3) -> Option<f64> {
        self.body.reach(direction)
    }

    fn sharp(&self) -> Option<Arc<Sharp>> {
        self.body.sharp()
    }

    fn facets(&self) -> Option<&Facets> {
        self.body.facets()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use toile_core::artifact::{SeamKind, SeamState};

    /// Two squares of a metre before each other, the second one 1 m farther along z and worn
    /// outside, and a seam along one side of it.
    fn pair() -> Garment {
        let square =
            |z: f64| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, z));
        let positions = [square(0.0), square(1.0)].concat();
        let fabric = toile_core::testkit::dress::fabric();
        let panel = |name: &str, k: usize, layer: u32| GarmentPanel {
            name: name.into(),
            vertices: 4 * k..4 * k + 4,
            triangles: 2 * k..2 * k + 2,
            boundary: (0..4).map(|v| v + 4 * k as u32).collect(),
            photo_px: Vec::new(),
            fabric: Arc::new(fabric.clone()),
            layer,
        };
        Garment {
            velocities: vec![Vector3::zeros(); 8],
            rest: positions.iter().map(|p| Point2::new(p.x, p.y)).collect(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            panels: vec![panel("inner", 0, 0), panel("outer", 1, 1)],
            seams: vec![GarmentSeam {
                name: "outer.left + outer.right".into(),
                kind: SeamKind::Matched,
                pairs: vec![[4, 5]],
                state: SeamState::Open,
            }],
            weld: (0..8).collect(),
            positions,
            ..Garment::default()
        }
    }

    #[test]
    fn a_garment_is_taken_out_of_an_outfit_and_put_back_where_it_came_to_rest() {
        let mut whole = pair();
        assert_eq!(layers(&whole), [0, 1]);
        let single = Single::of(1, &whole);
        single.garment.check_solvable().unwrap();
        assert_eq!(single.garment.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(single.garment.seams[0].pairs, [[0, 1]]);
        let mut rested = single.garment.clone();
        rested.positions.iter_mut().for_each(|p| p.z += 5.0);
        rested.weld[1] = 0;
        single.put_back(&rested, &mut whole);
        assert_eq!(
            whole.positions.iter().map(|p| p.z).collect::<Vec<_>>(),
            [0.0, 0.0, 0.0, 0.0, 6.0, 6.0, 6.0, 6.0]
        );
        assert_eq!(whole.weld[5], 4);
    }

    #[test]
    fn behind_cloth_is_inside_and_beside_its_edge_is_not() {
        let clothes = Clothes::under(1, &pair());
        let distance =
            |x: f64, y: f64, z: f64| clothes.nearest(&Vector3::new(x, y, z), 9.0).map(|n| n.distance);
        let is =
            |found: Option<f64>, right: f64| assert!((found.unwrap() - right).abs() < 1e-12, "{found:?}");
        is(distance(0.6, 0.5, 0.1), 0.1);
        is(distance(0.6, 0.5, -0.1), -0.1);
        assert_eq!(distance(0.6, 0.5, -0.2), None);
        is(distance(1.3, 0.5, -0.4), 0.5);
    }
}
