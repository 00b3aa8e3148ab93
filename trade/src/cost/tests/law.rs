//! Laws found in runs, and what is told of other pipelines, machines and stages.

use super::kit::*;
use crate::cost::*;
use toile_core::cost::{Estimate, Predicted, Quantity};

#[test]
fn a_known_law_is_found_in_noisy_runs() {
    let costs = Costs::fit(&runs("a", 60, 0.1), &[], 2);
    for n in [1e5, 1e6, 1e7, 4e7] {
        let ratio = wall(&costs, "a", &pixels(n)).value / otsu(n);
        assert!((ratio - 1.0).abs() < 0.08, "{n}: {ratio}");
    }
}

#[test]
fn outliers_sway_a_law_little() {
    let mut seen = runs("a", 60, 0.05);
    seen.iter_mut().step_by(12).for_each(|r| r.used.wall_s *= 8.0);
    let ratio = wall(&Costs::fit(&seen, &[], 2), "a", &pixels(1e6)).value / otsu(1e6);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

#[test]
fn odd_runs_sway_a_law_as_little_from_above_as_from_below() {
    let swayed = |factor: f64| {
        let mut seen = runs("a", 60, 0.05);
        seen.iter_mut().step_by(6).for_each(|r| r.used.wall_s *= factor);
        wall(&Costs::fit(&seen, &[], 2), "a", &pixels(1e6)).value / otsu(1e6)
    };
    let (high, low) = (swayed(5.0), swayed(0.2));
    assert!((high.ln() + low.ln()).abs() < 0.03 && (high - 1.0).abs() < 0.08, "{high} {low}");
}

#[test]
fn a_kind_of_garment_that_takes_more_is_known_by_other_pipelines_of_the_kind() {
    let of = |pipeline: &str, style: &str, factor: f64| {
        let mut seen = runs(pipeline, 9, 0.01);
        seen.iter_mut().for_each(|r| (r.style, r.used.wall_s) = (style.into(), r.used.wall_s * factor));
        seen
    };
    let all = [of("a", "Vest", 1.5), of("b", "Vest", 1.5), of("c", "TShirt", 1.0), of("d", "TShirt", 1.0)];
    let told = |seen: &[CostRecord], style: &str| {
        let at = StagePlace { style, ..place("new", "Otsu", "binariser") };
        let e = Costs::fit(seen, &[], 2).estimate(&at, &pixels(1e6), CostFigure::Wall).unwrap();
        e.value / otsu(1e6)
    };
    let (vest, tee, cape) =
        (told(&all.concat(), "Vest"), told(&all.concat(), "TShirt"), told(&all.concat(), "Cape"));
    assert!((1.3..1.5).contains(&vest) && (1.0..1.1).contains(&tee), "{vest} {tee}");
    assert!(tee < cape && cape < vest, "{cape} lies between");
    // One pipeline of a kind says less of it than two.
    let one = told(&all[1..].concat(), "Vest");
    assert!(tee < one && one < vest, "{one}");
}

#[test]
fn of_repeated_runs_each_stage_s_shortest_counts() {
    let run = |otsu: f64, rest: f64| {
        vec![
            record("a", "Otsu", "binariser", pixels(1e6), otsu),
            record("a", "StaticEquilibrium", "draper", triangles(1e3), rest),
        ]
    };
    let best = shortest(vec![run(0.03, 2.0), run(0.02, 3.0), run(0.05, 2.5)]);
    assert_eq!(best, [run(0.02, 9.0).remove(0), run(9.0, 2.0).remove(1)]);
    assert_eq!(shortest(vec![run(0.03, 2.0)]), run(0.03, 2.0));
    assert_eq!(shortest(Vec::new()), []);
}

#[test]
fn a_solver_grows_faster_than_its_mesh() {
    let run = |n: f64| record("a", "StaticEquilibrium", "draper", triangles(n), 1e-5 * n.powf(1.5));
    let seen: Vec<CostRecord> = [500.0, 1e3, 2e3, 4e3].map(run).into();
    let costs = Costs::fit(&seen, &[], 2);
    let far = costs
        .estimate(&place("a", "StaticEquilibrium", "draper"), &triangles(16e3), CostFigure::Wall)
        .unwrap();
    assert!((far.value / (1e-5 * 16e3_f64.powf(1.5)) - 1.0).abs() < 0.05, "{far:?}");
    let near = costs
        .estimate(&place("a", "StaticEquilibrium", "draper"), &triangles(3e3), CostFigure::Wall)
        .unwrap();
    assert!(far.high / far.value > near.high / near.value, "what was never measured is less sure");
}

#[test]
fn eighty_of_a_hundred_runs_lie_in_the_range() {
    let costs = Costs::fit(&runs("a", 60, 0.15), &[], 2);
    let fresh = runs("fresh", 400, 0.15);
    let inside = fresh.iter().filter(|r| wall(&costs, "a", &r.size).holds(r.used.wall_s)).count();
    assert!((290..=350).contains(&inside), "{inside} of 400");
}

#[test]
fn a_pipeline_that_was_never_run_is_less_sure() {
    let costs = Costs::fit(&runs("a", 30, 0.05), &[], 2);
    let (met, new) = (wall(&costs, "a", &pixels(1e6)), wall(&costs, "b", &pixels(1e6)));
    assert_eq!(met.value, new.value);
    assert!(new.high > met.high && new.low < met.low);
}

#[test]
fn a_slower_machine_is_known_by_other_stages() {
    let mut shipped = runs("a", 20, 0.05);
    shipped.extend((1..20).map(|i| {
        record("a", "StaticEquilibrium", "draper", triangles(f64::from(i) * 100.0), 1e-3 * f64::from(i))
    }));
    let slow: Vec<CostRecord> = runs("b", 8, 0.05)
        .into_iter()
        .map(|mut r| {
            r.used.wall_s *= 3.0;
            r
        })
        .collect();
    let at = place("b", "StaticEquilibrium", "draper");
    let before = Costs::fit(&[], &shipped, 2).estimate(&at, &triangles(1e3), CostFigure::Wall).unwrap();
    let after = Costs::fit(&slow, &shipped, 2).estimate(&at, &triangles(1e3), CostFigure::Wall).unwrap();
    assert!((after.value / before.value / 3.0 - 1.0).abs() < 0.1, "{after:?} after {before:?}");
    // Runs of another number of threads say nothing.
    assert_eq!(Costs::fit(&slow, &shipped, 1).own_runs(), 0);
}

#[test]
fn a_stage_without_record_is_told_by_its_role() {
    let costs = Costs::fit(&runs("a", 30, 0.05), &[], 2);
    assert!(!costs.knows("Background"));
    let e = costs.estimate(&place("a", "Background", "binariser"), &pixels(1e6), CostFigure::Wall).unwrap();
    assert!((e.value / otsu(1e6) - 1.0).abs() < 0.1 && e.high > 2.0 * e.value, "{e:?}");
    assert_eq!(costs.estimate(&place("a", "Glb", "writer"), &pixels(1e6), CostFigure::Wall), None);
}

#[test]
fn sums_of_independent_errors_grow_slower_than_the_sums() {
    let one = Estimate { value: 1.0, low: 0.5, high: 2.0 };
    let kept = Estimate { value: 10.0, low: 10.0, high: 10.0 };
    let stage = Predicted { wall_s: Some(one), peak_bytes: Some(one), kept_bytes: Some(kept), cpu_s: None };
    let all = total(&[&stage; 4]);
    assert_eq!(all.wall_s, Some(Estimate { value: 4.0, low: 3.0, high: 6.0 }));
    assert_eq!(all.peak_bytes.unwrap().value, 31.0, "the last on top of what three keep");
    assert_eq!(total(&[]), Predicted::default());
}

#[test]
fn the_shipped_figures_are_whole_and_know_the_shipped_stages() {
    let shipped = shipped();
    assert_eq!(shipped.damaged, 0);
    let costs = Costs::fit(&[], &shipped.records, 2);
    for stage in [
        "Photos",
        "Otsu",
        "GraphCut",
        "Canny",
        "GridMesher",
        "StaticEquilibrium",
        "SpringDraper",
        "PhotoTexturer",
        "Glb",
        "Scene",
    ] {
        assert!(costs.knows(stage), "{stage}");
    }
}

#[test]
fn rules_of_sizes_are_corrected_by_kind_of_garment() {
    let mut seen = [runs("a", 9, 0.05), runs("b", 9, 0.05)].concat();
    for r in &mut seen {
        let factor = if r.pipeline == "a" { 2.0 } else { 0.5 };
        r.style = if r.pipeline == "a" { "Vest".into() } else { "TShirt".into() };
        r.foreseen = pixels(r.size.get(Quantity::Pixels).unwrap() / factor);
    }
    let costs = Costs::fit(&seen[..17], &[], 2);
    let corrected = |style| costs.corrected("Otsu", style, &pixels(1e6)).get(Quantity::Pixels).unwrap();
    assert!((corrected("Vest") / 2e6 - 1.0).abs() < 1e-9 && (corrected("TShirt") / 5e5 - 1.0).abs() < 1e-9);
    assert!((corrected("Cape") / 2e6 - 1.0).abs() < 1e-9, "the middle of all kinds");
    assert_eq!(
        costs.corrected("Canny", "Vest", &pixels(7.0)),
        pixels(14.0),
        "what other stages tell of vests"
    );
    assert_eq!(costs.corrected("Canny", "Vest", &triangles(7.0)), triangles(7.0));
}

#[test]
fn a_pipeline_is_judged_by_the_others_alone() {
    let mut seen = [runs("a", 10, 0.05), runs("b", 10, 0.05), runs("c", 10, 0.05)].concat();
    let good = check(&seen, &[], CostFigure::Wall);
    assert_eq!((good.all.count, good.telling.count, good.met.count), (30, 30, 30));
    assert!(good.all.right >= 29, "{:?}", good.all);
    // c now takes twice as long: nobody else knows.
    seen.iter_mut().filter(|r| r.pipeline == "c").for_each(|r| r.used.wall_s *= 2.0);
    let c = check(&seen, &["c".into()], CostFigure::Wall);
    assert_eq!((c.stages.len(), c.all.count, c.all.right), (1, 10, 0));
}
