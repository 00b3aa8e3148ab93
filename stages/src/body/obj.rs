//! Vertices and faces of a Wavefront OBJ text; everything else in it is passed over.
//!
//! Faces of more than three corners are cut into fans, which suits the nearly flat quads of bodies.
//! Every fault is an error with its line; no text makes it panic. Cost: one pass.

use super::isosurface::TriMesh;
use toile_core::prelude::*;

/// More vertices than any scanned body has.
const MAX_VERTICES: usize = 4_000_000;

/// Reads an OBJ text.
pub(crate) fn parse(text: &str) -> Result<TriMesh, StageError> {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let result = match words.next() {
            Some("v") => vertex(words).map(|p| points.push(p)),
            Some("f") => face(words, points.len()).map(|f| triangles.extend(fan(&f))),
            _ => Ok(()),
        };
        result.map_err(|why| fault(number + 1, &why))?;
        if points.len() > MAX_VERTICES {
            return Err(fault(number + 1, &format!("there are more than {MAX_VERTICES} vertices")));
        }
    }
    match triangles.is_empty() {
        true => Err(StageError::new(ErrorCode::PatternLoading, "the body's file holds no faces")
            .hint("it must be a Wavefront OBJ with `v` and `f` lines")),
        false => Ok((points, triangles)),
    }
}

fn fault(line: usize, why: &str) -> StageError {
    StageError::new(ErrorCode::PatternLoading, format!("line {line} of the body's file: {why}"))
        .hint("it must be a Wavefront OBJ; write it again from the program that made it")
}

fn vertex<'a>(words: impl Iterator<Item = &'a str>) -> Result<Point3, String> {
    let numbers: Vec<f64> = words.take(3).filter_map(|w| w.parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|n| n.is_finite() && n.abs() < 1e7) => Ok(Point3::new(x, y, z)),
        _ => Err("a vertex wants three numbers".into()),
    }
}

fn face<'a>(words: impl Iterator<Item = &'a str>, count: usize) -> Result<Vec<u32>, String> {
    let corners = words.map(|w| corner(w, count)).collect::<Result<Vec<u32>, String>>()?;
    if corners.len() < 3 { Err("a face wants three corners".into()) } else { Ok(corners) }
}

/// `7`, `7/1`, `7/1/3`, `7//3`; negative numbers count from the last vertex.
fn corner(word: &str, count: usize) -> Result<u32, String> {
    let number = word.split('/').next().and_then(|w| w.parse::<i64>().ok());
    let number = number.ok_or_else(|| format!("\"{}\" is no corner of a face", clip(word)))?;
    let index = if number < 0 { count as i64 + number } else { number - 1 };
    let known = (0..count as i64).contains(&index);
    if known { Ok(index as u32) } else { Err(format!("there is no vertex {number} yet")) }
}

fn clip(word: &str) -> String {
    word.chars().take(20).collect()
}

fn fan(face: &[u32]) -> Vec<[u32; 3]> {
    face.windows(2).skip(1).map(|w| [face[0], w[0], w[1]]).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used)]
    use super::*;
    use proptest::prelude::*;

    const SQUARE: &str = "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3 -1\n";

    #[test]
    fn quads_become_two_triangles() {
        let (points, triangles) = parse(SQUARE).unwrap();
        assert_eq!((points.len(), triangles), (4, vec![[0, 1, 2], [0, 2, 3]]));
    }

    #[test]
    fn faults_name_their_line() {
        let message = |text: &str| parse(text).expect_err("malformed").message;
        assert_eq!(message("v 0 0\n"), "line 1 of the body's file: a vertex wants three numbers");
        assert_eq!(message("v 0 0 NaN\n"), "line 1 of the body's file: a vertex wants three numbers");
        assert_eq!(message("v 0 0 0\nf 1 2 3\n"), "line 2 of the body's file: there is no vertex 2 yet");
        assert_eq!(message("v 0 0 0\nf 1 1\n"), "line 2 of the body's file: a face wants three corners");
        assert_eq!(message("v 0 0 0\nf 1 1 a\n"), "line 2 of the body's file: \"a\" is no corner of a face");
        assert_eq!(message("v 0 0 0\nf 1 0 1\n"), "line 2 of the body's file: there is no vertex 0 yet");
        assert_eq!(message("hello"), "the body's file holds no faces");
    }

    proptest! {
        #[test]
        fn mutated_text_never_panics(
            cuts in prop::collection::vec((0..SQUARE.len(), "[ -~\n]{0,3}"), 1..6),
        ) {
            let mut text = SQUARE.to_owned();
            for (at, with) in cuts {
                let at = at.min(text.len());
                text.replace_range(at..(at + 1).min(text.len()), &with);
            }
            if let Ok((points, triangles)) = parse(&text) {
                prop_assert!(triangles.iter().flatten().all(|&i| (i as usize) < points.len()));
            }
        }
    }
}
