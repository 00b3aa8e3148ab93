//! Forecasts and checks in words.

use super::kit::*;
use crate::cost::*;
use toile_core::cost::{Estimate, Predicted, Size, Used};

#[test]
fn a_check_is_told_in_words() {
    let size = pixels(1e6);
    let seen = [
        record("a", "Otsu", "binariser", size.clone(), 0.04),
        record("b", "Otsu", "binariser", size.clone(), 0.05),
        record("b", "Cut", "binariser", size, 0.1),
    ];
    let lines = check_lines(&check(&seen, &["b".into()], CostFigure::Wall));
    assert_eq!(
        lines,
        [
            "wall time: prediction / fact on pipelines left out of the fit",
            "  pipeline    stage                 runs       fact   least  middle    most  within 30 %",
            "  b           Cut                      1     100 ms    0.40    0.40    0.40  0 of 1  others of its role stand in",
            "  b           Otsu                     1      50 ms    0.80    0.80    0.80  1 of 1",
            "within 30 %: 50 % (1 of 2) of all, 50 % (1 of 2) of those above 1 ms, 100 % (1 of 1) of these where other pipelines have the stage",
            "in the range of 80 %: 100 % of those above 1 ms",
        ]
    );
}

#[test]
fn a_forecast_is_told_in_words() {
    let e = |value: f64| Some(Estimate { value, low: value / 2.0, high: value * 2.0 });
    let predicted = Predicted { wall_s: e(0.04), peak_bytes: e(3e6), ..Predicted::default() };
    let forecast = |stage: &str, known, predicted| Forecast {
        stage: stage.into(),
        size: Size::new(),
        predicted,
        known,
        measured_here: true,
    };
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
