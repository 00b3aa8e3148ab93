//! Files that import each other in a circle: none outside a module and its own children.
//!
//! Each file's paths are read (uses, and paths that begin with `crate`, `self` or `super`) and
//! followed to the file that defines the name, through what a module hands on (`pub use`). A module
//! and its descendants may name each other. Tests are passed over. The same is asked of folders
//! that lie side by side: what one takes from the other it does not give back.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::Visit;

/// Files, by their place in the source tree, that import each other: none, and none may come.
const LEFT: &[&[&str]] = &[];

/// Folders, side by side, that import each other: none, and none may come.
const LEFT_FOLDERS: &[[&str; 2]] = &[];

/// The most files of code in a folder.
const MOST_FILES: usize = 20;

/// A module's path within its crate.
type Module = Vec<String>;

/// One crate's modules, and what they hand on.
#[derive(Default)]
struct Crate {
    files: BTreeMap<Module, PathBuf>,
    handed_on: BTreeMap<(Module, String), Module>,
}

/// The paths that a file names, each with the module in which it stands.
struct Named<'a> {
    at: Module,
    root: &'a Crate,
    paths: Vec<(Module, Module)>,
    tests: Vec<Module>,
    handed_on: Vec<((Module, String), Module)>,
}

pub(super) fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("test")
            || a.path().is_ident("cfg") && quoted(a).contains("test") && !quoted(a).contains("not")
    })
}

fn quoted(attribute: &syn::Attribute) -> String {
    match &attribute.meta {
        syn::Meta::List(list) => list.tokens.to_string(),
        _ => String::new(),
    }
}

impl<'a> Named<'a> {
    fn leaves(&mut self, tree: &syn::UseTree, before: &[String], public: bool) {
        match tree {
            syn::UseTree::Path(p) => {
                let path = [before, &[p.ident.to_string()]].concat();
                self.leaves(&p.tree, &path, public);
            }
            syn::UseTree::Group(g) => g.items.iter().for_each(|t| self.leaves(t, before, public)),
            syn::UseTree::Name(n) => self.leaf(before, &n.ident.to_string(), &n.ident.to_string(), public),
            syn::UseTree::Rename(r) => self.leaf(before, &r.ident.to_string(), &r.rename.to_string(), public),
            syn::UseTree::Glob(_) => self.paths.push((self.at.clone(), before.to_vec())),
        }
    }

    fn leaf(&mut self, before: &[String], name: &str, known_as: &str, public: bool) {
        let path = match name {
            "self" => before.to_vec(),
            _ => [before, &[name.to_owned()]].concat(),
        };
        if public {
            let known_as =
                if name == "self" { before.last().cloned().unwrap_or_default() } else { known_as.to_owned() };
            self.handed_on.push(((self.at.clone(), known_as), path.clone()));
        }
        self.paths.push((self.at.clone(), path));
    }
}

impl<'ast> Visit<'ast> for Named<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        self.at.push(item.ident.to_string());
        if is_test(&item.attrs) {
            self.tests.push(self.at.clone());
        } else {
            syn::visit::visit_item_mod(self, item);
        }
        self.at.pop();
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if !is_test(&item.attrs) {
            let public = !matches!(item.vis, syn::Visibility::Inherited);
            self.leaves(&item.tree, &[], public);
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if !is_test(&item.attrs) {
            syn::visit::visit_item_fn(self, item);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Module = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let first = names.first().map_or("", String::as_str);
        let child = [&self.at[..], &names[..1.min(names.len())]].concat();
        if names.len() > 1
            && (["crate", "self", "super"].contains(&first) || self.root.files.contains_key(&child))
        {
            self.paths.push((self.at.clone(), names));
        }
        syn::visit::visit_path(self, path);
    }
}

impl Crate {
    /// The path from the crate's root, where it is one of this crate's.
    fn absolute(&self, at: &Module, path: &[String]) -> Option<Module> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => Some(rest.to_vec()),
            "self" => Some([at, rest].concat()),
            "super" => {
                let parent = at[..at.len().checked_sub(1)?].to_vec();
                match rest.first().map(String::as_str) {
                    Some("super") => self.absolute(&parent, rest),
                    _ => Some([&parent[..], rest].concat()),
                }
            }
            _ => self
                .files
                .contains_key(&[&at[..], std::slice::from_ref(first)].concat())
                .then(|| [at, path].concat()),
        }
    }

    /// The file that defines what a path names.
    fn file(&self, path: &[String], depth: usize) -> Option<&PathBuf> {
        let known = (0..=path.len()).rev().find(|&k| self.files.contains_key(&path[..k]))?;
        let (module, rest) = path.split_at(known);
        let handed = rest.first().and_then(|name| self.handed_on.get(&(module.to_vec(), name.clone())));
        match handed {
            Some(to) if depth < 8 => {
                let to = self.absolute(&module.to_vec(), to)?;
                self.file(&[&to[..], &rest[1..]].concat(), depth + 1)
            }
            _ => self.files.get(module),
        }
    }
}

/// The module of a source file.
fn module_of(path: &Path) -> Module {
    let mut parts: Module =
        path.with_extension("").iter().map(|p| p.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|l| ["mod", "lib", "main"].contains(&l.as_str())) {
        parts.pop();
    }
    parts
}

pub(super) fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()) {
        if entry.is_dir() {
            sources(&entry, found);
        } else if entry.extension().is_some_and(|e| e == "rs") {
            found.push(entry);
        }
    }
}

/// Which file names which, within one crate; a module and its descendants left out.
fn imports(src: &Path) -> BTreeMap<PathBuf, BTreeSet<PathBuf>> {
    let mut all = Vec::new();
    sources(src, &mut all);
    all.sort();
    let mut house = Crate::default();
    for file in &all {
        house.files.insert(module_of(file.strip_prefix(src).unwrap()), file.clone());
    }
    let mut named = Vec::new();
    for file in &all {
        let at = module_of(file.strip_prefix(src).unwrap());
        let text = std::fs::read_to_string(file).unwrap();
        let parsed = syn::parse_file(&text).map_err(|e| format!("{}: {e}", file.display())).unwrap();
        let mut seen =
            Named { at: at.clone(), root: &house, paths: vec![], tests: vec![], handed_on: vec![] };
        seen.visit_file(&parsed);
        named.push((file.clone(), at, seen.paths, seen.tests, seen.handed_on));
    }
    let tests: Vec<Module> = named.iter().flat_map(|n| n.3.clone()).collect();
    let is_tests = |m: &Module| tests.iter().any(|t| m.starts_with(t));
    house.handed_on = named.iter().flat_map(|n| n.4.clone()).collect();
    let mut edges = BTreeMap::new();
    for (file, at, paths, ..) in named.iter().filter(|n| !is_tests(&n.1)) {
        let to = paths.iter().filter_map(|(from, path)| house.file(&house.absolute(from, path)?, 0));
        let apart = |other: &&PathBuf| {
            let other = module_of(other.strip_prefix(src).unwrap());
            !other.starts_with(at) && !at.starts_with(&other)
        };
        edges.insert(file.clone(), to.filter(apart).cloned().collect());
    }
    edges
}

/// Sets of files each of which reaches all others.
fn circles(edges: &BTreeMap<PathBuf, BTreeSet<PathBuf>>) -> Vec<BTreeSet<PathBuf>> {
    let reach = |start: &PathBuf| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start.clone()]);
        while let Some(file) = open.pop() {
            for next in edges.get(&file).into_iter().flatten() {
                if seen.insert(next.clone()) {
                    open.push(next.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&PathBuf, BTreeSet<PathBuf>> = edges.keys().map(|f| (f, reach(f))).collect();
    let mut found = BTreeSet::new();
    for (file, from) in &reached {
        let circle: BTreeSet<PathBuf> =
            from.iter().filter(|f| reached.get(f).is_some_and(|r| r.contains(*file))).cloned().collect();
        if circle.len() > 1 {
            found.insert(circle);
        }
    }
    found.into_iter().collect()
}

/// Folders side by side below `src`, each of which imports files of the other.
fn folder_pairs(src: &Path, edges: &BTreeMap<PathBuf, BTreeSet<PathBuf>>) -> BTreeSet<[PathBuf; 2]> {
    let folders = |a: &Path, b: &Path| {
        let (mut from, mut to) = (src.to_path_buf(), src.to_path_buf());
        let parts = a.strip_prefix(src).ok()?.iter().zip(b.strip_prefix(src).ok()?.iter());
        for (x, y) in parts {
            (from, to) = (from.join(x), to.join(y));
            if x != y {
                break;
            }
        }
        (from.is_dir() && to.is_dir()).then_some((from, to))
    };
    let all: BTreeSet<(PathBuf, PathBuf)> =
        edges.iter().flat_map(|(a, to)| to.iter().filter_map(move |b| folders(a, b))).collect();
    let both = all.iter().filter(|(a, b)| a < b && all.contains(&(b.clone(), a.clone())));
    both.map(|(a, b)| [a.clone(), b.clone()]).collect()
}

pub(super) fn crates(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).filter(|e| e.is_dir()) {
        let name = entry.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name == "target" || name.starts_with('.') {
            continue;
        }
        if entry.join("Cargo.toml").is_file() && entry.join("src").is_dir() {
            found.push(entry.join("src"));
        }
        if name != "src" {
            crates(&entry, found);
        }
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut all = Vec::new();
    crates(root, &mut all);
    all.sort();
    assert!(all.len() > 10, "{all:?}");
    let mut found = Vec::new();
    for src in all {
        for circle in circles(&imports(&src)) {
            let names =
                circle.iter().map(|f| f.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/"));
            found.push(names.collect::<Vec<String>>());
        }
    }
    found.sort();
    let left: Vec<Vec<String>> = LEFT.iter().map(|c| c.iter().map(|f| (*f).to_owned()).collect()).collect();
    assert_eq!(found, left, "{found:#?}");
}

#[test]
fn no_two_folders_import_each_other() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut all = Vec::new();
    crates(root, &mut all);
    let name = |p: &PathBuf| p.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
    let mut found: Vec<[String; 2]> = all
        .iter()
        .flat_map(|src| folder_pairs(src, &imports(src)))
        .map(|pair| [name(&pair[0]), name(&pair[1])])
        .collect();
    found.sort();
    let left: Vec<[String; 2]> = LEFT_FOLDERS.iter().map(|pair| pair.map(str::to_owned)).collect();
    assert_eq!(found, left, "{found:#?}");
}

#[test]
fn no_folder_has_more_files_than_a_reader_keeps_in_mind() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut all = Vec::new();
    for part in ["cli", "core", "pipelines", "plugins", "stages", "studio", "tests", "trade", "verify"] {
        sources(&root.join(part), &mut all);
    }
    let mut count: BTreeMap<&Path, usize> = BTreeMap::new();
    for file in all.iter().filter(|f| !f.components().any(|c| c.as_os_str() == "target")) {
        *count.entry(file.parent().unwrap()).or_default() += 1;
    }
    let full: Vec<_> = count.iter().filter(|(_, files)| **files > MOST_FILES).collect();
    assert!(full.is_empty() && all.len() > 900, "{full:?}");
}

#[test]
fn folders_that_import_each_other_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("lib.rs", "mod one; mod two; mod three;");
    write("one/mod.rs", "mod a; mod b;");
    write("one/a.rs", "use crate::two::x::X; pub struct A(X);");
    write("one/b.rs", "pub struct B;");
    write("two/mod.rs", "pub mod x; pub mod y;");
    write("two/x.rs", "pub struct X;");
    write("two/y.rs", "use crate::one::b::B; pub struct Y(B);");
    write("three/mod.rs", "use crate::two::y::Y; pub struct Three(Y);");
    let src = folder.path();
    assert!(circles(&imports(src)).is_empty());
    assert_eq!(
        folder_pairs(src, &imports(src)).into_iter().collect::<Vec<_>>(),
        [[src.join("one"), src.join("two")]]
    );
}

#[test]
fn a_circle_is_found_and_a_module_with_its_children_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("lib.rs", "mod one; mod two; mod three;");
    write("one.rs", "use crate::two::Two; pub struct One;");
    write("two/mod.rs", "mod inner; pub use inner::Two;");
    write("two/inner.rs", "use super::super::one::One; pub struct Two(One);");
    write("three.rs", "#[cfg(test)] mod tests; use crate::one::One; pub fn three(_: One) {}");
    write("three/tests.rs", "use crate::two::Two;");
    let found = circles(&imports(folder.path()));
    let names = |c: &BTreeSet<PathBuf>| -> Vec<PathBuf> {
        c.iter().map(|f| f.strip_prefix(folder.path()).unwrap().to_owned()).collect()
    };
    assert_eq!(
        found.iter().map(names).collect::<Vec<_>>(),
        [[PathBuf::from("one.rs"), PathBuf::from("two/inner.rs")]]
    );
}
