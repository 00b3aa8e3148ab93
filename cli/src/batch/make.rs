//! `toile manifest`: a manifest from files or from a table.

use super::manifest::{self, LineFault};
use super::tally::counted;
use super::{csv, names};
use crate::args::ManifestArgs;
use crate::verify::write_text;
use crate::{Streams, at_hand, exit};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use toile_pipeline::Override;

/// Writes a manifest, or says what is wrong with its sources.
pub(crate) fn make(args: &ManifestArgs, streams: &mut Streams<'_>) -> u8 {
    let folder = args.out.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    let made = match (args.sources.as_slice(), &args.field) {
        ([table], None) if table.to_ascii_lowercase().ends_with(".csv") => of_table(Path::new(table), folder),
        (_, None) => {
            return streams.misused(
                "say with --field which value each file is, like `--field pattern.file`; one CSV table needs none",
            );
        }
        (sources, Some(field)) => of_files(sources, field, folder),
    };
    let lines = match made {
        Ok(lines) => lines,
        Err(faults) => {
            faults.iter().for_each(|fault| streams.tell(format!("error: {fault}")));
            return exit::INVALID;
        }
    };
    match &args.out {
        None => lines.iter().for_each(|line| streams.say(line)),
        Some(out) => {
            let text = lines.iter().map(|line| format!("{line}\n")).collect::<String>();
            if let Err(e) = write_text(out, &text) {
                streams.tell(format!("error: {e}"));
                return exit::INVALID;
            }
            streams.report(format!("{}: {}", out.display(), counted(lines.len())));
        }
    }
    exit::DONE
}

fn line(id: &str, set: Map<String, Value>) -> String {
    json!({ "id": id, "set": set }).to_string()
}

/// A garment for each file, in the order in which they are named.
fn of_files(sources: &[String], field: &str, folder: &Path) -> Result<Vec<String>, Vec<String>> {
    let (mut files, mut faults) = (Vec::new(), Vec::new());
    for source in sources {
        match names::files(source) {
            Ok(found) => files.extend(found),
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut seen = BTreeSet::new();
    let mut of_file = |file: &PathBuf| {
        let stem = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let value = Value::String(seen_from(folder, file));
        line(&new_id(&stem, &mut seen), Map::from_iter([(field.to_owned(), value)]))
    };
    Ok(files.iter().map(&mut of_file).collect())
}

/// An id that no garment before has, after the name of a file.
fn new_id(stem: &str, seen: &mut BTreeSet<String>) -> String {
    let kept: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' }).collect();
    let kept = kept.trim_start_matches(|c: char| !c.is_ascii_alphanumeric());
    let kept: String = kept.chars().take(80).collect();
    let base = match kept.trim_end_matches('.') {
        "" => "garment",
        base => base,
    };
    let numbered = (2_usize..).map(|n| format!("{base}-{n}"));
    let free = std::iter::once(base.to_owned()).chain(numbered).find(|id| !seen.contains(&id.to_lowercase()));
    let id = free.unwrap_or_default();
    seen.insert(id.to_lowercase());
    id
}

/// A file's path as it is seen from a folder; the full path of one that lies elsewhere.
fn seen_from(folder: &Path, file: &Path) -> String {
    let full = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let base = if folder.as_os_str().is_empty() { full(Path::new(".")) } else { full(folder) };
    let file = full(file);
    file.strip_prefix(base).unwrap_or(&file).display().to_string()
}

/// A garment for each row: its column `id`, and columns named by paths. Empty cells set nothing.
fn of_table(table: &Path, folder: &Path) -> Result<Vec<String>, Vec<String>> {
    let name = table.display();
    let text =
        toile_core::read_text(table).map_err(|e| vec![format!("cannot read the table \"{name}\": {e}")])?;
    let at = |(line, message): (usize, String)| vec![format!("\"{name}\", {}", LineFault { line, message })];
    let mut rows = csv::rows(&text).map_err(at)?.into_iter();
    let Some((first, head)) = rows.next() else { return Err(at((1, "the table is empty".into()))) };
    let Some(id_column) = head.iter().position(|cell| cell == "id") else {
        return Err(at((first, "the first row has no column `id`".into())));
    };
    // Each garment in the line of its row, so that what a manifest refuses is told by the table's.
    let (mut text, mut written) = (String::new(), 1);
    let mut faults = Vec::new();
    for (number, row) in rows {
        match of_row(&head, id_column, &row, [table.parent().unwrap_or(Path::new("")), folder]) {
            Ok(line) => {
                text += &"\n".repeat(number - written);
                text += &line;
                written = number;
            }
            Err(message) => faults.push(LineFault { line: number, message }),
        }
    }
    faults.extend(manifest::parse(text.as_bytes()).1);
    faults.sort_by_key(|fault| fault.line);
    match faults.is_empty() {
        true => Ok(text.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect()),
        false => Err(faults.into_iter().flat_map(|fault| at((fault.line, fault.message))).collect()),
    }
}

fn of_row(head: &[String], id: usize, row: &[String], folders: [&Path; 2]) -> Result<String, String> {
    if row.len() != head.len() {
        return Err(format!("the row has {} cells, the first row has {}", row.len(), head.len()));
    }
    let [table, manifest] = folders;
    let mut set = Map::new();
    for (_, (path, cell)) in
        head.iter().zip(row).enumerate().filter(|(k, (_, cell))| *k != id && !cell.is_empty())
    {
        let given = Override { path: path.clone(), value: cell.clone() };
        let file = at_hand::named(&given).map(|file| table.join(file)).filter(|file| file.is_file());
        let value = file.map_or_else(|| cell.clone(), |file| seen_from(manifest, &file));
        if set.insert(path.clone(), Value::String(value)).is_some() {
            return Err(format!("two columns are called \"{path}\""));
        }
    }
    Ok(line(&row[id], set))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn ids_are_names_of_folders_and_each_stands_once() {
        let mut seen = BTreeSet::new();
        let ids =
            ["shirt", "Shirt", "my shirt (1)", ".hidden", "…", "a."].map(|stem| new_id(stem, &mut seen));
        assert_eq!(ids, ["shirt", "Shirt-2", "my_shirt__1_", "hidden", "garment", "a"]);
        assert!(ids.iter().all(|id| manifest::check_id(id).is_ok()));
    }

    #[test]
    fn a_table_is_a_garment_a_row_with_its_files_seen_from_the_manifest() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::create_dir(dir.path().join("in")).unwrap();
        std::fs::write(dir.path().join("in/a.json"), "").unwrap();
        let table = dir.path().join("in/table.csv");
        std::fs::write(&table, "id,pattern.file,body.height\nx,a.json,1.8 m\ny,b.json,\n").unwrap();
        assert_eq!(
            of_table(&table, dir.path()).unwrap(),
            [
                r#"{"id":"x","set":{"body.height":"1.8 m","pattern.file":"in/a.json"}}"#,
                r#"{"id":"y","set":{"pattern.file":"b.json"}}"#
            ]
        );
        std::fs::write(&table, "id,a\nx,1\nx,2\ny\n").unwrap();
        let name = table.display();
        assert_eq!(
            of_table(&table, dir.path()).unwrap_err(),
            [
                format!("\"{name}\", line 3: the id \"x\" stands in line 2, too"),
                format!("\"{name}\", line 4: the row has 1 cells, the first row has 2"),
            ]
        );
        std::fs::write(&table, "name\nx\n").unwrap();
        assert_eq!(
            of_table(&table, dir.path()).unwrap_err(),
            [format!("\"{name}\", line 1: the first row has no column `id`")]
        );
    }
}
