//! The documentation's shelves keep their form: links lead somewhere, the README and the guide stay
//! short, the log is dated.
//!
//! *Prose* is a page without fenced code, lines indented by four spaces, code within a line and the
//! targets of links. A *number* is a group of digits, with points and commas between digits
//! (`1,024.5` is one); numbers of lists at the begin of a line do not count. A *word* is a piece
//! between white space that holds a letter.

use std::fs;
use std::path::{Path, PathBuf};
use toile_tests::root;

/// The most commands that the README names.
const MOST_COMMANDS: usize = 12;

/// The most numbers in a hundred words of a page of the guide.
const MOST_NUMBERS: f64 = 6.0;

/// The most words of a page of the reference that is not generated, code and tables included.
const MOST_WORDS: usize = 2500;

/// Files below a folder whose names end so, but for what is built or fetched.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let left_out = ["target", "out", "node_modules", ".git"];
    let mut found = Vec::new();
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        match path.is_dir() {
            true if left_out.iter().any(|name| path.ends_with(name)) => (),
            true => found.extend(files(&path, endings)),
            false if endings.iter().any(|e| path.to_string_lossy().ends_with(e)) => found.push(path),
            false => (),
        }
    }
    found.sort();
    found
}

fn pages() -> Vec<PathBuf> {
    files(&root(), &[".md"])
}

/// A text's lines that are no code.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let mut fenced = false;
    text.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        !fence && !fenced && !line.starts_with("    ")
    })
}

/// A line without the code within it.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join(" ")
}

/// The targets of a text's links.
fn targets(text: &str) -> Vec<String> {
    let in_line = |line: &str| -> Vec<String> {
        without_code(line)
            .split("](")
            .skip(1)
            .filter_map(|rest| Some(rest.split_once(')')?.0.to_owned()))
            .collect()
    };
    lines(text).flat_map(in_line).collect()
}

/// A text's prose.
fn prose(text: &str) -> String {
    let without_targets = |line: &str| -> String {
        let code = without_code(line);
        let mut parts = code.split("](");
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |all, rest| all + " " + rest.split_once(')').map_or(rest, |(_, after)| after))
    };
    let without_number = |line: String| match line.trim_start().split_once(". ") {
        Some((number, rest)) if number.chars().all(|c| c.is_ascii_digit()) => rest.to_owned(),
        _ => line,
    };
    lines(text).map(|line| without_number(without_targets(line))).collect::<Vec<_>>().join("\n")
}

fn words(prose: &str) -> usize {
    prose.split_whitespace().filter(|word| word.chars().any(char::is_alphabetic)).count()
}

fn numbers(prose: &str) -> usize {
    let all: Vec<char> = prose.chars().collect();
    let goes_on = |before: &[char]| match before {
        [.., digit, '.' | ','] => digit.is_ascii_digit(),
        [.., last] => last.is_ascii_digit(),
        [] => false,
    };
    (0..all.len()).filter(|&i| all[i].is_ascii_digit() && !goes_on(&all[..i])).count()
}

/// The name under which a heading is linked to.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Whether a page has a heading of that name, or a place marked so, as rows of the log are:
/// `<a id="NAME">`.
fn has_anchor(page: &Path, name: &str) -> bool {
    let text = fs::read_to_string(page).unwrap();
    let mark = format!("<a id=\"{name}\">");
    lines(&text).any(|line| line.starts_with('#') && anchor(line) == name || line.contains(&mark))
}

#[test]
fn relative_links_lead_somewhere() {
    let mut broken = Vec::new();
    let mut seen = 0;
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for target in targets(&text).into_iter().filter(|t| !t.contains("://")) {
            seen += 1;
            let (path, name) = target.split_once('#').unwrap_or((&target, ""));
            let aim = if path.is_empty() { page.clone() } else { page.parent().unwrap().join(path) };
            if !aim.exists() || !name.is_empty() && !has_anchor(&aim, name) {
                broken.push(format!("{}: {target}", page.strip_prefix(root()).unwrap().display()));
            }
        }
    }
    assert!(seen > 100, "{seen} links");
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Pages of the documentation that sources name by their path from the root. The log and the
/// pipelines of earlier days keep the names of their day.
#[test]
fn pages_that_sources_name_exist() {
    let kinds = [".rs", ".ron", ".toml", ".md", ".h", ".sh", ".py", ".ci/run", ".ci/wide"];
    let is_part = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    let (mut missing, mut seen) = (Vec::new(), 0);
    for file in files(&root(), &kinds) {
        let place = file.strip_prefix(root()).unwrap().to_owned();
        let of_a_day = ["docs/log", "tests/migrated"].iter().any(|folder| place.starts_with(folder));
        if of_a_day || place.ends_with("texts/docs.rs") {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        for (at, _) in text.match_indices("docs/") {
            let path: String = text[at..].chars().take_while(|c| is_part(*c)).collect();
            let path = path.trim_end_matches(['.', '/', '-']);
            let of_ours = !text[..at].ends_with(is_part) || text[..at].ends_with("../");
            seen += usize::from(of_ours);
            if of_ours && !root().join(path).exists() {
                missing.push(format!("{}: {path}", place.display()));
            }
        }
    }
    assert!(seen > 50, "{seen}");
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn the_readme_names_few_commands() {
    let text = fs::read_to_string(root().join("README.md")).unwrap();
    let pieces = text.lines().flat_map(|line| match line.strip_prefix("    ") {
        Some(code) => vec![code],
        None => line.split('`').skip(1).step_by(2).collect(),
    });
    let commands: Vec<&str> =
        pieces.filter(|p| ["toile ", "cargo ", ".ci/"].iter().any(|start| p.starts_with(start))).collect();
    assert!(commands.len() <= MOST_COMMANDS, "{commands:#?}");
}

#[test]
fn the_guide_is_no_table_of_figures() {
    let mut seen = 0;
    for page in files(&root().join("docs/guide"), &[".md"]) {
        let prose = prose(&fs::read_to_string(&page).unwrap());
        let share = 100.0 * numbers(&prose) as f64 / words(&prose) as f64;
        assert!(share <= MOST_NUMBERS, "{}: {share:.1} numbers in 100 words", page.display());
        seen += 1;
    }
    assert!(seen >= 6, "{seen} pages");
}

#[test]
fn pages_of_the_reference_are_read_in_one_sitting() {
    let pages = files(&root().join("docs/reference"), &[".md"]);
    assert!(pages.len() > 15, "{} pages", pages.len());
    for page in pages.iter().filter(|page| !page.ends_with("stages.md")) {
        let words = fs::read_to_string(page).unwrap().split_whitespace().count();
        assert!(words <= MOST_WORDS, "{}: {words} words", page.display());
    }
}

/// But for the table of all measurements, `README.md`.
#[test]
fn pages_of_the_log_begin_with_their_date() {
    let is_date = |name: &str| {
        let form = name.bytes().zip(b"0000-00-00-".iter());
        name.len() > 11
            && form.into_iter().all(|(b, f)| if *f == b'0' { b.is_ascii_digit() } else { b == *f })
    };
    let names = fs::read_dir(root().join("docs/log")).unwrap().map(|e| e.unwrap().file_name());
    let names = names.map(|n| n.to_string_lossy().into_owned());
    let undated: Vec<String> = names.filter(|n| n != "README.md" && !is_date(n)).collect();
    assert!(undated.is_empty(), "{undated:#?}");
}

#[test]
fn prose_is_what_is_counted() {
    let text =
        "# Two 2\n\n1. It took 1,024.5 s, `3` times.\n\n    code 4\n\n```\n5\n```\n[six](7.md) 8-9 end.\n";
    let prose = prose(text);
    assert_eq!(numbers(&prose), 4, "{prose}");
    assert_eq!(words(&prose), 7, "{prose}");
    assert_eq!(targets(text), ["7.md"]);
    assert_eq!(numbers("0.5 to 12, then 3."), 3);
    assert_eq!(anchor("## Help it find the garment"), "help-it-find-the-garment");
}

/// The longest line of a comment, but for code, tables and headings of examples.
const COMMENT: usize = 100;

/// Lines of comments that are too long, with their numbers.
fn long_comments(code: &str) -> Vec<usize> {
    let mut fenced = false;
    let is_long = |(number, line): (usize, &str)| {
        let own = line.trim_start();
        let Some(text) = ["/// ", "//! ", "// "].iter().find_map(|start| own.strip_prefix(start)) else {
            fenced &= own.starts_with("//");
            return None;
        };
        fenced ^= text.starts_with("```");
        let is_prose = !fenced && !text.starts_with("    ") && !text.starts_with('|');
        (is_prose && line.chars().count() > COMMENT).then_some(number + 1)
    };
    code.lines().enumerate().filter_map(is_long).collect()
}

#[test]
fn comments_are_no_wider_than_a_page() {
    let long = "word ".repeat(25);
    let code = format!(
        "/// {long}\n//!     {long}\n// | {long}\n// ```\n// {long}\n// ```\nlet x = \"{long}\";\n// {long}"
    );
    assert_eq!(long_comments(&code), [1, 8]);
    let sources = files(&root(), &[".rs"]);
    assert!(sources.len() > 900, "{}", sources.len());
    let wide: Vec<String> = sources
        .iter()
        .flat_map(|file| {
            let long = long_comments(&fs::read_to_string(file).unwrap());
            long.into_iter().map(move |line| format!("{}:{line}", file.display()))
        })
        .collect();
    assert!(wide.is_empty(), "{wide:#?}");
}
