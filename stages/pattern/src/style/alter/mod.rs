//! `Alter`: a pattern changed as a person changes it on the screen.
//!
//! Method: [`moved`] moves corners, and every edge beside them follows by the similarity that takes
//! its old ends to the new ones, so that it keeps its shape; [`dart`] cuts darts, [`mirror`] makes
//! mirror images, [`sewn`] sews and opens seams and takes pieces out, [`sewn_on`] sews
//! pockets on. [`held`] refuses what no cloth can be cut to. The
//! changed pattern is lowered anew; [`shown`] remembers of each edge where its cloth lies in the
//! photo, by shares of its length, so that the photo goes along. [`names`] finds what an alteration
//! names. Cost: some milliseconds an alteration. Limits: lines and holes within a piece stay where
//! they are, but for the ends of lines that lie on an edge that moves.

mod agree;
mod alteration;
mod dart;
mod held;
mod mirror;
mod moved;
mod names;
mod sewn;
mod sewn_on;
mod shown;
#[cfg(test)]
mod tests;

pub use alteration::Alteration;
use shown::Showing;
use toile_core::prelude::*;

/// What is cut and sewn, before and behind.
type CutAndSewn = (Pattern, Set<Outline>, SewingPlan);

/// Changes a pattern by hand: moves corners and edges, cuts darts, mirrors pieces and takes them
/// out, sews and opens seams.
///
/// Stands behind what makes the pattern: the style, `Neckline`, or a reader. Alterations act one
/// after the other. Edges are those of the pattern, `"piece.edge"`; y is up and x to the right as
/// seen from outside the wearer. `MoveCorner` and `MoveEdge` move, and the edges beside follow and
/// keep their shape. `Lengthen` makes one edge longer: an edge that is nearer to upright than to
/// level grows at its lower end, any other at both ends by half. `Dart` is cut out of an edge,
/// which becomes `EDGE_1`, `EDGE_dart_1`, `EDGE_dart_2` and `EDGE_2`, and keeps its seams. `Mirror`
/// adds a piece, or makes one that is there the mirror image. `Sew` pairs the start of one edge
/// with the end of the other, as pieces laid face to face meet; `SewOn` sews all edges of a piece
/// but the highest onto another piece, as a pocket. `Unsew` opens every seam of an edge, `Remove`
/// takes a piece out and opens its seams. A seam whose sides differ now is eased or gathered, with
/// a note. Pieces of photos take their picture along.
#[stage(
    role = Style,
    source = "pattern alteration: Aldrich 2008; mean value coordinates: Hormann and Floater 2006",
    example = "Alter(alterations: [MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"20 mm\")])",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Alter {
    /// What is changed, in this order:
    /// `MoveCorner(piece: "front", corner: 2, x: "0 mm", y: "-20 mm")` (the edge number 2, counted
    /// from 0, starts at that corner), `MoveEdge(edge: "front.hem", x: "0 mm", y: "20 mm")`,
    /// `Lengthen(edge: "front.side_left", by: "20 mm")`,
    /// `Dart(edge: "front.hem", at: 0.5, width: "20 mm", length: "90 mm")`,
    /// `Mirror(piece: "front", name: "lining")`,
    /// `Sew(a: "front.hem", b: "back.hem", reversed: false)`,
    /// `SewOn(piece: "pocket", onto: "front", x: "60 mm", y: "0 mm")`,
    /// `Unsew(edge: "front.side_left")`, `Remove(piece: "pocket")`.
    #[param(default = Vec::new())]
    alterations: Vec<Alteration>,
}

#[stage]
impl Alter {
    pub(crate) fn run(
        &self,
        pattern: &Pattern,
        outlines: Option<Set<Outline>>,
        plan: Option<&SewingPlan>,
        cx: &Context,
    ) -> Result<CutAndSewn, StageError> {
        let before = pattern.lower().map_err(|e| StageError::invalid(e.to_string()).hint(e.remedy()))?;
        if let Some(outlines) = &outlines {
            belong(&before, outlines, plan)?;
        }
        if self.alterations.is_empty() {
            cx.note("`alterations` names none: the pattern stays as it is");
        }
        let mut altered =
            AlteredPattern { pattern: pattern.clone(), showing: Showing::of(pattern, outlines.as_ref()) };
        for (k, alteration) in self.alterations.iter().enumerate() {
            cx.check()?;
            let done = alteration.carry_out(&mut altered, cx);
            done.map_err(|e| e.at("alterations").within(k))?;
        }
        let AlteredPattern { pattern: changed, showing } = altered;
        changed.check().map_err(StageError::internal)?;
        let lowered = changed.lower().map_err(|e| {
            StageError::invalid(e.to_string()).hint("let fewer seams run through it").at("alterations")
        })?;
        agree::tell(pattern, &changed, cx);
        let shown = |(name, o): (String, Outline)| {
            let o = showing.laid(&changed, &name, o);
            (name, o)
        };
        let outlines = lowered.outlines.into_iter().map(shown).collect();
        Ok((changed, outlines, lowered.plan))
    }
}

/// A pattern that is being altered, and what photos show of it.
struct AlteredPattern {
    pattern: Pattern,
    showing: Showing,
}

/// Whether outlines and plan are what the pattern is cut and sewn to: else their changes would be
/// lost.
fn belong(before: &Lowered, outlines: &Set<Outline>, plan: Option<&SewingPlan>) -> Result<(), StageError> {
    let names = |o: &Outline| o.edges.iter().map(|e| e.name.clone()).collect::<Vec<String>>();
    let is_same =
        |name: &str, o: &Outline| before.outlines.get(name).is_some_and(|was| names(was) == names(o));
    if let Some((name, _)) = outlines.iter().find(|(name, o)| !is_same(name, o)) {
        return Err(StageError::invalid(format!("the outline \"{name}\" is not as the pattern draws it"))
            .hint("put `Alter` right behind the stage that makes the pattern, or behind `Neckline`"));
    }
    let sewn = |s: &Seam| (s.a.clone(), s.b.clone(), s.reversed);
    let seams = |plan: &SewingPlan| plan.seams.iter().map(sewn).collect::<Vec<_>>();
    match plan.is_none_or(|plan| seams(plan) == seams(&before.plan)) {
        true => Ok(()),
        false => Err(StageError::invalid("the seams are no longer those of the pattern")
            .hint("put `Alter` before `Seams` and `Unpick`; `Unsew` and `Sew` change seams here")),
    }
}
