//! What every artifact of a kind must be, whichever stage made it.
//!
//! The runner asks each artifact as it is made, so that a fault is named at the stage that made it
//! and later stages may index without a second look.

/// Says what is wrong: `vertex 12 is not a finite number`.
pub(crate) type Sound = Result<(), String>;

/// No length, speed or pixel of a garment comes near this; squares and cubes of it are still
/// finite.
pub(crate) const LARGEST: f64 = 1e9;

/// All coordinates of all items are finite, and not absurdly large.
pub(crate) fn finite<'a, P: 'a>(word: &str, items: impl IntoIterator<Item = &'a P>) -> Sound
where
    &'a P: IntoIterator<Item = &'a f64>,
{
    match items.into_iter().position(|p| !p.into_iter().all(|c| c.abs() <= LARGEST)) {
        Some(i) => Err(format!("{word} {i} is not a finite number below 1e9")),
        None => Ok(()),
    }
}

/// A single figure is finite, and not absurdly large.
pub(crate) fn finite_figure(word: &str, value: f64) -> Sound {
    ensure(value.abs() <= LARGEST, || format!("the {word} is {value}"))
}

/// A figure is above zero, and not absurdly large.
pub(crate) fn positive(word: &str, value: f64) -> Sound {
    ensure(value > 0.0 && value <= LARGEST, || {
        format!("the {word} is {value}, it must be above 0 and at most 1e9")
    })
}

/// All indices lie below `count`.
pub(crate) fn indices<'a>(word: &str, count: usize, mut of: impl Iterator<Item = &'a u32>) -> Sound {
    match of.find(|&&i| i as usize >= count) {
        Some(i) => Err(format!("{word} names vertex {i} of {count}")),
        None => Ok(()),
    }
}

/// A list is as long as another that runs beside it.
pub(crate) fn length(word: &str, is: usize, should: usize) -> Sound {
    ensure(is == should, || format!("there are {is} {word} for {should} vertices"))
}

/// Something holds.
pub(crate) fn ensure(holds: bool, message: impl FnOnce() -> String) -> Sound {
    if holds { Ok(()) } else { Err(message()) }
}

/// The first two triangles that run along one side in the same way, and what that means: in a
/// sheet, two that share a side run along it in opposite ways.
pub(crate) fn alike(triangles: &[[u32; 3]]) -> Option<([usize; 2], &'static str)> {
    let of = |(i, t): (usize, &[u32; 3])| {
        let t = *t;
        (0..3).map(move |k| ([t[k], t[(k + 1) % 3]], i))
    };
    let all = triangles.iter().enumerate().flat_map(of);
    let mut sides: Vec<([u32; 2], usize)> = all.filter(|([a, b], _)| a != b).collect();
    sides.sort_unstable();
    let pair = sides.windows(2).find(|w| w[0].0 == w[1].0)?;
    let both = [pair[0].1, pair[1].1];
    let [one, other] = both.map(|i| {
        let mut t = triangles[i];
        t.sort_unstable();
        t
    });
    Some((both, if one == other { "are one and the same" } else { "disagree on which side is up" }))
}
