//! A garment that misses its body or slides off it is a failure, reported early; one that keeps its
//! place is not.

use serde_json::{Value, json};
use toile_tests::{Answer, root, toile};

/// The shipped skirt, on its form.
struct Skirt {
    scene: Value,
    form: String,
}

impl Skirt {
    fn new() -> Self {
        let beside =
            |name: &str| std::fs::read_to_string(root().join("pipelines/samples/scene").join(name)).unwrap();
        Self { scene: serde_json::from_str(&beside("skirt.json")).unwrap(), form: beside("form.obj") }
    }

    /// Changes every number of a list of points: `change` takes the axis and the number.
    fn with(mut self, list: &str, change: impl Fn(usize, f64) -> f64) -> Self {
        for point in self.scene[list].as_array_mut().unwrap() {
            for (axis, number) in point.as_array_mut().unwrap().iter_mut().enumerate() {
                *number = json!(change(axis, number.as_f64().unwrap()));
            }
        }
        self
    }

    /// As wide as before times a factor.
    fn wider(self, factor: f64) -> Self {
        let across = move |axis: usize, x: f64| if axis == 0 { factor * x } else { x };
        self.with("positions", across).with("rest_uv", across)
    }

    fn moved(self, by: [f64; 3]) -> Self {
        self.with("positions", move |axis, x| x + by[axis])
    }

    /// The body's file in another unit of length.
    fn scaled_body(mut self, factor: f64) -> Self {
        let line = |l: &str| match l.strip_prefix("v ") {
            Some(numbers) => {
                let scaled =
                    numbers.split_whitespace().map(|x| (factor * x.parse::<f64>().unwrap()).to_string());
                format!("v {}", scaled.collect::<Vec<_>>().join(" "))
            }
            None => l.to_owned(),
        };
        self.form = self.form.lines().map(line).collect::<Vec<_>>().join("\n");
        self
    }

    /// Runs it with that draper: the answer, and its metrics where it wrote them.
    fn run(&self, draper: &str) -> (Answer, Option<Value>) {
        let dir = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
        write("skirt.json", &self.scene.to_string());
        write("form.obj", &self.form);
        let stages = format!("stages: [{draper}, GarmentObj(name: \"result\")]");
        write("p.ron", &format!("(name: \"skirt\", scene: Scene(file: \"skirt.json\"), {stages})"));
        let at = |name: &str| dir.path().join(name).display().to_string();
        let answer = toile(&["run", &at("p.ron"), "--out", &at("out")]);
        let metrics = std::fs::read_to_string(dir.path().join("out/metrics.json")).ok();
        (answer, metrics.map(|text| serde_json::from_str(&text).unwrap()))
    }
}

fn words(answer: &Answer) -> String {
    let text = answer.err.replace('│', " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

const SKIRT: &str = "the cloth of 'front' and 'back'";

#[test]
fn a_skirt_that_misses_its_body_is_an_error_with_a_remedy() {
    for draper in ["StaticEquilibrium()", "StaticEquilibrium(bending_continuation: false)"] {
        for (aside, start, back) in [
            (
                [0.6, 0.0, 0.0],
                "its middle starts 0.600 m beside the body's",
                "move it by (-0.60, 0.00, 0.00) m",
            ),
            (
                [0.0, 0.0, 0.3],
                "its middle starts 0.300 m beside the body's",
                "move it by (0.00, 0.00, -0.30) m",
            ),
        ] {
            let (answer, metrics) = Skirt::new().moved(aside).run(draper);
            assert_eq!((answer.code, metrics), (4, None), "{}", answer.err);
            let words = words(&answer);
            for text in [SKIRT, "falls past the body", start, back, "the same unit of length"] {
                assert!(words.contains(text), "`{text}` is not in {words}");
            }
        }
    }
}

#[test]
fn a_skirt_too_wide_is_an_error_with_a_remedy() {
    let (answer, metrics) = Skirt::new().wider(1.4).run("StaticEquilibrium()");
    assert_eq!((answer.code, metrics), (4, None), "{}", answer.err);
    let words = words(&answer);
    for text in [SKIRT, "finds no hold on the body and falls past it", "cut it narrower"] {
        assert!(words.contains(text), "`{text}` is not in {words}");
    }
}

#[test]
fn a_body_in_centimetres_is_read_so_and_told() {
    let (answer, _) = Skirt::new().scaled_body(100.0).run("StaticEquilibrium()");
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(words(&answer).contains("the body's OBJ is read in centimetres"), "{}", answer.err);
}

#[test]
fn solvers_in_time_tell_a_fall_as_well() {
    for draper in ["Xpbd()", "SpringStitcher(), SpringDraper()"] {
        let (answer, _) = Skirt::new().moved([0.0, 0.0, 0.4]).run(draper);
        assert_eq!(answer.code, 4, "{draper}: {}", answer.err);
        assert!(words(&answer).contains("falls past the body"), "{draper}: {}", answer.err);
    }
}

#[test]
fn a_skirt_that_slides_some_centimetres_is_good_and_measured() {
    let (answer, metrics) =
        Skirt::new().moved([0.0, 0.06, 0.02]).run("StaticEquilibrium(bending_continuation: false)");
    assert_eq!(answer.code, 0, "{}", answer.err);
    let share = metrics.unwrap()["garment"]["on_body"].as_f64().unwrap();
    assert!((0.7..1.0).contains(&share), "{share}");
    let (answer, _) =
        Skirt::new().run("StaticEquilibrium(bending_continuation: false), Measure(least_on_body: 1.0)");
    assert_eq!(answer.code, 4, "{}", answer.err);
    let words = words(&answer);
    assert!(words.contains("\"front\" and \"back\" slid down the body: "), "{words}");
}

#[test]
fn a_sewn_skirt_keeps_its_place_with_a_solver_in_time() {
    // Its seams need more than the 0.5 s that the scene gives them.
    let (answer, metrics) = Skirt::new().run("Xpbd()");
    let garment = &metrics.unwrap()["garment"];
    assert!(garment["on_body"].as_f64().unwrap() > 0.7, "{garment} {}", answer.err);
}

#[test]
fn without_a_body_a_fall_is_followed() {
    let mut skirt = Skirt::new();
    skirt.scene["body"] = Value::Null;
    let (answer, metrics) = skirt.run("StaticEquilibrium()");
    assert!(answer.err.contains("its fall is followed for the scene's phases"), "{}", answer.err);
    assert_eq!(metrics.unwrap()["garment"]["on_body"], Value::Null);
}
