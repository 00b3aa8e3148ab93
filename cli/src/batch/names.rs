//! Patterns of file names: `*` stands for any characters, `?` for one, within one folder.

use std::path::{Component, Path, PathBuf};

/// Whether a name is one of a pattern's.
pub(crate) fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    let (mut p, mut n) = (0, 0);
    // The last star, and how much of the name it takes so far.
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(c) if *c == '?' || *c == name[n] => {
                p += 1;
                n += 1;
            }
            _ => match star {
                Some((at, taken)) => {
                    star = Some((at, taken + 1));
                    p = at + 1;
                    n = taken + 1;
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|c| *c == '*')
}

/// Whether a text stands for more than one name.
fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?'])
}

/// The files of a pattern in the order of their names; the file itself where it is none.
///
/// Errors: a sentence; no file is so called.
pub(crate) fn files(pattern: &str) -> Result<Vec<PathBuf>, String> {
    let mut found = vec![PathBuf::new()];
    // A file may have a star in its name.
    if !is_pattern(pattern) || Path::new(pattern).is_file() {
        found = vec![PathBuf::from(pattern)];
    } else {
        for part in Path::new(pattern).components() {
            found = match part {
                Component::Normal(part) if is_pattern(&part.to_string_lossy()) => {
                    found.iter().flat_map(|folder| named(folder, &part.to_string_lossy())).collect()
                }
                part => found.into_iter().map(|folder| folder.join(part)).collect(),
            };
        }
    }
    found.retain(|path| path.is_file());
    match found.is_empty() {
        true => Err(format!("there is no file \"{pattern}\"")),
        false => Ok(found),
    }
}

/// What lies in a folder under a name of a pattern, in order. Hidden files have to be named.
fn named(folder: &Path, pattern: &str) -> Vec<PathBuf> {
    let place = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(place).into_iter().flatten().flatten();
    let names = entries.filter_map(|e| e.file_name().into_string().ok());
    let mut names: Vec<String> =
        names.filter(|n| matches(pattern, n) && (pattern.starts_with('.') || !n.starts_with('.'))).collect();
    names.sort();
    names.into_iter().map(|name| folder.join(name)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_star_is_anything_and_a_question_mark_one_character() {
        for (pattern, name) in [("*.png", "a.png"), ("a?c", "abc"), ("*", ""), ("*a*b", "xaab"), ("a", "a")] {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [("*.png", "a.jpg"), ("a?c", "ac"), ("?", ""), ("*a*b", "xaabx"), ("a", "A")] {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }

    #[test]
    fn files_come_in_the_order_of_their_names() {
        let dir = tempfile::tempdir().unwrap();
        for name in ["x/b.json", "x/a.json", "y/c.json", "x/.d.json", "x/e.txt"] {
            let path = dir.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        let pattern = format!("{}/*/*.json", dir.path().display());
        let found = files(&pattern).unwrap();
        let names: Vec<_> =
            found.iter().map(|p| p.strip_prefix(dir.path()).unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["x/a.json", "x/b.json", "y/c.json"]);
        assert_eq!(files("none*.json"), Err("there is no file \"none*.json\"".into()));
        assert_eq!(files("none.json"), Err("there is no file \"none.json\"".into()));
    }
}
