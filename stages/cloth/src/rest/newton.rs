//! Newton's method to rest on one level.
//!
//! Each step minimises the potential plus the inertia of a step of pseudo-time, which grows as long as steps succeed, so
//! that far from rest the cloth falls without overshooting and near rest the steps are Newton's own.

use super::multifrontal::{NotPositive, Symbolic};
use super::pattern::Pattern;
use super::system::System;
use crate::contact::limit::limit;
use crate::contact::tree::ClothTree;
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// When to stop, and how fast to go.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// First step of pseudo-time, s.
    pub first: f64,
    /// Longest step of pseudo-time, s.
    pub longest: f64,
    /// Steps at most.
    pub steps: usize,
    /// Speed below which the cloth is at rest, m/s.
    pub speed: f64,
    /// Farthest that a node may move in a step, m.
    pub farthest: f64,
}

/// How a level ended.
#[derive(Debug, Clone, Copy, Default)]
pub struct Outcome {
    /// Steps made.
    pub steps: usize,
    /// Greatest speed in the last step, m/s.
    pub speed: f64,
    /// Greatest force left over, N.
    pub residual: f64,
}

/// Moves `x` to rest.
pub fn relax(
    system: &mut System<'_>,
    layout: &[Vec3],
    tree: Option<&ClothTree>,
    x: &mut Vec<Vec3>,
    pace: &Pace,
    watch: &mut dyn FnMut(&System<'_>, &[Vec3], &Outcome) -> bool,
) -> Result<Outcome, NotPositive> {
    if let (Some(tree), Some(l)) = (tree, &mut system.layers) {
        l.pairs = tree.pairs(x, &vec![Vec3::zeros(); x.len()], l.thickness);
    }
    system.touch(x);
    let mut pattern = system.pattern();
    system.elastic.bind(&pattern);
    let mut symbolic = Symbolic::new(&pattern, layout);
    let mut values: Vec<Matrix3<f64>> = Vec::new();
    let mut dt = pace.first;
    let mut outcome = Outcome::default();
    let longest_dt = std::env::var("LONG").ok().and_then(|v| v.parse().ok()).unwrap_or(pace.longest);
    for step in 0..pace.steps {
        system.touch(x);
        let changed = system.layers.iter().flat_map(|l| &l.contacts).any(|c| !pattern.couples(&c.nodes));
        if changed {
            pattern = system.pattern();
            system.elastic.bind(&pattern);
            symbolic = Symbolic::new(&pattern, layout);
        }
        let g = system.gradient(x);
        let inertia = 1.0 / (dt * dt);
        system.matrix(x, &pattern, inertia, &mut values);
        let factor = symbolic.factor(&values)?;
        let mut move_by: Vec<Vec3> = g.iter().map(|g| -g).collect();
        symbolic.solve(&factor, &mut move_by);
        let longest = move_by.iter().map(|d| d.norm()).fold(0.0, f64::max);
        outcome = Outcome { steps: step + 1, speed: longest / dt, residual: g.iter().map(|g| g.norm()).fold(0.0, f64::max) };
        if longest > pace.farthest {
            move_by.iter_mut().for_each(|d| *d *= pace.farthest / longest);
        }
        let mut hits = 0;
        if let (Some(tree), Some(l)) = (tree, &mut system.layers) {
            l.pairs = tree.pairs(x, &move_by, l.thickness);
            hits = limit(x, &mut move_by, &l.pairs);
        }
        let slope: f64 = g.iter().zip(&move_by).map(|(g, d)| g.dot(d)).sum();
        let start = system.value(x);
        let mut share = 1.0;
        let mut tries = 0;
        loop {
            let trial: Vec<Vec3> = x.iter().zip(&move_by).map(|(p, d)| p + d * share).collect();
            let end = system.value(&trial);
            if end <= start + 1e-4 * share * slope + 1e-13 * start.abs() || tries >= 8 {
                *x = trial;
                break;
            }
            share *= 0.5;
            tries += 1;
        }
        system.drag(x);
        if std::env::var("TRACE").is_ok() {
            eprintln!("  {step} dt {dt:.3} speed {:.2e} res {:.2e} share {share} touches {} layers {} pairs {} hits {hits} E {start:.8e}", outcome.speed, outcome.residual, system.touches.len(), system.layers.as_ref().map_or(0, |l| l.contacts.len()), system.layers.as_ref().map_or(0, |l| l.pairs.len()));
        }
        if watch(system, x, &outcome) {
            break;
        }
        if outcome.speed < pace.speed && share == 1.0 {
            break;
        }
        if tries == 0 { dt = (dt * 1.5).min(longest_dt) } else if tries > 1 { dt *= 0.6 }
    }
    Ok(outcome)
}

#[allow(unused)]
fn unused(_: &Pattern) {}
