//! Which stage feeds which, and what is said where none does.

use super::*;

/// A file of these stages, one per line from line 3 on, with photos in front.
fn with(stages: &[&str]) -> String {
    let photos = "\"front\": (file: \"f.jpg\", width: \"5 cm\")";
    format!("(photos: {{{photos}}},\nstages: [\n{}\n])", stages.join(",\n"))
}

#[track_caller]
fn wired(stages: &[&str], expected: &[&str]) {
    let found = wiring(&good(&with(stages)));
    assert_eq!(found.iter().skip(1).collect::<Vec<_>>(), expected);
}

#[track_caller]
fn clash(stages: &[&str], message: &str, underlined: &[(&str, &str)]) {
    let text = with(stages);
    assert_eq!(faults(&text), message);
    let labels = places(&text).remove(0);
    assert_eq!(labels.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect::<Vec<_>>(), underlined);
}

#[test]
fn stages_follow_each_other_by_type_and_sections_stand_as_early_as_they_can() {
    let expected = [
        "Photos",
        "Mannequin",
        "Preset",
        "Mean < Photos",
        "Otsu < Mean",
        "Canny < Mean, Otsu",
        "Vest < Canny",
        "Seams < Vest, Vest.1",
        "GridMesher < Seams",
        "Taubin < GridMesher",
        "Painter < Taubin, Photos, Mannequin, Preset",
        "Glb < Painter",
        "Report < log",
    ];
    assert_eq!(wiring(&good(kit::VEST)), expected);
}

#[test]
fn a_style_waits_for_the_stage_that_its_from_names_and_the_seams_follow_the_style() {
    let text = kit::VEST
        .replace("Vest()", "Vest(from: \"Canny2\")")
        .replace("GridMesher(edge: \"12 mm\")", "Canny(high: 90), GridMesher(from: \"Seams\")");
    let wires = wiring(&good(&text));
    assert_eq!(wires[6..9], ["Canny2 < Mean, Otsu", "Vest < Canny2", "Seams < Vest, Vest.1"]);
}

#[test]
fn a_stage_of_a_sections_role_may_stand_in_the_list() {
    wired(
        &["Otsu()", "Canny()", "Vest()", "GridMesher()"],
        &["Otsu < Photos", "Canny < Photos, Otsu", "Vest < Canny", "GridMesher < Vest"],
    );
}

#[test]
fn what_is_remade_is_superseded_and_the_original_stays_at_hand() {
    wired(
        &["Mean()", "Mean()", "Otsu()", "Canny()", "GridMesher()", "Taubin()", "Taubin()", "Painter()"],
        &[
            "Mean < Photos",
            "Mean2 < Mean",
            "Otsu < Mean2",
            "Canny < Mean2, Otsu",
            "GridMesher < Canny",
            "Taubin < GridMesher",
            "Taubin2 < Taubin",
            "Painter < Taubin2, Photos, -, -",
        ],
    );
}

#[test]
fn what_is_made_anew_of_something_remade_supersedes_what_was_made_of_its_former_state() {
    wired(
        &["Otsu()", "Mean()", "Otsu()", "Canny()"],
        &["Otsu < Photos", "Mean < Photos", "Otsu2 < Mean", "Canny < Mean, Otsu2"],
    );
    // Both of the same photos: neither supersedes the other.
    clash(
        &["Mean()", "Otsu()", "Local()", "Canny()"],
        "vest.ron:6:1: `Canny` takes a mask, but `Otsu` and `Local` each make one; say which: `from: \"Local\"`",
        &[("Canny", "takes a mask"), ("Otsu", "makes a mask"), ("Local", "makes a mask")],
    );
}

#[test]
fn from_goes_back_to_what_is_superseded_and_chooses_between_equals() {
    wired(
        &["Mean()", "Otsu(from: \"Photos\")", "Local(id: \"rough\")", "Canny(from: [\"Photos\", \"rough\"])"],
        &["Mean < Photos", "Otsu < Photos", "rough < Mean", "Canny < Photos, rough"],
    );
    // A `from` that names one kind leaves the other ports to the rule.
    wired(
        &["Mean()", "Otsu()", "Local()", "Canny(from: \"Otsu\")"],
        &["Mean < Photos", "Otsu < Mean", "Local < Mean", "Canny < Mean, Otsu"],
    );
}

#[test]
fn ids_are_names_with_numbers_that_nobody_took() {
    let text = with(&["Otsu(id: \"Otsu2\")", "Otsu()", "Otsu()", "Canny(from: \"Otsu\")"]);
    let ids: Vec<String> = good(&text).nodes.into_iter().map(|n| n.id).collect();
    assert_eq!(ids, ["Photos", "Otsu2", "Otsu", "Otsu3", "Canny"]);
}

#[test]
fn stages_of_one_name_are_told_apart_by_what_they_take() {
    let roles = |stages: &[&str]| {
        let nodes = good(&with(stages)).nodes.into_iter().filter(|n| n.card.name == "Laplacian");
        nodes.map(|n| format!("{} {}{}", n.id, n.card.role.as_str(), n.stage.params())).collect::<Vec<_>>()
    };
    assert_eq!(
        roles(&["Otsu()", "Laplacian(threshold: 7)", "GridMesher()", "Laplacian(lambda: 0.25)"]),
        ["Laplacian edge detector(threshold: 7.0)", "Laplacian2 smoother(lambda: 0.25)"]
    );
    // After the mesher, `from` says that the edges are meant again.
    let twice =
        ["Otsu()", "Canny()", "GridMesher()", "Laplacian(from: \"Otsu\")", "Taubin(from: \"GridMesher\")"];
    assert_eq!(roles(&twice), ["Laplacian edge detector(threshold: 6.0)"]);
    assert_eq!(
        faults(&with(&["Otsu()", "Laplacian(lambda: 0.25)"])),
        "vest.ron:4:11: unknown parameter `lambda`; `Laplacian` has `threshold`"
    );
}

#[test]
fn nothing_makes_it() {
    clash(
        &["Canny()"],
        "vest.ron:3:1: `Canny` takes a mask, but nothing before it makes one; \
         `Otsu()` and `Local()` make a mask from a photo; put one of them before",
        &[("Canny", "takes a mask")],
    );
    clash(
        &["Taubin()"],
        "vest.ron:3:1: `Taubin` takes a panel, but nothing before it makes one; \
         `GridMesher()` and `DelaunayMesher()` make a panel from an outline",
        &[("Taubin", "takes a panel")],
    );
    assert_eq!(
        faults("(stages: [Otsu()])"),
        "vest.ron:1:11: `Otsu` takes a photo, but nothing before it makes one; `photos: ...` makes a photo; add it"
    );
    clash(
        &["Otsu()", "Canny()", "GridMesher()", "Fit()"],
        "vest.ron:6:1: `Fit` takes a body, but nothing before it makes one; `body: Mannequin()` makes a body; add it",
        &[("Fit", "takes a body")],
    );
}

#[test]
fn what_a_section_lacks_is_one_fault() {
    let text = kit::VEST.replace("        Canny(low: 20, high: 60),\n", "");
    let expected = "vest.ron:8:12: `Vest` takes an outline, but nothing before it makes one; \
                    `Canny()` and `Laplacian()` make an outline from a mask and a photo; put one of them before";
    assert_eq!(faults(&text), expected);
}

#[test]
fn it_is_made_only_later() {
    clash(
        &["Canny()", "Otsu()"],
        "vest.ron:3:1: `Canny` takes a mask, but `Otsu` makes it only later; put `Otsu` before `Canny`",
        &[("Canny", "takes a mask"), ("Otsu", "makes a mask")],
    );
}

#[test]
fn two_stages_make_it() {
    clash(
        &["Otsu()", "Local()", "Canny()", "GridMesher()"],
        "vest.ron:5:1: `Canny` takes a mask, but `Otsu` and `Local` each make one; say which: `from: \"Local\"`",
        &[("Canny", "takes a mask"), ("Otsu", "makes a mask"), ("Local", "makes a mask")],
    );
    // The stage that should have chosen ends the ambiguity for those after it.
    clash(
        &["Otsu()", "Canny()", "GridMesher()", "DelaunayMesher()", "Taubin()", "Painter()"],
        "vest.ron:7:1: `Taubin` takes a panel, but `GridMesher` and `DelaunayMesher` each make one; \
         say which: `from: \"DelaunayMesher\"`",
        &[("Taubin", "takes a panel"), ("GridMesher", "makes a panel"), ("DelaunayMesher", "makes a panel")],
    );
}

#[test]
fn two_photos_tables_have_no_one_original() {
    let photos = "Photos(photos: {\"back\": (file: \"b.jpg\", width: \"5 cm\")})";
    clash(
        &[photos, "Otsu(from: \"Photos\")", "Canny(from: \"Photos\")", "GridMesher()", "Painter()"],
        "vest.ron:7:1: `Painter` takes a photo, but `Photos` and `Photos2` each make one; say which: `from: \"Photos2\"`",
        &[("Painter", "takes a photo"), ("photos", "makes a photo"), ("Photos", "makes a photo")],
    );
}

#[test]
fn from_names_what_does_not_fit() {
    clash(
        &["Otsu()", "Canny()", "GridMesher(from: \"Cany\")"],
        "vest.ron:5:18: no stage has the id `Cany`; did you mean `Canny`? before it stand `Photos`, `Otsu`, `Canny`",
        &[("\"Cany\"", "")],
    );
    clash(
        &["Otsu()", "Canny()", "Local(from: \"Canny\")"],
        "vest.ron:5:13: `Local` takes a photo, but `Canny` makes an outline; \
         `Photos` makes a photo: write `from: \"Photos\"`",
        &[("\"Canny\"", "takes a photo"), ("Canny", "makes an outline")],
    );
    clash(
        &["Otsu()", "Canny()", "Taubin(from: \"Canny\")"],
        "vest.ron:5:14: `Taubin` takes a panel, but `Canny` makes an outline; \
         `GridMesher()` and `DelaunayMesher()` make a panel from an outline; put one of them between",
        &[("\"Canny\"", "takes a panel"), ("Canny", "makes an outline")],
    );
    clash(
        &["Otsu(from: \"Canny\")", "Canny()"],
        "vest.ron:3:12: `Otsu` reads from `Canny`, which stands after it; put `Canny` before `Otsu`",
        &[("\"Canny\"", "read here"), ("Canny", "stands here")],
    );
    clash(&["Otsu(from: \"Otsu\")"], "vest.ron:3:12: `Otsu` cannot read from itself", &[("\"Otsu\"", "")]);
}

#[test]
fn sets_and_single_values_do_not_mix() {
    let text = kit::VEST.replace("Taubin()", "Fit()");
    let expected = "vest.ron:17:9: `Painter` takes a single body, but `Fit` makes a named set (body)";
    assert_eq!(faults(&text), expected);
    let labels = places(&text).remove(0);
    assert_eq!(labels[0], ("Painter".into(), "takes a single body".into()));
    assert_eq!(labels[1], ("Fit".into(), "makes a named set (body)".into()));
    clash(
        &["Otsu()", "Canny()", "GridMesher()", "Merge()", "Taubin()"],
        "vest.ron:7:1: `Taubin` takes a named set (panel), but `Merge` makes a single panel",
        &[("Taubin", "takes a named set (panel)"), ("Merge", "makes a single panel")],
    );
}

#[test]
fn only_what_the_sinks_need_is_needed() {
    let text = kit::VEST.replace("Otsu(),", "Otsu(), Local(),").replace("Canny(", "Canny(from: \"Otsu\", ");
    let p = good(&text);
    let needed = |id: &str| {
        let needed = p.needed_for(&[p.find(id).unwrap()]);
        let ids = p.nodes.iter().zip(needed).filter(|(_, n)| *n).map(|(n, _)| n.id.clone());
        ids.collect::<Vec<_>>()
    };
    assert_eq!(needed("Canny"), ["Photos", "Mean", "Otsu", "Canny"]);
    assert_eq!(needed("Report"), ["Report"]);
    assert!(!needed("Glb").contains(&"Local".to_owned()));
    let readers = |id: &str| {
        let ids = p.consumers(p.find(id).unwrap()).into_iter().map(|i| p.nodes[i].id.clone());
        ids.collect::<Vec<_>>()
    };
    assert_eq!(readers("Photos"), ["Mean", "Painter"]);
    assert_eq!(readers("Local"), [""; 0]);
}

#[test]
fn a_stages_error_is_put_at_its_parameter() {
    let p = good(kit::VEST);
    let canny = &p.nodes[p.find("Canny").unwrap()];
    let error = toile_core::StageError::invalid("no edge is that strong").hint("lower `high`");
    let shown = p.locate(canny, &error.clone().at("high")).to_string();
    assert_eq!(shown, "vest.ron:14:30: Canny: no edge is that strong; lower `high`");
    let shown = p.locate(canny, &error).to_string();
    assert_eq!(shown, "vest.ron:14:9: Canny: no edge is that strong; lower `high`");
    assert_eq!(p.line(canny), 14);
}
