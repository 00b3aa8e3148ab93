//! Sewing: the seams are closed on the coarsest level.
//!
//! Method: closing forces that hardly depend on the gap pull the two sides of each seam together,
//! without weight and friction, and grow by rounds until the seams are closed (see [`SeamForce`]).
//! Then each pair becomes one node. Where the scene is sewn on other solids first, each of them
//! pushes the sewn cloth out. Cloth without seams is only flattened. Cost: some 40 Newton steps a
//! round. Limits: where the body keeps seams open, they are reported as open.

use crate::contact::collision_surface::CollisionSurface;
use crate::mesh::Sheet;
use crate::scene::Seam;
use crate::statics::drive::coarse_to_fine::{LevelMesh, Solve};
use crate::statics::drive::contour::uncross;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::height_springs::HeightSprings;
use crate::statics::forces::ridges::Ridges;
use crate::statics::forces::seam_force::{SeamForce, widest};
use crate::statics::forces::system::System;
use crate::statics::levels::assemble::{Collider, assemble, gravity, spacing, strongest};
use crate::statics::levels::bending_continuation::stages;
use crate::statics::levels::buckle::out_of_plane;
use crate::statics::newton::patience::{Patience, Shrinking};
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::Progress;
use crate::statics::report::error::MOST_EDGES;
use crate::statics::report::error::StaticsError;
use crate::statics::report::start::probably_reversed;
use toile_geometry::Vec3;

/// Closing force per metre of seam in the first round, as a share of stretch stiffness: the strain
/// that it causes.
const SEAM_PULL: f64 = 0.01;

/// Rounds of closing, in each of which the closing force is constant.
const ROUNDS: usize = 4;

/// Factor between the closing force of a round and that of the round before.
const GROWTH: f64 = 3.0;

/// Newton steps of a round.
const STEPS: usize = 40;

/// First step of pseudo-time, s.
const FIRST: f64 = 0.02;

/// Farthest that a node may move in a step, m; more where the gap is wide.
const FARTHEST: f64 = 0.05;

/// How fast a wide gap must shrink; otherwise the round ends.
const SHRINKS: Patience = Patience { steps: 12, share: 0.01 };

/// Most vertices of a mesh on which seams are closed with cloth of every stage between stiff and
/// the fabric's own, where the caller has another way of sewing: on a finer mesh they take half a
/// minute.
const MOST_SOFTENED: usize = 2000;

/// A gap may shrink under a stronger force by up to this factor more than in proportion to the
/// force.
const MORE_THAN_LINEAR: f64 = 3.0;

/// Widest gap at which seams are joined where crossings are resolved after sewing, as a share of an
/// edge.
const JOINED_GAP: f64 = 0.3;

/// Depth in the body up to which cloth comes out while it drapes, m.
const SHALLOW: f64 = 5e-3;

/// Greatest depth at which cloth in the body is found, m.
const DEEPEST: f64 = 0.3;

/// Newton steps in which sewn cloth slides to where it fits.
const SLIDING_STEPS: usize = 60;

/// Longest step of pseudo-time while it slides, s.
const LONGEST_SLIDE: f64 = 0.5;

/// Stiffness of the height springs of a square metre of panel, as a share of the closing force of a
/// metre of seam in the first round, 1/m^2. Found by trial: if it grew with the closing force,
/// waist seams of panels placed apart would stay open.
const HEIGHT_STIFFNESS: f64 = 40.0;

/// Share of that stiffness while a solid pushes sewn cloth out of itself: the cloth must rise with
/// the shoulders.
const PUSHED_STIFFNESS: f64 = 0.05;

/// Newton steps in which cloth without seams is flattened.
const FLATTENING_STEPS: usize = 10;

impl Solve<'_> {
    /// Closes the seams on the coarsest level and joins them.
    pub(crate) fn sew(&mut self, progress: &mut Progress<'_>) -> Result<(), StaticsError> {
        let coarsest = self.plan.coarsest_level();
        let sheet = self.plan.pieces[coarsest].open_sheet(&self.plan.cloths)?;
        let mut x = self.plan.starts[coarsest].clone();
        let pairs = self.plan.pieces[coarsest].seam_pairs();
        if self.plan.settings.from_here && widest(&x, &pairs) <= self.plan.settings.join_gap {
            self.joined_at = (!pairs.is_empty()).then(|| widest(&x, &pairs));
        } else if pairs.is_empty() {
            self.flatten(&sheet, &mut x, progress)?;
        } else {
            self.close(&sheet, &pairs, &mut x, progress)?;
        }
        self.x = self.plan.pieces[coarsest].sew(&x, sheet.masses());
        self.crossings = if self.sews_through { self.uncross()? } else { 0 };
        if let (Some(body), [first, next @ ..]) = (self.plan.body, self.plan.around) {
            // Without friction, which would hold the cloth where its seams happened to close.
            let solid = |surface| Collider { surface, friction: 0.0 };
            self.settle_on(solid(*first), progress)?;
            for surface in next.iter().copied().chain([body.surface]) {
                self.push_out(solid(surface), progress)?;
            }
            self.settle_on(solid(body.surface), progress)?;
        }
        Ok(())
    }

    /// Closes the seams, of flat cloth a second time from a start out of its plane (see `buckle`).
    fn close(
        &mut self,
        sheet: &Sheet,
        pairs: &[[u32; 2]],
        x: &mut [Vec3],
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        self.sews_through = self.plan.settings.sew_through;
        let start = x.to_vec();
        let mut force = self.close_with_continuation(sheet, pairs, x, progress)?;
        if widest(x, pairs) > self.most_gap() {
            let pieces = &self.plan.pieces[self.plan.coarsest_level()];
            if let Some(bent) = out_of_plane(pieces, &start, x, self.plan.edge()) {
                x.copy_from_slice(&bent);
                force = self.close_with_continuation(sheet, pairs, x, progress)?;
            }
        }
        let gap = widest(x, pairs);
        self.joined_at = Some(gap);
        if gap > self.most_gap() {
            let seam = self.widest_seam(self.plan.coarsest_level(), x);
            let reversed = probably_reversed(self.plan.scene, &self.plan.starts[0]);
            let positions = self.prolonged(self.plan.coarsest_level(), x.to_vec());
            return Err(StaticsError::SeamNotClosed { seam, gap, force, reversed, positions });
        }
        Ok(())
    }

    /// Resolves the crossings of the sewn cloth with itself; returns how many are left.
    fn uncross(&mut self) -> Result<usize, StaticsError> {
        if !self.plan.scene.self_collision {
            return Ok(0);
        }
        let pieces = &self.plan.pieces[self.plan.coarsest_level()];
        let sheet = pieces.sewn_sheet(&self.plan.cloths)?;
        let tree = self.plan.tree(self.plan.coarsest_level(), &sheet, &self.x, false);
        let mut pinned = vec![false; pieces.nodes];
        pieces.node.iter().zip(&pieces.pinned).for_each(|(n, p)| pinned[*n as usize] |= p);
        Ok(uncross(&sheet, &tree, &pinned, &mut self.x))
    }

    /// Closes the seams of cloth as stiff as in the first equilibrium. Where they stay open, tries
    /// again from the start with softer cloth. Returns the closing force per metre that it took.
    fn close_with_continuation(
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
        let mut softer = stages(first, 1.0);
        if self.plan.settings.gives_way && x.len() > MOST_SOFTENED {
            softer.drain(..softer.len().saturating_sub(1));
        }
        // Seams that stay wide open without added stiffness stay open with it, too. So the softest
        // stage is tried before the stages between.
        let probe = softer.last().copied().filter(|_| softer.len() > 1);
        for (k, stiff) in std::iter::once(first).chain(probe).chain(softer).enumerate() {
            // Cloth too stiff to go around the body may have moved away: above the arms, or off the
            // shoulders.
            x.copy_from_slice(&start);
            force = self.close_in_rounds(sheet, pairs, x, stiff, progress)?;
            let gap = widest(x, pairs);
            let is_probe = k == 1 && probe.is_some();
            if if is_probe { self.is_wide(gap) } else { gap <= self.most_gap() } {
                break;
            }
        }
        Ok(force)
    }

    /// The closing forces of pairs of vertices, N each.
    fn seam_forces(&self, pairs: &[[u32; 2]], force: f64) -> Vec<SeamForce> {
        let softening = 2.0 * self.plan.settings.join_gap;
        pairs.iter().map(|nodes| SeamForce { nodes: *nodes, force, softening }).collect()
    }

    /// Increases the closing force by rounds until the seams are closed; returns the force per
    /// metre that it took.
    fn close_in_rounds(
        &mut self,
        sheet: &Sheet,
        pairs: &[[u32; 2]],
        x: &mut [Vec3],
        stiff: f64,
        progress: &mut Progress<'_>,
    ) -> Result<f64, StaticsError> {
        let coarsest = self.plan.coarsest_level();
        let spacing = spacing(&self.plan.pieces[coarsest], pairs);
        let mut pull = SEAM_PULL * strongest(&self.plan.cloths);
        let mut before = f64::INFINITY;
        for round in 0..ROUNDS {
            let gap = widest(x, pairs);
            if gap < self.plan.settings.join_gap || self.is_wide(gap) && is_hopeless(before, gap, round) {
                break;
            }
            before = gap;
            let mut system = self.open(sheet, stiff)?;
            system.set_seam_forces(self.seam_forces(pairs, pull * spacing));
            if !self.plan.around.is_empty() {
                system.loads.height_springs = self.height_springs(
                    sheet,
                    &self.plan.starts[coarsest],
                    1.0,
                    self.plan.pieces[coarsest].panel.clone(),
                );
            }
            let farthest = (0.2 * gap).max(FARTHEST);
            let options = NewtonOptions {
                first: FIRST,
                longest: 1.0,
                steps: STEPS,
                speed: self.plan.settings.speed,
                farthest,
                asleep: self.plan.settings.asleep && self.plan.around.is_empty(),
                ..self.options()
            };
            let shrinking = Shrinking::new(SHRINKS);
            let closed = |_: &System<'_>, x: &[Vec3]| {
                let gap = widest(x, pairs);
                gap < self.plan.settings.join_gap || self.is_wide(gap) && !shrinking.goes_on(gap)
            };
            let mesh = LevelMesh { k: coarsest, is_open: true, sheet, layout: &self.plan.starts[coarsest] };
            let report = self.relax(mesh, &mut system, x, &options, &closed, progress)?;
            self.reports.push(report);
            pull *= GROWTH;
        }
        Ok(pull / GROWTH)
    }

    /// Lets a solid push the sewn cloth out of itself.
    fn push_out(&mut self, solid: Collider<'_>, progress: &mut Progress<'_>) -> Result<(), StaticsError> {
        self.slide(solid, PUSHED_STIFFNESS, STEPS, &|x| depth(solid.surface, x) <= SHALLOW, progress)
    }

    /// Lets the sewn cloth slide on a solid to where it fits.
    fn settle_on(&mut self, solid: Collider<'_>, progress: &mut Progress<'_>) -> Result<(), StaticsError> {
        self.slide(solid, 0.0, SLIDING_STEPS, &|_| false, progress)
    }

    /// Lets the sewn cloth move on a solid, without weight, in so many steps or until it is `done`.
    /// `stiffness` is that of the height springs, as a share of their stiffness while seams close.
    fn slide(
        &mut self,
        solid: Collider<'_>,
        stiffness: f64,
        steps: usize,
        done: &dyn Fn(&[Vec3]) -> bool,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let coarsest = self.plan.coarsest_level();
        let pieces = &self.plan.pieces[coarsest];
        let sheet = pieces.sewn_sheet(&self.plan.cloths)?;
        let start = pieces.sew(&self.plan.starts[coarsest], &vec![1.0; pieces.rest.len()]);
        let mut panel = vec![0; pieces.nodes];
        pieces.node.iter().zip(&pieces.panel).for_each(|(n, p)| panel[*n as usize] = *p);
        let mut x = std::mem::take(&mut self.x);
        let mut system =
            assemble(self.plan.scene, Some(solid), pieces, &sheet, false, self.plan.settings.models)?;
        system.remove::<Ridges>();
        if let Some(contact) = system.get_mut::<BodyContact>() {
            (contact.lets_through, contact.depth) = (true, DEEPEST);
        }
        system.loads.gravity = Vec3::zeros();
        system.loads.height_springs = self.height_springs(&sheet, &start, stiffness, panel);
        let options = NewtonOptions {
            first: FIRST,
            longest: LONGEST_SLIDE,
            steps,
            speed: self.plan.settings.speed,
            farthest: FARTHEST,
            skip_line_search: true,
            asleep: false,
            ..self.options()
        };
        let mesh = LevelMesh { k: coarsest, is_open: false, sheet: &sheet, layout: &start };
        let report = self.relax(mesh, &mut system, &mut x, &options, &|_, x| done(x), progress)?;
        self.reports.push(report);
        self.x = x;
        Ok(())
    }

    /// Springs that hold each panel at its height while seams close.
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
        Some(HeightSprings { up, heights, groups, stiffness: HEIGHT_STIFFNESS * pull * area / mass })
    }

    /// The widest gap at which seams are joined, m.
    fn most_gap(&self) -> f64 {
        let joined = self.plan.settings.join_gap;
        if self.plan.settings.sew_through { joined.max(JOINED_GAP * self.plan.edge()) } else { joined }
    }

    /// Whether a gap is too wide to be left by a coarse mesh alone.
    fn is_wide(&self, gap: f64) -> bool {
        gap > MOST_EDGES * self.plan.edge()
    }

    /// Flattens stiff cloth without seams before it has weight.
    fn flatten(
        &mut self,
        sheet: &Sheet,
        x: &mut [Vec3],
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let Some(continuation) = self.plan.continuation(sheet.size()) else { return Ok(()) };
        let options = NewtonOptions {
            first: FIRST,
            longest: 1.0,
            steps: FLATTENING_STEPS,
            speed: 0.0,
            farthest: FARTHEST,
            ..self.options()
        };
        let layout = x.to_vec();
        let mesh = LevelMesh { k: self.plan.coarsest_level(), is_open: true, sheet, layout: &layout };
        let system = &mut self.open(sheet, continuation.first())?;
        let report = self.relax(mesh, system, x, &options, &|_, _| false, progress)?;
        self.reports.push(report);
        Ok(())
    }

    /// The system of the open panels without weight, with bending `stiff` times stiffer.
    fn open<'b>(&'b self, sheet: &Sheet, stiff: f64) -> Result<System<'b>, StaticsError> {
        let coarsest = &self.plan.pieces[self.plan.coarsest_level()];
        let mut system =
            assemble(self.plan.scene, self.plan.sewn_on(), coarsest, sheet, true, self.plan.settings.models)?;
        if self.plan.settings.bending_continuation {
            system.elastic.scale_bending(stiff);
            system.get_mut::<BodyContact>().into_iter().for_each(|c| c.grows_offsets = true);
        }
        Ok(system)
    }

    /// The name of the seam with the widest gap, with the vertices of level `k` at `x`.
    pub(crate) fn widest_seam(&self, k: usize, x: &[Vec3]) -> String {
        let gap = |p: &[u32; 2]| (x[p[0] as usize] - x[p[1] as usize]).norm();
        let worst = self.plan.pieces[k].seam_pairs().into_iter().max_by(|a, b| gap(a).total_cmp(&gap(b)));
        let point = |v: u32| self.plan.pieces[0].point[v as usize];
        let at = worst.map(|p| point(self.plan.finest_of(k, p[0])));
        let has = |s: &&Seam| s.pairs.iter().any(|p| Some(point(p[0])) == at);
        self.plan.scene.seams.iter().find(has).map_or("?", |s| &s.name).to_string()
    }
}

/// Whether a gap that a round has changed from `before` to `after` will stay open in the last
/// round, after so many rounds.
fn is_hopeless(before: f64, after: f64, rounds: usize) -> bool {
    // The gap of a sheet that stretches shrinks in proportion to the force.
    let last = GROWTH.powi(ROUNDS.saturating_sub(rounds) as i32);
    let more = (before - after) * (last - 1.0) / (1.0 - 1.0 / GROWTH);
    rounds > 1 && MORE_THAN_LINEAR * more < after
}

/// Greatest depth of a vertex in a solid, m.
fn depth(surface: &dyn CollisionSurface, x: &[Vec3]) -> f64 {
    let near = surface.nearest(x, &vec![DEEPEST; x.len()]);
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
