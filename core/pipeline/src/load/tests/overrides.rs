//! `--set PATH=VALUE`.

use super::*;

/// The lines of the vest that an override changes, as they then are.
#[track_caller]
fn changed(set_to: &str, expected: &[&str]) {
    let loaded = set(kit::VEST, &[set_to]).unwrap_or_else(|faults| panic!("{set_to}: {faults}"));
    let lines = loaded.text.lines().zip(kit::VEST.lines()).filter(|(new, old)| new != old);
    assert_eq!(lines.map(|(new, _)| new.trim()).collect::<Vec<_>>(), expected, "{set_to}");
}

#[track_caller]
fn refused(set_to: &str, expected: &str) {
    let faults = set(kit::VEST, &[set_to]).expect_err(set_to);
    assert_eq!(faults.to_string(), expected);
}

#[test]
fn a_value_is_replaced_in_its_place() {
    changed("name=\"x\"", &["name: \"x\","]);
    changed("photos.front.file=\"x.jpg\"", &["\"front\": (file: \"x.jpg\", width: \"52 cm\"),"]);
    changed("stages.GridMesher.edge=\"6 mm\"", &["GridMesher(edge: \"6 mm\"),"]);
    changed("body.height=\"1.8 m\"", &["body: Mannequin(height: \"1.8 m\"),"]);
    changed("seams.0.1=\"back.hem\"", &["seams: [ Match(\"front.side_left\", \"back.hem\") ],"]);
    changed("seams=[]", &["seams: [],"]);
}

#[test]
fn a_whole_stage_is_replaced() {
    changed("fabric=Preset(\"denim\")", &["fabric: Preset(\"denim\"),"]);
    changed("stages.GridMesher=DelaunayMesher(edge: \"6 mm\")", &["DelaunayMesher(edge: \"6 mm\"),"]);
    let loaded = set(kit::VEST, &["stages.Otsu=Local()"]).unwrap();
    assert_eq!(wiring(&loaded)[4], "Local < Mean");
}

#[test]
fn a_field_that_is_not_there_is_put_in() {
    changed("stages.Otsu.bias=3", &["Otsu(bias: 3),"]);
    changed("stages.Canny.from=\"Otsu\"", &["Canny(from: \"Otsu\", low: 20, high: 60),"]);
    changed(
        "photos.side=(file: \"s\", width: \"1 m\")",
        &["photos: {\"side\": (file: \"s\", width: \"1 m\"),"],
    );
    let refused = set(kit::VEST, &["plugins=[\"p\"]"]).unwrap_err().to_string();
    assert_eq!(refused.lines().count(), 1);
    assert!(refused.contains("the plugin \"p\" is refused: there is no such file"), "{refused}");
}

#[test]
fn a_value_without_its_name_gets_it_when_another_joins() {
    changed("fabric.name=\"denim\"", &["fabric: Preset(\"denim\"),"]);
    changed("fabric.scale=2", &["fabric: Preset(scale: 2, name: \"cotton poplin\"),"]);
}

#[test]
fn overrides_apply_in_order_and_reach_what_earlier_ones_made() {
    let sets = [
        "stages.GridMesher=DelaunayMesher()",
        "stages.DelaunayMesher.edge=\"6 mm\"",
        "name=\"y\"",
        "name=\"z\"",
    ];
    let loaded = set(kit::VEST, &sets).unwrap();
    assert!(loaded.text.contains("DelaunayMesher(edge: \"6 mm\")"));
    assert_eq!(loaded.name, "z");
}

#[test]
fn the_second_stage_of_a_name_has_a_number() {
    let text =
        kit::VEST.replace("Taubin()", "Mean(from: \"Photos\")").replace("Otsu()", "Otsu(from: \"Mean\")");
    let text = text.replace("Canny(", "Canny(from: \"Mean\", ");
    let loaded = set(&text, &["stages.Mean2.radius=4"]).unwrap();
    assert!(loaded.text.contains("Mean(radius: 4, from: \"Photos\")"));
}

#[test]
fn an_unknown_path_comes_with_the_nearest_one() {
    refused(
        "stages.Cany.low=3",
        "--set stages.Cany.low=3: no stage in `stages` has the id `Cany`; did you mean `stages.Canny.low`?",
    );
    refused(
        "stages.Canny.lov=3",
        "--set stages.Canny.lov=3: `Canny` has no parameter `lov`; did you mean `stages.Canny.low`?",
    );
    refused(
        "boddy.height=3",
        "--set boddy.height=3: a pipeline has no field `boddy`; did you mean `body.height`?",
    );
    refused(
        "photos.frnt.file=3",
        "--set photos.frnt.file=3: `photos` has no `frnt`; did you mean `photos.front.file`?",
    );
    refused("seams.3=1", "--set seams.3=1: `seams` has no `3`; there is `0`");
    refused("body.height.x=3", "--set body.height.x=3: `height` has no parts");
    refused(
        "stages.Otsu.bias.x=1",
        "--set stages.Otsu.bias.x=1: the file has no `bias`; \
         set all of it: `--set 'stages.Otsu.bias=...'`",
    );
}

#[test]
fn a_section_that_is_not_there_is_set_as_a_whole() {
    let text = kit::VEST.replace("    body: Mannequin(height: \"172 cm\"),\n", "");
    let shown = set(&text, &["body.height=\"1.8 m\""]).unwrap_err().to_string();
    let expected = "--set body.height=\"1.8 m\": the file has no `body`; set all of it: `--set 'body=...'`";
    assert_eq!(shown, expected);
    assert!(set(&text, &["body=Mannequin(height: \"1.8 m\")"]).is_ok());
}

#[test]
fn the_value_is_one_ron_value() {
    refused(
        "body.height=1.8 m",
        "--set body.height=1.8 m: `1.8 m` is no RON value: expected the end, found `m`; \
         text stands in quotes: `--set 'body.height=\"1.8 m\"'`",
    );
    for value in ["1), (", "(", "\"", "//", "/*", "1 2", "]"] {
        let shown = set(kit::VEST, &[&format!("name={value}")]).unwrap_err().to_string();
        assert!(shown.starts_with(&format!("--set name={value}: `{value}` is no RON value: ")), "{shown}");
    }
    // A comment behind the value does not swallow the rest of the line.
    changed("stages.Canny.low=3 // weak", &["Canny(low: 3, high: 60),"]);
}

#[test]
fn a_fault_in_the_value_says_where_it_comes_from() {
    refused(
        "body.height=1.8",
        "--set body.height=1.8: `height`: the length 1.8 has no unit; write \"1.8 mm\" or \"1.8 cm\"",
    );
    refused("stages.Otsu=Otzu()", "--set stages.Otsu=Otzu(): unknown stage `Otzu`; did you mean `Otsu`?");
    // Each at its own option, in the order of the options.
    let sets = ["stages.Canny.low=NaN", "stages.Mean=Mean(mask: Four,\n radius: 2)", "stages.Cany=1"];
    let expected = "--set stages.Cany=1: no stage in `stages` has the id `Cany`; did you mean `stages.Canny`?\n\
                    --set stages.Canny.low=NaN: `low` is NaN, which is not a finite number";
    assert_eq!(set(kit::VEST, &sets).unwrap_err().to_string(), expected);
}

#[test]
fn an_override_is_a_path_and_a_value() {
    let parsed: Override = "a.b = \"x=y\"".parse().unwrap();
    assert_eq!(parsed, Override { path: "a.b".into(), value: "\"x=y\"".into() });
    for text in ["a", "=3", "a=", ""] {
        let expected = format!("`{text}` is not PATH=VALUE, like `body.height=\"1.8 m\"`");
        assert_eq!(text.parse::<Override>(), Err(expected));
    }
}

#[test]
fn a_fault_is_drawn_where_it_was_written() {
    let underlined = |sets: &[&str]| {
        let faults = set(kit::VEST, sets).unwrap_err();
        faults.faults.iter().map(|f| super::labels(&faults, f)[0].0.clone()).collect::<Vec<_>>()
    };
    assert_eq!(underlined(&["body.height=1.8"]), ["1.8"]);
    assert_eq!(underlined(&["stages.Otsu=Otzu()"]), ["Otzu"]);
    assert_eq!(underlined(&["stages.Cany.low=3"]), ["Cany"]);
    assert_eq!(underlined(&["body.height= 1 2"]), ["1 2"]);
    assert_eq!(underlined(&["stages.Mean=Mean(radius: 0)", "stages.Canny.low=NaN"]), ["0", "NaN"]);
    let expected = r#"  × `height`: the length 1.8 has no unit; write "1.8 mm" or "1.8 cm"
   ╭─[command line:1:19]
 1 │ --set body.height=1.8
   ·                   ───
   ╰────
"#;
    assert_eq!(set(kit::VEST, &["body.height=1.8"]).unwrap_err().render(false), expected);
}

#[test]
fn a_fault_of_the_file_is_shown_as_the_file_stands() {
    let text = kit::VEST.replace("Taubin()", "Taubni()");
    let faults = set(&text, &["name=\"a\nb\nc\"", "stages.Mean=Mean(mask: Four,\n radius: 2)"]).unwrap_err();
    assert_eq!(faults.to_string(), "vest.ron:16:9: unknown stage `Taubni`; did you mean `Taubin`?");
    assert_eq!(faults.text, text);
    // A stage that is set where it does not fit: the option, and no line that is not in the file.
    let faults = set(kit::VEST, &["stages.Canny=Local()"]).unwrap_err();
    assert!(faults.faults.iter().all(|f| faults.text == kit::VEST && !f.labels.is_empty()), "{faults}");
}

#[test]
fn the_error_of_a_stage_is_put_at_the_option_that_it_is_about() {
    let p = set(kit::VEST, &["name=\"longer than before\"", "fabric=Preset(\"coton\")"]).unwrap();
    let fabric = &p.nodes[p.find("Preset").unwrap()];
    let error = toile_core::StageError::invalid("there is no such cloth").at("name");
    let expected = "--set fabric=Preset(\"coton\"): Preset: there is no such cloth";
    assert_eq!(p.locate(fabric, &error).to_string(), expected);
    let photos = &p.nodes[p.find("Photos").unwrap()];
    let error = toile_core::StageError::invalid("cannot read it").at("photos").within("back").within("file");
    assert_eq!(p.locate(photos, &error).to_string(), "vest.ron:6:25: Photos: cannot read it");
}
