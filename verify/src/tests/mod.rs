//! Constructed truths: a skirt of two panels around a body, damaged in known ways.
#![allow(clippy::unwrap_used)]

mod damages;
mod reading;
mod rest;
mod same;
mod schema;
mod truths;

use crate::files::{subject, wearer};
use crate::subject::{Subject, WearerBody};
use crate::{CheckLimits, FigureCheck, Judgement, Verdict, judge};
use std::f64::consts::PI;
use toile_core::artifact::{
    EdgeCurve, EdgeRef, EdgeUse, Pattern, PatternLoop, PatternSeam, Piece, PieceEdge, Point2, Point3,
    SeamKind,
};
use toile_output::flat::FileMeshes;

/// The skirt's radius, height and hem, metres.
const RADIUS: f64 = 0.2;
const HEIGHT: f64 = 0.5;
const HEM: f64 = 0.6;
/// The radius of the body.
const BODY: f64 = 0.15;

/// A skirt of two half cylinders, `columns` by `rows` cells each, sewn at both sides: as a file
/// holds it, with texture points in metres.
#[derive(Clone)]
struct Skirt {
    columns: usize,
    rows: usize,
    meshes: FileMeshes,
}

impl Skirt {
    fn new(columns: usize, rows: usize) -> Self {
        let mut meshes = FileMeshes { names: vec!["front".into(), "back".into()], ..FileMeshes::default() };
        let (step, height) = (width(columns) / columns as f64, HEIGHT / rows as f64);
        for panel in 0..2 {
            let first = meshes.positions.len() as u32;
            let at = |c: usize, r: usize| first + (r * (columns + 1) + c) as u32;
            for r in 0..=rows {
                for c in 0..=columns {
                    // Both panels take the places of their shared sides from one sum.
                    let turn = (panel * columns + c) % (2 * columns);
                    let angle = -PI + PI * turn as f64 / columns as f64;
                    let y = HEM + height * r as f64;
                    meshes.positions.push(Point3::new(RADIUS * angle.cos(), y, -RADIUS * angle.sin()));
                }
            }
            // The back lies to the right of the front in the texture.
            let flat = |c: usize, r: usize| {
                Point2::new(2.0 * panel as f64 * width(columns) + step * c as f64, height * r as f64)
            };
            for r in 0..rows {
                for c in 0..columns {
                    for cell in [[(c, r), (c + 1, r), (c + 1, r + 1)], [(c, r), (c + 1, r + 1), (c, r + 1)]] {
                        meshes.triangles.push(cell.map(|(c, r)| at(c, r)));
                        meshes.texture.push(Some(cell.map(|(c, r)| flat(c, r))));
                        meshes.groups.push(panel as u32);
                        meshes.materials.push(0);
                    }
                }
            }
        }
        Skirt { columns, rows, meshes }
    }

    /// The vertex of a panel.
    fn at(&self, panel: usize, column: usize, row: usize) -> usize {
        panel * (self.columns + 1) * (self.rows + 1) + row * (self.columns + 1) + column
    }

    fn subject(&self, pattern: Option<&Pattern>, body: Result<WearerBody, String>) -> Subject {
        subject(&self.meshes, None, None, pattern, body)
    }

    fn judged(&self) -> Judgement {
        let pattern = pattern(self.columns);
        judge(&self.subject(Some(&pattern), Ok(post())), &CheckLimits::default())
    }
}

/// The flat width of a panel: chords, so that a sound skirt is not strained.
fn width(columns: usize) -> f64 {
    columns as f64 * 2.0 * RADIUS * (PI / (2.0 * columns as f64)).sin()
}

/// Two rectangles, sewn right to left.
fn pattern(columns: usize) -> Pattern {
    let piece = |name: &str| {
        let (w, h) = (width(columns), HEIGHT);
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(x, y)| Point2::new(x, y)).to_vec();
        let edge = |name: &&str| PieceEdge { name: (*name).into(), curve: EdgeCurve::Line };
        let edges = ["hem", "right", "waist", "left"].iter().map(edge).collect();
        Piece { name: name.into(), outer: PatternLoop { corners, edges }, ..Piece::default() }
    };
    let side = |panel: &str, edge: &str, reversed: bool| {
        vec![EdgeUse { edge: EdgeRef { panel: panel.into(), edge: edge.into() }, reversed }]
    };
    let seam = |one: &str, other: &str| PatternSeam {
        name: format!("{one}.right + {other}.left"),
        kind: SeamKind::Matched,
        sides: vec![side(one, "right", false), side(other, "left", true)],
    };
    Pattern {
        name: "skirt".into(),
        pieces: vec![piece("front"), piece("back")],
        seams: vec![seam("front", "back"), seam("back", "front")],
    }
}

/// A closed post of sixteen sides that stands in the skirt.
fn post() -> WearerBody {
    let sides = 16_u32;
    let mut places = Vec::new();
    for y in [0.0, 1.7] {
        places.extend((0..sides).map(|k| {
            let angle = 2.0 * PI * f64::from(k) / f64::from(sides);
            Point3::new(BODY * angle.cos(), y, -BODY * angle.sin())
        }));
    }
    places.extend([Point3::new(0.0, 0.0, 0.0), Point3::new(0.0, 1.7, 0.0)]);
    let mut triangles = Vec::new();
    for k in 0..sides {
        let next = (k + 1) % sides;
        triangles.extend([[k, next, sides + next], [k, sides + next, sides + k]]);
        triangles.extend([[2 * sides, next, k], [2 * sides + 1, sides + k, sides + next]]);
    }
    wearer(&places, &triangles)
}

fn check<'j>(found: &'j Judgement, name: &str) -> &'j FigureCheck {
    found.check(name).unwrap()
}

fn failing(found: &Judgement) -> Vec<&'static str> {
    found.checks.iter().filter(|c| c.verdict == Verdict::Fails).map(|c| c.name).collect()
}
