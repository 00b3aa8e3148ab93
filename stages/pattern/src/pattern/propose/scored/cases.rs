//! Patterns whose seams are known, made to look like those of a CAD file.

use super::super::super::garment_code;
use std::path::Path;
use toile_core::prelude::*;

/// A pattern as a CAD file has it, and its seams.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) pieces: Vec<Piece>,
    pub(super) seams: Vec<PatternSeam>,
    /// What the pieces were called.
    names: Vec<String>,
}

/// Whether a file is in the half by which the method is tuned, by the number of a random garment or
/// the letters of a name.
pub(super) fn is_tuned(name: &str) -> bool {
    name.bytes().map(usize::from).sum::<usize>() % 2 == 0
}

/// The files of `TOILE_SHARED`, none where that is not set.
pub(super) fn cases() -> Option<Vec<Case>> {
    let shared = std::env::var_os("TOILE_SHARED")?;
    let folder = Path::new(&shared).join("data/patterns");
    let mut out = Vec::new();
    for part in ["garmentcode", "garmentcode_random", "gpg_templates"] {
        let files = std::fs::read_dir(folder.join(part)).unwrap();
        let mut files: Vec<_> = files.map(|f| f.unwrap().path()).collect();
        files.sort();
        for file in files.iter().filter(|f| f.extension().is_some_and(|e| e == "json")) {
            let name = file.file_stem().unwrap().to_string_lossy().into_owned();
            let name = name.strip_suffix("_specification").unwrap_or(&name).to_owned();
            // A commented template is no JSON.
            if let Some(pattern) = garment_code::sewn(&std::fs::read(file).unwrap(), &name) {
                out.push(disguised(&pattern));
            }
        }
    }
    Some(out)
}

/// Numbers by lot.
pub(super) struct Lot(u64);

impl Lot {
    /// The lot of a name, the same each time.
    pub(super) fn of(name: &str) -> Self {
        Lot(name.bytes().fold(7, |h, b| (h * 31 + u64::from(b)) % 1_000_003))
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }
}

/// A pattern without what a CAD file does not have.
fn disguised(pattern: &Pattern) -> Case {
    let mut lot = Lot::of(&pattern.name);
    let mut order: Vec<usize> = (0..pattern.pieces.len()).collect();
    (1..order.len()).rev().for_each(|i| order.swap(i, lot.below(i + 1)));
    let mut pieces = Vec::new();
    let mut names = Vec::new();
    for &i in &order {
        let p = &pattern.pieces[i];
        names.push(p.name.clone());
        pieces.push(plain(p, &format!("P{}", pieces.len() + 1), lot.below(p.outer.edges.len())));
    }
    let renamed = |u: &EdgeUse| {
        let i = names.iter().position(|n| *n == u.edge.panel).unwrap();
        let (old, new) = (&pattern.pieces[order[i]], &pieces[i]);
        let n = new.outer.edges.len();
        let corner = old.outer.corners[old.edge_number(&u.edge.edge).unwrap()];
        let turn = turned_up(old);
        let near = |k: &usize| (new.outer.corners[*k] - turn(corner)).norm();
        let k = (0..n).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
        EdgeUse {
            edge: EdgeRef { panel: new.name.clone(), edge: new.outer.edges[k].name.clone() },
            reversed: u.reversed,
        }
    };
    let seams = pattern.seams.iter().map(|s| PatternSeam {
        sides: s.sides.iter().map(|side| side.iter().map(renamed).collect()).collect(),
        ..s.clone()
    });
    let seams = seams.collect();
    Case { name: pattern.name.clone(), pieces, seams, names }
}

/// The turn by right angles that brings the grain up: along the body, and along the arm.
fn turned_up(p: &Piece) -> impl Fn(Point2) -> Point2 + Copy {
    let arm = ["sleeve", "cuff"].iter().any(|w| p.name.contains(w)) && !p.name.contains("pant");
    let way = p.pose.map_or(Vector2::y(), |pose| {
        let middle = p.outer.corners.iter().map(|c| c.coords).sum::<Vector2>() / p.outer.corners.len() as f64;
        let side = -pose.at(middle.into()).x.signum();
        let up = if arm { Vector3::new(side, 0.6, 0.0) } else { Vector3::y() };
        Vector2::new(pose.across.dot(&up), pose.along.dot(&up))
    });
    // The rotation that turns that way up.
    let [c, s] = match way.x.abs() > way.y.abs() {
        true if way.x > 0.0 => [0.0, 1.0],
        true => [0.0, -1.0],
        false if way.y < 0.0 => [-1.0, 0.0],
        false => [1.0, 0.0],
    };
    move |q: Point2| Point2::new(c * q.x - s * q.y, s * q.x + c * q.y)
}

/// The outline alone, its edges numbered from another one on.
fn plain(p: &Piece, name: &str, first: usize) -> Piece {
    let turn = turned_up(p);
    let n = p.outer.edges.len();
    let at = |k: usize| (k + first) % n;
    let edge = |k: usize| PieceEdge {
        name: format!("edge_{k}"),
        curve: p.outer.edges[at(k)].curve.moved(turn, false),
    };
    Piece {
        name: name.to_owned(),
        outer: PatternLoop {
            corners: (0..n).map(|k| turn(p.outer.corners[at(k)])).collect(),
            edges: (0..n).map(edge).collect(),
        },
        holes: Vec::new(),
        lines: Vec::new(),
        notches: Vec::new(),
        drill_holes: Vec::new(),
        grain: None,
        body_part: None,
        pose: None,
        layer: 0,
    }
}

impl Case {
    fn called(&self, u: &EdgeUse) -> &str {
        let i = self.pieces.iter().position(|p| p.name == u.edge.panel);
        i.map_or("", |i| self.names[i].as_str())
    }

    /// A seam by what its pieces were called.
    pub(super) fn words(&self, seam: &PatternSeam) -> String {
        let side = |s: &Vec<EdgeUse>| {
            let one = |u: &EdgeUse| format!("{}.{}", self.called(u), u.edge.edge);
            let length = |u: &EdgeUse| {
                let p = self.pieces.iter().find(|p| p.name == u.edge.panel);
                p.and_then(|p| p.path(&u.edge.edge)).map_or(0.0, |e| e.length() * 1e3)
            };
            let all = s.iter().map(|u| format!("{} {:.0}", one(u), length(u)));
            all.collect::<Vec<_>>().join(" ")
        };
        seam.sides.iter().map(side).collect::<Vec<_>>().join(" + ")
    }

    /// What a tailor calls a seam, by what its pieces were called.
    pub(super) fn kind(&self, seam: &PatternSeam) -> &'static str {
        let [a, b] = [0, 1].map(|s| self.called(&seam.sides[s][0]));
        let has = |words: &[&str]| [a, b].map(|n| words.iter().any(|w| n.contains(w)));
        let one_of = |words: &[&str]| has(words)[0] != has(words)[1];
        if seam.kind == SeamKind::Dart {
            "dart"
        } else if one_of(&["cuff"]) {
            "cuff"
        } else if one_of(&["collar", "hood"]) {
            "collar"
        } else if one_of(&["sleeve"]) {
            "armhole"
        } else if one_of(&["wb_"]) || one_of(&["torso", "top_", "up_"]) {
            "waist"
        } else if has(&["torso", "top_", "up_", "front", "back"]) == [true, true] && self.is_high(seam) {
            "shoulder"
        } else {
            "side"
        }
    }

    /// Whether both sides look up, as those of a shoulder do.
    fn is_high(&self, seam: &PatternSeam) -> bool {
        seam.sides.iter().all(|s| {
            let p = self.pieces.iter().find(|p| p.name == s[0].edge.panel);
            let path = p.and_then(|p| p.path(&s[0].edge.edge));
            // The inside lies to the left of an edge.
            path.is_some_and(|e| (e.at(e.length()).x - e.at(0.0).x) < -0.6 * e.length())
        })
    }
}
