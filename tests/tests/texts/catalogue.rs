//! stages.md, stages.json and pipeline.schema.json in docs/reference are what the stages say of
//! themselves.
//!
//! After a change of a stage's card:
//! `UPDATE_DOCS=1 cargo test --release -p toile-tests --test whole catalogue::`.

use std::collections::{BTreeMap, BTreeSet};
use toile_core::{Card, Role};
use toile_tests::root;

const HEAD: &str = "# The stages\n\nMade from the stages' own cards by a test, which fails where this page is behind. \
                    `toile stage NAME` prints the same, `toile stages --json` gives it to programs.\n";

fn port_list(card: &Card) -> String {
    let inputs: Vec<String> =
        card.inputs.iter().map(|p| format!("{}{}", p.kind, if p.optional { "?" } else { "" })).collect();
    let outputs: Vec<String> = card.outputs.iter().map(|p| p.kind.to_string()).collect();
    format!("{} -> {}", inputs.join(", "), outputs.join(", "))
}

fn entry(card: &Card) -> String {
    let mut text = format!(
        "\n### {}\n\n`{}` — {}. Source: {}.\n\n",
        card.name,
        card.example,
        port_list(card),
        card.source
    );
    text += &format!("{}\n", card.doc.lines().map(str::trim).collect::<Vec<_>>().join("\n").trim());
    if !card.params.is_empty() {
        text += "\n| parameter | is | default | |\n|---|---|---|---|\n";
    }
    for p in &card.params {
        let cell = |s: &str| s.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|");
        let range = p.range().map_or(String::new(), |r| format!(", {r}"));
        let unit = if p.unit.is_empty() { String::new() } else { format!(" [{}]", p.unit) };
        let finer = p.finer.map_or_else(String::new, |way| format!("; {} is finer", way.as_str()));
        let trades = if p.trades { format!(" Trades accuracy for time{finer}.") } else { String::new() };
        let is = format!("{}{unit}{range}", cell(&p.kind));
        text += &format!("| `{}` | {is} | `{}` | {}{trades} |\n", p.name, cell(&p.default), cell(p.doc));
    }
    text
}

fn page() -> String {
    let registry = toile::registry();
    let mut by_role: BTreeMap<Role, Vec<&Card>> = BTreeMap::new();
    registry.cards().for_each(|c| by_role.entry(c.role).or_default().push(c));
    let sections = by_role.iter().map(|(role, cards)| {
        let entries: String = cards.iter().map(|c| entry(c)).collect();
        format!("\n## {}\n{entries}", role.as_str())
    });
    HEAD.to_owned() + &sections.collect::<String>()
}

#[test]
fn the_page_of_stages_is_up_to_date() {
    let (file, page) = (root().join("docs/reference/stages.md"), page());
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&file, &page).unwrap();
    }
    let kept = std::fs::read_to_string(&file).unwrap();
    let behind = kept.lines().zip(page.lines()).position(|(a, b)| a != b);
    assert_eq!(
        behind.map(|i| i + 1),
        None,
        "docs/reference/stages.md is behind from that line on; see the head of this test"
    );
    assert_eq!(kept.lines().count(), page.lines().count());
}

/// A committed file is what the program prints now; `UPDATE_DOCS=1` writes it anew.
fn committed(file: &str, arguments: &[&str]) {
    let answer = toile_tests::toile(arguments);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let value: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
    let now = format!("{value:#}\n");
    let path = root().join(file);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &now).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let behind = drift(&kept, &now);
    assert!(behind.is_empty(), "{file} is behind; see the head of this test\n{behind}");
}

/// The first lines that differ, old ones with a minus, new ones with a plus.
fn drift(kept: &str, now: &str) -> String {
    const SHOWN: usize = 6;
    let (kept, now): (Vec<&str>, Vec<&str>) = (kept.lines().collect(), now.lines().collect());
    let same = kept.iter().zip(&now).take_while(|(a, b)| a == b).count();
    if same == kept.len() && same == now.len() {
        return String::new();
    }
    let lines = |sign: char, all: &[&str]| {
        all.iter().skip(same).take(SHOWN).map(|l| format!("{sign} {l}\n")).collect::<String>()
    };
    format!("line {}:\n{}{}", same + 1, lines('-', &kept), lines('+', &now))
}

#[test]
fn the_catalogue_is_up_to_date() {
    committed("docs/reference/stages.json", &["stages", "--json"]);
}

#[test]
fn the_schema_of_pipeline_files_is_up_to_date() {
    committed("docs/reference/pipeline.schema.json", &["stages", "--schema"]);
}

#[test]
fn the_studio_has_every_card_in_chinese() {
    let path = root().join("studio/page/words/cards.zh.json");
    let chinese: BTreeMap<String, String> =
        serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let registry = toile::registry();
    let of = |card: &Card| {
        let params = card.params.iter().map(|p| p.doc.to_owned());
        params.chain([card.doc.to_owned()]).collect::<Vec<_>>()
    };
    let texts: BTreeSet<String> = registry.cards().flat_map(of).collect();
    // Sources and units have Chinese words where they are words.
    let others = registry.cards().flat_map(|card| {
        let units = card.params.iter().map(|p| p.unit.to_owned());
        units.chain([card.source.to_owned()]).collect::<Vec<_>>()
    });
    let known: BTreeSet<String> = others.chain(texts.iter().cloned()).collect();
    let missing: Vec<&String> = texts.iter().filter(|text| !chinese.contains_key(*text)).collect();
    let old: Vec<&String> = chinese.keys().filter(|text| !known.contains(*text)).collect();
    assert!(
        missing.is_empty() && old.is_empty(),
        "studio/page/words/cards.zh.json lacks {missing:#?}, and has what no card says: {old:#?}"
    );
    let is_chinese = |text: &str| text.chars().any(|c| ('\u{4e00}'..='\u{9fff}').contains(&c));
    let ticked = |text: &str| {
        let mut names: Vec<String> = text.split('`').skip(1).step_by(2).map(str::to_owned).collect();
        names.sort();
        names
    };
    for (english, other) in &chinese {
        assert!(is_chinese(other), "{english}");
        assert_eq!(ticked(english), ticked(other), "{english}");
    }
}

/// The committed schema as a validator reads it.
fn validator() -> (boon::Schemas, boon::SchemaIndex) {
    let text = std::fs::read_to_string(root().join("docs/reference/pipeline.schema.json")).unwrap();
    let (mut schemas, mut compiler) = (boon::Schemas::new(), boon::Compiler::new());
    compiler.add_resource("pipeline", serde_json::from_str(&text).unwrap()).unwrap();
    let index = compiler.compile("pipeline", &mut schemas).unwrap();
    (schemas, index)
}

#[test]
fn shipped_pipelines_follow_the_schema() {
    let (schemas, index) = validator();
    let mut seen = 0;
    let folders = ["pipelines", "pipelines/published"].map(|f| std::fs::read_dir(root().join(f)).unwrap());
    for entry in folders.into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "ron") {
            let text = std::fs::read_to_string(&path).unwrap();
            let value = toile_pipeline::to_json(&text, "").unwrap();
            let faults = schemas.validate(&value, index).err().map(|e| format!("{e:#}"));
            assert_eq!(faults, None, "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen >= 5, "{seen} pipelines");
}

#[test]
fn the_schema_refuses_what_the_loader_refuses() {
    let (schemas, index) = validator();
    let text = std::fs::read_to_string(root().join("pipelines/vest.ron")).unwrap();
    for (right, wrong) in [
        ("Canny(smooth: 1", "Canny(smoth: 1"),
        ("edge: \"16 mm\"", "edge: 16"),
        ("edge: \"16 mm\"", "edge: \"16 miles\""),
        ("BvhCollider()", "BvhCollider(volume: Box)"),
        ("NeighbourhoodMean()", "NeighbourhoodMean(radius: 1.5)"),
        ("PlaneSmoother()", "PlaneSmoother(lambda: -0.5)"),
        ("style: Outline(style: Vest)", "style: Otsu()"),
        ("fabric: Preset(", "fabrics: Preset("),
        ("StaticEquilibrium(", "Resting("),
    ] {
        assert!(text.contains(right), "{right}");
        let value = toile_pipeline::to_json(&text.replace(right, wrong), "").unwrap();
        assert!(schemas.validate(&value, index).is_err(), "{wrong}");
    }
}

#[test]
fn the_schema_takes_the_qualities_that_the_loader_takes() {
    let (schemas, index) = validator();
    let text = std::fs::read_to_string(root().join("pipelines/vest.ron")).unwrap();
    let change = "stages.GridMesher.edge=\"24 mm\"".parse().unwrap();
    let (error, words) = (toile_core::Length::mm(10.0), Some("2026-11-22: so".to_owned()));
    let quality = toile_pipeline::Quality::new("Very rough-2".into(), error, vec![change], words);
    let filled = toile_pipeline::fill_qualities(&text, &[quality]).unwrap();
    let valid = |text: &str| {
        let value = toile_pipeline::to_json(text, "").unwrap();
        schemas.validate(&value, index).is_ok()
    };
    assert!(valid(&filled));
    for (right, wrong) in [
        ("\"Very rough-2\"", "\"Very=rough\""),
        ("\"10 mm\"", "\"10\""),
        ("set: [", "sets: ["),
        ("Quality(", "Setting("),
        ("\"stages.GridMesher.edge=", "\"="),
    ] {
        let (before, field) = filled.split_once("qualities:").unwrap();
        assert!(field.contains(right), "{right}");
        assert!(!valid(&format!("{before}qualities:{}", field.replacen(right, wrong, 1))), "{wrong}");
    }
}

#[test]
fn drift_shows_the_first_lines_that_differ() {
    assert_eq!(drift("a\nb\nc\n", "a\nx\nc\n"), "line 2:\n- b\n- c\n+ x\n+ c\n");
    assert_eq!(drift("a\n", "a\n"), "");
    assert_eq!(drift("", "a\n"), "line 1:\n+ a\n");
}
