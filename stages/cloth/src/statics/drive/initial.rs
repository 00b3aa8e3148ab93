//! The first state of a garment: stiff, on the coarsest level, with friction or without.
//!
//! Friction keeps a garment wherever its seams happened to close. So it first finds its place
//! without. Where it lies there as it would with friction, friction is left out on the way from
//! stiff to limp; else friction holds it from there on. What slides off or turns away without
//! friction (a plate on a ball, a skirt on a round body) keeps it from its sewing on.
//!
//! A garment that is its own mirror image has its states of rest in pairs, and a hair decides
//! between the two. So it is turned back to how it was placed, and finds its place under a small
//! turning force first, as structures that may buckle either way are computed with a small flaw
//! (Koiter 1945, "On the stability of elastic equilibrium"); then without it.

use crate::statics::drive::coarse_to_fine::Solve;
use crate::statics::levels::bending_continuation::stages;
use crate::statics::levels::mesh_level::{Level, apart};
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::Progress;
use crate::statics::report::error::StaticsError;

/// Steps of the first state: a skirt that nothing holds may turn about its body for ever.
const FIRST_STEPS: usize = 40;

/// First states, the stiffest first, that are tried. A garment that slides off from each of them,
/// with friction and without, is taken to slide off from a limper one too.
const TRIES: usize = 2;

/// How far apart, in the mean and as a share of the garment's size, the first state may lie with
/// friction and without: where it is farther, friction holds the garment up.
const MOST_SLIP: f64 = 0.03;

/// How far the first state may turn away without friction, rad: what turns farther, friction holds.
const MOST_TURN: f64 = 0.175;

/// The turning force, as a share of the weight: enough to tell two mirror images apart from starts
/// moved by 1 mm, too little to turn a skirt on to its next seat.
const TWIST: f64 = 0.08;

impl<'a> Solve<'a> {
    /// Brings the coarsest level to its first state and on to `end`: how stiff it is then, and
    /// whether friction was left out.
    pub(crate) fn initial_equilibrium(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        first: f64,
        end: f64,
        progress: &mut Progress<'_>,
    ) -> Result<(f64, bool), StaticsError> {
        let slick = level.system.is_frictionless_on_body();
        for stiff in std::iter::once(first).chain(stages(first, end)).take(TRIES) {
            let (mut free, mut held) = (level.clone(), level.clone());
            self.last_fall = None;
            let stays = self.frictionless_equilibrium(&mut free, stiff, progress)?;
            if !slick {
                // Friction may hold what falls without it.
                self.last_fall = None;
            }
            let mut is_held = !slick && self.stiff_equilibrium(&mut held, stiff, progress)?;
            let alike = slick || is_held && apart(&held.x, &free.x) < MOST_SLIP * level.size();
            if stays && alike && self.continue_to(k, &mut free, [stiff, end], progress)? {
                *level = free;
                return Ok((end, true));
            }
            if stays && !alike && free.turned().abs() < MOST_TURN {
                free.enable_friction();
                (held, is_held) = (free, true);
            }
            if is_held && self.continue_to(k, &mut held, [stiff, end], progress)? {
                *level = held;
                return Ok((end, false));
            }
        }
        match self.last_fall.take() {
            Some(fall) => Err(fall),
            None => Ok((end, false)),
        }
    }

    /// Brings a level near rest without friction; whether it stays on the body.
    fn frictionless_equilibrium(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        level.disable_friction();
        level.turn_back();
        level.system.push = level.twist(TWIST);
        let stays = self.stiff_equilibrium(level, stiff, progress);
        level.system.push.clear();
        Ok(stays? && self.stiff_equilibrium(level, stiff, progress)?)
    }

    /// Brings a level near rest as stiff as it is in its first state; whether it stays on the body.
    fn stiff_equilibrium(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        let options = NewtonOptions { steps: FIRST_STEPS, ..self.continuation_options() };
        self.stays(level, stiff, options, progress)
    }
}
