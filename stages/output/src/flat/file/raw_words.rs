//! Counts in words.

/// `3 edges are cut`; none for nothing.
pub(in crate::flat) fn tell(n: usize, one: &str, many: &str) -> Option<String> {
    match n {
        0 => None,
        1 => Some(format!("1 {one}")),
        n => Some(format!("{n} {many}")),
    }
}
