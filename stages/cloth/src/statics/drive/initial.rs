//! The first equilibrium of bending continuation: stiff, on the coarsest level, with or without
//! friction.
//!
//! Friction would keep a garment wherever its seams happened to close, so the garment is first
//! solved without friction. If that equilibrium is the same as with friction, the continuation goes
//! on without friction; otherwise friction holds the garment from there on. A garment that slides
//! off or turns away without friction (a plate on a ball, a skirt on a round body) has friction
//! from its sewing on.
//!
//! The equilibria of a garment that is its own mirror image come in pairs, and rounding would
//! choose between the two. So the garment is turned back to its initial orientation and solved
//! under a small torque first, as structures that may buckle either way are computed with a small
//! imperfection (Koiter 1945, "On the stability of elastic equilibrium"); then without the torque.
//!
//! Cost: up to three runs of [`FIRST_STEPS`] Newton steps a try, on the coarsest level.

use crate::statics::drive::coarse_to_fine::Solve;
use crate::statics::drive::drape::Continued;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::levels::bending_continuation::stages;
use crate::statics::levels::mesh_level::{Level, apart};
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::Progress;
use crate::statics::report::error::StaticsError;

/// Newton steps of a run: a skirt without friction may keep turning about its body.
const FIRST_STEPS: usize = 40;

/// Stiffnesses that are tried, the greatest first. A garment that slides off with each of them,
/// with friction and without, is assumed to slide off when it is softer, too.
const TRIES: usize = 2;

/// Greatest mean distance of the equilibria with and without friction, as a share of the garment's
/// size, at which they count as the same.
const MOST_SLIP: f64 = 0.03;

/// Greatest angle by which the garment may turn without friction, rad.
const MOST_TURN: f64 = 0.175;

/// The force of the torque, as a share of the weight: enough to choose one of two mirror images
/// from initial positions that differ by 1 mm, too little to turn a skirt to its next equilibrium.
const TORQUE: f64 = 0.08;

impl<'a> Solve<'a> {
    /// Brings the coarsest level to its first equilibrium and on to the factor `end`.
    pub(crate) fn initial_equilibrium(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        first: f64,
        end: f64,
        progress: &mut Progress<'_>,
    ) -> Result<Continued, StaticsError> {
        let is_frictionless = level.system.get::<BodyContact>().is_none_or(BodyContact::is_frictionless);
        for stiff in std::iter::once(first).chain(stages(first, end)).take(TRIES) {
            let (mut free, mut held) = (level.clone(), level.clone());
            self.last_fall = None;
            let stays = self.frictionless_equilibrium(k, &mut free, stiff, progress)?;
            if !is_frictionless {
                // Friction may hold a garment that falls without it.
                self.last_fall = None;
            }
            let mut is_held = !is_frictionless && self.stiff_equilibrium(k, &mut held, stiff, progress)?;
            let alike = is_frictionless || is_held && apart(&held.x, &free.x) < MOST_SLIP * level.size();
            if stays && alike && self.continue_to(k, &mut free, [stiff, end], progress)? {
                *level = free;
                return Ok(Continued { stiff: end, frictionless: true });
            }
            if stays && !alike && free.turned().abs() < MOST_TURN {
                free.enable_friction();
                (held, is_held) = (free, true);
            }
            if is_held && self.continue_to(k, &mut held, [stiff, end], progress)? {
                *level = held;
                return Ok(Continued { stiff: end, frictionless: false });
            }
        }
        match self.last_fall.take() {
            Some(fall) => Err(fall),
            None => Ok(Continued { stiff: end, frictionless: false }),
        }
    }

    /// Brings a level near rest without friction; returns whether it stays on the body.
    fn frictionless_equilibrium(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        stiff: f64,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        level.disable_friction();
        level.turn_back();
        level.system.loads.push = level.twist(TORQUE);
        let stays = self.stiff_equilibrium(k, level, stiff, progress);
        level.system.loads.push.clear();
        Ok(stays? && self.stiff_equilibrium(k, level, stiff, progress)?)
    }

    /// Brings a level near rest with bending `stiff` times stiffer; returns whether it stays on the
    /// body.
    fn stiff_equilibrium(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        stiff: f64,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        let options = NewtonOptions { steps: FIRST_STEPS, ..self.continuation_options() };
        self.stays(k, level, stiff, options, progress)
    }
}
