//! Names of types: one name, one thing.
//!
//! Types that a trait asks for (`type Err`), and those of tests, are not counted.

use super::circles::{crates, is_test, sources};
use std::collections::BTreeMap;
use std::path::Path;
use syn::visit::Visit;

/// The most names, in a hundred, that more than one type has.
const MOST_SHARED: f64 = 5.0;

/// The names of the types that a file declares, outside of tests.
#[derive(Default)]
struct Declared(Vec<String>);

impl<'ast> Visit<'ast> for Declared {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let (name, attributes) = match item {
            syn::Item::Struct(i) => (&i.ident, &i.attrs),
            syn::Item::Enum(i) => (&i.ident, &i.attrs),
            syn::Item::Trait(i) => (&i.ident, &i.attrs),
            syn::Item::Type(i) => (&i.ident, &i.attrs),
            syn::Item::Mod(i) if is_test(&i.attrs) => return,
            _ => return syn::visit::visit_item(self, item),
        };
        if !is_test(attributes) {
            self.0.push(name.to_string());
        }
        syn::visit::visit_item(self, item);
    }
}

fn declared(text: &str) -> Vec<String> {
    let mut names = Declared::default();
    names.visit_file(&syn::parse_file(text).unwrap());
    names.0
}

/// Whether a file is one of tests.
fn is_of_tests(path: &Path) -> bool {
    path.file_stem().is_some_and(|s| s.to_string_lossy().ends_with("tests"))
        || path.components().any(|c| c.as_os_str() == "tests")
}

#[test]
fn nearly_every_type_has_a_name_of_its_own() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut count: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut folders = Vec::new();
    crates(root, &mut folders);
    for src in folders {
        let mut files = Vec::new();
        sources(&src, &mut files);
        for file in files {
            let place = file.strip_prefix(root).unwrap();
            if !is_of_tests(place) {
                for name in declared(&std::fs::read_to_string(&file).unwrap()) {
                    count.entry(name).or_default().push(place.display().to_string());
                }
            }
        }
    }
    let shared: Vec<_> = count.iter().filter(|(_, at)| at.len() > 1).collect();
    let share = 100.0 * shared.len() as f64 / count.len() as f64;
    println!("{} of {} names of types are used more than once: {share:.1} %", shared.len(), count.len());
    assert!(
        share <= MOST_SHARED,
        "{share:.1} % of {} names, at most {MOST_SHARED} %: {shared:#?}",
        count.len()
    );
}

#[test]
fn types_of_tests_and_of_traits_are_passed_over() {
    let text = "
        pub struct A; enum B {} trait C { type D; } type E = A;
        impl Iterator for A { type Item = B; fn next(&mut self) -> Option<B> { struct F; None } }
        mod inner { pub struct G; }
        #[cfg(test)] mod tests { struct H; }
        #[cfg(test)] struct I;
    ";
    assert_eq!(declared(text), ["A", "B", "C", "E", "F", "G"]);
}
