//! Runs that laws are fitted on.

use toile_core::cost::Size;

/// A run that a law is fitted on.
#[derive(Debug, Clone)]
pub(super) struct Seen<'a> {
    pub(super) pipeline: &'a str,
    pub(super) style: &'a str,
    pub(super) size: &'a Size,
    pub(super) fact: f64,
    pub(super) weight: f64,
}

/// The middle of some values; 0 of none.
pub(super) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[n / 2],
        n => (values[n / 2 - 1] + values[n / 2]) / 2.0,
    }
}
