//! The sheet on its way: one step with all its corrections, and the join.

use super::contact::{off_itself, off_the_body, stop_short};
use super::seams::Seams;
use super::{Motion, MotionError, Progress, Run, Vec3};
use crate::energy::{Air, AirDrag, Cloth};
use crate::error::ClothError;
use crate::mesh::Sheet;
use crate::rest::solve::Wearer;
use crate::rest::start::{check_lying, crossing, crossings};
use crate::solver::{Model, Solver, State};
use toile_geometry::cloth_tree::ClothTree;

/// Steps that differ by less than this share are the same: the end of a phase is met by rounding.
const SAME_STEP: f64 = 1e-6;

/// Contacts that leave less than this share of a step to all of the cloth hold it in the air.
const JAMMED: f64 = 0.5;

pub(super) struct Moving {
    sheet: Sheet,
    model: Model,
    solver: Box<dyn Solver>,
    method: super::Method,
    fabric: crate::fabric::Fabric,
    dt: f64,
    tree: Option<ClothTree>,
    inverse: Vec<f64>,
    pub(super) state: State,
    pub(super) seams: Seams,
    pub(super) progress: Progress,
    pub(super) is_joined: bool,
    pub(super) joined_at: Option<f64>,
    /// Whether contacts held all of the cloth back in the last step: it hangs in the air, and is not at rest.
    pub(super) is_jammed: bool,
}

impl Moving {
    /// The panels apart.
    pub(super) fn open(run: &Run<'_>, start: Vec<Vec3>) -> Result<Self, MotionError> {
        let cloths: Vec<_> = vec![run.fabric; run.scene.panels.len() + 1];
        let sheet = run.pieces.open_sheet(&cloths)?;
        let pairs = run.pieces.seam_pairs();
        let fixed: Vec<bool> = run.pieces.pinned.clone();
        let mut moving = Self::new(run, sheet, &fixed, State::at_rest(start))?;
        moving.is_joined = pairs.is_empty();
        moving.seams = Seams { pairs };
        moving.tree = moving.tree.map(|t| t.sewing(run.pieces.point.clone()));
        if let Some(tree) = &moving.tree {
            let (x, panel) = (&moving.state.x, &run.pieces.panel);
            if let Some(error) = crossing(run.scene, panel, x, &crossings(tree, panel, x)) {
                return Err(error.into());
            }
            check_lying::<MotionError>(run.scene, &run.pieces, x)?;
        }
        Ok(moving)
    }

    /// Pairs become single vertices at their common place, with their common momentum.
    pub(super) fn join(self, run: &Run<'_>) -> Result<Self, MotionError> {
        let cloths: Vec<_> = vec![run.fabric; run.scene.panels.len() + 1];
        let sheet = run.pieces.sewn_sheet(&cloths)?;
        let mut fixed = vec![false; run.pieces.points];
        for (v, &p) in run.pieces.pinned.iter().enumerate() {
            fixed[run.pieces.point[v] as usize] |= p;
        }
        let masses = self.sheet.masses();
        let state = State {
            x: run.pieces.sew(&self.state.x, masses),
            v: run.pieces.sew(&self.state.v, masses),
            time: self.state.time,
        };
        let mut moving = Self::new(run, sheet, &fixed, state)?;
        moving.set_gravity(self.model.gravity);
        moving.set_air(self.model.air.map(|a| a.air));
        moving.joined_at = self.seams.widest(&self.state.x).map(|(_, gap)| gap);
        moving.progress = Progress { gap: 0.0, ..self.progress };
        moving.is_joined = true;
        Ok(moving)
    }

    fn new(run: &Run<'_>, sheet: Sheet, fixed: &[bool], state: State) -> Result<Self, MotionError> {
        let settings = run.settings;
        let fabrics = [run.fabric];
        let mut model = Model::of(&sheet).pinned(|v| fixed[v]);
        model = model.made_of(settings.models, &Cloth { fixed, ..Cloth::of(&sheet, &fabrics) })?;
        (model.drag, model.viscosity) = (settings.drag, settings.viscosity);
        let solver = settings.method.solver(&sheet, &model, &state.x, run.fabric, settings.dt)?;
        let inverse =
            model.masses.iter().zip(&model.fixed).map(|(m, f)| if *f { 0.0 } else { 1.0 / m }).collect();
        let tree = run.scene.self_collision.then(|| ClothTree::new(sheet.triangles(), &state.x));
        Ok(Self {
            sheet,
            model,
            solver,
            method: settings.method,
            fabric: run.fabric.clone(),
            dt: settings.dt,
            tree,
            inverse,
            state,
            seams: Seams::default(),
            progress: Progress::default(),
            is_joined: false,
            joined_at: None,
            is_jammed: false,
        })
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

    /// Whether there are seams and all are within `gap`.
    pub(super) fn seams_met(&self, gap: f64) -> bool {
        !self.seams.is_empty() && self.progress.gap < gap
    }

    /// Elastic and gravitational energy, J.
    pub(super) fn energy(&self) -> f64 {
        use crate::energy::Energy as _;
        self.model.elastic_energy(&self.state.x) + self.model.weight().value(&self.state.x)
    }

    /// One step, no farther than to the time `end`.
    pub(super) fn step(
        &mut self,
        settings: &Motion,
        wearer: Option<Wearer<'_>>,
        end: f64,
    ) -> Result<(), ClothError> {
        self.aim(settings.dt.min(end - self.progress.time))?;
        let start = self.state.x.clone();
        let report = self.solver.advance(&self.model, &mut self.state)?;
        let wanted: Vec<Vec3> = self.state.x.iter().zip(&start).map(|(x, s)| x - s).collect();
        let mut moves = wanted.clone();
        let (pushed, share) = self.correct(&start, &mut moves, report.advanced, settings.closing, wearer);
        for (v, m) in moves.iter().enumerate() {
            self.state.x[v] = start[v] + m;
            self.state.v[v] += (m - pushed[v] - wanted[v]) / report.advanced;
        }
        self.is_jammed = share < JAMMED;
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

    /// Another solver where the step must be another: the last one before an end.
    fn aim(&mut self, dt: f64) -> Result<(), ClothError> {
        if self.method.chooses_its_step() || (dt - self.dt).abs() < SAME_STEP * self.dt {
            return Ok(());
        }
        self.solver = self.method.solver(&self.sheet, &self.model, &self.state.x, &self.fabric, dt)?;
        self.dt = dt;
        Ok(())
    }

    /// All corrections; how much of each move is a push, no velocity, and to what share all of the cloth was held back.
    fn correct(
        &self,
        start: &[Vec3],
        moves: &mut [Vec3],
        dt: f64,
        closing: f64,
        wearer: Option<Wearer<'_>>,
    ) -> (Vec<Vec3>, f64) {
        let offset = self.fabric.thickness;
        self.seams.close(start, moves, &self.model.masses, &self.model.fixed, closing * dt);
        if let Some(tree) = &self.tree {
            let pairs = tree.pairs(start, moves, offset);
            off_itself(&pairs, start, moves, &self.inverse, offset, self.fabric.friction);
        }
        let before = moves.to_vec();
        let pushed = match wearer {
            Some(wearer) => off_the_body(wearer, start, moves, offset),
            None => vec![Vec3::zeros(); moves.len()],
        };
        let is_free = !self.model.fixed.contains(&true) && moves == before;
        moves.iter_mut().zip(&self.model.fixed).filter(|(_, f)| **f).for_each(|(m, _)| *m = Vec3::zeros());
        let short = |moves: &mut [Vec3]| {
            self.tree.as_ref().map_or(1.0, |tree| stop_short(tree, start, moves, offset))
        };
        let share = if is_free { among_themselves(&self.model.masses, moves, short) } else { short(moves) };
        (pushed, share)
    }
}

/// Shortens the moves of what nothing else holds as `short` does, but against their common motion, which is kept: cloth that meets
/// cloth in mid-air changes how it is folded, not how it flies.
fn among_themselves(masses: &[f64], moves: &mut [Vec3], short: impl Fn(&mut [Vec3]) -> f64) -> f64 {
    let common = |moves: &[Vec3]| {
        let sum: Vec3 = moves.iter().zip(masses).map(|(m, w)| m * *w).sum();
        sum / masses.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    };
    let flight = common(moves);
    let mut own: Vec<Vec3> = moves.iter().map(|m| m - flight).collect();
    let wanted = own.clone();
    let share = short(&mut own);
    // What was not held back keeps its bits.
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
