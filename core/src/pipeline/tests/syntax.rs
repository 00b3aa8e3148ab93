//! Texts that are no RON, and RON at its limits.

use super::*;

#[track_caller]
fn syntax(text: &str, expected: &str, underlined: &[(&str, &str)]) {
    assert_eq!(faults(text), expected);
    let labels = places(text).remove(0);
    assert_eq!(labels.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect::<Vec<_>>(), underlined);
}

#[test]
fn brackets_are_closed() {
    syntax("(\n stages: [", "vest.ron:2:10: this `[` is never closed", &[("[", "")]);
    syntax(
        "(stages: [Otsu()}",
        "vest.ron:1:17: expected `,` or `]`, found `}`",
        &[("}", ""), ("[", "opened here")],
    );
    syntax(
        "(stages: [Otsu(],)",
        "vest.ron:1:16: expected `)`, found `]`",
        &[("]", ""), ("(", "opened here")],
    );
}

#[test]
fn entries_have_commas_and_values() {
    syntax(
        "(stages: [\n Otsu()\n Canny()])",
        "vest.ron:3:2: expected `,` or `]`, found `C`",
        &[("C", ""), ("[", "opened here")],
    );
    syntax("(stages: [Otsu(,)])", "vest.ron:1:16: expected a value, found `,`", &[(",", "")]);
    syntax("(stages:", "vest.ron:1:9: expected a value, found the end of the file", &[("", "")]);
    syntax("(photos: {3})", "vest.ron:1:12: expected `:` after the key, found `}`", &[("}", "")]);
    syntax("(stages: []) x", "vest.ron:1:14: expected the end, found `x`", &[("x", "")]);
    syntax("", "vest.ron:1:1: there is nothing in it", &[("", "")]);
    syntax("// only a comment", "vest.ron:1:18: there is nothing in it", &[("", "")]);
}

#[test]
fn texts_and_comments_are_closed() {
    syntax("(name: \"vest)", "vest.ron:1:8: this text is never closed", &[("\"", "")]);
    syntax("(name: r#\"vest\")", "vest.ron:1:8: this text is never closed", &[("r#\"", "")]);
    syntax("(name: 'v)", "vest.ron:1:8: this text is never closed", &[("'", "")]);
    syntax("(/* name: 3)", "vest.ron:1:2: this comment is never closed", &[("/*", "")]);
    syntax(
        "(name: \"vest,\n plugins: [\"x\"])",
        "vest.ron:2:13: expected `,` or `)`, found `x`",
        &[("x", ""), ("(", "opened here"), ("\"", "this text runs over the end of its line")],
    );
}

#[test]
fn what_only_ron_refuses_is_a_fault_too() {
    let text = kit::VEST.replacen("(\n", "#![enable(magic)]\n(\n", 1);
    let shown = faults(&text);
    assert!(shown.starts_with("vest.ron:2:") && shown.contains("magic"), "{shown}");
    assert!(read(&kit::VEST.replacen("(\n", "#![enable(implicit_some)]\n(\n", 1)).is_ok());
    assert_eq!(
        faults(&kit::VEST.replace("\"vest\"", "\"\\q\"")),
        "vest.ron:3:11: `name` wants text in quotes"
    );
}

#[test]
fn ron_in_all_its_forms_is_read() {
    let text = kit::VEST
        .replace("Mean(mask: Eight, radius: 1)", "/* a /* b */ */ Mean (mask : Eight , radius : 0b11,)")
        .replace("\"vest\"", "r#\"a \"vest\" (\"#")
        .replace("low: 20", "low: 2_0.5e0 // weak (\n")
        .replace("\"front.jpg\"", "\"fr\\\"ont)\\\\\"");
    let p = good(&text);
    assert_eq!(p.name, "a \"vest\" (");
    let mean = &p.nodes[p.find("Mean").unwrap()];
    assert_eq!(mean.stage.params(), "(mask: Eight, radius: 3)");
    assert_eq!(&p.text[mean.span.clone()], "Mean (mask : Eight , radius : 0b11,)");
    assert_eq!(&p.text[mean.place.clone()], "Mean");
    assert_eq!(&p.text[mean.params["radius"].clone()], "0b11");
}

#[test]
fn a_nodes_places_are_those_of_the_file() {
    let p = good(kit::VEST);
    let at = |id: &str| {
        let n = &p.nodes[p.find(id).unwrap()];
        (&p.text[n.place.clone()], &p.text[n.span.clone()])
    };
    assert_eq!(at("Canny"), ("Canny", "Canny(low: 20, high: 60)"));
    assert_eq!(at("Preset"), ("Preset", "Preset(\"cotton poplin\")"));
    assert_eq!(at("Seams"), ("seams", "[ Match(\"front.side_left\", \"back.side_right\") ]"));
    assert_eq!((p.name.as_str(), p.base.as_path()), ("vest", Path::new("pipelines")));
    let unnamed = good(&kit::VEST.replace("    name: \"vest\",\n", ""));
    assert_eq!(unnamed.name, "vest", "the file's stem");
}

#[test]
fn a_byte_order_mark_and_carriage_returns_do_not_move_places() {
    let text = kit::VEST.replace("radius: 1", "radius: 0").replace('\n', "\r\n");
    let expected = "vest.ron:12:35: `radius` is 0, below its least value 1 px";
    assert_eq!(faults(&text), expected);
    assert_eq!(faults(&format!("\u{feff}{text}")), expected);
    assert!(read(&format!("\u{feff}{}", kit::VEST)).is_ok());
    let first_line = format!("\u{feff}{}", "(stages: [])");
    assert_eq!(faults(&first_line), "vest.ron:1:10: `stages` holds no stage");
}

#[test]
fn columns_count_characters() {
    let text = kit::VEST.replace("Otsu()", "/* größer \u{1f9f5} */ Otzu()");
    assert_eq!(faults(&text), "vest.ron:13:24: unknown stage `Otzu`; did you mean `Otsu`?");
}

#[test]
fn deep_nesting_is_a_fault_and_no_crash() {
    for bracket in ["(", "[", "{", "Otsu(", "(a: ", "{3: ", "[[{"] {
        let shown = faults(&bracket.repeat(100_000));
        assert!(shown.contains("nested deeper than 60 brackets"), "{bracket}: {shown}");
    }
    let inner = format!("{}1{}", "[".repeat(50), "]".repeat(50));
    let shown = faults(&kit::VEST.replace("low: 20", &format!("low: {inner}")));
    assert_eq!(shown, "vest.ron:14:20: `low` wants a number, found `[...]`");
}

#[test]
fn size_has_limits() {
    let big = format!("({})", " ".repeat(super::super::MAX_BYTES));
    assert_eq!(faults(&big), "vest.ron:1:1: the file has 4194306 bytes, the limit is 4194304");
    let many = format!("(stages: [{}])", "Otsu(), ".repeat(1001));
    assert!(faults(&many).contains("1001 stages, the limit is 1000"));
    let fields: String = (0..300_000).map(|i| format!("a{i}: 1, ")).collect();
    let found = read(&format!("({fields} stages: [Otsu({fields})])")).unwrap_err();
    assert!(found.faults.len() <= super::super::MAX_FAULTS + 1, "{}", found.faults.len());
    assert!(found.render(false).len() < 100_000);
}
