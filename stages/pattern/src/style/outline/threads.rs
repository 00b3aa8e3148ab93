//! Threads between front and back, before the garment is sewn: whether the body is in their way.
//!
//! A garment that starts with its shoulder seams in the shoulders would be sewn through them. It is
//! raised as a whole until they are free. Where the body stands between the sides of another seam,
//! as an arm does that is spread otherwise than the sleeve, the user is warned. Cost: some
//! milliseconds.

use super::depth::DepthMap;
use crate::style::sewing::evenly;
use toile_core::artifact::Outline as Shape;
use toile_core::prelude::*;

/// Threads of a seam.
const COUNT: usize = 33;
/// The most steps by which a garment is raised.
const MOST_STEPS: u32 = 30;
/// One of them, metres.
const STEP: f64 = 0.005;
/// Distance that a thread should keep from the skin, metres.
const CLEARANCE: f64 = 0.006;
/// Share of a seam's threads that may have flesh between their ends; the cloth slips off a little.
const MAX_BLOCKED: f64 = 0.5;

/// The threads of each seam, with the seam's name, and the body that they pass.
pub(super) struct Threads<'a> {
    of_seams: Vec<(String, Vec<[Point3; 2]>)>,
    depths: DepthMap<'a>,
    body: &'a Body,
}

impl<'a> Threads<'a> {
    /// Those of the seams whose pieces have a pose.
    pub(super) fn new(outlines: &Set<Shape>, pattern: &Pattern, seams: &[Seam], body: &'a Body) -> Self {
        let side = |side: &EdgeRef| -> Option<[Point3; COUNT]> {
            let (outline, pose) = (outlines.get(&side.panel)?, pattern.piece(&side.panel)?.pose?);
            Some(evenly(&outline.edge_points(outline.edge(&side.edge)?)).map(|p| pose.at(p)))
        };
        let of = |seam: &Seam| {
            let (a, mut b) = (side(&seam.a)?, side(&seam.b)?);
            if !seam.reversed {
                b.reverse();
            }
            Some((seam.name(), a.into_iter().zip(b).map(|(p, q)| [p, q]).collect()))
        };
        Threads { of_seams: seams.iter().filter_map(of).collect(), depths: DepthMap::new(body), body }
    }

    /// How far the garment must be raised for its shoulder seams to be free, or most of them,
    /// metres.
    pub(super) fn raise(&self) -> f64 {
        let [shoulder, armpit] = ["shoulder_left", "armpit_left"].map(|name| self.body.landmarks.get(name));
        let (Some(shoulder), Some(armpit)) = (shoulder, armpit) else { return 0.0 };
        let blocked = |by: f64| {
            let over = |[p, q]: &&[Point3; 2]| {
                let middle = nalgebra::center(p, q);
                middle.x.abs() <= shoulder.x.abs() && middle.y + by > armpit.y
            };
            let threads = self.of_seams.iter().flat_map(|s| &s.1).filter(over);
            threads.filter(|thread| self.is_blocked(thread, by)).count()
        };
        let mut best = (blocked(0.0), 0);
        for k in 1..=MOST_STEPS {
            if best.0 == 0 {
                break;
            }
            best = best.min((blocked(f64::from(k) * STEP), k));
        }
        f64::from(best.1) * STEP
    }

    /// A sentence for each seam that starts with the body between its sides, raised by so much.
    pub(super) fn in_the_way(&self, by: f64) -> Vec<String> {
        let told = |(name, threads): &(String, Vec<[Point3; 2]>)| {
            let blocked = threads.iter().filter(|thread| self.is_blocked(thread, by)).count();
            (blocked as f64 > MAX_BLOCKED * threads.len() as f64).then(|| {
                format!(
                    "the seam {name} starts with the body between {:.0} % of it; arms spread like the sleeves would \
                     free it (the mannequin's `arm_angle`)",
                    100.0 * blocked as f64 / threads.len() as f64
                )
            })
        };
        self.of_seams.iter().filter_map(told).collect()
    }

    /// Whether the body stands between the ends of a thread, raised by so much.
    fn is_blocked(&self, [p, q]: &[Point3; 2], by: f64) -> bool {
        let middle = nalgebra::center(p, q);
        let (near, far) = (p.z.min(q.z), p.z.max(q.z));
        let span = |dy: f64| self.depths.span(middle.x, middle.y + by + dy);
        [-CLEARANCE, CLEARANCE].into_iter().filter_map(span).any(|(lo, hi)| near < hi && lo < far)
    }
}
