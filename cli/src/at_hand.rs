//! Files named by `--set`: as on any command line, relative to the current folder.
//!
//! A pipeline's own paths are relative to the pipeline file. The value of a field that names a file
//! (`FILE_PARAMS`) on the command line that is a file seen from the current folder becomes its full
//! path; quotes may be left out. So does such a field within brackets
//! (`--set 'body=BodyObj(file: "me.obj")'`), and each file of a list (`LISTS`).

use std::path::{Path, PathBuf};
use toile_core::param::FILE_PARAMS;
use toile_pipeline::Override;

/// Fields whose values are lists of such paths.
const LISTS: [&str; 1] = ["garments"];

/// The overrides with their files found from the current folder.
pub(crate) fn found(overrides: &[Override]) -> Vec<Override> {
    found_from(Path::new(""), overrides)
}

/// The overrides with their files found from a folder, as those of a manifest are.
pub(crate) fn found_from(folder: &Path, overrides: &[Override]) -> Vec<Override> {
    overrides.iter().map(|o| found_by(&mut |text| full(folder, text), o)).collect()
}

/// All texts of an override that may name files, whether there are such files or not.
pub(crate) fn mentioned(o: &Override) -> Vec<String> {
    let mut texts = Vec::new();
    let mut note = |text: &str| {
        texts.push(text.to_owned());
        None
    };
    found_by(&mut note, o);
    // A list of seams is none of files.
    texts.retain(|text| !text.starts_with('['));
    texts
}

/// The override with its files as `find` gives them.
fn found_by(find: &mut dyn FnMut(&str) -> Option<PathBuf>, o: &Override) -> Override {
    if names_file(o) { with_file(find, o) } else { within(find, o) }
}

/// The file that an override names as its whole value.
pub(crate) fn named(o: &Override) -> Option<&str> {
    let is_whole = names_file(o) && !o.path.ends_with("seams") && !is_open_text(&o.value);
    is_whole.then(|| bare(&o.value))
}

/// A value without its quotes.
fn bare(value: &str) -> &str {
    value.strip_prefix('"').and_then(|v| v.strip_suffix('"')).unwrap_or(value)
}

/// Whether a value begins as a text of RON, but is none that stands in plain quotes.
fn is_open_text(value: &str) -> bool {
    ["r\"", "r#"].iter().any(|open| value.starts_with(open)) || bare(value).contains('\\')
}

fn names_file(o: &Override) -> bool {
    o.path.rsplit('.').next().is_some_and(|field| FILE_PARAMS.contains(&field))
}

/// The override with the files found that fields within its value name.
fn within(find: &mut dyn FnMut(&str) -> Option<PathBuf>, o: &Override) -> Override {
    let mut value = String::new();
    let mut rest = o.value.as_str();
    // Whether the texts that follow are in a list of files.
    let mut in_list = false;
    while let Some((before, text, after)) = next_text(rest) {
        value.push_str(before);
        let before = before.trim();
        in_list = match before.strip_suffix('[') {
            Some("") => o.path.rsplit('.').next().is_some_and(|field| LISTS.contains(&field)),
            Some(head) => LISTS.contains(&field_before(head)),
            None => in_list && before == ",",
        };
        let is_file = in_list || FILE_PARAMS.contains(&field_before(before));
        match is_file.then(|| find(text)).flatten() {
            Some(full) => value.push_str(&format!("{:?}", full.display().to_string())),
            None => value.push_str(&format!("\"{text}\"")),
        }
        rest = after;
    }
    value.push_str(rest);
    Override { value, ..o.clone() }
}

/// The field whose value begins behind a text: `file` of `BodyObj(file:`; empty where none does.
fn field_before(text: &str) -> &str {
    text.trim_end().strip_suffix(':').map_or("", |b| {
        let b = b.trim_end();
        &b[b.rfind(|c: char| !(c.is_alphanumeric() || c == '_')).map_or(0, |i| i + 1)..]
    })
}

/// What stands before the first plain text in quotes, the text, and what stands behind it; none
/// where an escape or a raw text makes it another.
fn next_text(value: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = value.split_once('"')?;
    let (text, after) = rest.split_once('"')?;
    let is_plain = !text.contains('\\') && !before.ends_with(['r', '#', '\\']);
    is_plain.then_some((before, text, after))
}

/// The full path of a file that is seen from a folder.
fn full(folder: &Path, text: &str) -> Option<PathBuf> {
    let path = folder.join(text);
    std::path::absolute(&path).ok().filter(|_| path.is_file())
}

fn with_file(find: &mut dyn FnMut(&str) -> Option<PathBuf>, o: &Override) -> Override {
    let is_text = ["\"", "r\"", "r#"].iter().any(|open| o.value.starts_with(open));
    let bare = bare(&o.value);
    match find(bare) {
        Some(full) => Override { value: format!("{:?}", full.display().to_string()), ..o.clone() },
        // A list of seams is none of files.
        None if is_text || !o.path.ends_with("file") => o.clone(),
        None => Override { value: format!("{bare:?}"), ..o.clone() },
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{found, mentioned};
    use toile_pipeline::Override;

    fn value(text: &str) -> String {
        found(&[text.parse::<Override>().unwrap()])[0].value.clone()
    }

    #[test]
    fn a_file_of_the_current_folder_gets_its_full_path_with_or_without_quotes() {
        let here = std::env::current_dir().unwrap().join("Cargo.toml").display().to_string();
        assert_eq!(value("scene.file=Cargo.toml"), format!("{here:?}"));
        assert_eq!(value("scene.file=\"Cargo.toml\""), format!("{here:?}"));
    }

    #[test]
    fn a_file_that_is_not_there_stays_relative_to_the_pipeline() {
        assert_eq!(value("photos.front.file=\"front.jpg\""), "\"front.jpg\"");
        assert_eq!(value("scene.file=samples/skirt.json"), "\"samples/skirt.json\"");
        assert_eq!(value("photos.front.file=red.jpg"), "\"red.jpg\"");
        assert_eq!(value("photos.front.file=r\"red.jpg\""), "r\"red.jpg\"");
    }

    #[test]
    fn files_within_brackets_are_found_as_well() {
        let here = std::env::current_dir().unwrap().join("Cargo.toml").display().to_string();
        assert_eq!(
            value("body=BodyObj(file: \"Cargo.toml\", unit: Metres)"),
            format!("BodyObj(file: {here:?}, unit: Metres)")
        );
        let two = "pattern=SvgPattern(file : \"Cargo.toml\", seams: \"none.ron\", size: \"Cargo.toml\")";
        let found = format!("SvgPattern(file : {here:?}, seams: \"none.ron\", size: \"Cargo.toml\")");
        assert_eq!(value(two), found, "a size is no file");
        assert_eq!(value("a=B(file: \"C:\\\\x\")"), "B(file: \"C:\\\\x\")");
        assert_eq!(value("a=B(file: r\"Cargo.toml\")"), "B(file: r\"Cargo.toml\")");
        assert_eq!(value("a=\"open"), "\"open");
    }

    #[test]
    fn files_of_a_list_are_found_as_well() {
        let here = std::env::current_dir().unwrap().join("Cargo.toml").display().to_string();
        assert_eq!(
            value("pattern.garments=[\"Cargo.toml\", \"none.json\", \"Cargo.toml\"]"),
            format!("[{here:?}, \"none.json\", {here:?}]")
        );
        assert_eq!(
            value("pattern=Outfit(garments: [\"Cargo.toml\"], name: \"Cargo.toml\")"),
            format!("Outfit(garments: [{here:?}], name: \"Cargo.toml\")")
        );
        assert_eq!(value("plugins=[\"Cargo.toml\"]"), "[\"Cargo.toml\"]");
    }

    #[test]
    fn files_are_told_whether_they_are_there_or_not() {
        let told = |text: &str| mentioned(&text.parse::<Override>().unwrap());
        assert_eq!(told("pattern.file=a.json"), ["a.json"]);
        assert_eq!(told("body=BodyObj(file: \"b.obj\", unit: Metres)"), ["b.obj"]);
        assert_eq!(told("pattern.garments=[\"a.json\", \"b.json\"]"), ["a.json", "b.json"]);
        assert_eq!(told("pattern.seams=[Match(\"a.b\", \"c.d\")]"), [""; 0]);
        assert_eq!(told("fabric=Preset(\"denim\")"), [""; 0]);
    }

    #[test]
    fn other_fields_are_left_alone() {
        assert_eq!(value("stages.Otsu.bias=3"), "3");
        assert_eq!(value("seams=[Match(\"a.b\", \"c.d\")]"), "[Match(\"a.b\", \"c.d\")]");
    }
}
