//! The meshes of a 3D file as they stand there, for what judges them: nothing is mended.
//!
//! Of a file of this program the body is recognised by its name; strips along edges and turned
//! copies of the cloth are left out. Of other files what is closed all around beside open cloth is
//! no cloth: the largest such part is the body where it is as large as one.

use super::chosen::cloth_of_ours;
use super::closed::{Whole, wholes};
use super::raw::{NO_POINT, RawMesh};
use super::upright::lies;
use super::{read_glb, read_obj};
use crate::render::parts::BODY;
use std::ops::RangeInclusive;
use toile_core::prelude::*;

/// Vertices within this are one where closed parts are looked for, metres.
const JOIN: f64 = 1e-5;

/// A closed part is a body from this diagonal on, metres.
const BODY_SIZE: f64 = 0.5;

/// The diagonals that garments have in their right unit, metres.
pub(in crate::flat) const GARMENT_SIZES: RangeInclusive<f64> = 0.05..=6.0;

/// Units of OBJ files, metres, in the order in which they are tried.
const UNITS: [f64; 4] = [1.0, 0.01, 0.001, 0.1];

/// What a 3D file holds.
#[derive(Debug, Clone, Default)]
pub struct FileMeshes {
    /// Places of all vertices, metres.
    pub positions: Vec<Point3>,
    /// Triangles of the cloth, in the order of the file.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle of the cloth the texture points of its corners, v up, in the file's unit;
    /// none where it has none.
    pub texture: Vec<Option<[Point2; 3]>>,
    /// For each triangle of the cloth its group, object or node, by `names`.
    pub groups: Vec<u32>,
    /// For each triangle of the cloth its material, by `material_names`.
    pub materials: Vec<u32>,
    /// Names of the groups; may be empty texts.
    pub names: Vec<String>,
    /// Names of the materials; may be empty texts.
    pub material_names: Vec<String>,
    /// Triangles of the body; empty where the file holds none.
    pub body: Vec<[u32; 3]>,
    /// Whether this program wrote the file.
    pub is_ours: bool,
    /// Whether the cloth seems to lie, as where the file has another axis up than y.
    pub lies: bool,
    /// What was decided on the way, a sentence each.
    pub notes: Vec<String>,
}

/// Reads a GLB (by its first bytes or its name) or an OBJ file; `unit` is what one of its numbers
/// is in metres, guessed for an OBJ where it is not given: that in which its diagonal is 5 cm to
/// 6 m.
///
/// # Errors
/// The file cannot be read, or no unit makes it as large as a garment.
pub fn file_meshes(bytes: &[u8], file: &str, unit: Option<f64>) -> Result<FileMeshes, StageError> {
    let is_glb = file.to_ascii_lowercase().ends_with(".glb") || bytes.starts_with(b"glTF");
    let mut raw = if is_glb { read_glb(bytes, file) } else { read_obj(bytes, file) }?;
    let mut notes = Vec::new();
    let unit = match unit {
        Some(unit) => unit,
        None if is_glb || raw.is_ours => 1.0,
        None => guessed(&raw, file, &mut notes)?,
    };
    raw.positions.iter_mut().for_each(|p| *p *= unit);
    let body = match raw.is_ours {
        true => own_body(&mut raw, file, &mut notes),
        false => closed_parts(&mut raw, &mut notes),
    };
    let lies = !raw.is_ours && lies(&raw);
    let corner = |c: &[u32; 3]| (!c.contains(&NO_POINT)).then(|| c.map(|i| raw.uv[i as usize]));
    Ok(FileMeshes {
        texture: raw.corners.iter().map(corner).collect(),
        positions: raw.positions,
        triangles: raw.triangles,
        groups: raw.groups,
        materials: raw.materials,
        names: raw.group_names,
        material_names: raw.material_names,
        body,
        is_ours: raw.is_ours,
        lies,
        notes,
    })
}

fn guessed(raw: &RawMesh, file: &str, notes: &mut Vec<String>) -> Result<f64, StageError> {
    let used = || raw.triangles.iter().flatten().map(|&v| raw.positions[v as usize]);
    let Some(first) = used().next() else { return Ok(1.0) };
    let (lo, hi) = used().fold((first, first), |(lo, hi), p| (lo.inf(&p), hi.sup(&p)));
    let size = (hi - lo).norm();
    let fits = |u: &&f64| GARMENT_SIZES.contains(&(size * **u));
    let Some(unit) = UNITS.iter().find(fits) else {
        let what = format!("\"{file}\": no unit makes its {size:.4} from corner to corner a garment");
        return Err(StageError::invalid(what)
            .hint("garments are 5 cm to 6 m from corner to corner; state the unit with `--unit`"));
    };
    if *unit != 1.0 {
        notes.push(format!("\"{file}\": its numbers are taken as {} mm each", unit * 1e3));
    }
    Ok(*unit)
}

/// Removes from a file of this program the body and other meshes that are no cloth.
fn own_body(raw: &mut RawMesh, file: &str, notes: &mut Vec<String>) -> Vec<[u32; 3]> {
    let is_body = |g: &u32| raw.group_names.get(*g as usize).is_some_and(|n| n == BODY);
    let has_cloth = raw.groups.iter().any(|g| !is_body(g));
    let body = raw.triangles.iter().zip(&raw.groups).filter(|(_, g)| is_body(g) && has_cloth);
    let body = body.map(|(t, _)| *t).collect();
    let cx = Context::quiet();
    cloth_of_ours(raw, file, &cx);
    notes.extend(cx.take_remarks().notes);
    body
}

/// Takes off what is closed all around beside open cloth; gives the body among it.
fn closed_parts(raw: &mut RawMesh, notes: &mut Vec<String>) -> Vec<[u32; 3]> {
    let mended = raw.clone().mended(JOIN);
    let all = wholes(&mended.mesh);
    let (closed, open): (Vec<&Whole>, Vec<&Whole>) = all.iter().partition(|w| w.is_closed());
    if open.is_empty() || closed.is_empty() {
        return Vec::new();
    }
    let number = |t: &u32| mended.numbers[*t as usize] as usize;
    let mut is_closed = vec![false; raw.positions.len()];
    let of_closed = closed.iter().flat_map(|w| &w.triangles).flat_map(|t| raw.triangles[number(t)]);
    of_closed.for_each(|v| is_closed[v as usize] = true);
    // Triangles of closed parts that have no area go with them.
    let is_kept: Vec<bool> =
        raw.triangles.iter().map(|t| !t.iter().any(|v| is_closed[*v as usize])).collect();
    let largest = closed.iter().copied().reduce(|a, b| if b.size > a.size { b } else { a });
    let body = largest.filter(|w| w.size >= BODY_SIZE);
    let taken = body.map(|w| w.triangles.iter().map(|t| raw.triangles[number(t)]).collect());
    match body {
        Some(w) => notes.push(format!("\"{}\" is closed all around and taken as the body", w.name)),
        None => notes.push(format!("{} closed parts are left out of the garment", closed.len())),
    }
    raw.keep(&is_kept);
    taken.unwrap_or_default()
}
