//! `StaticEquilibrium`: sews and drapes at once, and solves for static equilibrium without
//! simulating motion.
//!
//! Method: the engine's `StaticEquilibrium` (coarse to fine, Newton's method on the potential of
//! sheet, seams, weight, contacts and friction). Cost: some 35 to 150 factorizations of the finest
//! mesh, O(triangles^1.5) each with a small factor. Limits: intermediate states are no physical
//! motion and make no animation; folds and friction have many states of rest, of which one is
//! found.

use super::again::{MOST_DIP, is_better, thin_of, why_again};
use super::asleep;
use super::by_place;
use super::layers::{Clothes, Dressed, Single, layers};
use super::mixed_precision::{self, FactorPrecision};
use super::models::{BendingModel, MembraneModel, models};
use super::motion::{engine_air, points};
use super::starts;
use super::{ImplicitEuler, InTime};
use crate::engine::{
    self, MessageContext, Rests, SceneSetting, SchemeSurface, crossing, scene_of, weld_seams,
};
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};
use toile_cloth::contact::collision_surface::CollisionSurface;
use toile_cloth::statics::drive::solve::{
    Collider as EngineCollider, Equilibrium, LevelReport, StaticEquilibrium as Solver, StaticsError,
};
use toile_cloth::statics::report::start::surely_reversed;
use toile_cloth::stopper::Stopper;
use toile_core::Known;
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Node};

/// The time that a solve is left with where those before it took all, seconds.
const LEAST_TIME: f64 = 0.001;

/// Which steps prove that cloth is at rest. Each step begins standing, so that what nothing holds
/// gains speed in it.
#[choice]
#[derive(Copy, Eq)]
pub enum ProofSteps {
    /// A sixtieth of a second: the least force left over shows.
    Short,
    /// A tenth of a second and more, too: what slides or falls shows. Folds may still creep, in
    /// garments of many gathers by some centimetres in the end; following that creep takes most of
    /// the time.
    Long,
}

/// Sews the garment and finds its state of rest, without simulating how it gets there.
///
/// The default for garments: it solves for the drape itself, on coarser meshes first, so it takes a
/// fraction of the time of a simulated fall and ends at rest: no vertex but the share `non_static`
/// would gain `speed` if it moved freely for a short while (see `proof`), with friction within its
/// limit. Seams are joined exactly, cloth is kept out of the body and out of itself. Where it does
/// not come to rest in `steps`, the last state goes on with a warning. Where the coarsest mesh
/// turns out too coarse (a seam stays open, layers tangle, a limb comes through), it begins again
/// on a finer one: the figure `restarts` says how often, and a larger `coarsest` avoids it. Cloth
/// that misses the body or slides off it is an error, as soon as nothing is left that could catch
/// it, mostly on the coarsest mesh. A scene without a body that no pin holds has no rest: its fall
/// is followed for the scene's phases, as by `ImplicitEuler(drag: 0.0)`. Still air changes no state
/// of rest; a scene with wind in its last phase is refused, for wind has no potential: take
/// `ImplicitEuler`.
///
/// Garments that are worn over each other, as `Outfit` reads them, are sewn from the innermost:
/// each on the body and what it wears already. Then all come to rest together, cloth on cloth.
///
/// Behind another `StaticEquilibrium` it takes that one's parameters where it is given none. A
/// prepared scene (`Scene`) is solved to its last vertex: left out, `speed` is 1 mm/s behind it,
/// `non_static` 0 and `proof` `Short`.
#[stage(
    role = Draper,
    version = 25,
    source = "Newton's method on the potential of Baraff and Witkin 1998; Bergou et al. 2006; Li et al. 2020",
    example = "StaticEquilibrium(speed: 0.001, non_static: 0.0)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct StaticEquilibrium {
    /// Downward acceleration; a scene's own phases come before it.
    #[param(default = 9.81, min = 0.0, max = 1000.0, unit = "m/s2")]
    pub gravity: f64,
    /// What cloth resists in its plane.
    #[param(default = MembraneModel::Woven, trades)]
    pub membrane: MembraneModel,
    /// What cloth resists when it is folded.
    #[param(default = BendingModel::Quadratic, trades)]
    pub bending: BendingModel,
    /// At rest, no vertex gains more than this in a step that proves rest (see `proof`), but for
    /// the share `non_static` of the vertices.
    #[param(default = 5e-3, min = 1e-9, max = 1.0, unit = "m/s", trades, finer = "less")]
    pub speed: f64,
    /// The share of the vertices that may gain more, for garments that lie where the skin of a body
    /// folds, as in an armpit: some vertices there never come to rest. The figure `non_static` is
    /// the share that still moves.
    #[param(default = 0.015, min = 0.0, max = 0.5, trades, finer = "less")]
    pub non_static: f64,
    /// Which steps prove rest.
    #[param(default = ProofSteps::Long, trades)]
    pub proof: ProofSteps,
    /// Vertices of the coarsest mesh, on which the garment is sewn; with `bending_continuation`, at
    /// least 700.
    #[param(default = 300, min = 20, max = 100_000, unit = "vertices", trades)]
    pub coarsest: usize,
    /// Steps on every mesh but the finest; with `bending_continuation`, each of its states has 60.
    #[param(default = 30, min = 1, max = 100_000, unit = "steps", trades)]
    pub coarse_steps: usize,
    /// Steps on the finest mesh, after which the drape stops as it is.
    #[param(default = 500, min = 1, max = 100_000, unit = "steps", trades)]
    pub steps: usize,
    /// Gap below which a seam is joined.
    #[param(default = Length::mm(0.5), min = 1e-6, max = 0.1, trades)]
    pub join_gap: Length,
    /// Wall time after which it gives up, with an error. A run that meets it is not repeatable.
    #[param(default = 600.0, min = 0.001, max = 1e6, unit = "s", trades)]
    pub time_limit: f64,
    /// Whether bending starts far too stiff and is softened mesh by mesh: a start moved by a
    /// millimetre then ends in the same folds, and a finer mesh in like ones. Without, it is
    /// faster, and chance picks the folds.
    #[param(default = true)]
    pub bending_continuation: bool,
    /// Whether the cloth goes on from where it is, on its own mesh alone: for a garment that came
    /// to rest on a coarser mesh (see `Subdivide`) and shall keep its folds. Bending is not
    /// continued then. Left out, it is true behind a draper, with only stages between that move
    /// the garment or cut its mesh.
    #[param(default = false, way)]
    pub from_here: bool,
    /// Whether cloth passes through cloth while its seams close: for panels that start far apart,
    /// with others in between, or in the body. What crosses itself then is taken out of itself
    /// along the contours where it does (Volino, Magnenat-Thalmann 2006). What starts in the body
    /// is moved out of it, and seams join at gaps of up to a third of an edge of the coarsest mesh.
    /// Where the body keeps seams open, or the cloth does not come out of itself or of the body,
    /// the garment is sewn again around a thin figure of the body's pose, which grows to its full
    /// size in it; a note says so, and the better result is taken. Where the placement left other
    /// starts and the first does not sew cleanly on the coarsest mesh, or sinks while its seams
    /// close, each is sewn on it, and the best goes on. Left out, it is true behind a placement of
    /// a pattern, such as `Arrange`.
    #[param(default = false, way)]
    pub sew_through: bool,
    /// How precise the factor of each step's matrix is: single where that solves the step well,
    /// which is checked, or always double. The state that is found keeps `speed` either way.
    #[param(default = FactorPrecision::Mixed)]
    pub precision: FactorPrecision,
    /// Whether vertices at rest are held while few others still move: these are solved alone before
    /// the next step of all vertices. Rest is proved with all vertices either way.
    #[param(default = true)]
    pub asleep: bool,
    /// Distance at which cloth is held off itself where the pipeline names no collider.
    #[param(default = Length::mm(1.0), min = 1e-5, max = 0.05)]
    pub thickness: Length,
}

#[stage]
impl StaticEquilibrium {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        phases: Option<&Phases>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        garment.check_solvable()?;
        engine::check_response(collider, "StaticEquilibrium")?;
        let layers = layers(garment);
        if layers.len() > 1 && !self.from_here {
            return self.one_over_the_other(&layers, garment, collider, phases, cx);
        }
        self.over(None, garment, collider, phases, cx)
    }

    /// Sews garments that are worn over each other, from the innermost, and lets them come to rest
    /// together.
    fn one_over_the_other(
        &self,
        layers: &[u32],
        garment: &Garment,
        collider: Option<&Collider>,
        phases: Option<&Phases>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let clock = Instant::now();
        let left = || (self.time_limit - clock.elapsed().as_secs_f64()).max(LEAST_TIME);
        let mut whole = garment.clone();
        let mut on_body = vec![1.0; whole.panels.len()];
        for layer in layers {
            let clothes = (layer != &layers[0]).then(|| Clothes::under(*layer, &whole));
            let single = Single::of(*layer, &whole);
            let single_solver = StaticEquilibrium { time_limit: left(), ..self.clone() };
            let rested = single_solver.over(clothes.as_ref(), &single.garment, collider, phases, cx)?;
            single.put_back(&rested, &mut whole);
            let own = whole.panels.iter().zip(&mut on_body).filter(|(p, _)| p.layer == *layer);
            own.zip(&rested.status.on_body).for_each(|((_, share), found)| *share = *found);
        }
        whole.starts.clear();
        whole.status.on_body = on_body;
        weld_seams(&mut whole);
        // What each could not close or resolve alone is resolved together, from the coarsest mesh.
        let last = StaticEquilibrium { time_limit: left(), ..self.clone() };
        last.over(None, &whole, collider, phases, cx)
    }

    /// Sews a garment over what the body wears already, and lets it come to rest.
    fn over(
        &self,
        clothes: Option<&Clothes>,
        garment: &Garment,
        collider: Option<&Collider>,
        phases: Option<&Phases>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let gravity =
            phases.and_then(Phases::last_gravity).unwrap_or_else(|| Vector3::new(0.0, -self.gravity, 0.0));
        let card = collider.map(|c| c.scheme.card());
        let setting = SceneSetting {
            gravity,
            air: phases.and_then(Phases::last_air).map(engine_air),
            thickness: card.map_or(self.thickness.metres(), |c| c.thickness),
            self_collision: card.is_none_or(|c| c.self_collision),
        };
        let scene = scene_of(garment, &setting)?;
        let friction = card.map_or(0.0, |c| c.friction);
        let surface = collider.map(|c| Dressed { body: SchemeSurface::new(c.scheme.as_ref()), clothes });
        let engine_collider = surface.as_ref().map(|surface| EngineCollider { surface, friction });
        let mut progress =
            SolverProgress { cx, wanted: self.speed, vertices: garment.positions.len(), steps: 0 };
        let clock = Instant::now();
        let reversed = surely_reversed(&scene, &scene.positions);
        for name in reversed.iter().filter(|_| self.sew_through) {
            cx.warn(format!(
                "{} seems to run the wrong way: {}",
                engine::seam(name),
                engine::turn_round(name)
            ));
        }
        let cancel = cx.cancel().clone();
        let stopper = Stopper::when(move || cancel.is_cancelled());
        let scene = match self.sew_through {
            true => starts::at_the_best(scene, garment, &self.solver(), engine_collider, &stopper, cx)?,
            false => scene,
        };
        // Where the body keeps seams open, the garment can be sewn around a thin figure instead.
        let gives_way = self.sew_through && collider.is_some_and(|c| c.scheme.surface().is_some());
        let mut result = Solver { gives_way, ..self.solver() }.solve_around(
            &scene,
            engine_collider,
            &[],
            &stopper,
            &mut |level, positions| progress.tell(level, positions),
        );
        // What is worn over cloth dips into it between its points; that is resolved later.
        let is_alone = clothes.is_none() || result.is_err();
        if let (true, Some(collider), Some(why)) =
            (self.sew_through && is_alone, collider, why_again(&result))
        {
            let thin = thin_of(collider);
            let around: Vec<&dyn CollisionSurface> =
                thin.iter().map(|f| f as &dyn CollisionSurface).collect();
            if !around.is_empty() {
                cx.note(format!(
                    "{why}: the garment is sewn again around a thin figure, which grows to the body"
                ));
                // Both solves together get the time limit.
                let solver =
                    Solver { budget: self.solver().budget.saturating_sub(clock.elapsed()), ..self.solver() };
                let mut tell = |level: &LevelReport, positions: &dyn Fn() -> Vec<Vector3<f64>>| {
                    progress.tell(level, positions)
                };
                let second = solver.solve_around(&scene, engine_collider, &around, &stopper, &mut tell);
                if is_better(&second, &result) {
                    result = second;
                } else {
                    cx.note("sewing around the thin figure came out no better: the first result is kept");
                }
            }
        }
        cx.check()?;
        if let (Err(StaticsError::Falls), Some(phases)) = (&result, phases) {
            cx.warn("nothing holds the cloth, so it has no state of rest: its fall is followed for the scene's phases");
            return ImplicitEuler {
                motion: InTime { drag: 0.0, ..InTime::default() },
                ..ImplicitEuler::default()
            }
            .run(garment, collider, Some(phases), cx);
        }
        let steps = progress.steps;
        if let Some(positions) = result.as_ref().err().and_then(StaticsError::so_far) {
            cx.so_far(self.at(garment, positions));
        }
        let words =
            MessageContext { garment, scheme: collider.map(|c| c.scheme.as_ref()), stage: cx.stage() };
        let (state, converged) = self.judge(result, &words, &reversed, cx)?;
        cx.figure("residual", state.residual, "N");
        cx.figure("non_static", state.outcome.non_static, "");
        cx.figure("restarts", state.restarts as f64, "");
        if state.dip > MOST_DIP {
            let mm = state.dip * 1e3;
            cx.warn(format!(
                "between its points the cloth dips up to {mm:.1} mm into the body: a smaller edge length of the mesh follows it closer"
            ));
        }
        let mut rested = self.finish(garment, &state, steps, converged);
        if let Some(collider) = collider {
            let kept = engine::on_body(garment, &rested.positions, collider.scheme.as_ref(), &gravity);
            rested.status.on_body = engine::both(&garment.status.on_body, kept);
        }
        Ok(rested)
    }

    /// Going on from a garment at rest on a finer mesh, or in another pose.
    fn improves(&self) -> bool {
        self.from_here
    }

    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        by_place::by_place(nodes, index)
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        let rules = [
            by_place::rule(known),
            mixed_precision::rule(self.precision, self.bending_continuation, known.given),
            asleep::rule(self.asleep, self.bending_continuation, known.given),
        ];
        rules.into_iter().flatten().collect()
    }

    fn solver(&self) -> Solver {
        Solver {
            models: models(self.membrane, self.bending),
            speed: self.speed,
            non_static: self.non_static,
            coarsest: self.coarsest,
            coarse_steps: self.coarse_steps,
            finest_steps: self.steps,
            join_gap: self.join_gap.metres(),
            budget: Duration::from_secs_f64(self.time_limit),
            bending_continuation: self.bending_continuation,
            from_here: self.from_here,
            sew_through: self.sew_through,
            gives_way: false,
            long_proof: self.proof == ProofSteps::Long,
            precision: self.precision.into(),
            asleep: self.asleep,
        }
    }

    /// The state to go on with, and whether it is at rest.
    fn judge(
        &self,
        result: Result<Equilibrium, StaticsError>,
        words: &MessageContext<'_>,
        reversed: &[String],
        cx: &Context,
    ) -> Result<(Equilibrium, bool), StageError> {
        let can = Rests {
            reversed,
            sew_through: self.sew_through,
            coarsest: self.coarsest,
            steps: self.steps,
            time_limit: self.time_limit,
        };
        match result {
            Ok(state) => Ok((state, true)),
            Err(StaticsError::NotAtRest { wanted, panel, state }) => {
                let [warning, detail] = words.still_moving(&state, &panel, wanted, &can);
                cx.warn(warning);
                cx.note(detail);
                Ok((*state, false))
            }
            Err(StaticsError::Crossing { pairs, state }) => {
                cx.warn(crossing(pairs));
                Ok((*state, false))
            }
            Err(error) => Err(words.rest(&error, &can)),
        }
    }

    /// The garment at rest somewhere.
    fn at(&self, garment: &Garment, positions: &[Vector3<f64>]) -> Garment {
        let mut garment = garment.clone();
        garment.positions = points(positions);
        garment.velocities.fill(Vector3::zeros());
        garment.starts.clear();
        garment
    }

    fn finish(&self, garment: &Garment, state: &Equilibrium, steps: usize, converged: bool) -> Garment {
        let mut garment = self.at(garment, &state.positions);
        weld_seams(&mut garment);
        garment.status = SolveStatus {
            steps: garment.status.steps + steps,
            converged,
            energy: state.energy,
            max_speed: state.outcome.fastest,
            on_body: garment.status.on_body.clone(),
            held: engine::held_of(&state.held()),
        };
        garment
    }
}

/// Shows the user how far the solver has come, and stops it when asked to.
struct SolverProgress<'a> {
    cx: &'a Context,
    wanted: f64,
    /// Vertices of the garment.
    vertices: usize,
    steps: usize,
}

impl SolverProgress<'_> {
    fn tell(&mut self, level: &LevelReport, positions: &dyn Fn() -> Vec<Vector3<f64>>) -> ControlFlow<()> {
        self.steps += 1;
        self.cx.work(level.nodes as f64 / self.vertices.max(1) as f64);
        if self.cx.check().is_err() {
            return ControlFlow::Break(());
        }
        self.cx.moves(|| points(&positions()));
        let (speed, [pass, passes]) = (level.outcome.speed, level.pass);
        let text = match level.sewing {
            true => format!("sewing: {} is open by {:.1} mm", engine::seam(&level.seam), level.gap * 1e3),
            false => format!(
                "draping, mesh {pass} of {passes}: moves {:.1} mm/s, at rest below {:.1} mm/s",
                speed * 1e3,
                self.wanted * 1e3
            ),
        };
        // From 1 m/s down to rest, by the logarithm.
        let share = if speed > 0.0 { speed.ln() / self.wanted.ln() } else { 1.0 };
        self.cx.progress(if level.sewing { 0.0 } else { share }, text);
        ControlFlow::Continue(())
    }
}
