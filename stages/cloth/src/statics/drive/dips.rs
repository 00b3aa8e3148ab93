//! Dips of the final cloth into the body between its vertices.
//!
//! Method: nodes rest outside the body, but a triangle between them may dip in. The nodes of such a
//! triangle are asked to keep farther off, and the cloth is relaxed again, in rounds. In a crease,
//! as of an armpit, that leads nowhere: what is nearest to a node there is the skin on the other
//! side. Then the nodes are moved out along the normal at the dip and held where they are, as the
//! body holds them through the triangles, while the rest is relaxed; a node whose cloth pulls it
//! off the body is released. Dips of some hundredths of a millimetre are moved out without regard
//! to forces. Cost: a relaxation from near rest a round. Limits: a held node does not slide along
//! the body either.

use crate::contact::collision_surface::CollisionSurface;
use crate::statics::drive::coarse_to_fine::{LevelMesh, Solve};
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::clearance::{Clearance, clearance, lifted};
use crate::statics::forces::system::System;
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::Progress;
use crate::statics::report::error::StaticsError;
use toile_geometry::Vec3;

/// Rounds at most in which nodes are asked to keep farther off.
const ROUNDS: usize = 12;

/// First step of pseudo-time in such a round, in which the cloth hardly moves, s.
const FIRST_STEP: f64 = 0.2;

/// Dips that are less deep than this after a round are moved out without regard to forces, m.
const SHALLOW: f64 = 1e-4;

/// Farthest that a node is moved so, m.
const FARTHEST_LIFT: f64 = 1e-3;

/// Two rounds that leave more than this share of the depth lead nowhere.
const STALLED: f64 = 0.8;

/// Farthest that a node is moved that is held there, m.
const FARTHEST_HELD: f64 = 6e-3;

/// Times that nodes are held, each followed by a relaxation.
const HOLDS: usize = 4;

/// What the rounds work on.
pub(crate) struct Rounds<'r, 's> {
    pub(crate) mesh: LevelMesh<'r>,
    pub(crate) system: &'r mut System<'s>,
    pub(crate) x: &'r mut [Vec3],
    pub(crate) options: NewtonOptions,
}

impl Solve<'_> {
    /// Moves nodes out where triangles between them dip into the body, and relaxes the cloth again.
    pub(crate) fn restore_clearance(
        &mut self,
        rounds: Rounds<'_, '_>,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let Some(body) = self.plan.body.map(|b| b.surface) else { return Ok(()) };
        let mut r = Rounds {
            options: NewtonOptions { first: FIRST_STEP, one_by_one: false, ..rounds.options },
            ..rounds
        };
        let offsets = offsets(r.system);
        let (mut depths, mut was_held) = (Vec::new(), false);
        for round in 0..=ROUNDS {
            let Clearance { lacks, depth, triangles, .. } = clearance(r.mesh.sheet, body, r.x);
            if triangles == 0 {
                self.dip = Some(depth);
                break;
            }
            if round > 0 && depth < SHALLOW && self.lift(&mut r, body) {
                break;
            }
            depths.push(depth);
            let stalled = round >= 2 && depth > STALLED * depths[round - 2];
            if (stalled || round == ROUNDS) && !was_held {
                was_held = true;
                if self.hold_out(&mut r, body, &offsets, progress)? {
                    break;
                }
            }
            if round == ROUNDS {
                break;
            }
            if let Some(contact) = r.system.get_mut::<BodyContact>() {
                contact.offsets.iter_mut().zip(&lacks).for_each(|(o, l)| *o += l);
            }
            self.relax_again(&mut r, progress)?;
        }
        Ok(())
    }

    fn relax_again(
        &mut self,
        r: &mut Rounds<'_, '_>,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let report = self.relax_uncrossed(r.mesh, r.system, r.x, &r.options, progress)?;
        self.reports.push(report);
        Ok(())
    }

    /// Moves nodes out of the body without regard to forces, where cloth does not cross more cloth
    /// then; returns whether it did.
    fn lift(&self, r: &mut Rounds<'_, '_>, body: &dyn CollisionSurface) -> bool {
        let lifted = lifted(r.mesh.sheet, body, r.x, &r.system.pinned, FARTHEST_LIFT);
        let crossings = |x: &[Vec3]| self.crossings(r.mesh.sheet, x);
        let Some(lifted) = lifted.filter(|lifted| crossings(lifted) <= crossings(r.x)) else { return false };
        r.x.copy_from_slice(&lifted);
        true
    }

    /// Moves nodes out of the body and holds them there while the cloth is relaxed; returns whether
    /// nothing dips in then. Otherwise all is as before. `offsets` are those of before the rounds.
    fn hold_out(
        &mut self,
        r: &mut Rounds<'_, '_>,
        body: &dyn CollisionSurface,
        offsets: &[f64],
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        let (pins, start, asked) = (r.system.pinned.clone(), r.x.to_vec(), self::offsets(r.system));
        let reports = self.reports.len();
        let crossings = self.crossings(r.mesh.sheet, r.x);
        let mut out = vec![Vec3::zeros(); r.x.len()];
        for _ in 0..HOLDS {
            let Some(lifted) = lifted(r.mesh.sheet, body, r.x, &pins, FARTHEST_HELD) else { break };
            if lifted == r.x {
                self.dip = Some(0.0);
                return Ok(true);
            }
            if self.crossings(r.mesh.sheet, &lifted) > crossings {
                break;
            }
            out.iter_mut().zip(&lifted).zip(r.x.iter()).for_each(|((o, to), from)| *o += to - from);
            r.x.copy_from_slice(&lifted);
            hold(r.system, &pins, &out, offsets);
            self.relax_again(r, progress)?;
            if release(r, &pins, &mut out) {
                hold(r.system, &pins, &out, offsets);
                self.relax_again(r, progress)?;
            }
        }
        r.x.copy_from_slice(&start);
        r.system.pinned = pins;
        if let Some(contact) = r.system.get_mut::<BodyContact>() {
            contact.offsets = asked;
        }
        self.reports.truncate(reports);
        Ok(false)
    }
}

/// The offset of each node; none without a body.
fn offsets(system: &mut System<'_>) -> Vec<f64> {
    system.get_mut::<BodyContact>().map_or_else(Vec::new, |contact| contact.offsets.clone())
}

/// Holds the nodes that were moved `out`, beside those that are pinned; their offsets are what they
/// were.
fn hold(system: &mut System<'_>, pins: &[bool], out: &[Vec3], offsets: &[f64]) {
    let is_held = |v: usize| out[v] != Vec3::zeros();
    system.pinned = pins.iter().enumerate().map(|(v, pin)| *pin || is_held(v)).collect();
    if let Some(contact) = system.get_mut::<BodyContact>() {
        let held = contact.offsets.iter_mut().zip(offsets).enumerate().filter(|(v, _)| is_held(*v));
        held.for_each(|(_, (offset, before))| *offset = *before);
    }
}

/// Takes those nodes from the held ones that their cloth pulls off the body; returns whether there
/// are any.
fn release(r: &mut Rounds<'_, '_>, pins: &[bool], out: &mut [Vec3]) -> bool {
    let held = std::mem::replace(&mut r.system.pinned, pins.to_vec());
    r.system.update_contacts(r.x);
    let gradient = r.system.gradient(r.x);
    r.system.pinned = held;
    let mut any = false;
    for (o, _) in out.iter_mut().zip(&gradient).filter(|(o, g)| o.dot(g) < 0.0) {
        (*o, any) = (Vec3::zeros(), true);
    }
    any
}
