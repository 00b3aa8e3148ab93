#![allow(clippy::unwrap_used)]
use super::*;
use crate::cost::{Quantity, Size};
use crate::load::{Pipeline, load, tests::kit};
use crate::{RunOptions, plan};
use std::path::Path;
use toile_core::Known;
use toile_core::prelude::*;

/// A painter that tells what it knows.
#[stage(role = Texturer)]
struct Telling {
    /// Whether its rules fail.
    #[param(default = false)]
    fails: bool,
}

#[stage]
impl Telling {
    fn run(
        &self,
        _panels: Set<Panel>,
        #[original] _photos: Set<Photo>,
        _body: Option<&Body>,
        _model: Option<&Model>,
        _cx: &Context,
    ) -> Result<Model, StageError> {
        Err(StageError::internal("a test stage does nothing"))
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        assert!(!self.fails, "a rule that fails");
        let wired: Vec<&str> = ["panels", "photos", "body", "model", "shoes"]
            .into_iter()
            .filter(|port| known.is_wired(port))
            .collect();
        let before: Vec<&str> = known.before().map(|n| n.id.as_str()).collect();
        vec![Decision {
            rule: "telling".into(),
            state: State::Simplified,
            what: wired.join(" "),
            fact: before.join(" "),
            tolerance: Tolerance::Distance(2e-3),
            saves: Saves::Share(0.5),
            source: known.node().id.clone(),
            turn: Turn::Param { name: "fails".into(), value: "true".into() },
        }]
    }
}

fn pipeline(painter: &str) -> Pipeline {
    let mut registry = kit::registry();
    registry.add::<Telling>();
    let text = kit::VEST.replace("Painter(),", painter).replace("Glb(), Report()", "Glb()");
    load(&text, "vest.ron", Path::new("."), &registry, &[]).unwrap()
}

fn of(pipeline: &Pipeline, options: RunOptions) -> Vec<StageDecision> {
    decisions(pipeline, &options).unwrap()
}

#[test]
fn a_stage_tells_by_what_is_wired_and_what_runs_before_it() {
    let all = of(&pipeline("Telling(),"), RunOptions::default());
    let told: Vec<_> = all.iter().filter(|d| d.decision.rule == "telling").collect();
    assert_eq!(told.len(), 1);
    assert_eq!((told[0].stage.as_str(), told[0].decision.what.as_str()), ("Telling", "panels photos body"));
    let before = &told[0].decision.fact;
    assert!(
        before.starts_with("Photos ") && before.contains("Taubin") && !before.contains("Preset"),
        "{before}"
    );
    assert_eq!(told[0].words("stages.Telling"), "--set 'stages.Telling.fails=true'");
}

#[test]
fn rules_that_fail_tell_nothing() {
    let all = of(&pipeline("Telling(fails: true),"), RunOptions::default());
    assert!(all.iter().all(|d| d.decision.rule == "unasked"), "{all:?}");
}

#[test]
fn what_nobody_asks_for_is_left_out_and_runs_when_it_is_asked_for() {
    let pipeline = pipeline("Telling(),");
    let unasked = |options| {
        let all = of(&pipeline, options).into_iter().filter(|d| d.decision.rule == "unasked");
        all.map(|d| (d.stage.clone(), d.words(""))).collect::<Vec<_>>()
    };
    // The painter takes no fabric.
    assert_eq!(unasked(RunOptions::default()), [("Preset".to_owned(), "--also Preset".to_owned())]);
    let also = RunOptions { also: vec!["Preset".into()], ..RunOptions::default() };
    assert_eq!(unasked(also.clone()), []);
    assert!(plan(&pipeline, &also).unwrap().iter().all(Option::is_none));
    let until = RunOptions { until: Some("Otsu".into()), ..RunOptions::default() };
    assert_eq!(unasked(until), [], "what `until` cuts off is the user's own choice");
    let unknown = RunOptions { also: vec!["Shoes".into()], ..RunOptions::default() };
    let error = decisions(&pipeline, &unknown).unwrap_err();
    assert_eq!(error.to_string(), "there is no stage `Shoes` in this pipeline");
}

#[test]
fn amounts_are_shared_out_among_the_sides() {
    let pipeline = pipeline("Telling(),");
    let given = Size::new().with(Quantity::Pieces, 2.0).with(Quantity::Pixels, 10.0);
    let cx = Context::quiet();
    let known = Known { given: &given, nodes: &pipeline.nodes, index: 0, runs: &[], cx: &cx };
    assert_eq!((known.each(Quantity::Pixels), known.each(Quantity::Area)), (Some(5.0), None));
}

#[test]
fn tolerances_in_words() {
    let words = [
        (Tolerance::SameBits, "same bits"),
        (Tolerance::Outline(0.3e-3), "outline 0.3 mm"),
        (Tolerance::Texture(8.0), "texture 8 levels"),
        (Tolerance::Distance(2e-3), "surface 2 mm"),
    ];
    for (tolerance, text) in words {
        assert_eq!(tolerance.to_string(), text);
        let json = serde_json::to_string(&tolerance).unwrap();
        assert_eq!(serde_json::from_str::<Tolerance>(&json).unwrap(), tolerance);
    }
}
