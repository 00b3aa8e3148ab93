//! Threads between front and back, before the garment is sewn: whether the body is in their way.
//!
//! Where the body stands between the sides of a seam below the shoulders, as an arm does that is
//! spread otherwise than the sleeve, the user is warned. (`Arrange` clears the shoulders.) Cost:
//! some milliseconds.

use crate::style::sewing::evenly;
use toile_body::DepthMap;
use toile_core::artifact::Outline as Shape;
use toile_core::prelude::*;

/// Threads of a seam.
const COUNT: usize = 33;
/// Share of a seam's threads that may have flesh between their ends; the cloth slips off a little.
const MAX_BLOCKED: f64 = 0.5;

/// A sentence for each seam that starts with the body between its sides. Seams of pieces without a
/// pose are passed over.
pub(super) fn in_the_way(
    outlines: &Set<Shape>,
    pattern: &Pattern,
    seams: &[Seam],
    body: &Body,
) -> Vec<String> {
    let depths = DepthMap::new(body);
    let side = |side: &EdgeRef| -> Option<[Point3; COUNT]> {
        let (outline, pose) = (outlines.get(&side.panel)?, pattern.piece(&side.panel)?.pose?);
        Some(evenly(&outline.edge_points(outline.edge(&side.edge)?)).map(|p| pose.at(p)))
    };
    let told = |seam: &Seam| {
        let (a, mut b) = (side(&seam.a)?, side(&seam.b)?);
        if !seam.reversed {
            b.reverse();
        }
        let blocked = a.iter().zip(&b).filter(|(p, q)| depths.is_between(p, q)).count();
        (blocked as f64 > MAX_BLOCKED * COUNT as f64).then(|| {
            format!(
                "the seam {} starts with the body between {:.0} % of it; arms spread like the sleeves would free it (the \
                 mannequin's `arm_angle`)",
                seam.name(),
                100.0 * blocked as f64 / COUNT as f64
            )
        })
    };
    let is_shoulder = |seam: &&Seam| Hand::split(&seam.a.edge).0 == EdgeRole::Shoulder.word();
    seams.iter().filter(|s| !is_shoulder(s)).filter_map(told).collect()
}
