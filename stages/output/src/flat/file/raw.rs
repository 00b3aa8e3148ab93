//! The mesh of a 3D file as it stands there, before it is cut into pieces, and its repair.
//!
//! Vertices at one place are joined, triangles without area and triangles that repeat others go;
//! each is counted. What the file says of texture points, groups and materials stays with its
//! triangle. Cost: O(n log n).

use super::raw_words::tell;
use std::collections::BTreeSet;
use toile_core::prelude::*;
use toile_flatten::islands::weld_places;
use toile_flatten::surface::LEAST_QUALITY;

/// What a file holds.
#[derive(Debug, Clone, Default)]
pub(in crate::flat) struct RawMesh {
    /// Places, metres, y up.
    pub(in crate::flat) positions: Vec<Point3>,
    /// Triangles.
    pub(in crate::flat) triangles: Vec<[u32; 3]>,
    /// Texture points, in the file's unit.
    pub(in crate::flat) uv: Vec<Point2>,
    /// For each corner of each triangle its texture point; [`NO_POINT`] where it has none.
    pub(in crate::flat) corners: Vec<[u32; 3]>,
    /// For each triangle its group.
    pub(in crate::flat) groups: Vec<u32>,
    /// For each triangle its material.
    pub(in crate::flat) materials: Vec<u32>,
    /// Names of groups; may be empty texts.
    pub(in crate::flat) group_names: Vec<String>,
    /// Names of materials; may be empty texts.
    pub(in crate::flat) material_names: Vec<String>,
    /// Marked edges, by vertices.
    pub(in crate::flat) lines: Vec<[u32; 2]>,
    /// Whether this program wrote the file.
    pub(in crate::flat) is_ours: bool,
    /// Whether panels of a file of ours share no vertices, so that what shares some is one piece.
    pub(in crate::flat) has_own_vertices: bool,
}

/// A corner without a texture point.
pub(in crate::flat) const NO_POINT: u32 = u32::MAX;

/// A mesh whose vertices are joined and whose triangles have area.
#[derive(Debug, Clone)]
pub(in crate::flat) struct Mended {
    /// The mesh; its corners name joined vertices.
    pub(in crate::flat) mesh: RawMesh,
    /// The triangles by the file's own vertices.
    pub(in crate::flat) own: Vec<[u32; 3]>,
    /// For each triangle its number in the file.
    pub(in crate::flat) numbers: Vec<u32>,
    /// What was done.
    pub(in crate::flat) repairs: GarmentRepairs,
}

/// What was mended, in numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(in crate::flat) struct GarmentRepairs {
    /// Vertices that were joined to others at their places.
    pub(in crate::flat) joined: usize,
    /// Triangles without area.
    pub(in crate::flat) without_area: usize,
    /// Triangles that repeat others.
    pub(in crate::flat) twice: usize,
    /// Edges of three triangles or more of one piece, where it was cut.
    pub(in crate::flat) cut: usize,
    /// Triangles turned to agree with their neighbours.
    pub(in crate::flat) turned: usize,
}

impl GarmentRepairs {
    /// Damage in words, none where there was none; joined vertices are no damage, since most
    /// programs split them along seams.
    pub(in crate::flat) fn words(&self) -> Option<String> {
        let all = [
            tell(self.without_area, "triangle without area is removed", "triangles without area are removed"),
            tell(
                self.twice,
                "triangle that is listed twice is removed",
                "triangles that are listed twice are removed",
            ),
            tell(
                self.cut,
                "edge of three triangles or more is cut",
                "edges of three triangles or more are cut",
            ),
            tell(
                self.turned,
                "triangle is turned to face as its neighbours",
                "triangles are turned to face as their neighbours",
            ),
        ];
        let told: Vec<String> = all.into_iter().flatten().collect();
        (!told.is_empty()).then(|| told.join(", "))
    }

    /// Hands the counts to the run's record.
    pub(in crate::flat) fn count(&self, cx: &Context) {
        let counts = [
            ("joined_vertices", self.joined),
            ("triangles_without_area", self.without_area),
            ("doubled_triangles", self.twice),
            ("cut_edges", self.cut),
            ("turned_triangles", self.turned),
        ];
        counts.into_iter().for_each(|(name, n)| cx.figure(name, n as f64, ""));
    }
}

impl RawMesh {
    /// Drops the triangles that are not kept.
    pub(in crate::flat) fn keep(&mut self, is_kept: &[bool]) {
        retain(&mut self.triangles, is_kept);
        retain(&mut self.corners, is_kept);
        retain(&mut self.groups, is_kept);
        retain(&mut self.materials, is_kept);
    }

    /// What the group of a triangle is called, else its material; may be empty.
    pub(in crate::flat) fn called(&self, triangle: usize) -> &str {
        let of = |list: &[u32]| list.get(triangle).map_or(usize::MAX, |k| *k as usize);
        let group = self.group_names.get(of(&self.groups)).map_or("", |n| n.trim());
        match group {
            "" => self.material_names.get(of(&self.materials)).map_or("", |n| n.trim()),
            group => group,
        }
    }

    /// Joins vertices within `reach` metres and drops triangles that are none.
    pub(in crate::flat) fn mended(mut self, reach: f64) -> Mended {
        let first = weld_places(&self.positions, reach);
        let mut used = vec![false; first.len()];
        self.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        let joined = (0..first.len()).filter(|&v| used[v] && first[v] as usize != v).count();
        let mut repairs = GarmentRepairs { joined, ..GarmentRepairs::default() };
        let own = std::mem::take(&mut self.triangles);
        let welded: Vec<[u32; 3]> = own.iter().map(|t| t.map(|v| first[v as usize])).collect();
        let kept = self.kept(&welded, &mut repairs);
        let pick = |list: &[u32]| kept.iter().map(|&t| list[t as usize]).collect();
        let mesh = RawMesh {
            triangles: kept.iter().map(|&t| welded[t as usize]).collect(),
            corners: kept.iter().map(|&t| self.corners[t as usize]).collect(),
            groups: pick(&self.groups),
            materials: pick(&self.materials),
            lines: self.lines.iter().map(|l| l.map(|v| first[v as usize])).collect(),
            ..self
        };
        Mended { own: kept.iter().map(|&t| own[t as usize]).collect(), mesh, numbers: kept, repairs }
    }

    /// Triangles with area, the first of those that name the same vertices.
    fn kept(&self, welded: &[[u32; 3]], repairs: &mut GarmentRepairs) -> Vec<u32> {
        let mut seen = BTreeSet::new();
        let mut kept = Vec::with_capacity(welded.len());
        for (t, corners) in welded.iter().enumerate() {
            let mut key = *corners;
            key.sort_unstable();
            if quality(corners.map(|v| self.positions[v as usize])) <= LEAST_QUALITY {
                repairs.without_area += 1;
            } else if seen.insert(key) {
                kept.push(t as u32);
            } else {
                repairs.twice += 1;
            }
        }
        kept
    }
}

impl Mended {
    /// Drops the triangles that are not kept.
    pub(in crate::flat) fn keep(&mut self, is_kept: &[bool]) {
        self.mesh.keep(is_kept);
        retain(&mut self.own, is_kept);
        retain(&mut self.numbers, is_kept);
    }
}

fn retain<T>(list: &mut Vec<T>, is_kept: &[bool]) {
    let mut kept = is_kept.iter();
    list.retain(|_| kept.next().copied().unwrap_or(true));
}

/// Height over the longest edge; 0 for a triangle without edges.
fn quality([a, b, c]: [Point3; 3]) -> f64 {
    let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    if longest > 0.0 { (b - a).cross(&(c - a)).norm() / longest } else { 0.0 }
}
