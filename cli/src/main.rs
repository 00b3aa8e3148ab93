//! `toile`, the command.

fn main() {
    let mut registry = toile_core::Registry::new();
    toile_stages::register(&mut registry);
}
