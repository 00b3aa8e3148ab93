//! Texts that are no RON, and RON at its limits.

use super::*;

#[track_caller]
fn syntax(text: &str, expected: &str, underlined: &[(&str, &str)]) {
    let found = read(text).expect_err("the text has a fault");
    let line = found.lines().into_iter().zip(&found.faults).filter(|(_, f)| f.code == "syntax");
    let (lines, faults): (Vec<String>, Vec<&super::super::Fault>) = line.unzip();
    assert_eq!(lines.join("\n"), expected);
    let labels = super::labels(&found, faults[0]);
    assert_eq!(labels.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect::<Vec<_>>(), underlined);
}

#[test]
fn brackets_are_closed() {
    syntax("(\n stages: [", "vest.ron:2:10: this `[` is never closed", &[("[", "")]);
    syntax(
        "(stages: [Otsu()})",
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
    syntax("(stages: [\n Otsu()\n Canny()])", "vest.ron:2:8: a comma is missing after `Otsu()`", &[("", "")]);
    syntax("(stages: [Otsu(,)])", "vest.ron:1:16: expected a value, found `,`", &[(",", "")]);
    syntax("(stages:", "vest.ron:1:9: expected a value, found the end of the file", &[("", "")]);
    syntax("(photos: {3})", "vest.ron:1:12: expected `:` after the key, found `}`", &[("}", "")]);
    syntax("(stages: []) x", "vest.ron:1:14: expected the end, found `x`", &[("x", "")]);
    syntax("", "vest.ron:1:1: there is nothing in it", &[("", "")]);
    syntax("// only a comment", "vest.ron:1:18: there is nothing in it", &[("", "")]);
}

#[test]
fn texts_and_comments_are_closed() {
    syntax("(name: \"vest)", "vest.ron:1:8: this text is never closed; write `\"` at its end", &[("\"", "")]);
    syntax("(name: r#\"vest\")", "vest.ron:1:8: this text is never closed", &[("r#\"", "")]);
    syntax("(name: 'v)", "vest.ron:1:8: this text is never closed; write `'` at its end", &[("'", "")]);
    syntax("(/* name: 3)", "vest.ron:1:2: this comment is never closed", &[("/*", "")]);
    syntax(
        "(name: \"vest,\n plugins: [\"x\"])",
        "vest.ron:1:8: this text is never closed; write `\"` at its end",
        &[("\"", "")],
    );
}

#[test]
fn what_only_ron_refuses_is_a_fault_too() {
    let text = kit::VEST.replacen("(\n", "#![enable(magic)]\n(\n", 1);
    let shown = faults(&text);
    assert!(shown.starts_with("vest.ron:2:") && shown.contains("magic"), "{shown}");
    assert!(read(&kit::VEST.replacen("(\n", "#![enable(implicit_some)]\n(\n", 1)).is_ok());
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
    assert_eq!(shown, "vest.ron:14:20: `low` must be a number, found `[...]`");
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

/// The vest with a slip in it, and the faults that come of it: no others, and the rest of the file
/// is read.
#[track_caller]
fn slip(from: &str, to: &str, expected: &str) {
    assert!(kit::VEST.contains(from), "{from}");
    let text = kit::VEST.replacen(from, to, 1);
    assert_eq!(faults(&text), expected, "\n{text}");
    // A fault behind the slip, and one before it, come out in the same run.
    let more = text.replacen("Report()", "Reprot()", 1);
    if more != text {
        let both = faults(&more);
        assert!(both.contains("unknown stage `Reprot`; did you mean `Report`?"), "{both}");
    }
    let more = text.replacen("172 cm", "9 m", 1);
    if more != text {
        let both = faults(&more);
        assert!(both.contains("`height` is 9 m, above its greatest value 2.5 m"), "{both}");
    }
}

#[test]
fn a_missing_comma_is_named_where_it_is_missing_and_the_rest_is_read() {
    slip("Otsu(),", "Otsu()", "vest.ron:13:15: a comma is missing after `Otsu()`");
    slip("low: 20,", "low: 20", "vest.ron:14:22: a comma is missing after `20`");
    slip("name: \"vest\",", "name: \"vest\"", "vest.ron:3:17: a comma is missing after `\"vest\"`");
    slip("\"52 cm\"),", "\"52 cm\")", "vest.ron:5:53: a comma is missing after `(...)`");
    slip("style: Vest(),", "style: Vest()", "vest.ron:8:18: a comma is missing after `Vest()`");
    slip("    },\n", "    }\n", "vest.ron:7:6: a comma is missing after `{...}`");
    slip(
        "edge: \"12 mm\"),",
        "edge: \"12 mm\")",
        "vest.ron:15:34: a comma is missing after `GridMesher(...)`",
    );
    slip("left\", ", "left\" ", "vest.ron:20:37: a comma is missing after `\"front.side_left\"`");
    slip("Otsu(),", "Otsu();", "vest.ron:13:15: expected `,`, found `;`");
    slip("Otsu(),", "Otsu(),,", "vest.ron:13:16: expected a value, found `,`");
}

#[test]
fn two_missing_commas_are_two_faults() {
    let text = kit::VEST.replace("Otsu(),", "Otsu()").replace("Taubin(),", "Taubin()");
    let expected = "vest.ron:13:15: a comma is missing after `Otsu()`\n\
                    vest.ron:16:17: a comma is missing after `Taubin()`";
    assert_eq!(faults(&text), expected);
}

#[test]
fn a_missing_colon_is_named() {
    slip("radius: 1", "radius 1", "vest.ron:12:33: a colon is missing after `radius`; write `radius: ...`");
    slip(
        "radius: 1",
        "radius = 1",
        "vest.ron:12:34: expected `:` after `radius`, found `=`; write `radius: ...`",
    );
    slip(
        "style: Vest()",
        "style Vest()",
        "vest.ron:8:10: a colon is missing after `style`; write `style: ...`",
    );
    slip("\"front\": (", "\"front\" (", "vest.ron:5:17: expected `:` after the key, found `(`");
}

#[test]
fn a_text_without_one_of_its_quotes_is_named() {
    let closed = "this text is never closed; write `\"` at its end";
    slip("\"vest\",", "\"vest,", &format!("vest.ron:3:11: {closed}"));
    slip("\"front.jpg\"", "\"front.jpg", &format!("vest.ron:5:25: {closed}"));
    slip("\"12 mm\"", "\"12 mm", &format!("vest.ron:15:26: {closed}"));
    slip("\"12 mm\"", "12 mm\"", "vest.ron:15:26: `12 mm` is a text and stands in quotes; write `\"12 mm\"`");
    slip("\"12 mm\"", "12 mm", "vest.ron:15:26: `12 mm` is a text and stands in quotes; write `\"12 mm\"`");
    slip(
        "\"vest\"",
        "my vest",
        "vest.ron:3:11: `my vest` is a text and stands in quotes; write `\"my vest\"`",
    );
}

#[test]
fn a_path_of_windows_is_told_to_begin_escapes() {
    let none = |place: &str, escape: &str, path: &str| {
        format!(
            "vest.ron:{place}: a backslash begins an escape in a text, and `{escape}` is none; write / or two backslashes: \"{path}\""
        )
    };
    let is = |place: &str, escape: &str, what: &str, path: &str| {
        format!(
            "vest.ron:{place}: a backslash begins an escape in a text, and `{escape}` is {what}; write / or two backslashes: \"{path}\""
        )
    };
    let file = |path: &str, expected: &str| slip("\"front.jpg\"", &format!("\"{path}\""), expected);
    file(r"C:\Users\me\tee.jpg", &none("5:28", r"\U", "C:/Users/me/tee.jpg"));
    file(r"D:\users\tee.jpg", &none("5:28", r"\u", "D:/users/tee.jpg"));
    file(r"D:\xmas\tee.jpg", &none("5:28", r"\x", "D:/xmas/tee.jpg"));
    file(r"\\server\Photos\tee.jpg", &none("5:34", r"\P", "/server/Photos/tee.jpg"));
    file(r"D:\tee.jpg", &is("5:28", r"\t", "a tab", "D:/tee.jpg"));
    file(r"photos\new.jpg", &is("5:32", r"\n", "a line's end", "photos/new.jpg"));
    file(r"photos\raw.jpg", &is("5:32", r"\r", "a carriage return", "photos/raw.jpg"));
    file(r"photos\0001.jpg", &is("5:32", r"\0", "a zero byte", "photos/0001.jpg"));
    file(r"D:\Tees\", &none("5:28", r"\T", "D:/Tees/"));
    file(r"tees\", &is("5:30", r#"\""#, "a quote inside of it", "tees/"));
    slip("\"vest\"", r#""a \q""#, &none("3:14", r"\q", "a /q"));
    let escaped = r#"D:\\Users\\t\u{fc}\xC3\xBC\"\\.jpg"#;
    assert!(read(&kit::VEST.replace("front.jpg", escaped)).is_ok());
}

#[test]
fn all_paths_of_windows_are_told_at_once_and_once() {
    let text = kit::VEST
        .replace("front.jpg", r"C:\Users\front.jpg")
        .replace("back.jpg", r"C:\Users\back.jpg")
        .replace("name:", "plugins: [\"C:\\me\\x.dll\"], name:")
        .replace("cotton poplin", "cotton\\tpoplin");
    let places: Vec<String> =
        faults(&text).lines().map(|l| l.split(": ").next().unwrap().to_owned()).collect();
    assert_eq!(places, ["vest.ron:3:18", "vest.ron:5:28", "vest.ron:6:28", "vest.ron:10:27"]);
}

#[test]
fn a_path_of_windows_in_an_option_is_shown_there() {
    let found = set(kit::VEST, &[r#"photos.front.file="C:\Users\tee.jpg""#]).unwrap_err();
    assert_eq!(
        found.to_string(),
        r#"--set photos.front.file="C:\Users\tee.jpg": a backslash begins an escape in a text, and `\U` is none; write / or two backslashes: "C:/Users/tee.jpg""#
    );
}

#[test]
fn a_bracket_that_lacks_its_partner_is_named() {
    let never = |place: &str, bracket: &str, end: &str, next: &str| {
        format!("vest.ron:{place}: this `{bracket}` is never closed; write `{end}` before `{next}`")
    };
    slip("Report(),\n    ],", "Report(),", &never("11:13", "[", "]", "seams"));
    slip("Otsu()", "Otsu(", "vest.ron:13:13: this `(` is never closed; write `)` before this comma");
    slip("Otsu(),", "Otsu(", &never("13:13", "(", ")", "Canny"));
    slip("\"52 cm\"),\n    },", "\"52 cm\"),", &never("4:13", "{", "}", "style"));
    slip("Otsu()", "Otsu(]", "vest.ron:13:14: expected `)`, found `]`");
    slip("Otsu()", "Otsu())", "vest.ron:13:15: expected `,` or `]`, found `)`");
    slip("high: 60)", "high: 60]", "vest.ron:14:32: expected `,` or `)`, found `]`");
}

#[test]
fn a_key_that_stands_twice_in_a_map_is_refused() {
    slip("\"back\":  (", "\"front\": (", "vest.ron:6:9: the key \"front\" is given twice");
    let text = kit::VEST.replacen("\"back\":", "\"fr\\u{6f}nt\":", 1);
    assert_eq!(faults(&text), "vest.ron:6:9: the key \"front\" is given twice");
    let labels = places(&text).remove(0);
    assert_eq!(labels[1], ("\"front\"".into(), "first here".into()));
    let plugins = "plugins: [(file: \"a\", file: \"b\")], name:";
    assert_eq!(
        faults(&kit::VEST.replacen("name:", plugins, 1)),
        "vest.ron:3:27: the field `file` is given twice"
    );
}
