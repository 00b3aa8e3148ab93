//! `Arrange`: the pieces of a pattern into space around the body, with their seams.
//!
//! Method: every piece stands where its pattern says. Pieces that lie around an arm (sleeves,
//! cuffs) are bent to cylinders around it, as the arrangement points of garment CAD do: halves
//! before and behind the arm that are sewn to each other share one cylinder, whose girth is theirs,
//! or the arm's where that is more; what is too narrow for the arm is refused ([`narrow`]). A
//! garment of flat pieces is raised until its shoulder seams clear the shoulders ([`boards`]). Flat
//! halves of legs that stand beside the body's are swung before them ([`legs`]). Poses that were
//! made for a body whose origin is its middle are raised onto the floor. Pieces with pleats are
//! folded first ([`pleats`]), and pieces that are sewn onto others are laid on them last
//! ([`patches`]). A pattern in which no piece has a pose is placed by names, seams and sizes
//! ([`region`], [`stand`]); pieces with key points stand at their landmarks ([`key_points`]), and
//! those with a place by hand are moved there, whatever else was decided ([`hand_places`]). Other
//! starts are left for the solver: pieces without the gaps between those above each other
//! ([`tiers`]), and skirts on cones ([`cones`]).
//!
//! Cost: some milliseconds. Limits: where some pieces have a pose, those without are refused; trunk
//! and legs keep the flat places of the file, from which `StaticEquilibrium(sew_through: true)`
//! sews them.

mod boards;
mod cones;
mod hand_places;
mod key_points;
mod layers;
mod legs;
mod limb;
mod move_input;
mod moving;
mod narrow;
mod patches;
mod pleats;
mod region;
mod stand;
mod tiers;
mod tubes;

use super::sew::{Offsets, seams};
use super::whole::{offsets, whole};
pub use hand_places::HandPlace;
pub use key_points::KeyPoint;
use move_input::MoveInput;
use moving::Moved;
pub use region::undecided;
use region::{Decided, Region};
use std::collections::{BTreeMap, BTreeSet};
use toile_core::prelude::*;

/// The vertices of each piece in space.
type PiecePlaces = BTreeMap<String, Vec<Point3>>;

/// Places of every piece, and the sleeves among those that had none, each with the hand of its arm.
type Stood = (PiecePlaces, Option<Vec<(String, Hand)>>);

/// Below the floor by more than this, poses are for a body whose origin is its middle, metres.
const BELOW: f64 = 0.1;

/// Every garment reaches higher than this on a body that stands on the floor, as a share of its
/// height: to its waist.
const WORN: f64 = 0.5;

/// Nothing is worn that reaches higher above the body than this share of its height.
const BEYOND: f64 = 0.25;
/// Or that reaches up no further than this share of it.
const LEAST_WORN: f64 = 0.3;
/// Or whose middle lies farther from the body's than this share of its height.
const ASIDE: f64 = 0.35;

/// The height of that origin as a share of the body's: that of a standing figure whose origin lies
/// at its waist.
const MIDDLE: f64 = 0.65;

/// Arranges the pieces of a sewing pattern around the body, ready to be sewn.
///
/// Pieces stand where the pattern says; sleeves and cuffs are bent around the arms. Where the
/// pattern says nothing, fronts, backs, sleeves, legs in one piece and waistbands are placed by
/// their names, seams and sizes. A sleeve or cuff that is cut narrower than the arm by more than
/// cloth stretches is refused before anything is sewn. What was decided and moved is in the log.
/// `StaticEquilibrium` is given other starts, which it tries where the garment does not sew from
/// this one: legs that were swung, and a garment that was raised until its shoulder seams clear the
/// shoulders, where the pattern puts them; tiers of the pattern without the gaps between them;
/// skirts on cones around the legs.
#[stage(
    role = Placement,
    version = 10,
    source = "arrangement of pattern pieces around limbs, as in garment CAD",
    example = "Arrange(bend: true)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Arrange {
    /// Whether sleeves and cuffs are bent around the arms, and flat halves of legs that miss the
    /// body's legs are swung to where those are. Without it they stand where the pattern puts them.
    #[param(default = true)]
    bend: bool,
    /// Least distance of a bent piece from the arm.
    #[param(default = Length::cm(2.0), min = 0.0, max = 0.5)]
    clearance: Length,
    /// Greatest share by which an arm may stretch a sleeve or cuff that goes around it. What is cut
    /// narrower than that is refused, with both girths (woven cotton tears at some 25 %).
    #[param(default = 0.25, min = 0.0, max = 10.0)]
    max_tight: f64,
    /// Pieces that are placed by hand: points of their edges at landmarks of the body, such as
    /// `[(edge: "collar.neck", at: 0.5, landmark: "neck_base_back")]`. A piece with one key point
    /// is moved, with more it is turned as well; it stays flat, `clearance` outside of the
    /// landmarks, and nothing else moves it.
    #[param(default = Vec::new(), min = 0, max = 1)]
    key_points: Vec<KeyPoint>,
    /// Pieces that are moved by hand, as the studio does when they are dragged:
    /// `[(piece: "collar", middle: ("0 mm", "1450 mm", "-80 mm"), turn: (0, 180, 0))]`. The middle
    /// of the piece's box stands there, measured to the wearer's left, up from the floor and
    /// forwards, and the piece is turned about it by degrees around these axes, one after the
    /// other. It keeps the shape that it has otherwise; one that nothing else places is flat and
    /// upright, its outside forwards.
    #[param(default = Vec::new())]
    hand_places: Vec<HandPlace>,
}

#[stage]
impl Arrange {
    pub(crate) fn run(
        &self,
        pattern: &Pattern,
        panels: Set<Panel>,
        plan: &SewingPlan,
        body: &Body,
        fabric: &Fabric,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let offsets = offsets(&panels)?;
        let seams = seams(plan, &offsets)?;
        let folded = pleats::fold(pattern, &offsets)?;
        let mut flat = offsets.clone();
        for (name, of) in &folded {
            cx.note(format!("\"{name}\" is {}", of.told));
            if let Some((_, panel)) = flat.get_mut(name.as_str()) {
                *panel = &of.panel;
            }
        }
        let patches = patches::names(pattern);
        let clearance = self.clearance.metres();
        let (by_hand, told_by_hand) = key_points::place(&self.key_points, pattern, &flat, body, clearance)?;
        let keyed = key_points::names(&self.key_points);
        if let Some(name) = patches.intersection(&keyed).next() {
            return Err(StageError::invalid(format!(
                "the piece \"{name}\" lies on the piece that it is sewn onto"
            ))
            .at("key_points")
            .hint(format!("take \"{name}\" out of `key_points`")));
        }
        told_by_hand.into_iter().for_each(|what| cx.note(what));
        let dragged = hand_places::names(&self.hand_places, &flat, &patches, &keyed)?;
        let mut elsewhere: BTreeSet<String> = patches.union(&keyed).cloned().collect();
        let outer = patches::without(pattern, &patches);
        let mut worn = patches::without(pattern, &elsewhere);
        if worn.pieces.iter().any(|p| p.pose.is_some()) {
            let has_pose = |name: &&String| pattern.piece(name).is_some_and(|p| p.pose.is_some());
            elsewhere.extend(dragged.iter().filter(|name| !has_pose(name)).cloned());
            worn = patches::without(pattern, &elsewhere);
        }
        let mut standing = flat.clone();
        standing.retain(|name, _| !elsewhere.contains(*name));
        // A pattern without any pose is placed by what its pieces are.
        let unplaced = worn.pieces.iter().all(|p| p.pose.is_none());
        let (mut places, sleeves) = match unplaced && !worn.pieces.is_empty() {
            true => self.stood(&outer, [&keyed, &dragged], &standing, body, cx)?,
            false => (posed(&worn, &standing)?, None),
        };
        elsewhere.extend(dragged.iter().filter(|name| !places.contains_key(*name)).cloned());
        let worn = patches::without(pattern, &elsewhere);
        self.raise(&mut places, body, cx);
        let mut put = places.clone();
        hand_places::stand(&dragged, &flat, &mut put);
        hand_places::put(&self.hand_places, &mut put);
        at_the_body(&put, body)?;
        layers::spread(&worn, &mut places, body);
        let finished = |mut places: PiecePlaces| -> Result<(Vec<Point3>, Vec<String>), StageError> {
            places.extend(by_hand.clone());
            hand_places::stand(&dragged, &flat, &mut places);
            for (name, of) in &folded {
                if let Some(places) = places.get_mut(name) {
                    of.deepen(places);
                }
            }
            hand_places::put(&self.hand_places, &mut places);
            let told = patches::lay(&patches, &mut places, &seams, &flat)?;
            Ok((places.into_values().flatten().collect(), told))
        };
        let moving = MoveInput {
            body,
            pattern: &worn,
            seams: &seams,
            offsets: &offsets,
            sleeves: sleeves.as_deref(),
            clearance,
        };
        let moved = |places: &PiecePlaces| match self.bend {
            true => moving.moved_and_others(places),
            false => (Moved { places: places.clone(), told: Vec::new(), narrowest: None }, Vec::new()),
        };
        let named = sleeves.iter().flatten().map(|s| s.0.clone()).collect::<Vec<_>>();
        let mut others = Vec::new();
        let raised = raised(&worn, &named, &places, &flat, &seams, (body, false));
        if raised.by > 0.0 {
            others.push(("as high as the pattern puts it", moved(&places).0.places));
            places = raised.places;
            cx.note(format!(
                "raised by {:.0} mm, so that its shoulder seams clear the shoulders",
                raised.by * 1e3
            ));
        }
        let kept = places;
        let (Moved { places, told, narrowest }, unmoved) = moved(&kept);
        if let Some((names, narrow)) = narrowest {
            narrow::refuse(&names, &narrow, self.max_tight, cx.stage())?;
        }
        others.extend(unmoved);
        if self.bend && !unplaced {
            // Where not all pieces are flat, the trunk may be.
            let higher = self::raised(&worn, &named, &kept, &flat, &seams, (body, true)).places;
            let closed = tiers::closed(&moving, &higher);
            let from = closed.as_ref().unwrap_or(&higher);
            others.extend((*from != kept).then(|| (tiers::TOLD, moved(from).0.places)));
            let coned = cones::laid(&moving, from);
            others.extend(coned.map(|places| (cones::TOLD, moving.bent(places, Vec::new()).places)));
        }
        let start = |(told, places): (&str, PiecePlaces)| -> Result<GarmentStart, StageError> {
            Ok(GarmentStart { told: told.into(), positions: finished(places)?.0 })
        };
        let starts = others.into_iter().map(start).collect::<Result<Vec<_>, _>>()?;
        let (points, laid) = finished(places)?;
        told.into_iter().chain(laid).for_each(|what| cx.note(what));
        cx.check()?;
        let mut garment = Garment { starts, ..whole(&offsets, seams, fabric, points) };
        garment.panels.iter_mut().for_each(|p| p.layer = layers::layer(pattern, &p.name));
        Ok(garment)
    }

    /// Places the pieces of a pattern that has no poses; every decision is told. What is still to
    /// be bent around an arm is named with its hand.
    fn stood(
        &self,
        pattern: &Pattern,
        [keyed, dragged]: [&BTreeSet<String>; 2],
        offsets: &Offsets,
        body: &Body,
        cx: &Context,
    ) -> Result<Stood, StageError> {
        if let Some(name) = offsets.keys().find(|name| pattern.piece(name).is_none()) {
            return Err(unknown(name));
        }
        let decided = region::decide(pattern, keyed, dragged)?;
        let (places, told) = stand::stand(pattern, &decided, offsets, body, self.clearance.metres())?;
        told.into_iter().for_each(|what| cx.note(what));
        let arm = |(p, d): (&Piece, &Decided)| match d.region {
            Region::Arm(hand) => Some((p.name.clone(), hand)),
            _ => None,
        };
        Ok((places, Some(pattern.pieces.iter().zip(&decided).filter_map(arm).collect())))
    }

    /// Raises poses that were made around a body's middle.
    fn raise(&self, places: &mut PiecePlaces, body: &Body, cx: &Context) {
        let heights = || places.values().flatten().map(|p| p.y);
        let (lowest, highest) = (heights().fold(f64::INFINITY, f64::min), heights().fold(0.0, f64::max));
        let top = body.positions.iter().map(|p| p.y).fold(0.0, f64::max);
        // A long round skirt lies below the floor where it is flat; but its waist is at the body's.
        if lowest >= -BELOW || highest > WORN * top {
            return;
        }
        let by = MIDDLE * top;
        places.values_mut().flatten().for_each(|p| p.y += by);
        cx.note(format!(
            "the pattern reaches {:.0} cm below the floor: its places are taken for those around a body's middle and raised by {:.0} cm",
            -lowest * 1e2,
            by * 1e2
        ));
    }
}

/// Places of flat pieces that stand higher.
struct Raised {
    places: PiecePlaces,
    /// The farthest that a piece was raised, metres; 0 where none was.
    by: f64,
}

/// Raises each garment of flat pieces until its shoulder seams clear the shoulders of the body;
/// with true, also where only some of its pieces are flat.
fn raised(
    pattern: &Pattern,
    sleeves: &[String],
    places: &PiecePlaces,
    flat: &Offsets,
    seams: &[GarmentSeam],
    (body, some): (&Body, bool),
) -> Raised {
    let mut out = Raised { places: places.clone(), by: 0.0 };
    for layer in layers::layers(pattern) {
        let is_of = |name: &str| layers::layer(pattern, name) == layer;
        let own: PiecePlaces =
            places.iter().filter(|(name, _)| is_of(name)).map(|(n, p)| (n.clone(), p.clone())).collect();
        let by = boards::raise(&boards::boards(pattern, sleeves, &own, flat, some), seams, body);
        let mine = out.places.iter_mut().filter(|(name, _)| is_of(name));
        mine.flat_map(|(_, points)| points).for_each(|p| p.y += by);
        out.by = out.by.max(by);
    }
    out
}

/// The pieces stand where the body is.
fn at_the_body(places: &PiecePlaces, body: &Body) -> Result<(), StageError> {
    let span = |all: &mut dyn Iterator<Item = f64>| {
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
    };
    let body_of = |k: usize| span(&mut body.positions.iter().map(|p| p[k]));
    let ((floor, top), height) = (body_of(1), body_of(1).1 - body_of(1).0);
    let heights = span(&mut places.values().flatten().map(|p| p.y));
    let wrong = |what: String| {
        let e = StageError::new(ErrorCode::PatternLoading, what);
        Err(e.hint(
            "take the body that the pattern was drafted for, and look at the pattern's units and places",
        ))
    };
    if body.positions.is_empty() || places.values().all(Vec::is_empty) {
        return Ok(());
    }
    if heights.1 > top + BEYOND * height {
        let over = (heights.1 - top) * 1e2;
        return wrong(format!(
            "the pattern reaches {over:.0} cm above the body, which is {:.0} cm high",
            height * 1e2
        ));
    }
    if heights.1 < floor + LEAST_WORN * height {
        let at = (heights.1 - floor) * 1e2;
        return wrong(format!(
            "the highest point of the pattern stands {at:.0} cm above the floor, the body is {:.0} cm high: nothing would hold it",
            height * 1e2
        ));
    }
    for k in [0, 2] {
        let (middle, own) = (span(&mut places.values().flatten().map(|p| p[k])), body_of(k));
        let off = (f64::midpoint(middle.0, middle.1) - f64::midpoint(own.0, own.1)).abs();
        if off > ASIDE * height {
            return wrong(format!("the middle of the pattern stands {:.0} cm beside the body", off * 1e2));
        }
    }
    Ok(())
}

/// The vertices of every panel where its piece's pose puts them, in the order of the offsets.
fn posed(pattern: &Pattern, offsets: &Offsets) -> Result<PiecePlaces, StageError> {
    let place = |(name, (_, panel)): (&&str, &(usize, &Panel))| {
        let piece = pattern.piece(name).ok_or_else(|| unknown(name))?;
        let pose = piece.pose.ok_or_else(|| {
            StageError::invalid(format!("nothing says where the piece \"{name}\" stands"))
                .hint("place it by `hand_places` or `key_points` of `Arrange`, or give its pattern places around the body, as GarmentCode files have")
        })?;
        Ok(((*name).to_owned(), panel.positions.iter().map(|p| pose.at(*p)).collect()))
    };
    offsets.iter().map(place).collect()
}

fn unknown(name: &str) -> StageError {
    StageError::invalid(format!("the pattern has no piece \"{name}\""))
        .hint("let the panels be those of the pattern: no stage between may rename them")
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod unplaced;
