//! What every artifact of a kind must be, whichever stage made it.
//!
//! The runner asks each artifact as it is made, so that a fault is named at the stage that made it
//! and later stages may index without a second look.

/// Says what is wrong: `vertex 12 is not a finite number`.
pub(super) type Sound = Result<(), String>;

/// No length, speed or pixel of a garment comes near this; squares and cubes of it are still finite.
pub(super) const LARGEST: f64 = 1e9;

/// All coordinates of all items are finite, and not absurdly large.
pub(super) fn finite<'a, P: 'a>(word: &str, items: impl IntoIterator<Item = &'a P>) -> Sound
where
    &'a P: IntoIterator<Item = &'a f64>,
{
    match items.into_iter().position(|p| !p.into_iter().all(|c| c.abs() <= LARGEST)) {
        Some(i) => Err(format!("{word} {i} is not a finite number below 1e9")),
        None => Ok(()),
    }
}

/// A single figure is finite, and not absurdly large.
pub(super) fn finite_figure(word: &str, value: f64) -> Sound {
    ensure(value.abs() <= LARGEST, || format!("the {word} is {value}"))
}

/// A figure is above zero, and not absurdly large.
pub(super) fn positive(word: &str, value: f64) -> Sound {
    ensure(value > 0.0 && value <= LARGEST, || {
        format!("the {word} is {value}, it must be above 0 and at most 1e9")
    })
}

/// All indices lie below `count`.
pub(super) fn indices<'a>(word: &str, count: usize, mut of: impl Iterator<Item = &'a u32>) -> Sound {
    match of.find(|&&i| i as usize >= count) {
        Some(i) => Err(format!("{word} names vertex {i} of {count}")),
        None => Ok(()),
    }
}

/// A list is as long as another that runs beside it.
pub(super) fn length(word: &str, is: usize, should: usize) -> Sound {
    ensure(is == should, || format!("there are {is} {word} for {should} vertices"))
}

/// Something holds.
pub(super) fn ensure(holds: bool, message: impl FnOnce() -> String) -> Sound {
    if holds { Ok(()) } else { Err(message()) }
}
