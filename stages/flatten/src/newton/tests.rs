use super::*;
use crate::energy::{ArapEnergy, SymmetricDirichletEnergy};
use crate::shapes::{bump, surface};
use crate::start::start;

fn solve(
    energy: &dyn EnergyDensity,
    terms: &[QuadraticTerm],
    constraints: &[Constraint],
    options: StoppingLimits,
) -> Result<(Vec<Point2<f64>>, NewtonOutcome), FlattenError> {
    let s = surface(bump(12, 12, 0.8));
    let pairs: Vec<_> = terms.iter().flat_map(QuadraticTerm::pairs).collect();
    let (system, frames) = (PieceSystem::new(&s, &pairs), TriangleFrames::new(&s));
    let (mut q, _) = start(&s, &system, &frames)?;
    let problem = NewtonProblem { system: &system, frames: &frames, energy, terms, constraints };
    let report = problem.minimise(&mut q, options)?;
    Ok((q, report))
}

#[test]
fn the_end_is_a_minimum() {
    for energy in [&SymmetricDirichletEnergy as &dyn EnergyDensity, &ArapEnergy] {
        let tight = StoppingLimits { tolerance: 1e-18, ..StoppingLimits::default() };
        let Ok((_, report)) = solve(energy, &[], &[], tight) else { unreachable!() };
        let Ok((_, loose)) = solve(energy, &[], &[], StoppingLimits::default()) else { unreachable!() };
        assert!(report.converged && loose.converged);
        assert!(report.remaining <= 1e-18);
        assert!((report.energy - loose.energy).abs() < 1e-9);
    }
}

#[test]
fn a_constraint_is_met_and_a_held_vertex_stays() {
    let chain: Vec<u32> = (0..13).collect();
    let length =
        Constraint::ChainLength { vertices: chain.clone(), target: 1.1, scale: Vector2::new(1.0, 1.0) };
    let place = Point2::new(3.0, 4.0);
    let Ok((q, report)) =
        solve(&ArapEnergy, &[QuadraticTerm::at(80, place, 1e4)], &[length], StoppingLimits::default())
    else {
        unreachable!()
    };
    assert!(report.converged);
    assert!((chain_length(&chain, &q) - 1.1).abs() < 1e-7);
    assert!((q[80] - place).norm() < 1e-7);
}

#[test]
fn a_vertex_on_a_line_slides_along_it() {
    let (place, normal) = (Point2::new(0.3, 0.9), Vector2::new(0.6, 0.8));
    let held = |term| {
        solve(
            &ArapEnergy,
            &[term, QuadraticTerm::at(0, Point2::new(-0.5, -0.5), 1e4)],
            &[],
            StoppingLimits::default(),
        )
    };
    let Ok((q, slid)) = held(QuadraticTerm::on_line(80, place, normal, 1e6)) else { unreachable!() };
    assert!((q[80] - place).dot(&normal).abs() < 1e-6 && (q[80] - place).norm() > 0.05, "{}", q[80]);
    // What is free along the line costs less than what is held on it.
    let Ok((_, held)) = held(QuadraticTerm::at(80, place, 1e6)) else { unreachable!() };
    assert!(slid.converged && held.converged && slid.energy < 0.99 * held.energy, "{slid:?} {held:?}");
}

#[test]
fn a_constraint_that_is_said_twice_is_met() {
    let length =
        Constraint::ChainLength { vertices: (0..13).collect(), target: 1.05, scale: Vector2::new(1.0, 1.0) };
    let solved = solve(&ArapEnergy, &[], &[length.clone(), length], StoppingLimits::default());
    assert!(solved.is_ok_and(|(_, report)| report.converged));
}

#[test]
fn no_iterations_leave_the_start_and_say_so() {
    let none = StoppingLimits { iterations: 0, ..StoppingLimits::default() };
    let solved = solve(&ArapEnergy, &[], &[], none).map(|(_, r)| (r.iterations, r.converged));
    assert_eq!(solved, Ok((0, false)));
}

#[test]
fn a_tolerance_of_zero_is_refused() {
    let zero = StoppingLimits { tolerance: 0.0, ..StoppingLimits::default() };
    let text = solve(&ArapEnergy, &[], &[], zero).map_err(|e| e.to_string()).err();
    assert_eq!(text.as_deref(), Some("tolerance = 0 is out of range: a finite number above 0"));
}
