//! `Place`: panels into space around the body, with their seams.
//!
//! Each panel is anchored by a landmark, then all are raised or lowered together until the shoulder
//! seams just clear the shoulders, then lifted off the skin. Cost: some tens of milliseconds.
//! Limit: sleeves are not turned; they fit arms that leave the trunk at about their own angle, and
//! a warning names the seams that start with an arm between their sides.

use super::depth::DepthMap;
use super::fit::{Cut, check_girths};
use super::lift::{Board, Lift, depth_inside, lift, profile};
use super::sew::{Offsets, seams, unknown_panel};
use super::whole::{offsets, whole};
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// Seam pairs that start farther apart than this are not sewn but dragged across the room, metres.
const MAX_GAP: f64 = 0.8;
/// Heights above the landmark that are tried, upwards: first, last, step in metres.
const RAISES: (i32, i32, f64) = (-10, 30, 0.005);
/// Distance that a seam should keep from the skin on its way, metres.
const CLEARANCE: f64 = 0.006;
/// Share of a seam's pairs that may have flesh between them; the cloth slips off a little.
const MAX_BLOCKED: f64 = 0.5;

/// Places panels before and behind the body, ready to be sewn.
///
/// The front panel stands before the body, the back panel behind it, turned so that both show their
/// outside. Anchors tie pattern points to landmarks; the whole garment is then raised a little
/// where that frees its seams.
#[stage(
    role = Placement,
    source = "lift by depth: 3D garment modelling based on image-based rendering, about 2012",
    example = "Place(start_offset: \"2 cm\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Place {
    /// Distance between the panels and the skin.
    #[param(default = Length::cm(2.0), min = -0.5, max = 3.0)]
    start_offset: Length,
    /// Stiff boards, or panels bent around the body.
    #[param(default = Lift::Flat)]
    lift: Lift,
    /// How far the garment starts above its landmarks; found from the seams where it is not given.
    #[param(default = None, min = -1.0, max = 1.0)]
    raise: Option<Length>,
}

#[stage]
impl Place {
    pub(crate) fn run(
        &self,
        panels: Set<Panel>,
        plan: &SewingPlan,
        body: &Body,
        fabric: &Fabric,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let scene = Scene::new(self, &panels, plan, body)?;
        let raise = match self.raise {
            Some(raise) => raise.metres(),
            None => scene.best_raise(cx)?,
        };
        cx.figure("raise", raise, "m");
        scene.check_size(raise, fabric)?;
        scene.check_start(raise, cx)?;
        scene.garment(raise, fabric)
    }
}

/// Everything that stands around the body.
struct Scene<'a> {
    place: &'a Place,
    offsets: Offsets<'a>,
    plan: &'a SewingPlan,
    body: &'a Body,
    depths: DepthMap<'a>,
    seams: Vec<GarmentSeam>,
}

/// A panel in space.
struct Placed<'a> {
    name: &'a str,
    panel: &'a Panel,
    board: Board,
    /// Its first vertex within the garment.
    first: usize,
    points: Vec<Point3>,
}

impl<'a> Scene<'a> {
    fn new(
        place: &'a Place,
        panels: &'a Set<Panel>,
        plan: &'a SewingPlan,
        body: &'a Body,
    ) -> Result<Self, StageError> {
        let offsets = offsets(panels)?;
        if let Some(name) = plan.placements.keys().find(|n| !offsets.contains_key(n.as_str())) {
            return Err(unknown_panel(name, &offsets));
        }
        let seams = seams(plan, &offsets)?;
        Ok(Scene { place, offsets, plan, body, depths: DepthMap::new(body), seams })
    }

    fn placed(&self, raise: f64) -> Result<Vec<Placed<'a>>, StageError> {
        self.offsets
            .iter()
            .map(|(name, (first, panel))| self.placed_panel(name, *first, panel, raise))
            .collect()
    }

    fn placed_panel(
        &self,
        name: &'a str,
        first: usize,
        panel: &'a Panel,
        raise: f64,
    ) -> Result<Placed<'a>, StageError> {
        let place = self.plan.placements.get(name).ok_or_else(|| {
            StageError::invalid(format!("nothing says where the panel \"{name}\" goes on the body"))
                .hint("the style names the panels that it places; choose a style that has this panel")
        })?;
        let board = Board::new(place, self.body, raise)?;
        let laid: Vec<Point2> = panel.positions.iter().map(|&p| board.lay(p)).collect();
        let profile = profile(self.place.lift, &laid, &board, self.body, self.place.start_offset.metres());
        Ok(Placed { name, panel, board, first, points: lift(&laid, &board, &profile) })
    }

    /// The least height at which the shoulder seams clear the shoulders; else that of the fewest
    /// pairs with flesh between them; 0 where no seam crosses the shoulders.
    fn best_raise(&self, cx: &Context) -> Result<f64, StageError> {
        let (from, to, step) = RAISES;
        let mut best = (usize::MAX, 0);
        for k in from..=to {
            cx.check()?;
            let Some(blocked) = self.blocked_shoulders(f64::from(k) * step)? else { return Ok(0.0) };
            best = best.min((blocked, k));
            if blocked == 0 {
                break;
            }
        }
        Ok(f64::from(best.1) * step)
    }

    /// How many pairs over the shoulders have flesh between them; `None` where there are no such
    /// pairs.
    fn blocked_shoulders(&self, raise: f64) -> Result<Option<usize>, StageError> {
        let [shoulder, armpit] = ["shoulder_left", "armpit_left"].map(|name| self.body.landmarks.get(name));
        let (Some(shoulder), Some(armpit)) = (shoulder, armpit) else { return Ok(None) };
        let points: Vec<Point3> = self.placed(raise)?.into_iter().flat_map(|p| p.points).collect();
        let over = |pair: &&[u32; 2]| {
            let middle = nalgebra::center(&points[pair[0] as usize], &points[pair[1] as usize]);
            middle.x.abs() <= shoulder.x.abs() && middle.y > armpit.y
        };
        let pairs: Vec<&[u32; 2]> = self.seams.iter().flat_map(|s| &s.pairs).filter(over).collect();
        let blocked = pairs.iter().filter(|p| self.is_blocked(&points, ***p)).count();
        Ok((!pairs.is_empty()).then_some(blocked))
    }

    /// For each seam the number of pairs with flesh between them.
    fn blocked(&self, raise: f64) -> Result<Vec<usize>, StageError> {
        let points: Vec<Point3> = self.placed(raise)?.into_iter().flat_map(|p| p.points).collect();
        let count = |s: &GarmentSeam| s.pairs.iter().filter(|p| self.is_blocked(&points, **p)).count();
        Ok(self.seams.iter().map(count).collect())
    }

    fn is_blocked(&self, points: &[Point3], [a, b]: [u32; 2]) -> bool {
        let (a, b) = (points[a as usize], points[b as usize]);
        let middle = nalgebra::center(&a, &b);
        let (near, far) = (a.z.min(b.z), a.z.max(b.z));
        [-CLEARANCE, CLEARANCE]
            .iter()
            .any(|dy| self.depths.span(middle.x, middle.y + dy).is_some_and(|(lo, hi)| near < hi && lo < far))
    }

    /// Refuses a start from which sewing cannot succeed.
    fn check_start(&self, raise: f64, cx: &Context) -> Result<(), StageError> {
        let placed = self.placed(raise)?;
        for p in &placed {
            let depth = depth_inside(&p.points, p.board.side, &self.depths);
            if depth > 1e-9 {
                return Err(too_deep(p.name, depth));
            }
        }
        let points: Vec<Point3> = placed.into_iter().flat_map(|p| p.points).collect();
        for seam in &self.seams {
            let gap = |[a, b]: &[u32; 2]| (points[*a as usize] - points[*b as usize]).norm();
            let widest = seam.pairs.iter().map(gap).fold(0.0, f64::max);
            if widest > MAX_GAP {
                return Err(too_far(&seam.name, widest));
            }
        }
        for (seam, blocked) in self.seams.iter().zip(self.blocked(raise)?) {
            if blocked as f64 > MAX_BLOCKED * seam.pairs.len() as f64 {
                cx.warn(format!(
                    "the seam {} starts with the body between {blocked} of its {} pairs; arms spread like the \
                     sleeves would free it (the mannequin's `arm_angle`)",
                    seam.name,
                    seam.pairs.len()
                ));
            }
        }
        Ok(())
    }

    fn check_size(&self, raise: f64, fabric: &Fabric) -> Result<(), StageError> {
        let trunk = |name: &str| self.plan.placements.get(name).is_some_and(|p| p.limb == Limb::Torso);
        let sewn: BTreeSet<usize> =
            self.seams.iter().flat_map(|s| &s.pairs).flatten().map(|v| *v as usize).collect();
        let placed = self.placed(raise)?;
        let cut = |p: &Placed<'a>| {
            let count = p.panel.positions.len();
            let own = sewn.range(p.first..p.first + count).map(|v| (v - p.first) as u32);
            Cut { board: p.board, panel: p.panel, sewn: own.collect() }
        };
        let panels: Vec<Cut> = placed.iter().filter(|p| trunk(p.name)).map(cut).collect();
        check_girths(&panels, self.body, fabric)
    }

    fn garment(&self, raise: f64, fabric: &Fabric) -> Result<Garment, StageError> {
        let points = self.placed(raise)?.into_iter().flat_map(|p| p.points).collect();
        Ok(whole(&self.offsets, self.seams.clone(), fabric, points))
    }
}

fn too_deep(panel: &str, depth: f64) -> StageError {
    let message = format!("the panel \"{panel}\" would start {:.0} mm deep in the body", depth * 1e3);
    StageError::invalid(message)
        .hint("raise `start_offset`: the panels' distance from the skin")
        .at("start_offset")
}

fn too_far(seam: &str, gap: f64) -> StageError {
    let message = format!("the seam {seam} would start {:.0} cm apart, too far to be sewn", gap * 100.0);
    StageError::invalid(message).hint(format!(
        "lower `start_offset`, or check the panels' places; seams may start {:.0} cm apart",
        MAX_GAP * 100.0
    ))
}
