//! What a run leaves out, simplifies or adds because of what the scene is.
//!
//! A *rule* looks at a fact of the scene that is known before anything runs (parameters, wired
//! ports, sizes) and, where the fact holds, gives a [`Decision`]: what is done, by which fact,
//! within which tolerance, saving how much, and the switch that reverses it. The switch is a
//! parameter of a stage, or an option of the run: what a decision says is what the stage itself
//! does. Rules are in the folders of the stages that they are about, one file per rule; a stage
//! gives its decisions by `fn decisions(&self, known: &Known<'_>) -> Vec<Decision>` beside its
//! `run`. Stages of plugins give none.
//!
//! `toile_pipeline::decide` asks all stages, and has one rule of its own: stages that no requested
//! result depends on do not run.

mod decision;

pub use decision::{Decision, Saves, State, Tolerance, Turn};
