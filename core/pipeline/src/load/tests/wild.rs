//! Any text whatever gives a pipeline or faults with places inside it, and never a panic.

use super::*;
use proptest::prelude::*;

/// What must hold of any load.
fn sound(text: &str, overrides: &[Override]) {
    match load(text, "wild.ron", Path::new("."), &kit::registry(), overrides) {
        Ok(p) => {
            for (i, node) in p.nodes.iter().enumerate() {
                assert_eq!(node.inputs.len(), node.card.inputs.len());
                for feed in &node.inputs {
                    assert!(!matches!(feed, Feed::Node { node, .. } if *node >= i), "fed from behind");
                }
                assert!(p.text.get(node.span.clone()).is_some() && p.text.get(node.place.clone()).is_some());
            }
        }
        Err(faults) => {
            assert!(!faults.faults.is_empty(), "an error without a fault");
            for (fault, label) in faults.faults.iter().flat_map(|f| f.labels.iter().map(move |l| (f, l))) {
                let text = fault.option.as_ref().unwrap_or(&faults.text);
                assert!(text.get(label.span.clone()).is_some(), "{label:?} is not in {text}");
            }
            assert_eq!(faults.text, text, "places are in the file as it stands");
            assert!(faults.faults.iter().all(|f| !f.labels.is_empty()));
            assert!(!faults.render(false).is_empty() && !faults.to_string().is_empty());
        }
    }
}

/// The vest cut into pieces that are worth moving about.
fn tokens(text: &str) -> Vec<&str> {
    let mut cuts = vec![0];
    let mut before = ' ';
    for (i, c) in text.char_indices() {
        if !(c.is_alphanumeric() && before.is_alphanumeric()) && i > 0 {
            cuts.push(i);
        }
        before = c;
    }
    cuts.push(text.len());
    cuts.windows(2).map(|w| &text[w[0]..w[1]]).collect()
}

fn piece() -> impl Strategy<Value = String> {
    let words = [
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ",",
        ":",
        "\"",
        "'",
        "\\",
        "//",
        "/*",
        "*/",
        "\n",
        "r#",
        "#![",
        "from: ",
        "id: ",
        "Otsu()",
        "Local(),",
        "Vest()",
        "stages",
        "photos: {}",
        "qualities: [",
        "Quality(name: \"a\", max_error: \"1 mm\", set: [\"stages.Otsu=",
        "NaN",
        "-inf",
        "1e999",
        "\"5 cm\"",
        "0x",
        "--",
        "\u{feff}",
        "é",
        "\u{1f9f5}",
        "b'",
        "r##\"",
        "Some(",
        "None",
        "true",
        "()",
        "from: [\"Otsu\", 3]",
    ];
    prop_oneof![prop::sample::select(words.to_vec()).prop_map(str::to_owned), ".{0,3}"]
}

/// Cuts a piece out, doubles it, or puts something in.
fn mutated() -> impl Strategy<Value = String> {
    let change = (any::<prop::sample::Index>(), 0..3u8, piece());
    prop::collection::vec(change, 1..6).prop_map(|changes| {
        let mut pieces: Vec<String> = tokens(kit::VEST).into_iter().map(str::to_owned).collect();
        for (at, what, new) in changes {
            let i = at.index(pieces.len());
            match what {
                0 => pieces[i].clear(),
                1 => pieces[i] = pieces[i].repeat(2),
                _ => pieces.insert(i, new),
            }
        }
        pieces.concat()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_answered(text in any::<String>()) {
        sound(&text, &[]);
    }

    #[test]
    fn any_heap_of_tokens_is_answered(pieces in prop::collection::vec(piece(), 0..40)) {
        sound(&pieces.concat(), &[]);
    }

    #[test]
    fn any_mutated_pipeline_is_answered(text in mutated()) {
        sound(&text, &[]);
    }

    #[test]
    fn nested_brackets_are_answered(depth in 0..200usize, open in "[(\\[{A:]{1,4}", text in piece()) {
        sound(&format!("(stages: [Otsu(bias: {}{text}", open.repeat(depth)), &[]);
    }

    #[test]
    fn any_override_is_answered(path in "(stages|photos|body|fabric|seams|name|x)(\\.(Otsu|Canny|front|file|height|name|0|low|id|from|))*", value in piece()) {
        let overrides = [Override { path, value }, Override { path: "name".into(), value: "\"x\"".into() }];
        sound(kit::VEST, &overrides);
    }

    /// Our parser takes all that `ron` takes. Beyond ASCII the two differ in what is a letter:
    /// `ron` takes some characters for letters that are assigned to nothing, such as U+3D000.
    #[test]
    fn what_ron_accepts_the_parser_accepts(text in mutated()) {
        let text: String = text.chars().filter(|c| c.is_ascii() || "é\u{1f9f5}".contains(*c)).collect();
        let accepted = toile_core::param::ron_options().from_str::<serde::de::IgnoredAny>(&text).is_ok();
        if accepted {
            prop_assert!(crate::load::syntax::parser::parse(&text).is_ok(), "{text}");
        }
    }
}
