#![allow(clippy::unwrap_used)]
use super::*;
use proptest::prelude::*;
use std::path::Path;
use toile_core::cost::{Estimate, Predicted, Quantity, Size, Used};

/// Numbers that look random and are the same every time (Lehmer 1951), from 0 to 1.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0
    }

    /// A factor around 1 whose logarithm has about this standard deviation.
    fn noise(&mut self, spread: f64) -> f64 {
        let sum: f64 = (0..12).map(|_| self.roll()).sum();
        (spread * (sum - 6.0)).exp()
    }
}

fn pixels(n: f64) -> Size {
    Size::new().with(Quantity::Pixels, n)
}

fn triangles(n: f64) -> Size {
    Size::new().with(Quantity::Triangles, n)
}

fn record(pipeline: &str, stage: &str, role: &str, size: Size, wall_s: f64) -> CostRecord {
    CostRecord {
        pipeline: pipeline.into(),
        style: "Vest".into(),
        stage: stage.into(),
        role: role.into(),
        key: format!("{stage} {wall_s}"),
        threads: 2,
        made: size.clone(),
        foreseen: size.clone(),
        size,
        used: Used { wall_s, cpu_s: Some(wall_s * 2.0), peak_bytes: Some(5_000_000), kept_bytes: None },
    }
}

/// Some milliseconds, and 30 ns a pixel.
fn otsu(pixels: f64) -> f64 {
    2e-3 + 30e-9 * pixels
}

/// Runs of Otsu by that law.
fn runs(pipeline: &str, count: usize, spread: f64) -> Vec<CostRecord> {
    let mut dice = Dice(1 + pipeline.bytes().map(u64::from).sum::<u64>());
    let run = |_| {
        let n = (1e5 * 100_f64.powf(dice.roll())).round();
        let microseconds = (otsu(n) * dice.noise(spread) * 1e6).round();
        record(pipeline, "Otsu", "binariser", pixels(n), microseconds / 1e6)
    };
    (0..count).map(run).collect()
}

fn place<'a>(pipeline: &'a str, stage: &'a str, role: &'a str) -> Place<'a> {
    Place { pipeline, stage, role }
}

fn wall(costs: &Costs, pipeline: &str, size: &Size) -> Estimate {
    costs.estimate(&place(pipeline, "Otsu", "binariser"), size, Figure::Wall).unwrap()
}

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
fn a_solver_grows_faster_than_its_mesh() {
    let run = |n: f64| record("a", "Rest", "draper", triangles(n), 1e-5 * n.powf(1.5));
    let seen: Vec<CostRecord> = [500.0, 1e3, 2e3, 4e3].map(run).into();
    let costs = Costs::fit(&seen, &[], 2);
    let far = costs.estimate(&place("a", "Rest", "draper"), &triangles(16e3), Figure::Wall).unwrap();
    assert!((far.value / (1e-5 * 16e3_f64.powf(1.5)) - 1.0).abs() < 0.05, "{far:?}");
    let near = costs.estimate(&place("a", "Rest", "draper"), &triangles(3e3), Figure::Wall).unwrap();
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
    shipped.extend(
        (1..20).map(|i| record("a", "Rest", "draper", triangles(f64::from(i) * 100.0), 1e-3 * f64::from(i))),
    );
    let slow: Vec<CostRecord> = runs("b", 8, 0.05)
        .into_iter()
        .map(|mut r| {
            r.used.wall_s *= 3.0;
            r
        })
        .collect();
    let at = place("b", "Rest", "draper");
    let before = Costs::fit(&[], &shipped, 2).estimate(&at, &triangles(1e3), Figure::Wall).unwrap();
    let after = Costs::fit(&slow, &shipped, 2).estimate(&at, &triangles(1e3), Figure::Wall).unwrap();
    assert!((after.value / before.value / 3.0 - 1.0).abs() < 0.1, "{after:?} after {before:?}");
    // Runs of another number of threads say nothing.
    assert_eq!(Costs::fit(&slow, &shipped, 1).own_runs(), 0);
}

#[test]
fn a_stage_without_record_is_told_by_its_role() {
    let costs = Costs::fit(&runs("a", 30, 0.05), &[], 2);
    assert!(!costs.knows("Background"));
    let e = costs.estimate(&place("a", "Background", "binariser"), &pixels(1e6), Figure::Wall).unwrap();
    assert!((e.value / otsu(1e6) - 1.0).abs() < 0.1 && e.high > 2.0 * e.value, "{e:?}");
    assert_eq!(costs.estimate(&place("a", "Glb", "writer"), &pixels(1e6), Figure::Wall), None);
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

fn host() -> Host {
    Host { cpu: "A processor".into(), cores: 2 }
}

fn written(text: &str) -> (tempfile::TempDir, Opened) {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("costs.jsonl"), text).unwrap();
    let opened = CostStore::new(dir.path()).open(&host());
    (dir, opened)
}

fn warned(text: &str, words: &str) {
    let (dir, opened) = written(text);
    let path = dir.path().join("costs.jsonl");
    let all = format!("what earlier runs took, \"{}\", {words}", path.display());
    assert_eq!(opened, Opened { records: Vec::new(), warning: Some(all) });
}

fn text_of(host: Host, version: &str) -> String {
    let collection = Collection { host, toile: version.into(), ..Collection::here(runs("a", 3, 0.1)) };
    collection.to_text()
}

#[test]
fn a_store_that_is_of_no_use_is_said_to_be() {
    let version = env!("CARGO_PKG_VERSION");
    let other = Host { cpu: "Another".into(), cores: 64 };
    warned("", "is damaged; the shipped figures stand in");
    warned("nonsense\n{}", "is damaged; the shipped figures stand in");
    warned(
        &text_of(other, version),
        "is of another machine (Another, 64 cores); the shipped figures stand in",
    );
    warned(&text_of(host(), "0.0.1"), "was kept by version 0.0.1; the shipped figures stand in");
    let newer = text_of(host(), version).replace("\"scheme\":1", "\"scheme\":2");
    warned(&newer, "was kept by another version; the shipped figures stand in");
    assert_eq!(CostStore::new(Path::new("/nowhere/at/all")).open(&host()), Opened::default());
}

#[test]
fn a_damaged_line_of_the_store_loses_itself_alone() {
    let text = text_of(host(), env!("CARGO_PKG_VERSION")).replacen("{\"pipeline\"", "{\"pipe", 1);
    let (dir, opened) = written(&text);
    assert_eq!(opened.records, runs("a", 3, 0.1)[1..]);
    let path = dir.path().join("costs.jsonl");
    let words = format!("what earlier runs took, \"{}\", has 1 damaged line, left out", path.display());
    assert_eq!(opened.warning, Some(words));
}

#[test]
fn the_store_keeps_the_latest_runs_and_no_more() {
    let dir = tempfile::tempdir().unwrap();
    let store = CostStore::new(&dir.path().join("deep"));
    for run in runs("a", 30, 0.1).chunks(10) {
        store.add(&host(), run.to_vec()).unwrap();
    }
    let opened = store.open(&host());
    assert_eq!((opened.records.as_slice(), opened.warning), (&runs("a", 30, 0.1)[6..], None));
    // What another machine left makes place.
    let other = Host { cores: 8, ..host() };
    store.add(&other, runs("b", 1, 0.1)).unwrap();
    assert_eq!(store.open(&other).records, runs("b", 1, 0.1));
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
        "Rest",
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
    assert_eq!(costs.corrected("Canny", "Vest", &pixels(7.0)), pixels(7.0));
}

#[test]
fn a_pipeline_is_judged_by_the_others_alone() {
    let mut seen = [runs("a", 10, 0.05), runs("b", 10, 0.05), runs("c", 10, 0.05)].concat();
    let good = check(&seen, &[], Figure::Wall);
    assert_eq!((good.all.count, good.telling.count, good.met.count), (30, 30, 30));
    assert!(good.all.right >= 29, "{:?}", good.all);
    // c now takes twice as long: nobody else knows.
    seen.iter_mut().filter(|r| r.pipeline == "c").for_each(|r| r.used.wall_s *= 2.0);
    let c = check(&seen, &["c".into()], Figure::Wall);
    assert_eq!((c.stages.len(), c.all.count, c.all.right), (1, 10, 0));
}

#[test]
fn a_check_is_told_in_words() {
    let size = pixels(1e6);
    let seen = [
        record("a", "Otsu", "binariser", size.clone(), 0.04),
        record("b", "Otsu", "binariser", size.clone(), 0.05),
        record("b", "Cut", "binariser", size, 0.1),
    ];
    let lines = check_lines(&check(&seen, &["b".into()], Figure::Wall));
    assert_eq!(
        lines,
        [
            "wall time: prediction / fact on pipelines left out of the fit",
            "  pipeline    stage                runs       fact   least  middle    most  within 30 %",
            "  b           Cut                     1     100 ms    0.40    0.40    0.40  0 of 1  others of its role stand in",
            "  b           Otsu                    1      50 ms    0.80    0.80    0.80  1 of 1",
            "within 30 %: 50 % (1 of 2) of all, 50 % (1 of 2) of those above 1 ms, 100 % (1 of 1) of these where other pipelines have the stage",
            "in the range of 80 %: 100 % of those above 1 ms",
        ]
    );
}

#[test]
fn a_forecast_is_told_in_words() {
    let e = |value: f64| Some(Estimate { value, low: value / 2.0, high: value * 2.0 });
    let predicted = Predicted { wall_s: e(0.04), peak_bytes: e(3e6), ..Predicted::default() };
    let forecast =
        |stage: &str, known, predicted| Forecast { stage: stage.into(), size: Size::new(), predicted, known };
    let (otsu, own) = (forecast("Otsu", true, predicted), forecast("Own", false, Predicted::default()));
    assert_eq!(
        forecast_lines(&[&otsu, &own], "from 3 runs"),
        [
            "expected where nothing comes from the cache: wall time and memory at its peak beyond what is held before",
            "(80 of 100 runs lie in the range; from 3 runs)",
            "  Otsu                 40 ms (20 ms to 80 ms)         3.0 MB (1.5 MB to 6.0 MB)",
            "  Own                  not known                      not known  no record of it; others of its role stand in",
            "  all, one by one      40 ms (20 ms to 80 ms)         3.0 MB (1.5 MB to 6.0 MB)",
        ]
    );
    let used = Used { wall_s: 0.05, peak_bytes: Some(2_000_000), ..Used::default() };
    assert_eq!(
        beside(&[("Otsu", used, predicted)]),
        [
            "  Otsu                 took 50 ms, 2.0 MB      expected 40 ms (20 ms to 80 ms), 3.0 MB (1.5 MB to 6.0 MB)",
            "expected times: 1 of 1 within 30 %, 1 in the range of 80 %",
        ]
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}", bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = parse_collection(&text);
        let _ = parse_collection(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn a_spoilt_store_is_read_and_fitted_without_panic(at in 0usize..900, byte in any::<u8>(), cut in 0usize..900) {
        let mut bytes = text_of(host(), env!("CARGO_PKG_VERSION")).into_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(bytes.len().saturating_sub(cut % 300));
        if let Ok(collection) = parse_collection(&String::from_utf8_lossy(&bytes)) {
            let costs = Costs::fit(&collection.records, &[], 2);
            let e = costs.estimate(&place("a", "Otsu", "binariser"), &pixels(1e6), Figure::Wall);
            prop_assert!(e.is_none_or(|e| e.value.is_finite() && e.low <= e.value && e.value <= e.high));
        }
    }
}
