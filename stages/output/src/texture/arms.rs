//! The body without its arms, as a dress form stands in a shop: what hangs beside the trunk is then
//! seen from the side.
//!
//! Each arm is cut across the upper arm by a plane upright on it, and the cut is closed by a fan.
//! Cost: linear in triangles. Limit: the cut must be one loop, as it is on bodies whose arms hang
//! clear of the trunk.

use std::collections::{BTreeMap, VecDeque};
use toile_core::artifact::{Body, Point3, Vector3};
use toile_core::prelude::*;

/// Where the cut lies between the arm's root and the elbow.
const SHARE: f64 = 0.22;

/// The body without its arms.
///
/// Errors: a landmark of an arm is missing; an arm is not found beyond its cut.
pub(super) fn without_arms(body: &Body) -> Result<Body, StageError> {
    let mut rest = body.clone();
    for hand in Hand::BOTH {
        let mark = |name: &str| {
            let missing = || no_arm(&format!("has no landmark `{}`", hand.name(name)));
            body.landmark(name, hand).ok_or_else(missing)
        };
        let root = nalgebra::center(&mark("shoulder")?, &mark("armpit")?);
        let along = (mark("elbow")? - root) * SHARE;
        let normal =
            along.try_normalize(1e-9).ok_or_else(|| no_arm("has elbow and shoulder in one place"))?;
        rest = cut(&rest, root + along, normal, mark("wrist")?)?;
    }
    Ok(rest)
}

fn no_arm(what: &str) -> StageError {
    StageError::invalid(format!("the body {what}, so its arms cannot be left out"))
        .hint("give the body that landmark, or show it whole: `body: Show`")
        .at("body")
}

/// The body without the part beyond a plane that holds the vertex nearest to `within`.
fn cut(body: &Body, at: Point3, normal: Vector3, within: Point3) -> Result<Body, StageError> {
    let beyond: Vec<f64> = body.positions.iter().map(|p| (p - at).dot(&normal)).collect();
    let part = part(body, &beyond, within).ok_or_else(|| no_arm("has no wrist beyond its upper arm"))?;
    let mut kept = Body { triangles: Vec::new(), landmarks: body.landmarks.clone(), ..body.clone() };
    let mut ends = Ends { beyond: &beyond, part: &part, known: BTreeMap::new() };
    let mut rim = Vec::new();
    for t in &body.triangles {
        let gone = t.map(|i| part[i as usize]);
        let Some(first) =
            (0..3).find(|k| !gone[*k] && gone[(k + 2) % 3]).or((gone == [false; 3]).then_some(0))
        else {
            continue;
        };
        // From `first` on, vertices are kept; then come those that are gone.
        let [a, b, c] = [0, 1, 2].map(|k| t[(first + k) % 3]);
        let is_gone = |i: u32| part[i as usize];
        match (is_gone(b), is_gone(c)) {
            (false, false) => kept.triangles.push([a, b, c]),
            (false, true) => {
                let (p, q) = (ends.of(&mut kept, b, c), ends.of(&mut kept, a, c));
                kept.triangles.extend([[a, b, p], [a, p, q]]);
                rim.push([p, q]);
            }
            (true, _) => {
                let (p, q) = (ends.of(&mut kept, a, b), ends.of(&mut kept, a, c));
                kept.triangles.push([a, p, q]);
                rim.push([p, q]);
            }
        }
    }
    close(&mut kept, &rim);
    Ok(compact(kept))
}

/// The vertices beyond the plane that are joined to the one nearest to a point.
fn part(body: &Body, beyond: &[f64], within: Point3) -> Option<Vec<bool>> {
    let distance = |i: &usize| (body.positions[*i] - within).norm_squared();
    let seed =
        (0..beyond.len()).filter(|i| beyond[*i] > 0.0).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let mut next: Vec<Vec<u32>> = vec![Vec::new(); beyond.len()];
    for t in &body.triangles {
        (0..3).for_each(|k| next[t[k] as usize].extend([t[(k + 1) % 3], t[(k + 2) % 3]]));
    }
    let mut part = vec![false; beyond.len()];
    let mut open = VecDeque::from([seed]);
    part[seed] = true;
    while let Some(i) = open.pop_front() {
        for &j in &next[i] {
            if beyond[j as usize] > 0.0 && !part[j as usize] {
                part[j as usize] = true;
                open.push_back(j as usize);
            }
        }
    }
    Some(part)
}

/// New vertices where edges meet the plane, each made once.
struct Ends<'a> {
    beyond: &'a [f64],
    part: &'a [bool],
    known: BTreeMap<[u32; 2], u32>,
}

impl Ends<'_> {
    fn of(&mut self, body: &mut Body, kept: u32, gone: u32) -> u32 {
        debug_assert!(self.part[gone as usize] && !self.part[kept as usize]);
        let share = |i: u32| self.beyond[i as usize];
        *self.known.entry([kept, gone]).or_insert_with(|| {
            let t = (share(kept) / (share(kept) - share(gone))).clamp(0.0, 1.0);
            let (a, b) = (body.positions[kept as usize], body.positions[gone as usize]);
            body.positions.push(a + (b - a) * t);
            body.positions.len() as u32 - 1
        })
    }
}

/// Closes a loop by a fan around its middle; its corners are made anew, so that light turns sharply
/// there.
fn close(body: &mut Body, rim: &[[u32; 2]]) {
    let mut own: BTreeMap<u32, u32> = BTreeMap::new();
    for i in rim.iter().flatten() {
        own.entry(*i).or_insert_with(|| {
            body.positions.push(body.positions[*i as usize]);
            body.positions.len() as u32 - 1
        });
    }
    let sum: Vector3 = own.values().map(|i| body.positions[*i as usize].coords).sum();
    let middle = body.positions.len() as u32;
    body.positions.push(Point3::from(sum / own.len().max(1) as f64));
    // The kept side runs from p to q along the cut; the fan runs back.
    body.triangles.extend(rim.iter().map(|[p, q]| [own[q], own[p], middle]));
}

/// The body without vertices that no triangle has.
fn compact(mut body: Body) -> Body {
    let mut place = vec![u32::MAX; body.positions.len()];
    let mut positions = Vec::new();
    for i in body.triangles.iter_mut().flatten() {
        let at = &mut place[*i as usize];
        if *at == u32::MAX {
            *at = positions.len() as u32;
            positions.push(body.positions[*i as usize]);
        }
        *i = *at;
    }
    body.positions = positions;
    body
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use toile_body::Mannequin;
    use toile_core::Context;

    fn mannequin() -> Body {
        Mannequin::default().run(&Context::quiet()).unwrap()
    }

    #[test]
    fn the_trunk_stays_and_is_closed() {
        let (whole, rest) = (mannequin(), without_arms(&mannequin()).unwrap());
        let widest = |b: &Body| b.positions.iter().fold(0.0_f64, |x, p| x.max(p.x.abs()));
        assert!(widest(&whole) > 0.5 && widest(&rest) < 0.3, "{}", widest(&rest));
        // Closed: the volume does not hang on where it is taken from.
        let moved = Body {
            positions: rest.positions.iter().map(|p| p + Vector3::new(5.0, 7.0, 9.0)).collect(),
            ..rest.clone()
        };
        assert!((moved.volume() - rest.volume()).abs() < 1e-9);
        assert!(rest.volume() < whole.volume() && rest.volume() > 0.85 * whole.volume());
    }

    #[test]
    fn a_body_without_landmarks_is_refused() {
        let bare = Body { landmarks: BTreeMap::new(), ..mannequin() };
        let told = without_arms(&bare).unwrap_err();
        assert_eq!(told.message, "the body has no landmark `shoulder_left`, so its arms cannot be left out");
        assert_eq!(told.hint.unwrap(), "give the body that landmark, or show it whole: `body: Show`");
    }
}
