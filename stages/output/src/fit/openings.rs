//! The openings of a sewn garment (neckline, hem, cuffs, waist), and the measures that a tailor
//! takes along them.

use std::collections::{BTreeMap, BTreeSet};
use toile_core::artifact::{Body, Garment, GarmentPanel, Hand, Point2, Point3};

/// The middle of an armhole, a cuff or a leg is farther than this from the middle of the body,
/// metres.
const BESIDE: f64 = 0.05;

/// A closed line of edges that nothing is sewn to.
#[derive(Debug, Clone)]
pub(super) struct Opening {
    /// Its vertices in order, one per panel that has part in it.
    pub vertices: Vec<u32>,
    /// Where they are.
    pub points: Vec<Point3>,
    /// Its length as cut, metres.
    pub length: f64,
    /// Mean height, metres.
    pub height: f64,
}

impl Opening {
    /// Whether it winds around a vertical line at (x, z).
    pub(super) fn goes_around(&self, at: Point2) -> bool {
        let n = self.points.len();
        let turn = |k: usize| {
            let [a, b] = [k, (k + 1) % n].map(|i| Point2::new(self.points[i].x, self.points[i].z) - at);
            a.perp(&b).atan2(a.dot(&b))
        };
        (0..n).map(turn).sum::<f64>().abs() > std::f64::consts::PI
    }

    fn is_in(&self, panel: &GarmentPanel) -> bool {
        self.vertices.iter().any(|v| panel.vertices.contains(&(*v as usize)))
    }

    fn middle(&self) -> Point3 {
        Point3::from(
            self.points.iter().map(|p| p.coords).sum::<nalgebra::Vector3<f64>>() / self.points.len() as f64,
        )
    }
}

/// Every opening of a garment whose seams are joined, the highest first.
pub(super) fn openings(garment: &Garment) -> Vec<Opening> {
    let mut uses: BTreeMap<[u32; 2], Vec<[u32; 2]>> = BTreeMap::new();
    for t in &garment.triangles {
        for k in 0..3 {
            let own = [t[k], t[(k + 1) % 3]];
            let [a, b] = own.map(|v| garment.weld[v as usize]);
            uses.entry([a.min(b), a.max(b)]).or_default().push(own);
        }
    }
    let free = uses.into_iter().filter_map(|([a, b], own)| match own[..] {
        [only] if a != b => Some((garment.weld[only[0] as usize], only)),
        _ => None,
    });
    let mut next: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
    free.for_each(|(from, edge)| next.entry(from).or_default().push(edge));
    let mut all = Vec::new();
    while let Some((&start, _)) = next.iter().find(|(_, edges)| !edges.is_empty()) {
        all.extend(follow(garment, &mut next, start));
    }
    all.sort_by(|a, b| b.height.total_cmp(&a.height));
    all
}

fn follow(garment: &Garment, next: &mut BTreeMap<u32, Vec<[u32; 2]>>, start: u32) -> Option<Opening> {
    let (mut at, mut vertices, mut length) = (start, Vec::new(), 0.0);
    while let Some([a, b]) = next.get_mut(&at).and_then(Vec::pop) {
        vertices.push(a);
        length += (garment.rest[b as usize] - garment.rest[a as usize]).norm();
        at = garment.weld[b as usize];
        if at == start {
            break;
        }
    }
    let points: Vec<Point3> = vertices.iter().map(|&v| garment.positions[v as usize]).collect();
    let height = points.iter().map(|p| p.y).sum::<f64>() / points.len().max(1) as f64;
    (at == start && points.len() > 2).then_some(Opening { vertices, points, length, height })
}

/// Finished measures of a garment, metres, by name: `length` from its highest point straight down
/// to the hem, `hem`, `opening` of neck or waist, `sleeve_left` from its highest point to the cuff,
/// `cuff_left`, or `armhole_left` of a garment without sleeves, `leg_left` and `leg_opening_left`
/// of trousers; and the same of the right.
pub(super) fn finished(
    garment: &Garment,
    body: Option<&Body>,
    openings: &[Opening],
) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    let axis = body.and_then(|b| b.landmarks.get("waist_front")).map_or(0.0, |p| p.x);
    let around: Vec<&Opening> = openings.iter().filter(|o| o.goes_around(centre(o, axis, body))).collect();
    if let [top, .., hem] = around[..] {
        all.insert("opening".to_owned(), top.length);
        all.insert("hem".to_owned(), hem.length);
        all.extend(longest(garment, hem).map(|l| ("length".to_owned(), l)));
    }
    let trunk: BTreeSet<u32> = around.iter().flat_map(|o| o.vertices.iter().copied()).collect();
    for hand in Hand::BOTH {
        let own = |o: &&Opening| {
            hand.sign() * (o.middle().x - axis) > BESIDE && !o.vertices.iter().any(|v| trunk.contains(v))
        };
        let Some(end) = openings.iter().filter(own).min_by(|a, b| a.height.total_cmp(&b.height)) else {
            continue;
        };
        let is_leg = around.len() == 1;
        let is_own = |p: &&GarmentPanel| end.is_in(p) && !around.iter().any(|o| o.is_in(p));
        if !is_leg && !garment.panels.iter().any(|p| is_own(&p)) {
            all.insert(hand.name("armhole"), end.length);
            continue;
        }
        let (width, length) = if is_leg { ("leg_opening", "leg") } else { ("cuff", "sleeve") };
        all.insert(hand.name(width), end.length);
        all.extend(longest(garment, end).map(|l| (hand.name(length), l)));
        if is_leg {
            all.insert("opening".to_owned(), around[0].length);
        }
    }
    all
}

/// Where the trunk is at an opening's height: under the waist's landmarks, or the opening's own
/// middle where there is no body.
fn centre(opening: &Opening, axis: f64, body: Option<&Body>) -> Point2 {
    let z =
        body.and_then(|b| Some((b.landmarks.get("waist_front")?.z + b.landmarks.get("waist_back")?.z) / 2.0));
    Point2::new(axis, z.unwrap_or_else(|| opening.middle().z))
}

/// The greatest length of a panel, as it was cut, square to its share of an opening.
fn longest(garment: &Garment, opening: &Opening) -> Option<f64> {
    let of = |panel: &GarmentPanel| {
        let own: Vec<Point2> = opening
            .vertices
            .iter()
            .filter(|v| panel.vertices.contains(&(**v as usize)))
            .map(|&v| garment.rest[v as usize])
            .collect();
        let (first, last) = (own.first()?, own.last()?);
        let along = (last - first).try_normalize(1e-6)?;
        let off = |p: &Point2| along.perp(&(p - first)).abs();
        let share = own.len() * 4 >= opening.vertices.len();
        share.then(|| garment.rest[panel.vertices.clone()].iter().map(off).fold(0.0, f64::max))
    };
    garment.panels.iter().filter_map(of).reduce(f64::max)
}
