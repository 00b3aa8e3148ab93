//! Everything that acts on one level's nodes, as one potential: value, gradient and matrix.
//!
//! Membrane, bending, weight, seams that still pull, the body (a penalty within a thickness of its
//! surface, so that vertices rest outside it), and friction as a potential about anchors: a force
//! that grows with the way slid and nears Coulomb's limit without reaching it, so that every state
//! of rest keeps the law. Anchors are dragged along while the cloth moves fast. Cloth rubs on cloth
//! in the same way (see `friction_history`). Normals and limits of friction are those of the step's
//! start.

use crate::linear::Pattern;
use crate::statics::forces::body_contact::{BodyContact, ContactQuery, DistanceCache, NEAR, NUDGE};
use crate::statics::forces::coulomb::Coulomb;
use crate::statics::forces::elastic::Elastic;
use crate::statics::forces::height_springs::HeightSprings;
use crate::statics::forces::ridges::Ridges;
use crate::statics::forces::seam_force::SeamForce;
use crate::statics::forces::self_contact::SelfContact;
use nalgebra::{Matrix3, Vector3};
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// Where a node touches the body.
#[derive(Debug, Clone, Copy)]
pub struct BodyTouch {
    /// The node.
    pub node: u32,
    /// Outward normal of the body there.
    pub normal: Vec3,
    /// Force of the body, N.
    pub force: f64,
    /// The force that limits friction: the mean over the last steps, N.
    pub load: f64,
}

/// All that acts on the nodes.
#[derive(Debug, Clone)]
pub struct System<'a> {
    /// The sheet's resistance.
    pub elastic: Elastic,
    /// kg per node.
    pub masses: Vec<f64>,
    /// m/s².
    pub gravity: Vec3,
    /// Forces on the nodes besides their weight, N; empty where there are none.
    pub push: Vec<Vec3>,
    /// What holds the nodes at the height where they start, if anything does.
    pub height_springs: Option<HeightSprings>,
    /// Nodes that stay.
    pub pinned: Vec<bool>,
    /// Seams that still pull.
    pub threads: Vec<SeamForce>,
    /// The body.
    pub support: Option<BodyContact<'a>>,
    /// Its sharp edges and corners.
    pub ridges: Option<Ridges>,
    /// Cloth against itself.
    pub layers: Option<SelfContact>,
    /// Nodes in contact at the start of the step.
    pub touches: Vec<BodyTouch>,
    /// Where friction holds each node.
    pub anchors: Vec<Option<Vec3>>,
    /// How far friction holds each node back when it first touches: what the coarser level found,
    /// m.
    pub slides: Vec<Vec3>,
    /// What presses each node on the body, a mean over the last steps, N.
    pub loads: Vec<f64>,
    /// What holds each node still in this step, N/m; empty where nothing does.
    pub brakes: Vec<f64>,
    /// Nodes that are being led somewhere, and where to: they must be pinned.
    pub pulls: Vec<(u32, Vec3)>,
    /// Where each node was last seen from the body; empty before the first step.
    pub seen: Vec<DistanceCache>,
}

/// What was found at the end of a step, where the next one starts.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// All energy, J.
    pub energy: f64,
    /// The part that no contact has a share in, J.
    pub lasting: f64,
    /// What each node sees of the body; empty without one.
    pub sight: Vec<ContactQuery>,
}

impl System<'_> {
    /// The pattern of its matrix without contacts of cloth with cloth.
    #[must_use]
    pub fn pattern(&self) -> Pattern {
        Pattern::holding(&self.pinned, |visit| {
            self.elastic.couplings(visit);
            self.threads.iter().for_each(|t| visit(&t.nodes));
        })
    }

    /// Nodes that elements or threads hold together, two by two.
    #[must_use]
    pub fn links(&self) -> Vec<[u32; 2]> {
        let mut links = Vec::new();
        let mut link = |nodes: &[u32]| links.extend(nodes.windows(2).map(|w| [w[0], w[1]]));
        self.elastic.couplings(&mut link);
        self.threads.iter().for_each(|t| link(&t.nodes));
        links
    }

    /// The body nearest to each node, if it presses there; remembers what was seen, now or by who
    /// came here before.
    fn look(&mut self, x: &[Vec3], sight: Option<Vec<ContactQuery>>) -> Vec<Option<Nearest>> {
        if self.support.is_none() {
            return vec![None; x.len()];
        }
        let found = sight.unwrap_or_else(|| self.looks(x));
        self.seen = found.iter().map(|(seen, _)| *seen).collect();
        found.into_iter().map(|(_, near)| near).collect()
    }

    /// Leads the pulled nodes on, by up to `farthest`; whether any of them still has a way to go.
    pub fn pull(&self, x: &[Vec3], moves: &mut [Vec3], farthest: f64) -> bool {
        for (node, to) in &self.pulls {
            let way = to - x[*node as usize];
            moves[*node as usize] = way * (farthest / way.norm().max(farthest));
        }
        self.pulls.iter().any(|(node, to)| (to - x[*node as usize]).norm() > NUDGE)
    }

    /// What each node sees of the body. What was seen earlier saves the search, or narrows it.
    fn looks(&self, x: &[Vec3]) -> Vec<ContactQuery> {
        let Some(s) = &self.support else { return Vec::new() };
        let within: Vec<Option<f64>> =
            x.iter().enumerate().map(|(i, p)| s.reach(p, s.offsets[i], self.seen.get(i))).collect();
        let asked: Vec<usize> = (0..x.len()).filter(|&i| within[i].is_some()).collect();
        let points: Vec<Vec3> = asked.iter().map(|&i| x[i]).collect();
        let reach: Vec<f64> = asked.iter().filter_map(|&i| within[i]).collect();
        let mut found = s.body.nearest(&points, &reach).into_iter();
        let one = |(i, p): (usize, &Vec3)| match (within[i], self.seen.get(i)) {
            (None, Some(seen)) => (*seen, None),
            (reach, _) => match found.next().flatten() {
                Some(n) => {
                    let seen = DistanceCache { at: *p, distance: n.distance, exact: true };
                    (seen, (n.distance < NEAR * s.offsets[i]).then_some(n))
                }
                None => (DistanceCache { at: *p, distance: reach.unwrap_or(0.0), exact: false }, None),
            },
        };
        x.iter().enumerate().map(one).collect()
    }

    /// Ends moves that lead into the body just outside it.
    pub fn clear_of_body(&mut self, x: &[Vec3], moves: &mut [Vec3], asks: impl Fn(usize) -> bool) {
        let sews = !self.threads.is_empty();
        let Some(s) = self.support.as_mut().filter(|s| !s.passes) else { return };
        let seen = &self.seen;
        let is_free = |i: usize| {
            seen.get(i).is_some_and(|n| n.distance - (x[i] - n.at).norm() - moves[i].norm() > s.guard(i))
        };
        let asked: Vec<usize> = (0..x.len()).filter(|&i| asks(i) && !is_free(i)).collect();
        let points: Vec<Vec3> = asked.iter().map(|&i| x[i]).collect();
        let gaps: Vec<f64> = asked.iter().map(|&i| s.guard(i)).collect();
        let mut guarded: Vec<Vec3> = asked.iter().map(|&i| moves[i]).collect();
        s.body.guard(&points, &mut guarded, &gaps);
        for (&i, m) in asked.iter().zip(guarded) {
            if (moves[i] - m).norm() > NUDGE {
                let distance = seen.get(i).map_or(0.0, |n| n.distance);
                match s.grows {
                    true => s.grow(i, distance),
                    // What a seam presses on the body gives way to the seam, or the seam stays
                    // open.
                    false if sews => {}
                    false => s.press(i, distance),
                }
            }
            moves[i] = m;
        }
    }

    /// Finds what may touch sharp features at `x`.
    pub fn seek_ridges(&mut self, x: &[Vec3]) {
        self.ridges.iter_mut().for_each(|r| r.seek(x, &vec![Vec3::zeros(); x.len()]));
    }

    /// Ends moves that lead the cloth past a sharp feature of the body before that; it gives way
    /// where it can.
    pub fn clear_of_ridges(&mut self, x: &[Vec3], moves: &mut [Vec3]) {
        let Some(r) = &mut self.ridges else { return };
        r.seek(x, moves);
        let pushed = r.give_way(x, moves, &self.pinned);
        if pushed.contains(&true) {
            self.clear_of_body(x, moves, |i| pushed[i]);
            self.ridges.iter_mut().for_each(|r| {
                r.seek(x, moves);
                r.hold_apart(x, moves);
            });
        }
    }

    /// Shortens all moves alike where they still lead past one.
    pub fn stop_at_ridges(&mut self, x: &[Vec3], moves: &mut [Vec3]) {
        if let Some(r) = &mut self.ridges {
            r.seek(x, moves);
            r.stop(x, moves);
        }
    }

    /// Looks for cloth that the body passes through at `x`, as what a coarser mesh left may: it is
    /// pushed back out.
    pub fn look_for_pierced(&mut self, x: &[Vec3]) {
        if let (Some(r), Some(s)) = (&mut self.ridges, &self.support) {
            r.look_for_pierced(s, x);
        }
    }

    /// Whether a sharp edge or corner of the body passes through the cloth at `x`.
    #[must_use]
    pub fn is_pierced(&self, x: &[Vec3]) -> bool {
        matches!((&self.ridges, &self.support), (Some(r), Some(s)) if r.is_pierced(s, x))
    }

    /// Energy at `x`, J; `touches` and `anchors` are those of the step's start.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        self.visit(x).energy
    }

    /// Energy at `x`, and what a step that starts there need not look up again.
    #[must_use]
    pub fn visit(&self, x: &[Vec3]) -> Evaluation {
        let pull = || self.threads.iter().map(|t| t.value(x)).sum::<f64>();
        let (lasting, sight) = rayon::join(
            || self.stored(x) + self.elastic.value_of_holds(x) + self.pushed(x) + pull(),
            || self.looks(x),
        );
        let body: f64 = match &self.support {
            Some(s) => {
                let press = |((n, o), k): ((&ContactQuery, &f64), &f64)| {
                    n.1.as_ref().map_or(0.0, |n| 0.5 * k * (o - n.distance).max(0.0).powi(2))
                };
                sight.iter().zip(&s.offsets).zip(&s.stiffness).map(press).sum()
            }
            None => 0.0,
        };
        let rub: f64 = self.rubs().map(|(i, r)| r.value(&x[i])).sum();
        let layers = self.layers.as_ref().map_or(0.0, |l| l.value(x));
        let ridges = self.ridges.as_ref().map_or(0.0, |r| r.value(x));
        Evaluation { energy: lasting + body + rub + layers + ridges, lasting, sight }
    }

    /// Energy at the step's start, J, of which `lasting` does not depend on contacts.
    #[must_use]
    pub fn value_at_start(&self, x: &[Vec3], lasting: f64) -> f64 {
        let body: f64 = match &self.support {
            Some(s) => {
                let press = |t: &BodyTouch| 0.5 * t.force * t.force / s.stiffness[t.node as usize];
                self.touches.iter().filter(|t| t.force > 0.0).map(press).sum()
            }
            None => 0.0,
        };
        let rub: f64 = self.rubs().map(|(i, r)| r.value(&x[i])).sum();
        let layers = self.layers.as_ref().map_or(0.0, |l| l.value_at_start(x));
        let ridges = self.ridges.as_ref().map_or(0.0, |r| r.value_at_start(x));
        lasting + body + rub + layers + ridges
    }

    /// Elastic and gravitational energy at `x`, J.
    #[must_use]
    pub fn stored(&self, x: &[Vec3]) -> f64 {
        let weight: f64 = x.iter().zip(&self.masses).map(|(p, m)| -m * self.gravity.dot(p)).sum();
        self.elastic.value(x) + weight
    }

    /// Energy of the forces besides weight, J.
    fn pushed(&self, x: &[Vec3]) -> f64 {
        let held = self.height_springs.as_ref().map_or(0.0, |h| h.value(x, &self.masses));
        held - self.push.iter().zip(x).map(|(p, x)| p.dot(x)).sum::<f64>()
    }

    /// Whether crossings of the start are still being undone.
    #[must_use]
    pub fn is_tangled(&self) -> bool {
        self.layers.as_ref().is_some_and(|l| !l.tangled.is_empty())
    }

    /// Whether there is no friction with a body.
    #[must_use]
    pub fn rubs_nowhere(&self) -> bool {
        self.support.as_ref().is_none_or(|s| s.friction.iter().all(|f| *f == 0.0))
    }

    /// Takes friction away, and gives it back.
    pub fn swap_friction(&mut self, friction: &mut Vec<f64>) {
        if let Some(s) = &mut self.support {
            std::mem::swap(&mut s.friction, friction);
        }
        self.layers.iter_mut().for_each(SelfContact::swap_friction);
        self.ridges.iter_mut().for_each(Ridges::swap_friction);
        self.anchors.fill(None);
        self.loads.fill(0.0);
    }

    /// Finds the touches at `x`: call it at the start of each step.
    pub fn touch(&mut self, x: &[Vec3]) {
        self.touch_in_sight(x, None);
    }

    /// The same, where what was seen at `x` is known.
    pub fn touch_in_sight(&mut self, x: &[Vec3], sight: Option<Vec<ContactQuery>>) {
        self.layers.iter_mut().for_each(|l| l.touch(x));
        #[cfg(toile_without = "body")]
        return;
        let near = self.look(x, sight);
        let Some(s) = &mut self.support else { return };
        s.stiffen();
        let ridges = &mut self.ridges;
        ridges.iter_mut().for_each(|r| r.touch(s, x));
        if !s.passes {
            s.allow_for_sag(&near, x, |edge| ridges.as_ref().is_some_and(|r| r.bridges(edge)));
        }
        let mut anchors = vec![None; x.len()];
        let mut loads = vec![0.0; x.len()];
        self.touches.clear();
        for (i, n) in near.iter().enumerate() {
            let Some(n) = n else { continue };
            if s.hard && n.distance < 0.0 {
                s.pressed.push(i as u32);
            }
            let force = s.stiffness[i] * (s.offsets[i] - n.distance).max(0.0);
            // While Newton's steps swing between touching and not, friction follows the mean.
            // A node that has just come down will carry its weight at least.
            let weight = -self.masses[i] * self.gravity.dot(&n.normal);
            let first = if n.distance < 1.1 * s.offsets[i] { force.max(weight) } else { force };
            loads[i] = if self.anchors[i].is_some() { 0.5 * (self.loads[i] + force) } else { first };
            if force > 0.0 || loads[i] > 0.0 {
                anchors[i] = Some(self.anchors[i].unwrap_or(x[i] - std::mem::take(&mut self.slides[i])));
                self.touches.push(BodyTouch { node: i as u32, normal: n.normal, force, load: loads[i] });
            }
        }
        (self.anchors, self.loads) = (anchors, loads);
    }

    /// Drags anchors along behind nodes that slide: call it at the end of each step that moves far.
    pub fn drag(&mut self, x: &[Vec3]) {
        let dragged: Vec<(usize, Vec3)> = self.rubs().map(|(i, r)| (i, r.dragged(&x[i]))).collect();
        dragged.into_iter().for_each(|(i, anchor)| self.anchors[i] = Some(anchor));
        self.layers.iter_mut().for_each(|l| l.drag(x));
        self.ridges.iter_mut().for_each(|r| r.drag(x));
        self.elastic.drag(x);
    }

    /// How far each node has slid from its anchor at `x`, m; the same on a finer mesh.
    #[must_use]
    pub fn held_back(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut slides = vec![Vec3::zeros(); x.len()];
        self.rubs().for_each(|(i, r)| slides[i] = r.way(&x[i]));
        slides
    }

    /// Nodes that rub on the body.
    fn rubs(&self) -> impl Iterator<Item = (usize, Coulomb)> + '_ {
        let s = self.support.as_ref();
        self.touches.iter().filter_map(move |t| {
            let node = t.node as usize;
            let s = s.filter(|s| s.friction[node] > 0.0)?;
            let anchor = self.anchors[node]?;
            Some((node, Coulomb { normal: t.normal, anchor, limit: s.friction[node] * t.load }))
        })
    }

    /// Derivative of the energy at the step's start, N; zero at pins.
    #[must_use]
    pub fn gradient(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut g: Vec<Vec3> = self.masses.iter().map(|m| -self.gravity * *m).collect();
        g.iter_mut().zip(&self.push).for_each(|(g, p)| *g -= p);
        self.height_springs.iter().for_each(|h| h.add_gradient(x, &self.masses, &mut g));
        self.elastic.add_gradient(x, &mut g);
        self.threads.iter().for_each(|t| t.add_gradient(x, &mut g));
        self.touches.iter().for_each(|t| g[t.node as usize] -= t.normal * t.force);
        self.rubs().for_each(|(i, r)| g[i] += r.gradient(&x[i]));
        self.layers.iter().for_each(|l| l.add_gradient(x, &mut g));
        self.ridges.iter().for_each(|r| r.add_gradient(x, &mut g));
        g.iter_mut().zip(&self.pinned).filter(|(_, p)| **p).for_each(|(g, _)| *g = Vec3::zeros());
        g
    }

    /// Matrix at the step's start: second derivative plus `inertia` times the masses. Without
    /// `compression` it is positive definite.
    pub fn matrix(
        &self,
        x: &[Vec3],
        pattern: &Pattern,
        inertia: f64,
        compression: f64,
        values: &mut Vec<Matrix3<f64>>,
    ) {
        values.resize(pattern.blocks(), Matrix3::zeros());
        self.elastic.write_matrix(x, compression, values);
        for (v, m) in values.iter_mut().zip(&self.masses) {
            (0..3).for_each(|c| v[(c, c)] += m * inertia);
        }
        values.iter_mut().zip(&self.brakes).for_each(|(v, b)| *v += Matrix3::identity() * *b);
        self.height_springs.iter().for_each(|h| h.add_matrix(&self.masses, values));
        self.threads.iter().for_each(|t| t.add_matrix(x, pattern, values));
        if let Some(s) = &self.support {
            for t in self.touches.iter().filter(|t| t.force > 0.0) {
                values[t.node as usize] += t.normal * t.normal.transpose() * s.stiffness[t.node as usize];
            }
        }
        self.rubs().for_each(|(i, r)| values[i] += r.matrix(&x[i]));
        self.layers.iter().for_each(|l| l.add_matrix(x, pattern, values));
        self.ridges.iter().for_each(|r| r.add_matrix(x, pattern, values));
        let held = self.pinned.iter().zip(values).filter(|(p, _)| **p);
        held.for_each(|(_, v)| *v = Matrix3::identity());
    }
}
