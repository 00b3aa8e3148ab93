//! The moving sheet: one step with all its corrections, and the joining of seams. Cost: a step of
//! the solver, and contacts linear in the pairs.

use super::contact::{Answer, Pushed, limit_step, nearest_on_body, respond_to_body, respond_to_self_contact};
use super::near::Near;
use super::seams::{SeamClosing, Seams};
use super::{Motion, MotionError, MotionRun, Progress, Vec3};
use crate::constraint::Provot;
use crate::energy::{Air, AirDrag, Band, Bands, Cloth, SeamSprings};
use crate::error::ClothError;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use crate::solver::{CentralDifferences, Model, Report, Solver, State};
use crate::statics::drive::contour::uncross;
use crate::statics::drive::solve::Collider;
use crate::statics::forces::clearance::clearance;
use crate::statics::forces::penetration::pierced;
use crate::statics::levels::assemble::cloths;
use crate::statics::report::start::{check_lying, crossing, crossings};
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::signed_distance::Nearest;

/// Shortest step of a solver that chooses its own, as a share of the time between two searches for
/// contacts.
const SHORTEST: f64 = 5e-5;

/// Relative difference below which two steps count as equal: the end of a phase is subject to
/// rounding.
const SAME_STEP: f64 = 1e-6;

/// Rounds at most in which triangles are lifted off the body.
const CLEARANCE_ROUNDS: usize = 10;

/// Distance within which the body is sought for a vertex whose triangle dips into it, m.
const FAR: f64 = 0.05;

/// Share of a step below which contacts hold the whole cloth back in the air.
const JAMMED: f64 = 0.5;

pub(super) struct Moving {
    sheet: Sheet,
    model: Model,
    solver: Box<dyn Solver>,
    method: super::Method,
    /// The fabric of the first panel, for solvers of one fabric.
    fabric: Fabric,
    /// Contact distance of cloth from the body and from itself, m.
    offset: f64,
    /// Friction of cloth on cloth at each node.
    friction: Vec<f64>,
    /// The share of friction that acts.
    friction_share: f64,
    limit: Option<Provot>,
    dt: f64,
    tree: Option<ClothTree>,
    inverse: Vec<f64>,
    pub(super) state: State,
    pub(super) seams: Seams,
    pub(super) progress: Progress,
    pub(super) is_joined: bool,
    pub(super) joined_at: Option<f64>,
    /// Whether contacts held the whole cloth back in the last step, so that it is in the air and
    /// not at rest.
    pub(super) is_jammed: bool,
    /// How the body pushes out what starts in it; `None` where nothing does.
    pub(super) pushed: Option<Pushed>,
}

impl Moving {
    /// The open panels, before sewing.
    pub(super) fn open(run: &MotionRun<'_>, start: Vec<Vec3>) -> Result<Self, MotionError> {
        let sheet = run.pieces.open_sheet(&cloths(run.scene))?;
        let pairs = run.pieces.seam_pairs();
        let fixed: Vec<bool> = run.pieces.pinned.clone();
        let springs = (run.pieces.springs(true), pairs.clone());
        let mut moving = Self::new(run, sheet, &fixed, springs, State::at_rest(start))?;
        moving.is_joined = pairs.is_empty();
        moving.seams = Seams::new(pairs, run.settings.seam_force);
        if run.settings.through.is_some() {
            moving.tree = None;
            return Ok(moving);
        }
        let is_sewn =
            moving.seams.widest(&moving.state.x).is_some_and(|(_, gap)| gap < run.settings.join_gap);
        moving.tree = moving.tree.map(|t| t.sewing(run.pieces.point.clone()));
        if let Some(tree) = moving.tree.as_ref().filter(|_| !is_sewn) {
            let (x, panel) = (&moving.state.x, &run.pieces.panel);
            if let Some(error) = crossing(run.scene, panel, x, &crossings(tree, panel, x)) {
                return Err(error.into());
            }
            check_lying::<MotionError>(run.scene, &run.pieces, x)?;
        }
        Ok(moving)
    }

    /// Joins each pair to one vertex at the common position, with the common momentum.
    pub(super) fn join(self, run: &MotionRun<'_>) -> Result<Self, MotionError> {
        let masses = self.sheet.masses();
        let state = State {
            x: run.pieces.sew(&self.state.x, masses),
            v: run.pieces.sew(&self.state.v, masses),
            time: self.state.time,
        };
        let joined_at = self.seams.widest(&self.state.x).map(|(_, gap)| gap);
        let mut moving = self.goes_on(run, state)?;
        moving.joined_at = joined_at;
        Ok(moving)
    }

    /// The sewn cloth of the run's mesh in another state of its nodes, in the same time.
    pub(super) fn goes_on(self, run: &MotionRun<'_>, state: State) -> Result<Self, MotionError> {
        let sheet = run.pieces.sewn_sheet(&cloths(run.scene))?;
        let mut fixed = vec![false; run.pieces.points];
        for (v, &p) in run.pieces.pinned.iter().enumerate() {
            fixed[run.pieces.point[v] as usize] |= p;
        }
        let mut moving = Self::new(run, sheet, &fixed, (run.pieces.springs(false), Vec::new()), state)?;
        moving.set_gravity(self.model.gravity);
        moving.set_air(self.model.air.map(|a| a.air));
        moving.set_damping(self.model.drag, self.friction_share);
        moving.joined_at = self.joined_at;
        moving.progress = Progress { gap: 0.0, ..self.progress };
        moving.is_joined = true;
        Ok(moving)
    }

    /// Takes crossings of the sewn cloth out of itself; returns how many are left.
    pub(super) fn uncross(&mut self) -> usize {
        let Some(tree) = &self.tree else { return 0 };
        uncross(&self.sheet, tree, &self.model.fixed, &mut self.state.x)
    }

    /// Whether the body passes through the cloth between its nodes.
    pub(super) fn is_pierced(&self, collider: Option<Collider<'_>>) -> bool {
        collider.is_some_and(|c| pierced(&self.sheet, c.surface, &self.state.x) > 0)
    }

    fn new(
        run: &MotionRun<'_>,
        sheet: Sheet,
        fixed: &[bool],
        (bands, pulled): (Vec<Band>, Vec<[u32; 2]>),
        state: State,
    ) -> Result<Self, MotionError> {
        let settings = run.settings;
        let (fabrics, first) = (cloths(run.scene), [run.scene.fabric_of(0)]);
        let mut model = Model::of(&sheet).pinned(|v| fixed[v]);
        let uncut = run.pieces.uncut().transpose()?;
        let cloth = Cloth {
            fixed,
            cut: uncut.as_ref().unwrap_or(&sheet),
            fabrics: &fabrics,
            fabric: &|t| run.pieces.cloth(t),
            ..Cloth::of(&sheet, &first)
        };
        model = model.made_of(settings.models, &cloth)?;
        if !bands.is_empty() {
            model = model.with(Bands::new(bands));
        }
        (model.drag, model.viscosity) = (settings.drag, settings.viscosity);
        model.stopper = run.stopper.clone();
        if let SeamClosing::Linear(stiffness) = settings.seam_force
            && !pulled.is_empty()
        {
            model = model.with(SeamSprings::new(pulled, stiffness));
        }
        if let Some(least) = settings.method.least_step() {
            model.inertia = CentralDifferences::inertia(&model, &state.x, least);
        }
        let solver = settings.method.solver(&sheet, &model, &state.x, first[0], settings.dt)?;
        let inverse =
            model.inertia().iter().zip(&model.fixed).map(|(m, f)| if *f { 0.0 } else { 1.0 / m }).collect();
        let tree = run.scene.self_collision.then(|| ClothTree::new(sheet.triangles(), &state.x));
        let friction = node_friction(run, &sheet, &fabrics);
        Ok(Self {
            sheet,
            model,
            solver,
            method: settings.method,
            fabric: first[0].clone(),
            offset: fabrics.iter().skip(1).map(|f| f.thickness).fold(0.0, f64::max),
            friction,
            friction_share: 1.0,
            limit: settings.strain_limit.map(|limit| Provot::new(limit, 1)).transpose()?,
            dt: settings.dt,
            tree,
            inverse,
            state,
            seams: Seams::default(),
            progress: Progress::default(),
            is_joined: false,
            joined_at: None,
            is_jammed: false,
            pushed: None,
        })
    }

    /// Sets the drag, 1/s, and the share of friction that acts.
    pub(super) fn set_damping(&mut self, drag: f64, friction_share: f64) {
        (self.model.drag, self.friction_share) = (drag, friction_share);
    }

    pub(super) fn set_gravity(&mut self, gravity: Vec3) {
        self.model.gravity = gravity;
    }

    pub(super) fn has_weight(&self) -> bool {
        self.model.gravity != Vec3::zeros()
    }

    pub(super) fn set_air(&mut self, air: Option<Air>) {
        self.model.air = air.filter(Air::acts).map(|a| AirDrag::new(a, self.sheet.triangles()));
    }

    /// Whether there are seams and all gaps are below `gap`.
    pub(super) fn seams_met(&self, gap: f64) -> bool {
        !self.seams.is_empty() && self.progress.gap < gap
    }

    /// Elastic and gravitational energy, J.
    pub(super) fn energy(&self) -> f64 {
        use crate::energy::Energy as _;
        self.model.elastic_energy(&self.state.x) + self.model.weight().value(&self.state.x)
    }

    /// One step, at most to the time `end`.
    pub(super) fn step(
        &mut self,
        settings: &Motion,
        collider: Option<Collider<'_>>,
        end: f64,
    ) -> Result<(), MotionError> {
        let dt = settings.dt.min(end - self.progress.time);
        self.set_step(dt)?;
        let start = self.state.x.clone();
        let (report, moves) = match self.method.chooses_its_step() {
            true => self.many_steps(settings, collider, dt)?,
            false => self.one_step(settings, collider)?,
        };
        for (v, m) in moves.iter().enumerate() {
            self.state.x[v] = start[v] + m;
        }
        self.seams.hold_met(&self.state.x, settings.join_gap);
        let fastest = moves.iter().map(|m| m.norm()).fold(0.0, f64::max);
        self.progress = Progress {
            time: self.progress.time + report.advanced,
            steps: self.progress.steps + 1,
            speed: fastest / report.advanced,
            gap: self.seams.widest(&self.state.x).map_or(0.0, |w| w.1),
            residual: report.residual,
        };
        Ok(())
    }

    /// One step of the solver, corrected as a whole; returns the moves.
    fn one_step(
        &mut self,
        settings: &Motion,
        collider: Option<Collider<'_>>,
    ) -> Result<(Report, Vec<Vec3>), ClothError> {
        let start = self.state.x.clone();
        let report = self.solver.advance(&self.model, &mut self.state)?;
        let wanted: Vec<Vec3> = self.state.x.iter().zip(&start).map(|(x, s)| x - s).collect();
        let mut moves = wanted.clone();
        let dt = report.advanced;
        let (pushed, is_free) = self.respond(settings, collider, None, dt, &start, &mut moves);
        self.is_jammed = self.limit_step(collider, is_free, &start, &mut moves) < JAMMED;
        self.update_velocities(&moves, &wanted, &pushed, dt);
        Ok((report, moves))
    }

    /// As many steps of the solver as fill `dt`, each corrected by what was near at the start;
    /// returns the moves.
    ///
    /// Errors: those of the solver, and steps that are too short.
    fn many_steps(
        &mut self,
        settings: &Motion,
        collider: Option<Collider<'_>>,
        dt: f64,
    ) -> Result<(Report, Vec<Vec3>), MotionError> {
        let start = self.state.x.clone();
        let foretold: Vec<Vec3> = self.state.v.iter().map(|v| v * dt).collect();
        let reach = self.reach(settings);
        let near = Near::of(self.tree.as_ref(), collider, &start, &foretold, self.offset, reach);
        let (mut advanced, mut is_free, least) = (0.0, true, SHORTEST * settings.dt);
        let report = loop {
            self.model.stopper.check()?;
            let before = self.state.x.clone();
            let report = self.solver.advance(&self.model, &mut self.state)?;
            if report.advanced < least {
                let Progress { time, gap, .. } = self.progress;
                return Err(MotionError::TooStiff {
                    step: report.advanced,
                    least,
                    time: time + advanced,
                    gap,
                });
            }
            let wanted: Vec<Vec3> = self.state.x.iter().zip(&before).map(|(x, s)| x - s).collect();
            let mut moves = wanted.clone();
            let (pushed, free) =
                self.respond(settings, collider, Some(&near), report.advanced, &before, &mut moves);
            is_free &= free;
            self.update_velocities(&moves, &wanted, &pushed, report.advanced);
            self.state.x.iter_mut().zip(before.iter().zip(&moves)).for_each(|(x, (b, m))| *x = b + m);
            advanced += report.advanced;
            if advanced >= (1.0 - SAME_STEP) * dt {
                break Report { advanced, ..report };
            }
        };
        let wanted: Vec<Vec3> = self.state.x.iter().zip(&start).map(|(x, s)| x - s).collect();
        let mut moves = wanted.clone();
        self.is_jammed = self.limit_step(collider, is_free, &start, &mut moves) < JAMMED;
        self.update_velocities(&moves, &wanted, &vec![Vec3::zeros(); moves.len()], advanced);
        Ok((report, moves))
    }

    /// How much farther than the contact distance the body is sought, m: for what starts in it, and
    /// for a force that reaches farther.
    fn reach(&self, settings: &Motion) -> f64 {
        self.pushed.map_or(0.0, |p| p.reach).max(settings.response.beyond(self.offset))
    }

    /// Mean length of the edges, m.
    pub(super) fn edge(&self) -> f64 {
        let edges = self.sheet.edges();
        edges.iter().map(|e| e.rest_length).sum::<f64>() / edges.len().max(1) as f64
    }

    /// Lifts triangles that dip into the body between their vertices.
    pub(super) fn restore_clearance(&mut self, collider: Collider<'_>) {
        for _ in 0..CLEARANCE_ROUNDS {
            let start = self.state.x.clone();
            let clearance = clearance(&self.sheet, collider.surface, &start);
            if clearance.triangles == 0 {
                return;
            }
            let within: Vec<f64> = clearance.lacks.iter().map(|l| if *l > 0.0 { FAR } else { 0.0 }).collect();
            let surface = collider.surface.nearest(&start, &within);
            let lift = |(n, lack): (&Option<Nearest>, &f64)| {
                n.as_ref().map_or(Vec3::zeros(), |n| n.normal * lack.min(self.offset))
            };
            let mut moves: Vec<Vec3> = surface.iter().zip(&clearance.lacks).map(lift).collect();
            moves
                .iter_mut()
                .zip(&self.model.fixed)
                .filter(|(_, f)| **f)
                .for_each(|(m, _)| *m = Vec3::zeros());
            self.limit_step(Some(collider), false, &start, &mut moves);
            self.state.x.iter_mut().zip(&moves).for_each(|(x, m)| *x += m);
        }
    }

    /// Updates the velocities after the `wanted` moves were changed to `moves`, of which `pushed`
    /// is no velocity.
    fn update_velocities(&mut self, moves: &[Vec3], wanted: &[Vec3], pushed: &[Vec3], dt: f64) {
        for (v, m) in moves.iter().enumerate() {
            self.state.v[v] += (m - pushed[v] - wanted[v]) / dt;
        }
    }

    /// Makes a solver of another time step where it changes, as for the last step of a phase.
    fn set_step(&mut self, dt: f64) -> Result<(), ClothError> {
        if self.method.chooses_its_step() || (dt - self.dt).abs() < SAME_STEP * self.dt {
            return Ok(());
        }
        self.solver = self.method.solver(&self.sheet, &self.model, &self.state.x, &self.fabric, dt)?;
        self.dt = dt;
        Ok(())
    }

    /// Corrects the moves from `x` by strain limits, seams, self-contact and body. Returns how much
    /// of each move is no velocity, and whether neither body nor pins have changed any. Seeks pairs
    /// and the body where `near` is not given.
    fn respond(
        &self,
        settings: &Motion,
        collider: Option<Collider<'_>>,
        near: Option<&Near>,
        dt: f64,
        x: &[Vec3],
        moves: &mut [Vec3],
    ) -> (Vec<Vec3>, bool) {
        let offset = self.offset;
        if let Some(limit) = &self.limit {
            let mut ends: Vec<Vec3> = x.iter().zip(moves.iter()).map(|(x, m)| x + m).collect();
            limit.apply(&self.sheet, &self.model.fixed, &mut ends);
            moves.iter_mut().zip(ends.iter().zip(x)).for_each(|(m, (e, x))| *m = e - x);
        }
        self.seams.close(x, moves, &self.inverse, settings.closing * dt);
        if let Some(tree) = &self.tree {
            let found = near.is_none().then(|| tree.pairs(x, moves, offset));
            let pairs = found.as_ref().or(near.map(|n| &n.pairs)).map_or(&[][..], |p| p);
            respond_to_self_contact(
                pairs,
                x,
                moves,
                &self.inverse,
                offset,
                &self.friction,
                self.friction_share,
            );
        }
        let before = moves.to_vec();
        let pushed = match collider {
            Some(collider) => {
                let surface = near.map_or_else(
                    || nearest_on_body(collider, x, moves, offset + self.reach(settings)),
                    |n| n.surface(x),
                );
                let friction = collider.friction * self.friction_share;
                let lift = self.pushed.map_or(f64::INFINITY, |p| p.speed * dt);
                let answer =
                    Answer { response: settings.response, inverse: &self.inverse, dt, friction, lift };
                respond_to_body(&surface, &answer, moves, offset)
            }
            None => vec![Vec3::zeros(); moves.len()],
        };
        let is_free = !self.model.fixed.contains(&true) && moves == before;
        moves.iter_mut().zip(&self.model.fixed).filter(|(_, f)| **f).for_each(|(m, _)| *m = Vec3::zeros());
        (pushed, is_free)
    }

    /// Shortens moves that would lead into the body or through cloth; returns the share to which
    /// the whole step was shortened.
    fn limit_step(
        &self,
        collider: Option<Collider<'_>>,
        is_free: bool,
        start: &[Vec3],
        moves: &mut [Vec3],
    ) -> f64 {
        let (offset, before) = (self.offset, moves.to_vec());
        if let Some(collider) = collider {
            collider.surface.guard(start, moves, &vec![0.5 * offset; start.len()]);
        }
        let is_free = is_free && moves == before;
        let short = |moves: &mut [Vec3]| {
            self.tree.as_ref().map_or(1.0, |tree| limit_step(tree, start, moves, offset))
        };
        if is_free { among_themselves(self.model.inertia(), moves, short) } else { short(moves) }
    }
}

/// The friction of cloth on cloth at each node: that of the fabric of one of its triangles.
fn node_friction(run: &MotionRun<'_>, sheet: &Sheet, fabrics: &[&Fabric]) -> Vec<f64> {
    let mut friction = vec![0.0; sheet.vertex_count()];
    for (t, corners) in sheet.triangles().iter().enumerate() {
        corners.iter().for_each(|&v| friction[v as usize] = fabrics[run.pieces.cloth(t)].friction);
    }
    friction
}

/// Shortens the moves of cloth in free fall by `short`, relative to their common motion, which is
/// kept: cloth that collides with itself in the air does not change its momentum.
fn among_themselves(masses: &[f64], moves: &mut [Vec3], short: impl Fn(&mut [Vec3]) -> f64) -> f64 {
    let common = |moves: &[Vec3]| {
        let sum: Vec3 = moves.iter().zip(masses).map(|(m, w)| m * *w).sum();
        sum / masses.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    };
    let flight = common(moves);
    let mut own: Vec<Vec3> = moves.iter().map(|m| m - flight).collect();
    let wanted = own.clone();
    let share = short(&mut own);
    // Moves that were not shortened must keep their bits.
    if own != wanted {
        let shift = flight - common(&own);
        moves.iter_mut().zip(&own).for_each(|(m, o)| *m = o + shift);
    }
    share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cloth_that_holds_itself_back_in_mid_air_keeps_its_flight() {
        let masses = [1.0, 2.0, 3.0];
        let fall = [Vec3::new(0.3, -1.0, 0.0), Vec3::new(0.1, -1.0, 0.2), Vec3::new(-0.1, -1.0, 0.0)];
        let sum = |moves: &[Vec3]| -> Vec3 { moves.iter().zip(&masses).map(|(m, w)| m * *w).sum() };
        let mut moves = fall;
        let share = among_themselves(&masses, &mut moves, |own| {
            own[0] *= 0.25;
            own[2] *= 0.5;
            0.25
        });
        assert_eq!(share, 0.25);
        assert!((sum(&moves) - sum(&fall)).norm() < 1e-12, "{moves:?}");
        assert!(moves.iter().all(|m| (m.y + 1.0).abs() < 1e-12), "none falls slower: {moves:?}");
        assert_ne!(moves, fall);
        let mut free = fall;
        assert_eq!(among_themselves(&masses, &mut free, |_| 1.0), 1.0);
        assert_eq!(free, fall, "the same bits");
    }
}
