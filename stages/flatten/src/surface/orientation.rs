//! Turning triangles until all run the same way.
//!
//! From a first triangle over the edges: a neighbour that walks the common edge in the same
//! direction is turned. Where that turns more than half, the others are turned instead, so the
//! majority's right side stays the right side.

use super::edges::{FREE, ends};
use crate::error::SurfaceError;

#[derive(Clone, Copy, PartialEq)]
enum TriangleTurn {
    Unknown,
    Keep,
    Flip,
}

/// Makes the triangles of a connected mesh agree; returns how many were turned.
///
/// # Errors
/// [`SurfaceError::NotOrientable`] for a surface with one side.
pub(super) fn orient(triangles: &mut [[u32; 3]], opposite: &mut [u32]) -> Result<usize, SurfaceError> {
    let component = vec![0; triangles.len()];
    Ok(orient_all(triangles, opposite, &component)?.into_iter().sum())
}

/// Makes the triangles of each component agree; returns how many were turned in each.
///
/// # Errors
/// As [`orient`].
pub(crate) fn orient_all(
    triangles: &mut [[u32; 3]],
    opposite: &mut [u32],
    component: &[u32],
) -> Result<Vec<usize>, SurfaceError> {
    let mut turns = find_turns(triangles, opposite)?;
    let count = component.iter().max().map_or(0, |&c| c as usize + 1);
    let (mut sizes, mut turned) = (vec![0; count], vec![0; count]);
    for (&c, turn) in component.iter().zip(&turns) {
        sizes[c as usize] += 1;
        turned[c as usize] += usize::from(*turn == TriangleTurn::Flip);
    }
    let minority = |c: u32| 2 * turned[c as usize] <= sizes[c as usize];
    for (&c, turn) in component.iter().zip(&mut turns) {
        if !minority(c) {
            *turn = if *turn == TriangleTurn::Flip { TriangleTurn::Keep } else { TriangleTurn::Flip };
        }
    }
    if turns.contains(&TriangleTurn::Flip) {
        turn(triangles, opposite, &turns);
    }
    Ok((0..count).map(|c| turned[c].min(sizes[c] - turned[c])).collect())
}

fn find_turns(triangles: &[[u32; 3]], opposite: &[u32]) -> Result<Vec<TriangleTurn>, SurfaceError> {
    let mut turns = vec![TriangleTurn::Unknown; triangles.len()];
    for seed in 0..triangles.len() {
        if turns[seed] == TriangleTurn::Unknown {
            turns[seed] = TriangleTurn::Keep;
            turn_neighbours(triangles, opposite, &mut turns, seed)?;
        }
    }
    Ok(turns)
}

/// Decides about all triangles that hang together with `seed`.
fn turn_neighbours(
    triangles: &[[u32; 3]],
    opposite: &[u32],
    turns: &mut [TriangleTurn],
    seed: usize,
) -> Result<(), SurfaceError> {
    let mut waiting = vec![seed];
    while let Some(t) = waiting.pop() {
        for (h, &o) in (3 * t..).zip(&opposite[3 * t..3 * t + 3]) {
            if o == FREE {
                continue;
            }
            let agree = ends(triangles, h as u32)[0] != ends(triangles, o)[0];
            let wanted = if agree == (turns[t] == TriangleTurn::Keep) {
                TriangleTurn::Keep
            } else {
                TriangleTurn::Flip
            };
            let other = o as usize / 3;
            if turns[other] == TriangleTurn::Unknown {
                turns[other] = wanted;
                waiting.push(other);
            } else if turns[other] != wanted {
                return Err(SurfaceError::NotOrientable { triangle: other });
            }
        }
    }
    Ok(())
}

/// Turns the triangles that are marked.
pub(crate) fn turn_marked(triangles: &mut [[u32; 3]], opposite: &mut [u32], marked: &[bool]) {
    let turns: Vec<TriangleTurn> =
        marked.iter().map(|&m| if m { TriangleTurn::Flip } else { TriangleTurn::Keep }).collect();
    turn(triangles, opposite, &turns);
}

/// Swaps the last two corners of the triangles to turn; their half-edges 0 and 2 change places.
fn turn(triangles: &mut [[u32; 3]], opposite: &mut [u32], turns: &[TriangleTurn]) {
    let moved = |h: u32| {
        let (t, k) = (h / 3, h % 3);
        if h != FREE && turns[t as usize] == TriangleTurn::Flip { 3 * t + 2 - k } else { h }
    };
    let old = opposite.to_vec();
    for (h, &o) in old.iter().enumerate() {
        opposite[moved(h as u32) as usize] = if o == FREE { FREE } else { moved(o) };
    }
    for (corners, turn) in triangles.iter_mut().zip(turns) {
        if *turn == TriangleTurn::Flip {
            corners.swap(1, 2);
        }
    }
}
