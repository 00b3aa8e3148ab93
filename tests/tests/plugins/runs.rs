//! Stages of plugins at work: the same results as linked in, and a clear word where they fail.

use crate::plugins::kit::{make, only, outline, photo, registry_with, run, run_in};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use toile_core::{Cancel, Context, ErrorCode, Event, Listener, Registry, Stage};
use toile_pipeline::plugin::load_plugin;
use toile_tests::plugins::compiled;

const FAULTY: &str = "plugin \"toile-faulty\" 0.1.0";

fn linked() -> Registry {
    let mut registry = Registry::new();
    toile_faulty::register(&mut registry);
    registry
}

#[test]
fn a_stage_gives_the_same_loaded_and_linked_in() {
    for arguments in ["()", "(by: 0.25)", "(by: 1)"] {
        let loaded = make(&registry_with(&["toile_faulty"]), "Shades", arguments);
        let linked = make(&linked(), "Shades", arguments);
        assert_eq!(loaded.params(), linked.params());
        let [a, b] = [loaded, linked].map(|s| only(&run(s.as_ref(), vec![Arc::new(photo())]).unwrap()));
        assert_eq!(a, b);
    }
}

#[test]
fn cards_are_the_same_loaded_and_linked_in() {
    let (loaded, linked) = (registry_with(&["toile_faulty"]), linked());
    for own in linked.cards() {
        let mut other = loaded.card(own.name).unwrap().clone();
        assert_eq!(other.plugin.take().unwrap().name, "toile-faulty");
        assert_eq!(format!("{other:?}"), format!("{own:?}"));
    }
}

#[test]
fn parameters_are_checked_by_the_plugin_with_its_own_words() {
    let registry = registry_with(&["toile_faulty"]);
    let doc = &registry.card("Shades").unwrap().params[0];
    assert!(doc.check.run("0.75", doc).is_ok());
    let linked = linked();
    let own = &linked.card("Shades").unwrap().params[0];
    for value in ["2.0", "-1", "\"half\"", "(", "NaN"] {
        assert_eq!(doc.check.run(value, doc), own.check.run(value, own), "{value}");
        assert!(doc.check.run(value, doc).is_err());
    }
}

/// Runs a faulty stage on a photo.
fn failing(name: &str) -> (ErrorCode, String) {
    let stage = make(&registry_with(&["toile_faulty"]), name, "()");
    let e = run(stage.as_ref(), vec![Arc::new(photo())]).unwrap_err();
    (e.code, e.message)
}

#[test]
fn a_panic_becomes_an_error_with_its_message() {
    let panicked = |what: &str| (ErrorCode::Internal, format!("{FAULTY} panicked: {what}"));
    assert_eq!(failing("PanicsInRun"), panicked("a photo of 40 pixels frightens me"));
    assert_eq!(failing("PanicsInLoop"), panicked("five"));
}

#[test]
fn a_panic_while_a_stage_is_made_is_an_error() {
    let registry = registry_with(&["toile_faulty", "toile_oldest"]);
    let card = registry.card("PanicsInCreate").unwrap();
    let e = registry.make(card, "(trap: 13)").unwrap_err();
    assert_eq!(e, format!("{FAULTY} panicked: thirteen"));
    assert!(card.params[0].check.run("13", &card.params[0]).is_err());
    let old = registry.card("OldInvert").unwrap();
    let e = registry.make(old, "(white: 13)").unwrap_err();
    assert_eq!(e, "plugin \"toile-oldest\" 0.1.0 panicked: thirteen");
}

#[test]
fn a_panic_in_drop_ends_there() {
    let registry = registry_with(&["toile_faulty"]);
    let stage = make(&registry, "PanicsInDrop", "(armed: true)");
    assert!(run(stage.as_ref(), vec![Arc::new(photo())]).is_ok());
    drop(stage);
    assert!(run(make(&registry, "Shades", "()").as_ref(), vec![Arc::new(photo())]).is_ok());
}

#[test]
fn what_cannot_be_is_not_taken() {
    let registry = registry_with(&["toile_faulty"]);
    let message =
        |name| run(make(&registry, name, "()").as_ref(), vec![Arc::new(outline())]).unwrap_err().message;
    assert_eq!(
        message("GivesNan"),
        format!("{FAULTY}: its panel cannot be used: vertex 0 is not a finite number below 1e9")
    );
    assert_eq!(
        message("GivesBadTriangles"),
        format!("{FAULTY}: its panel cannot be used: a triangle names vertex 7 of 3")
    );
    assert_eq!(
        message("TurnsOver"),
        format!("{FAULTY}: its panel cannot be used: triangle 1 is turned over: its vertices run clockwise")
    );
}

/// A garment as a stage that drapes gives it on: the stage is named, not the one that solves it
/// next.
#[test]
fn a_garment_with_a_triangle_turned_over_is_not_taken() {
    let mut two = crate::plugins::colliders::garment();
    let (p, r) = (two.positions[2], two.rest[2]);
    two.positions.push(p + (two.positions[1] - two.positions[0]));
    two.rest.push(r + (two.rest[1] - two.rest[0]));
    two.velocities.push(two.velocities[0]);
    two.weld.push(3);
    two.triangles.push([1, 3, 2]);
    (two.panels[0].vertices, two.panels[0].triangles, two.panels[0].boundary) =
        (0..4, 0..2, vec![0, 1, 3, 2]);
    let stage = make(&registry_with(&["toile_faulty"]), "TurnsCloth", "()");
    assert_eq!(
        run(stage.as_ref(), vec![Arc::new(two)]).unwrap_err().message,
        format!(
            "{FAULTY}: its garment cannot be used: triangles 0 and 1 of panel \"front\" disagree on which side is up"
        )
    );
}

#[test]
fn an_error_keeps_code_hint_and_parameter() {
    let stage = make(&registry_with(&["toile_faulty"]), "Forgets", "(what: 4)");
    let e = run(stage.as_ref(), vec![Arc::new(photo())]).unwrap_err();
    assert_eq!((e.code, e.message.as_str()), (ErrorCode::InvalidInput, "it forgot 4 things"));
    assert_eq!((e.hint.as_deref(), e.param), (Some("remember them"), Some("what")));
}

#[test]
fn a_run_that_never_asks_whether_to_stop_is_left_behind() {
    let cancel = Cancel::new();
    let cx = Context::new("NeverStops", Path::new("."), cancel.clone(), Arc::new(()));
    let stage = make(&registry_with(&["toile_faulty"]), "NeverStops", "()");
    let stop = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(50));
        cancel.cancel();
    });
    let e = run_in(stage.as_ref(), vec![Arc::new(photo())], &cx).unwrap_err();
    stop.join().unwrap();
    assert_eq!(
        (e.code, e.message),
        (ErrorCode::Cancelled, format!("{FAULTY} did not stop within 2 s of being asked"))
    );
}

/// Notes and warnings of a stage.
#[derive(Default)]
struct Told(Mutex<Vec<String>>);

impl Listener for Told {
    fn event(&self, stage: &str, entry: &str, event: &Event) {
        self.0.lock().unwrap().push(format!("{stage}/{entry}: {event:?}"));
    }
}

#[test]
fn progress_warnings_figures_and_loops_reach_the_program() {
    let told = Arc::new(Told::default());
    let cx = Context::new("Loops2", Path::new("."), Cancel::new(), told.clone()).for_entry("front");
    let stage = make(&registry_with(&["toile_faulty"]), "Loops", "()");
    run_in(stage.as_ref(), vec![Arc::new(photo())], &cx).unwrap();
    let (figures, warnings) = (cx.take_figures(), cx.take_remarks().warnings);
    assert_eq!((figures[0].name.as_str(), figures[0].value), ("squares", 328_350.0));
    assert_eq!(warnings, ["front of Loops2"]);
    let told = told.0.lock().unwrap();
    assert_eq!(told[0], "Loops2/front: Progress { share: 0.5, text: \"half way\" }");
}

/// The inverted photo of a plugin in C.
fn inverted(flags: &[&str]) -> (Box<dyn Stage>, String) {
    let dir = tempfile::tempdir().unwrap();
    let library = compiled("plugins/c/invert.c", dir.path(), flags).unwrap();
    let mut registry = Registry::new();
    load_plugin(&mut registry, &library, None).unwrap();
    let stage = make(&registry, "InvertC", "(white: 200)");
    let made = only(&run(stage.as_ref(), vec![Arc::new(photo())]).unwrap());
    (stage, made)
}

#[test]
fn a_plugin_in_c_works_built_for_the_present_and_for_the_oldest_minor() {
    let mut pixels = photo().pixels.as_ref().clone();
    pixels.iter_mut().for_each(|v| *v = 200_u8.saturating_sub(*v));
    let expected = format!("{:?}", photo().with_pixels(pixels));
    for flags in [&[][..], &["-DTOILE_ABI_MINOR=0"]] {
        let (stage, made) = inverted(flags);
        assert_eq!(stage.params(), "(white: 200)");
        assert_eq!(made, expected);
    }
}

#[test]
fn a_plugin_of_the_oldest_sdk_still_loads_and_is_checked_by_its_types_words() {
    let registry = registry_with(&["toile_oldest"]);
    assert_eq!(registry.plugins()[0].abi, (1, 0));
    let doc = &registry.card("OldInvert").unwrap().params[0];
    let fault = doc.check.run("300", doc).unwrap_err().message;
    assert_eq!(fault, "`white` is 300, above its greatest value 255 grey levels");
    let made = run(make(&registry, "OldInvert", "(white: 200)").as_ref(), vec![Arc::new(photo())]);
    let mut pixels = photo().pixels.as_ref().clone();
    pixels.iter_mut().for_each(|v| *v = 200_u8.saturating_sub(*v));
    assert_eq!(only(&made.unwrap()), format!("{:?}", photo().with_pixels(pixels)));
}
