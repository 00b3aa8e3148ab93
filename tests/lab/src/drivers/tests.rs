#![allow(clippy::unwrap_used)]
use super::super::map::Scheme;
use super::*;
use toile_cloth::energy::Membrane;

const WOVEN: Membrane = Membrane::Woven;

fn way(scheme: Option<Scheme>, membrane: Membrane) -> Way {
    Way { scheme, membrane }
}

fn measured(ways: &[Way], longest: f64) -> Report {
    let options = Options { ways: ways.to_vec(), longest, ..Options::default() };
    drivers(&options, &mut |_, _| ControlFlow::Continue(()))
}

fn error_power(report: &Report, scene: Scene, driver: Driver, way: Way) -> Power {
    let is_asked = |f: &&Fit| (f.scene, f.driver, f.way) == (scene, driver, way);
    report.fits.iter().find(is_asked).unwrap().error.unwrap()
}

#[test]
#[ignore = "slow: .ci/wide"]
fn errors_fall_as_theory_has_it() {
    let (explicit, implicit) = (way(Some(Scheme::Explicit), WOVEN), way(Some(Scheme::Implicit), WOVEN));
    let (newton, xpbd) = (way(None, WOVEN), way(Some(Scheme::Xpbd), WOVEN));
    let report = measured(&[explicit, implicit, newton, xpbd], 0.4);
    assert!(!report.stopped);
    let power = |scene, driver, way| error_power(&report, scene, driver, way).exponent;
    // Second order in the edge length is first order in the particles.
    let spatial = power(Scene::Swing, Driver::Particles, explicit);
    assert!((-1.6..-0.8).contains(&spatial), "{spatial}");
    let spatial = power(Scene::Catenary, Driver::Particles, newton);
    assert!((-1.6..-0.8).contains(&spatial), "{spatial}");
    // Backward Euler is of first order in the step, and right at rest whatever the step.
    let first = power(Scene::Swing, Driver::Step, implicit);
    assert!((0.75..1.1).contains(&first), "{first}");
    assert!(power(Scene::Catenary, Driver::Step, implicit).abs() < 0.01);
    // XPBD's rest depends on its step.
    assert!(power(Scene::Catenary, Driver::Step, xpbd) > 1.0);
    let refused = report.rows.iter().filter(|r| r.way == explicit && r.driver == Driver::Step);
    let texts: Vec<&str> = refused.filter_map(|r| r.refused.as_deref()).collect();
    assert!(
        texts.len() >= 8
            && texts[0].starts_with("time step 1.280e-1 s is unstable: the limit 2/omega_max is ")
    );
}

#[test]
fn springs_miss_the_sag_that_elements_find() {
    let ways = [way(None, WOVEN), way(None, Membrane::Springs)];
    let report = measured(&ways, 1.0);
    let finest = |w: Way| report.rows.iter().rfind(|r| r.way == w).and_then(|r| r.error).unwrap();
    assert!(finest(ways[1]) > 5.0 * finest(ways[0]), "{} {}", finest(ways[1]), finest(ways[0]));
    // Nothing without a time step has a motion, or steps to turn.
    assert!(report.rows.iter().all(|r| r.scene == Scene::Catenary && r.driver == Driver::Particles));
    assert!(report.rows.windows(2).all(|w| w[0].way != w[1].way || w[0].particles < w[1].particles));
}

#[test]
fn every_run_is_a_line_of_the_csv() {
    let report = measured(&[way(Some(Scheme::Explicit), WOVEN), way(Some(Scheme::Rest), WOVEN)], 0.02);
    let csv = report.to_csv();
    assert_eq!(csv.lines().next(), Some("scene,driver,solver,particles,dt_s,error,cpu_s,refused"));
    assert_eq!(csv.lines().count(), 1 + 2 * (6 + 8) + 6);
    assert!(csv.lines().all(|l| l.split(',').count() == 8));
    assert!(csv.contains("it would take longer than a run may"));
    assert!(csv.contains("swing,step,\"central differences\","));
    assert!(report.to_json().contains("\"way\": \"StaticEquilibrium\""));
    let table = report.to_string();
    assert!(table.contains("| StaticEquilibrium ") && table.contains("swing of a hanging strip"));
}

#[test]
fn a_caller_can_stop_between_and_within_runs() {
    let newton = Options { ways: vec![way(None, WOVEN)], ..Options::default() };
    let none = drivers(&newton, &mut |_, _| ControlFlow::Break(()));
    assert!(none.stopped && none.rows.is_empty());
    let ways = vec![way(Some(Scheme::Implicit), WOVEN)];
    let cut =
        drivers(
            &Options { ways, stop: || true, ..Options::default() },
            &mut |_, _| ControlFlow::Continue(()),
        );
    assert!(cut.stopped && cut.rows.is_empty() && cut.fits.is_empty());
}
