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
        "vest.ron:11:5: `--set stages.Cany.low`: no stage in `stages` has the id `Cany`; did you mean `stages.Canny.low`?",
    );
    refused(
        "stages.Canny.lov=3",
        "vest.ron:14:9: `--set stages.Canny.lov`: `Canny` has no parameter `lov`; did you mean `stages.Canny.low`?",
    );
    refused(
        "boddy.height=3",
        "vest.ron:2:1: `--set boddy.height`: a pipeline has no field `boddy`; did you mean `body.height`?",
    );
    refused(
        "photos.frnt.file=3",
        "vest.ron:4:5: `--set photos.frnt.file`: `photos` has no `frnt`; did you mean `photos.front.file`?",
    );
    refused("seams.3=1", "vest.ron:20:5: `--set seams.3`: `seams` has no `3`; there is `0`");
    refused("body.height.x=3", "vest.ron:9:21: `--set body.height.x`: `height` has no parts");
    refused(
        "stages.Otsu.bias.x=1",
        "vest.ron:13:9: `--set stages.Otsu.bias.x`: the file gives no `bias` to change a part of; \
         set all of it: `--set 'stages.Otsu.bias=...'`",
    );
}

#[test]
fn a_section_that_is_not_there_is_set_as_a_whole() {
    let text = kit::VEST.replace("    body: Mannequin(height: \"172 cm\"),\n", "");
    let shown = set(&text, &["body.height=\"1.8 m\""]).unwrap_err().to_string();
    let expected =
        "vest.ron:2:1: `--set body.height`: the file has no `body`; set all of it: `--set 'body=...'`";
    assert_eq!(shown, expected);
    assert!(set(&text, &["body=Mannequin(height: \"1.8 m\")"]).is_ok());
}

#[test]
fn the_value_is_one_ron_value() {
    refused(
        "body.height=1.8 m",
        "vest.ron:2:1: `--set body.height`: `1.8 m` is no RON value: expected the end, found `m`; \
         text stands in quotes: `--set 'body.height=\"1.8 m\"'`",
    );
    for value in ["1), (", "(", "\"", "//", "/*", "1 2", "]"] {
        let shown = set(kit::VEST, &[&format!("name={value}")]).unwrap_err().to_string();
        assert!(
            shown.starts_with(&format!("vest.ron:2:1: `--set name`: `{value}` is no RON value: ")),
            "{shown}"
        );
    }
    // A comment behind the value does not swallow the rest of the line.
    changed("stages.Canny.low=3 // weak", &["Canny(low: 3, high: 60),"]);
}

#[test]
fn a_fault_in_the_value_says_where_it_comes_from() {
    refused(
        "body.height=1.8",
        "vest.ron:9:29: `height`: the length 1.8 has no unit; write \"1.8 mm\" or \"1.8 cm\" (from `--set body.height`)",
    );
    refused(
        "stages.Otsu=Otzu()",
        "vest.ron:13:9: unknown stage `Otzu` (from `--set stages.Otsu`); did you mean `Otsu`?",
    );
    // Places shift with the text that was put in before them.
    let sets = ["stages.Canny.low=NaN", "stages.Mean=Mean(mask: Four,\n radius: 2)", "stages.Cany=1"];
    let expected = "vest.ron:11:5: `--set stages.Cany`: no stage in `stages` has the id `Cany`; did you mean `stages.Canny`?\n\
                    vest.ron:15:20: `low` is NaN, which is not a finite number (from `--set stages.Canny.low`)";
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
