//! Panels are sewn, on the coarsest level.

use crate::contact::skin::CollisionSurface;
use crate::mesh::Sheet;
use crate::scene::Seam;
use crate::statics::drive::coarse_to_fine::Solve;
use crate::statics::drive::contour::uncross;
use crate::statics::forces::height_springs::HeightSprings;
use crate::statics::forces::seam_force::{SeamForce, widest};
use crate::statics::forces::system::System;
use crate::statics::levels::assemble::{Collider, assemble, gravity, spacing, strongest};
use crate::statics::levels::bending_continuation::stages;
use crate::statics::levels::buckle::out_of_plane;
use crate::statics::newton::patience::Patience;
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::Progress;
use crate::statics::report::error::MOST_EDGES;
use crate::statics::report::error::StaticsError;
use crate::statics::report::start::probably_reversed;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Force of a seam per metre, as a share of stretch stiffness: the strain that sewing causes.
const SEAM_PULL: f64 = 0.01;

/// Factor by which a seam that stays open pulls harder, and how often.
const HARDER: (f64, usize) = (3.0, 4);

/// Steps of sewing, its first step of pseudo-time, s, and the least way that is the farthest of a
/// step, m.
const SEWING: (usize, f64, f64) = (40, 0.02, 0.05);

/// Steps in which a wide gap must shrink, and by what share of itself; else it is pulled harder, or
/// given up.
const SHRINKING: (usize, f64) = (12, 0.01);

/// How many times more a gap may shrink under a harder pull than in proportion to it.
const MORE_THAN_LINEAR: f64 = 3.0;

/// The share of an edge that a gap may be wide where cloth is taken out of itself after sewing.
const SNAPPED: f64 = 0.3;

/// Cloth that is less deep in the body than this comes out while it drapes, and the farthest that
/// is looked for it, m.
const SHALLOW: f64 = 5e-3;
const DEEPEST: f64 = 0.3;

/// Steps in which sewn cloth slides to where it fits, and the longest step of pseudo-time, s.
const SETTLING: usize = 60;
const LONGEST: f64 = 0.5;

/// How stiff a panel is held at its mean height while it is sewn, a square metre of it, as a share
/// of the pull of a metre of seam in the first round, 1/m^2. Found by trial: stiffer in the harder
/// rounds, waist seams of panels placed apart stay open.
const HELD: f64 = 40.0;

/// The share of that with which sewn cloth is held that a body pushes out of itself: it goes up
/// with the shoulders.
const LOOSE: f64 = 0.05;

/// Steps in which cloth without seams is pressed flat.
const PRESSING: usize = 10;

impl Solve<'_> {
    /// Closes the seams on the coarsest level and joins them.
    pub(crate) fn sew(&mut self, progress: &mut Progress<'_>) -> Result<(), StaticsError> {
        let coarsest = self.plan.pieces.len() - 1;
        let sheet = self.plan.pieces[coarsest].open_sheet(&self.plan.cloths)?;
        let mut x = self.plan.starts[coarsest].clone();
        let pairs = self.plan.pieces[coarsest].seam_pairs();
        let here = self.plan.settings.from_here;
        if here && widest(&x, &pairs) <= self.plan.settings.join_gap {
            self.joined_at = (!pairs.is_empty()).then(|| widest(&x, &pairs));
        } else if pairs.is_empty() {
            self.press(&sheet, &mut x, progress)?;
        } else {
            self.close(&sheet, &pairs, &mut x, progress)?;
        }
        self.x = self.plan.pieces[coarsest].sew(&x, sheet.masses());
        self.crossed = if self.through { self.uncross()? } else { 0 };
        if let (Some(body), [first, next @ ..]) = (self.plan.body, self.plan.around) {
            // Friction would hold the cloth where its seams happened to close.
            let solid = |skin| Collider { skin, friction: 0.0 };
            self.settle_on(solid(*first), progress)?;
            for skin in next.iter().copied().chain([body.skin]) {
                self.push_out(solid(skin), progress)?;
            }
            self.settle_on(solid(body.skin), progress)?;
        }
        Ok(())
    }

    /// Closes the seams.
    fn close(
        &mut self,
        sheet: &Sheet,
        pairs: &[[u32; 2]],
        x: &mut [Vec3],
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        self.through = self.plan.settings.sew_through;
        let start = x.to_vec();
        let mut force = self.draw(sheet, pairs, x, progress)?;
        if widest(x, pairs) > self.most_gap() {
            let pieces = &self.plan.pieces[self.plan.pieces.len() - 1];
            if let Some(bent) = out_of_plane(pieces, &start, x, self.plan.edge()) {
                x.copy_from_slice(&bent);
                force = self.draw(sheet, pairs, x, progress)?;
            }
        }
        let gap = widest(x, pairs);
        self.joined_at = Some(gap);
        if gap > self.most_gap() {
            let seam = self.widest_seam(self.plan.pieces.len() - 1, x);
            let reversed = probably_reversed(self.plan.scene, &self.plan.starts[0]);
            let positions = self.carried(x);
            return Err(StaticsError::SeamNotClosed { seam, gap, force, reversed, positions });
        }
        Ok(())
    }

    /// Takes the cloth, just sewn, out of itself; how often it still crosses itself.
    fn uncross(&mut self) -> Result<usize, StaticsError> {
        if !self.plan.scene.self_collision {
            return Ok(0);
        }
        let pieces = &self.plan.pieces[self.plan.pieces.len() - 1];
        let sheet = pieces.sewn_sheet(&self.plan.cloths)?;
        let tree = self.plan.tree(&sheet, &self.x, false);
        let mut pinned = vec![false; pieces.nodes];
        pieces.node.iter().zip(&pieces.pinned).for_each(|(n, p)| pinned[*n as usize] |= p);
        Ok(uncross(&sheet, &tree, &pinned, &mut self.x))
    }

    /// Draws the seams of cloth together that is as stiff as its first state is to be, or else,
    /// each time from the start, as stiff as they close; the force a metre that it took.
    fn draw(
        &mut self,
        sheet: &Sheet,
        pairs: &[[u32; 2]],
        x: &mut [Vec3],
        progress: &mut Progress<'_>,
    ) -> Result<f64, StaticsError> {
        let continuation = self.plan.continuation(sheet.size()).filter(|_| self.plan.around.is_empty());
        let first = continuation.map_or(1.0, |g| g.first());
        let mut force = 0.0;
        let start = x.to_vec();
        let softer = stages(first, 1.0);
        // What stays wide open as limp as it is would stay so while it is stiffer, too: that is
        // looked at before the stages between.
        let probe = softer.last().copied().filter(|_| softer.len() > 1);
        for (k, stiff) in std::iter::once(first).chain(probe).chain(softer).enumerate() {
            // Cloth too stiff to go round the body has been squeezed out of its place: above the
            // arms, off the shoulders.
            x.copy_from_slice(&start);
            force = self.pull(sheet, pairs, x, stiff, progress)?;
            let gap = widest(x, pairs);
            let is_probe = k == 1 && probe.is_some();
            if if is_probe { self.is_wide(gap) } else { gap <= self.most_gap() } {
                break;
            }
        }
        Ok(force)
    }

    fn seam_forces(&self, pairs: &[[u32; 2]], force: f64) -> Vec<SeamForce> {
        let soft = 2.0 * self.plan.settings.join_gap;
        pairs.iter().map(|nodes| SeamForce { nodes: *nodes, force, soft }).collect()
    }

    /// Pulls harder and harder until the seams are closed; the force a metre that it took.
    fn pull(
        &mut self,
        sheet: &Sheet,
        pairs: &[[u32; 2]],
        x: &mut [Vec3],
        stiff: f64,
        progress: &mut Progress<'_>,
    ) -> Result<f64, StaticsError> {
        let coarsest = self.plan.pieces.len() - 1;
        let spacing = spacing(&self.plan.pieces[coarsest], pairs);
        let mut pull = SEAM_PULL * strongest(&self.plan.cloths);
        let mut before = f64::INFINITY;
        for round in 0..HARDER.1 {
            let gap = widest(x, pairs);
            if gap < self.plan.settings.join_gap || self.is_wide(gap) && is_hopeless(before, gap, round) {
                break;
            }
            before = gap;
            let mut system = self.open(sheet, stiff)?;
            system.seam_forces = self.seam_forces(pairs, pull * spacing);
            if !self.plan.around.is_empty() {
                system.height_springs = self.height_springs(
                    sheet,
                    &self.plan.starts[coarsest],
                    1.0,
                    self.plan.pieces[coarsest].panel.clone(),
                );
            }
            let (steps, first, least) = SEWING;
            let farthest = (0.2 * gap).max(least);
            let options = NewtonOptions {
                first,
                longest: 1.0,
                steps,
                speed: self.plan.settings.speed,
                farthest,
                asleep: self.plan.settings.asleep && self.plan.around.is_empty(),
                ..self.options()
            };
            let shrinking = Patience::new(SHRINKING);
            let closed = |_: &System<'_>, x: &[Vec3]| {
                let gap = widest(x, pairs);
                gap < self.plan.settings.join_gap || self.is_wide(gap) && !shrinking.goes_on(gap)
            };
            let report =
                self.relax(&mut system, sheet, &self.plan.starts[coarsest], x, &options, &closed, progress)?;
            self.reports.push(report);
            pull *= HARDER.0;
        }
        Ok(pull / HARDER.0)
    }

    /// Lets a solid push the sewn cloth out of itself.
    fn push_out(&mut self, solid: Collider<'_>, progress: &mut Progress<'_>) -> Result<(), StaticsError> {
        self.slide(solid, LOOSE, SEWING.0, &|x| depth(solid.skin, x) <= SHALLOW, progress)
    }

    /// Lets the sewn cloth slide on a solid to where it fits.
    fn settle_on(&mut self, solid: Collider<'_>, progress: &mut Progress<'_>) -> Result<(), StaticsError> {
        self.slide(solid, 0.0, SETTLING, &|_| false, progress)
    }

    /// Lets the sewn cloth move on a solid, without weight, held at its height so hard, in so many
    /// steps or until it is done.
    fn slide(
        &mut self,
        solid: Collider<'_>,
        held: f64,
        steps: usize,
        done: &dyn Fn(&[Vec3]) -> bool,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let coarsest = self.plan.pieces.len() - 1;
        let pieces = &self.plan.pieces[coarsest];
        let sheet = pieces.sewn_sheet(&self.plan.cloths)?;
        let start = pieces.sew(&self.plan.starts[coarsest], &vec![1.0; pieces.rest.len()]);
        let mut panel = vec![0; pieces.nodes];
        pieces.node.iter().zip(&pieces.panel).for_each(|(n, p)| panel[*n as usize] = *p);
        let mut x = std::mem::take(&mut self.x);
        let mut system =
            assemble(self.plan.scene, Some(solid), pieces, &sheet, false, self.plan.settings.models)?;
        system.gravity = Vec3::zeros();
        system.ridges = None;
        system.body_contact.iter_mut().for_each(|s| (s.passes, s.depth) = (true, DEEPEST));
        system.height_springs = self.height_springs(&sheet, &start, held, panel);
        let (_, first, farthest) = SEWING;
        let speed = self.plan.settings.speed;
        let options = NewtonOptions {
            first,
            longest: LONGEST,
            steps,
            speed,
            farthest,
            rough: true,
            asleep: false,
            ..self.options()
        };
        let report = self.relax(&mut system, &sheet, &start, &mut x, &options, &|_, x| done(x), progress)?;
        self.reports.push(report);
        self.x = x;
        Ok(())
    }

    /// What holds each panel at its height under seams: a share of the pull of the first round.
    fn height_springs(
        &self,
        sheet: &Sheet,
        start: &[Vec3],
        share: f64,
        groups: Vec<u32>,
    ) -> Option<HeightSprings> {
        let up = -gravity(self.plan.scene).try_normalize(1e-9)?;
        let area: f64 = sheet.areas().iter().sum();
        let mass: f64 = sheet.masses().iter().sum();
        let heights = start.iter().map(|p| up.dot(p)).collect();
        let pull = share * SEAM_PULL * strongest(&self.plan.cloths);
        Some(HeightSprings { up, heights, groups, stiffness: HELD * pull * area / mass })
    }

    /// The widest gap at which seams are joined all the same, m.
    fn most_gap(&self) -> f64 {
        let joined = self.plan.settings.join_gap;
        if self.plan.settings.sew_through { joined.max(SNAPPED * self.plan.edge()) } else { joined }
    }

    /// Whether a gap is wider than a mesh that is too coarse leaves it.
    fn is_wide(&self, gap: f64) -> bool {
        gap > MOST_EDGES * self.plan.edge()
    }

    /// Lets stiff cloth without seams forget its unevenness before it has weight.
    fn press(
        &mut self,
        sheet: &Sheet,
        x: &mut [Vec3],
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let Some(continuation) = self.plan.continuation(sheet.size()) else { return Ok(()) };
        let (_, first, farthest) = SEWING;
        let options =
            NewtonOptions { first, longest: 1.0, steps: PRESSING, speed: 0.0, farthest, ..self.options() };
        let layout = x.to_vec();
        let report = self.relax(
            &mut self.open(sheet, continuation.first())?,
            sheet,
            &layout,
            x,
            &options,
            &|_, _| false,
            progress,
        )?;
        self.reports.push(report);
        Ok(())
    }

    /// Weightless cloth before it is sewn, so many times stiffer.
    fn open<'b>(&'b self, sheet: &Sheet, stiff: f64) -> Result<System<'b>, StaticsError> {
        let coarsest = &self.plan.pieces[self.plan.pieces.len() - 1];
        let mut system =
            assemble(self.plan.scene, self.plan.sewn_on(), coarsest, sheet, true, self.plan.settings.models)?;
        if self.plan.settings.bending_continuation {
            system.elastic.scale_bending(stiff);
            system.body_contact.iter_mut().for_each(|s| s.grows = true);
        }
        Ok(system)
    }

    /// The name of the seam that is open widest, with the vertices of level `k` at `x`.
    pub(crate) fn widest_seam(&self, k: usize, x: &[Vec3]) -> String {
        let gap = |p: &[u32; 2]| (x[p[0] as usize] - x[p[1] as usize]).norm();
        let worst = self.plan.pieces[k].seam_pairs().into_iter().max_by(|a, b| gap(a).total_cmp(&gap(b)));
        let point = |v: u32| self.plan.pieces[0].point[v as usize];
        let at = worst.map(|p| point(self.plan.finest_of(k, p[0])));
        let has = |s: &&Seam| s.pairs.iter().any(|p| Some(point(p[0])) == at);
        self.plan.scene.seams.iter().find(has).map_or("?", |s| &s.name).to_string()
    }
}

/// Whether a gap, `before` one pull and `after` a harder one, stays open under the hardest, when so
/// many rounds of pulling are over.
fn is_hopeless(before: f64, after: f64, rounds: usize) -> bool {
    let (factor, most) = HARDER;
    // Of a sheet that stretches, the gap shrinks in proportion to the pull.
    let last = factor.powi(most.saturating_sub(rounds) as i32);
    let more = (before - after) * (last - 1.0) / (1.0 - 1.0 / factor);
    rounds > 1 && MORE_THAN_LINEAR * more < after
}

/// How deep a vertex lies in a solid at most, m.
fn depth(skin: &dyn CollisionSurface, x: &[Vec3]) -> f64 {
    let near = skin.nearest(x, &vec![DEEPEST; x.len()]);
    near.iter().flatten().map(|n| -n.distance).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_that_a_harder_pull_hardly_closes_is_given_up() {
        assert!(!is_hopeless(f64::INFINITY, 0.3, 0));
        assert!(!is_hopeless(0.5, 0.3, 1), "the first pull tells nothing yet");
        assert!(is_hopeless(0.300, 0.299, 2));
        assert!(!is_hopeless(0.30, 0.28, 2), "nine times the pull may close it");
        assert!(is_hopeless(0.30, 0.28, 3), "three times will not");
        assert!(!is_hopeless(0.30, 0.25, 3));
    }
}
