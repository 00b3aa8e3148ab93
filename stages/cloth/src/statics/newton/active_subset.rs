//! Active subset: the few nodes that still move near rest are solved alone before the next step.
//!
//! Method: see `subdomain`. Cost: that of the active nodes and of the rings around them.

use crate::statics::factor::multifrontal::{Halt, Stop};
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::newton::line_search::ROUNDING;
use crate::statics::newton::nearby::Nearby;
use crate::statics::newton::subdomain::{Subdomain, widen};
use crate::statics::newton::to_rest::{NewtonOptions, NewtonState, greatest};
use toile_geometry::Vec3;

/// Share of the greatest move above which a node is active.
const ACTIVE: f64 = 0.3;

/// Rings of triangles around the active nodes that move with them.
const RINGS: usize = 2;

/// Greatest share of active nodes at which they are solved alone.
const FEW: f64 = 0.15;

/// Steps of the subdomain at most.
const SUBDOMAIN_STEPS: usize = 20;

impl NewtonState {
    /// Brings the nodes that the last step moved most to rest alone, where they are few.
    ///
    /// # Errors
    /// [`Halt`], as [`Self::step`].
    pub(crate) fn settle_active(
        &mut self,
        system: &mut System<'_>,
        x: &mut [Vec3],
        options: &NewtonOptions,
        stop: &Stop,
    ) -> Result<(), Halt> {
        let Some(active) = self.active(system) else { return Ok(()) };
        self.nearby.seek_about(system, x, &active);
        let options = NewtonOptions { non_static: 0.0, ..*options };
        let mut subdomain = Subdomain::of(system, active);
        let (mut own, layout) = (subdomain.pick(x), subdomain.pick(self.linear.layout()));
        let reach = system.get::<SelfContact>().map_or(f64::INFINITY, SelfContact::slack);
        let nearby = Nearby::of_subdomain(subdomain.pick(self.nearby.at()), reach);
        rayon::scope(|_| {
            let mut inner = Self::among(nearby, &mut subdomain.system, &layout, &own, self.dt);
            for _ in 0..SUBDOMAIN_STEPS {
                let outcome = inner.step_here(&mut subdomain.system, &mut own, &options, stop)?;
                if outcome.at_rest || inner.has_left {
                    break;
                }
            }
            Ok::<(), Halt>(())
        })?;
        subdomain.put_back(&own, system, x);
        self.moved();
        Ok(())
    }

    /// The nodes that the last step moved most and those around them, if they are few.
    fn active(&self, system: &System<'_>) -> Option<Vec<bool>> {
        let most = greatest(&self.moves);
        if system.is_intersecting() || !system.targets.is_empty() || most < ROUNDING {
            return None;
        }
        let mut active: Vec<bool> = self.moves.iter().map(|m| m.norm() > ACTIVE * most).collect();
        widen(system, &mut active, RINGS);
        let count = active.iter().filter(|a| **a).count();
        (count as f64 <= FEW * active.len() as f64).then_some(active)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::scene::generate;
    use crate::statics::drive::solve::{Equilibrium, StaticEquilibrium};
    use std::ops::ControlFlow;

    /// A skirt sewn on a form, and its steps on the finest level.
    fn skirt([nx, ny]: [u32; 2], asleep: bool) -> (Equilibrium, usize) {
        let (scene, mut levels) = (generate::tube(nx, ny), vec![]);
        let settings = StaticEquilibrium { asleep, ..StaticEquilibrium::default() };
        let state = settings.solve(&scene, &mut |level, _| {
            levels.push(level.nodes);
            ControlFlow::Continue(())
        });
        let finest = levels.iter().max().copied();
        (state.unwrap(), levels.iter().filter(|n| Some(**n) == finest).count())
    }

    #[test]
    fn an_active_subset_finds_rest_in_fewer_steps_of_the_whole() {
        let (mut few, mut many) = (0, 0);
        for size in [[40, 14], [48, 12], [32, 16]] {
            let ((subset, a), (all, b)) = (skirt(size, true), skirt(size, false));
            (few, many) = (few + a, many + b);
            let apart = subset.energy / all.energy - 1.0;
            assert!(apart.abs() < 0.01, "{apart}");
        }
        assert!(few < many, "{few} {many}");
    }
}
