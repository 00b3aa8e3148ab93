//! Files named by `--set`: as on any command line, relative to the current folder.
//!
//! A pipeline's own paths are relative to the pipeline file. A value of a field `file` on the command line that is a
//! file seen from the current folder becomes its full path; quotes may be left out.

use std::path::Path;
use toile_pipeline::Override;

/// The overrides with their files found.
pub(crate) fn found(overrides: &[Override]) -> Vec<Override> {
    overrides.iter().map(|o| if names_file(o) { with_file(o) } else { o.clone() }).collect()
}

fn names_file(o: &Override) -> bool {
    o.path.rsplit('.').next() == Some("file")
}

fn with_file(o: &Override) -> Override {
    let is_text = o.value.starts_with('"') || o.value.starts_with('r');
    let bare = o.value.strip_prefix('"').and_then(|v| v.strip_suffix('"')).unwrap_or(&o.value);
    match std::path::absolute(bare) {
        Ok(full) if Path::new(bare).is_file() => {
            Override { value: format!("{:?}", full.display().to_string()), ..o.clone() }
        }
        _ if is_text => o.clone(),
        _ => Override { value: format!("{bare:?}"), ..o.clone() },
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::found;
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
    }

    #[test]
    fn other_fields_are_left_alone() {
        assert_eq!(value("stages.Otsu.bias=3"), "3");
    }
}
