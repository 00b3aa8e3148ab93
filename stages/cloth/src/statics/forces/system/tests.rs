//! A force that the solver does not know takes part in everything by its own file and one line
//! where the list is built.
#![allow(clippy::unwrap_used)]
use super::*;
use crate::energy::Models;
use crate::scene::generate;
use crate::statics::factor::scalar::Precision;
use crate::statics::levels::assemble::{assemble, cloths};
use crate::statics::levels::pieces::Pieces;
use crate::statics::newton::subdomain::Subdomain;
use crate::statics::newton::to_rest::{NewtonOptions, Proof, relax};
use std::ops::ControlFlow;

/// A linear spring from a node to a place.
#[derive(Debug, Clone, Copy)]
struct Spring {
    /// `None` where the node is not in the subset.
    node: Option<u32>,
    to: Vec3,
    /// N/m.
    stiffness: f64,
}

impl Force for Spring {
    fn boxed(&self) -> Box<dyn Force> {
        Box::new(*self)
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        self.node.map_or(0.0, |i| 0.5 * self.stiffness * (x[i as usize] - self.to).norm_squared())
    }

    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        self.node.iter().for_each(|&i| g[i as usize] += (x[i as usize] - self.to) * self.stiffness);
    }

    fn add_matrix(&self, _: &[Vec3], _: &Pattern, values: &mut [Matrix3<f64>]) {
        self.node.iter().for_each(|&i| values[i as usize] += Matrix3::identity() * self.stiffness);
    }

    fn restrict(&self, cut: &Subset) -> Box<dyn Force> {
        let node = self.node.filter(|&i| cut.has_all(&[i]));
        Box::new(Self { node: node.map(|i| cut.renumbered([i])[0]), ..*self })
    }
}

/// A hanging sheet with a spring at its lowest corner, and its positions.
fn with_a_spring(check: impl FnOnce(System<'_>, Vec<Vec3>, Spring)) {
    let scene = generate::hang(6);
    let pieces = Pieces::new(&scene);
    let sheet = pieces.sewn_sheet(&cloths(&scene)).unwrap();
    let mut system = assemble(&scene, None, &pieces, &sheet, false, Models::STATIC).unwrap();
    let x = scene.positions.clone();
    let lowest = (0..x.len()).min_by(|&a, &b| x[a].y.total_cmp(&x[b].y)).unwrap();
    // Towards the middle of the sheet, which is slack on the way.
    let to = (x[lowest] + x.iter().sum::<Vec3>() / x.len() as f64) * 0.5;
    let spring = Spring { node: Some(lowest as u32), to, stiffness: 5000.0 };
    system.forces.push(Box::new(spring));
    check(system, x, spring);
}

#[test]
fn a_spring_in_the_list_pulls_its_node_to_its_place() {
    with_a_spring(|mut system, mut x, spring| {
        let options = NewtonOptions {
            first: 0.05,
            longest: 1.0,
            steps: 200,
            speed: 1e-3,
            non_static: 0.0,
            farthest: 0.1,
            proof: Proof::ProofStep,
            precision: Precision::Double,
            skip_line_search: false,
            holds_stopped: false,
            one_by_one: false,
            asleep: true,
        };
        let (layout, node) = (x.clone(), spring.node.unwrap() as usize);
        let go_on = &mut |_: &System<'_>, _: &[Vec3], _: &_| ControlFlow::Continue(());
        let outcome = relax(&mut system, &layout, None, &mut x, &options, go_on, &|| false).unwrap();
        assert!(outcome.at_rest && (x[node] - spring.to).norm() < 5e-3, "{outcome:?} {}", x[node]);
    });
}

#[test]
fn a_spring_in_the_list_is_in_every_sum_and_in_a_subset() {
    with_a_spring(|mut system, x, spring| {
        let node = spring.node.unwrap() as usize;
        let bare = {
            let mut bare = system.clone();
            bare.remove::<Spring>();
            bare
        };
        system.update_contacts(&x);
        assert!((system.value(&x) - bare.value(&x) - spring.value(&x)).abs() < 1e-9);
        let pull = system.gradient(&x)[node] - bare.gradient(&x)[node];
        assert!((pull - (x[node] - spring.to) * spring.stiffness).norm() < 1e-6);
        let active = (0..x.len()).map(|i| i == node).collect();
        let subdomain = Subdomain::of(&system, active);
        let own = subdomain.pick(&x);
        let found = subdomain.system.get::<Spring>().unwrap().node.unwrap() as usize;
        assert_eq!(own[found], x[node]);
        let apart = subdomain.system.gradient(&own)[found] - system.gradient(&x)[node];
        assert!(apart.norm() < 1e-9 * system.gradient(&x)[node].norm());
    });
}
