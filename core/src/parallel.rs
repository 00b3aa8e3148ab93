//! Loops over the threads of the program's pool; with the feature `rayon`, else one after the
//! other.

use std::sync::{Mutex, PoisonError};

/// Calls `body(i)` for every `i` below `count`, in any order.
#[cfg(feature = "rayon")]
pub(crate) fn each(count: usize, body: &(dyn Fn(usize) + Sync)) {
    use rayon::prelude::*;
    (0..count).into_par_iter().for_each(body);
}

/// Calls `body(i)` for every `i` below `count`, in any order.
#[cfg(not(feature = "rayon"))]
pub(crate) fn each(count: usize, body: &(dyn Fn(usize) + Sync)) {
    (0..count).for_each(body);
}

/// `work(i)` of every `i` below `count`, made in parallel by `each`, in their order.
pub(crate) fn map<T: Send>(
    count: usize,
    each: impl FnOnce(usize, &(dyn Fn(usize) + Sync)),
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let slots: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    each(count, &|i| *slots[i].lock().unwrap_or_else(PoisonError::into_inner) = Some(work(i)));
    slots.into_iter().filter_map(|s| s.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
}
