//! Every fault's words and place.

use super::*;

/// Loads the vest with `from` replaced by `to`, and compares the faults' lines.
#[track_caller]
fn check(from: &str, to: &str, expected: &[&str]) {
    assert!(kit::VEST.contains(from), "{from}");
    let found = faults(&kit::VEST.replacen(from, to, 1));
    assert_eq!(found.lines().collect::<Vec<_>>(), expected, "\n{found}");
}

#[test]
fn unknown_names_come_with_the_nearest_one() {
    check("Otsu()", "Otzu()", &["vest.ron:13:9: unknown stage `Otzu`; did you mean `Otsu`?"]);
    check("Vest()", "Vset()", &["vest.ron:8:12: unknown stage `Vset`; did you mean `Vest`?"]);
    check(
        "radius",
        "raduis",
        &["vest.ron:12:27: unknown parameter `raduis`; did you mean `radius`? `Mean` has `mask`, `radius`"],
    );
    check("radius", "quux", &["vest.ron:12:27: unknown parameter `quux`; `Mean` has `mask`, `radius`"]);
    check("Vest()", "Vest(x: 1)", &["vest.ron:8:17: unknown parameter `x`; `Vest` has no parameters"]);
    let fields = "a pipeline has the fields `name`, `photos`, `style`, `body`, `fabric`, `seams`, `stages`, `plugins`, `qualities`";
    let style = format!("vest.ron:8:5: unknown field `stile`; did you mean `style`? {fields}");
    check("style", "stile", &[&style]);
    let colour = format!("vest.ron:3:16: unknown field `colour`; {fields}");
    check("\"vest\"", "\"v\", colour: 3", &[&colour]);
}

#[test]
fn a_stage_unlike_any_other_hides_what_it_may_have_made() {
    check(
        "Otsu()",
        "Frobnicate()",
        &["vest.ron:13:9: unknown stage `Frobnicate`; `toile stages` lists those that there are; \
             a stage of a plugin needs its library in the file, `plugins: [\"libfrobnicate.so\"]`"],
    );
}

#[test]
#[cfg(target_os = "linux")]
fn a_stage_named_after_another_may_be_of_a_plugin_that_is_not_named() {
    let needs = |name: &str| {
        format!("a stage of a plugin needs its library in the file, `plugins: [\"lib{name}.so\"]`")
    };
    let mine = format!("vest.ron:13:9: unknown stage `MyOtsu`; did you mean `Otsu`? {}", needs("my_otsu"));
    check("Otsu()", "MyOtsu()", &[&mine]);
    let second = format!("vest.ron:13:9: unknown stage `Otsu2`; did you mean `Otsu`? {}", needs("otsu2"));
    check("Otsu()", "Otsu2()", &[&second]);
    let refused = "vest.ron:3:11: the plugin \"none.so\" is refused: there is no such file; \
                   build it first, and name the library, like target/release/libtoile_sdf.so";
    let its = "vest.ron:13:9: unknown stage `MyOtsu`; it may be of the plugin that is refused";
    let text = kit::VEST.replace("name: \"vest\"", "plugins: [\"none.so\"]").replace("Otsu()", "MyOtsu()");
    let refused = refused.replace("3:11", "3:15");
    assert_eq!(faults(&text).lines().collect::<Vec<_>>(), [refused.as_str(), its]);
}

#[test]
fn every_element_of_a_list_or_map_is_checked() {
    let text = kit::VEST.replace("width: \"52 cm\"", "width: 52").replace(
        "[ Match(\"front.side_left\", \"back.side_right\") ]",
        "[ Macth(\"a.b\", \"c.d\"), Match(\"a.b\", \"c.d\"), Match(\"a\", \"c.d\") ]",
    );
    let expected = [
        "vest.ron:5:45: `width` in `photos`: the length 52 has no unit; write \"52 mm\" or \"52 cm\"",
        "vest.ron:6:45: `width` in `photos`: the length 52 has no unit; write \"52 mm\" or \"52 cm\"",
        "vest.ron:20:14: `seams` must be a list of Match(...): there is no choice `Macth`; did you mean `Match`?",
        "vest.ron:20:62: `seams`: \"a\" is not an edge; write \"panel.edge\", like \"front.hem\"",
    ];
    assert_eq!(faults(&text).lines().collect::<Vec<_>>(), expected);
}

/// The faults of a text with what stages find wrong.
fn with_stages(text: &str) -> Vec<String> {
    let changes = crate::load::Changes { asks: true, ..Default::default() };
    let registry = kit::registry();
    let found = crate::load::load_with(text, "vest.ron", Path::new("pipelines"), &registry, &changes);
    found.expect_err("the text has a fault").to_string().lines().map(str::to_owned).collect()
}

#[test]
fn what_stages_find_wrong_comes_out_beside_faults_of_every_kind() {
    let above = "Canny: `low` is above `high`";
    let low = kit::VEST.replace("low: 20", "low: 90");
    // A value of another stage, a stage that there is not, a field, a comma, a port, an id.
    for (from, to, fault) in [
        (
            "width: \"52 cm\"",
            "width: 52",
            "vest.ron:5:45: `width` in `photos`: the length 52 has no unit; write",
        ),
        ("Otsu()", "Otzu()", "vest.ron:13:9: unknown stage `Otzu`;"),
        ("radius", "raduis", "vest.ron:12:27: unknown parameter `raduis`;"),
        ("Otsu(),", "Otsu()", "vest.ron:13:15: a comma is missing after `Otsu()`"),
        ("Otsu(),", "", "vest.ron:14:9: `Canny` takes a mask, but nothing before it makes one;"),
        ("Taubin()", "Taubin(from: \"x\")", "vest.ron:16:22: no stage has the id `x`"),
        ("name:", "colour: 3, name:", "vest.ron:3:5: unknown field `colour`;"),
    ] {
        assert!(low.contains(from), "{from}");
        let found = with_stages(&low.replacen(from, to, 1));
        assert!(found.iter().any(|line| line.starts_with(fault)), "{fault}: {found:#?}");
        let told = found.iter().filter(|line| line.ends_with(above)).count();
        assert_eq!(told, 1, "{to}: {found:#?}");
        assert_eq!(found.len(), 2, "{to}: {found:#?}");
    }
    // A stage that has a fault of its own is not asked: the value that it was to have is not known.
    let found = with_stages(&low.replace("high: 60", "hihg: 100"));
    let alone = "vest.ron:14:24: unknown parameter `hihg`; did you mean `high`? `Canny` has `low`, `high`";
    assert_eq!(found, [alone]);
}

#[test]
fn a_misspelt_field_is_read_all_the_same() {
    let text = kit::VEST.replace("stages:", "stagse:").replace("Otsu", "Otzu");
    let lines: Vec<String> = faults(&text).lines().map(|l| l.split(';').next().unwrap().to_owned()).collect();
    assert_eq!(lines, ["vest.ron:11:5: unknown field `stagse`", "vest.ron:13:9: unknown stage `Otzu`"]);
}

#[test]
fn a_wrong_type_is_named_by_its_field() {
    check(
        "radius: 1",
        "radius: \"one\"",
        &["vest.ron:12:35: `radius` must be a whole number, found `\"one\"`"],
    );
    check("radius: 1", "radius: 1.5", &["vest.ron:12:35: `radius` must be a whole number, found `1.5`"]);
    check("low: 20", "low: \"x\"", &["vest.ron:14:20: `low` must be a number, found `\"x\"`"]);
    check("low: 20", "low: [1]", &["vest.ron:14:20: `low` must be a number, found `[...]`"]);
    check("low: 20", "low: Some", &["vest.ron:14:20: `low` must be a number, found `Some`"]);
    check("\"cotton poplin\"", "3", &["vest.ron:10:20: `name` must be text, found `3`"]);
    check("\"vest\"", "vest", &["vest.ron:3:11: `name` must be text in quotes"]);
    check("Eight", "8", &["vest.ron:12:20: `mask` must be Four | Eight, found `8`"]);
    check(
        "Eight",
        "Eigth",
        &[
            "vest.ron:12:20: `mask` must be Four | Eight: there is no choice `Eigth`; did you mean `Eight`? there is `Four`, `Eight`",
        ],
    );
    check("\"vest\"", "\"vest\", plugins: 3", &["vest.ron:3:28: `plugins` must be a list of texts"]);
    check("\"vest\"", "\"vest\", plugins: [3]", &["vest.ron:3:29: `plugins` must be text in quotes"]);
}

#[test]
fn numbers_keep_their_range() {
    check("radius: 1", "radius: 99", &["vest.ron:12:35: `radius` is 99, above its greatest value 9 px"]);
    check("radius: 1", "radius: -1", &["vest.ron:12:35: `radius` is -1, below its least value 1 px"]);
    check("low: 20", "low: NaN", &["vest.ron:14:20: `low` is NaN, which is not a finite number"]);
    check("low: 20", "low: -inf", &["vest.ron:14:20: `low` is -inf, which is not a finite number"]);
    check("low: 20", "low: 1e999", &["vest.ron:14:20: `low` is inf, which is not a finite number"]);
    check("\"12 mm\"", "\"12 m\"", &["vest.ron:15:26: `edge` is 12 m, above its greatest value 10 cm"]);
    check("\"12 mm\"", "\"-12 mm\"", &["vest.ron:15:26: `edge` is -12 mm, below its least value 1 mm"]);
}

#[test]
fn lengths_carry_their_unit() {
    check(
        "\"12 mm\"",
        "12",
        &["vest.ron:15:26: `edge`: the length 12 has no unit; write \"12 mm\" or \"12 cm\""],
    );
    let like = "is not a length; write a number and a unit, like \"12 mm\" (mm, cm, m, in)";
    check("\"12 mm\"", "\"12\"", &[&format!("vest.ron:15:26: `edge`: \"12\" {like}")]);
    check("\"12 mm\"", "\"1 mile\"", &[&format!("vest.ron:15:26: `edge`: \"1 mile\" {like}")]);
    check(
        "\"12 mm\"",
        "true",
        &["vest.ron:15:26: `edge` must be a length with its unit, like \"12 mm\", found the boolean `true`"],
    );
}

#[test]
fn a_fault_deep_in_a_table_is_put_at_its_own_field() {
    check(
        "width: \"52 cm\"",
        "width: 52",
        &["vest.ron:5:45: `width` in `photos`: the length 52 has no unit; write \"52 mm\" or \"52 cm\""],
    );
    check(
        "width",
        "widht",
        &["vest.ron:5:38: unknown field `widht` in `photos`; did you mean `width`? there is `file`, `width`"],
    );
    check(", width: \"52 cm\"", "", &["vest.ron:5:18: `front` in `photos`: the field `width` is missing"]);
    check(
        "width: \"52 cm\"",
        "width: \"5 cm\", width: \"6 cm\"",
        &["vest.ron:5:53: the field `width` is given twice in `photos`"],
    );
    check("\"front.jpg\"", "3", &["vest.ron:5:25: `file` in `photos`: expected text in quotes, found `3`"]);
    check(
        "front.side_left",
        "front",
        &["vest.ron:20:20: `seams`: \"front\" is not an edge; write \"panel.edge\", like \"front.hem\""],
    );
    check(
        "Match",
        "Macth",
        &[
            "vest.ron:20:14: `seams` must be a list of Match(...): there is no choice `Macth`; did you mean `Match`?",
        ],
    );
    check(
        "\"front.side_left\", ",
        "",
        &["vest.ron:20:14: `seams` must be a list of Match(...): it needs 2 values, found 1"],
    );
}

#[test]
fn a_stage_is_written_with_brackets() {
    check("Otsu()", "Otsu", &["vest.ron:13:9: `Otsu` needs brackets; write `Otsu()`"]);
    check("Otsu()", "\"Otsu\"", &["vest.ron:13:9: expected a stage, written `Name(field: value)`"]);
    check("Vest()", "3", &["vest.ron:8:12: expected a stage, written `Name(field: value)`"]);
    check(
        "Vest()",
        "Otsu()",
        &["vest.ron:8:12: `style` must be a style stage, `Otsu` is a binariser; there is `Vest`"],
    );
}

#[test]
fn one_value_may_go_without_its_name() {
    let expected = "vest.ron:10:20: `Preset` takes one value without a name at most, and then no others; \
                    write `Preset(name: ..., ...)`";
    check("\"cotton poplin\"", "\"a\", \"b\"", &[expected]);
    check("\"cotton poplin\"", "\"a\", scale: 2", &[expected]);
    check("Vest()", "Vest(3)", &["vest.ron:8:17: `Vest` has no parameters; write `Vest()`"]);
}

#[test]
fn fields_and_ids_stand_once() {
    check("radius: 1", "radius: 1, radius: 2", &["vest.ron:12:38: the field `radius` is given twice"]);
    check("name:", "name: \"x\", name:", &["vest.ron:3:16: the field `name` is given twice"]);
    check(
        "Taubin()",
        "Taubin(id: \"smooth\"), Taubin(id: \"smooth\")",
        &["vest.ron:16:42: two stages have the id `smooth`"],
    );
    check(
        "Taubin()",
        "Taubin(id: \"../x\")",
        &["vest.ron:16:20: an id has 1 to 64 letters, digits, `_` or `-`: it names a folder"],
    );
}

#[test]
fn stages_must_be_there() {
    let missing = "the field `stages` is missing; write `stages: [ ... ]` with the stages in their order";
    assert_eq!(faults("()"), format!("vest.ron:1:1: {missing}"));
    assert_eq!(faults("(stages: [])"), "vest.ron:1:10: `stages` holds no stage");
    assert_eq!(faults("(stages: Otsu())"), "vest.ron:1:10: `stages` must be a list, `[Otsu(), ...]`");
    for other in ["[]", "3", "Pipeline()", "{}"] {
        assert_eq!(faults(other), "vest.ron:1:1: a pipeline file is written `(name: ..., stages: [...])`");
    }
}

#[test]
fn all_faults_come_out_in_one_run() {
    let text = kit::VEST
        .replace("front.jpg\", width: \"52 cm\"", "front.jpg\", width: 52")
        .replace("\"172 cm\"", "\"9 m\"")
        .replace("radius: 1", "radius: 0, raduis: 1")
        .replace("Otsu()", "Otzu()")
        .replace("low: 20", "low: NaN")
        .replace("Taubin()", "Merge()")
        .replace("Match(", "Macth(");
    let expected = [
        "vest.ron:5:45: `width` in `photos`: the length 52 has no unit; write \"52 mm\" or \"52 cm\"",
        "vest.ron:9:29: `height` is 9 m, above its greatest value 2.5 m",
        "vest.ron:12:35: `radius` is 0, below its least value 1 px",
        "vest.ron:12:38: unknown parameter `raduis`; did you mean `radius`? `Mean` has `mask`, `radius`",
        "vest.ron:13:9: unknown stage `Otzu`; did you mean `Otsu`?",
        "vest.ron:14:20: `low` is NaN, which is not a finite number",
        "vest.ron:17:9: `Painter` takes a named set (panel), but `Merge` makes a single panel",
        "vest.ron:20:14: `seams` must be a list of Match(...): there is no choice `Macth`; did you mean `Match`?",
    ];
    assert_eq!(faults(&text).lines().collect::<Vec<_>>(), expected);
}

#[test]
fn records_are_for_machines() {
    let faults = read(&kit::VEST.replace("Otsu()", "Otzu()")).unwrap_err();
    let expected = r#"[{"file":"vest.ron","line":13,"column":9,"code":"unknown_stage","message":"unknown stage `Otzu`","hint":"did you mean `Otsu`?"}]"#;
    assert_eq!(serde_json::to_string(&faults.records()).unwrap(), expected);
}

#[test]
fn a_clash_is_drawn_with_both_ends_underlined() {
    let faults = read(&kit::VEST.replace("Taubin()", "Taubin(from: \"Canny\")")).unwrap_err();
    let expected = r#"  × `Taubin` takes a panel, but `Canny` makes an outline
    ╭─[vest.ron:16:22]
 13 │         Otsu(),
 14 │         Canny(low: 20, high: 60),
    ·         ──┬──
    ·           ╰── makes an outline
 15 │         GridMesher(edge: "12 mm"),
 16 │         Taubin(from: "Canny"),
    ·                      ───┬───
    ·                         ╰── takes a panel
 17 │         Painter(),
    ╰────
  help: `GridMesher()` and `DelaunayMesher()` make a panel from an outline; put one of them
        between
"#;
    assert_eq!(faults.render(false), expected);
    assert!(faults.render(true).contains('\u{1b}'));
}

#[test]
fn a_line_too_long_to_read_is_not_drawn() {
    let text = format!("(name: \"{}\", x: 1, stages: [])", "n".repeat(3000));
    let drawn = read(&text).unwrap_err().render(false);
    assert!(drawn.lines().all(|l| l.len() < 300), "{drawn}");
    assert!(drawn.contains("vest.ron:1:3026: `stages` holds no stage"), "{drawn}");
}
