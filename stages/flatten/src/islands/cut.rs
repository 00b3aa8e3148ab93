//! Cutting: corners that stay together become vertices, triangles that hang together become pieces.

use super::facing::inside_out;
use super::seams::find_seams;
use super::{SurfacePiece, SurfacePieces};
use crate::error::SurfaceError;
use crate::surface::{
    FREE, OppositeEdges, PieceSurface, check, component_count, components, corner_vertices, edge_key,
    orient_all, sorted_edges, turn_marked,
};
use nalgebra::Point3;

/// The connected components of a mesh, cut nowhere.
///
/// # Errors
/// The faults of [`PieceSurface::new`] but a second component.
pub fn split_components(
    positions: &[Point3<f64>],
    triangles: &[[u32; 3]],
) -> Result<SurfacePieces, SurfaceError> {
    islands_by_group(positions, triangles, &vec![0; triangles.len()])
}

/// Cuts where the two sides of an edge have different UV indices; `uv` has three a triangle, as
/// OBJ's `f v/vt`.
///
/// # Errors
/// [`SurfaceError::LengthMismatch`], and the faults of [`PieceSurface::new`] of any piece.
pub fn islands_by_uv(
    positions: &[Point3<f64>],
    triangles: &[[u32; 3]],
    uv: &[[u32; 3]],
) -> Result<SurfacePieces, SurfaceError> {
    same_length("uv", uv.len(), triangles.len())?;
    check(positions, triangles)?;
    let label = |h: u32| {
        let (t, k) = (h as usize / 3, h as usize % 3);
        // The two UV indices by the order of the vertices, so that both sides compare alike.
        let next = (k + 1) % 3;
        let (a, b) = (uv[t][k], uv[t][next]);
        if triangles[t][k] < triangles[t][next] { [a, b] } else { [b, a] }
    };
    gather(positions, triangles, &joined(triangles, label)?)
}

/// Cuts where two groups (materials, panels) meet; `groups` has one a triangle.
///
/// # Errors
/// As [`islands_by_uv`].
pub fn islands_by_group(
    positions: &[Point3<f64>],
    triangles: &[[u32; 3]],
    groups: &[u32],
) -> Result<SurfacePieces, SurfaceError> {
    same_length("groups", groups.len(), triangles.len())?;
    check(positions, triangles)?;
    gather(positions, triangles, &joined(triangles, |h| [groups[h as usize / 3], 0])?)
}

/// Cuts where the two sides of an edge have different labels; `labels` has one a half-edge,
/// `3 t + k` from corner k of triangle t to the next.
///
/// # Errors
/// As [`islands_by_uv`]; [`SurfaceError::NonManifoldEdge`] where three sides of one edge have the
/// same label.
pub fn islands_by_labels(
    positions: &[Point3<f64>],
    triangles: &[[u32; 3]],
    labels: &[[u32; 2]],
) -> Result<SurfacePieces, SurfaceError> {
    same_length("labels", labels.len(), 3 * triangles.len())?;
    check(positions, triangles)?;
    gather(positions, triangles, &joined(triangles, |h| labels[h as usize])?)
}

/// Cuts along marked edges, each given by its two vertices; an edge of three triangles or more must
/// be marked.
///
/// # Errors
/// [`SurfaceError::NoSuchEdge`], and the faults of [`PieceSurface::new`] of any piece.
pub fn islands_by_seams(
    positions: &[Point3<f64>],
    triangles: &[[u32; 3]],
    seams: &[[u32; 2]],
) -> Result<SurfacePieces, SurfaceError> {
    check(positions, triangles)?;
    let edges = sorted_edges(triangles);
    let mut marked: Vec<u64> = Vec::with_capacity(seams.len());
    for (index, &[a, b]) in seams.iter().enumerate() {
        let key = edge_key(a, b);
        if edges.binary_search_by_key(&key, |e| e.0).is_err() {
            return Err(SurfaceError::NoSuchEdge { index, a, b });
        }
        marked.push(key);
    }
    marked.sort_unstable();
    let label = |h: u32| {
        let (t, k) = (h as usize / 3, h as usize % 3);
        let key = edge_key(triangles[t][k], triangles[t][(k + 1) % 3]);
        // A label of its own joins a half-edge to none.
        if marked.binary_search(&key).is_ok() { [h, 1] } else { [0, 0] }
    };
    gather(positions, triangles, &joined(triangles, label)?)
}

fn same_length(what: &'static str, found: usize, wanted: usize) -> Result<(), SurfaceError> {
    if found == wanted { Ok(()) } else { Err(SurfaceError::LengthMismatch { what, found, wanted }) }
}

/// Pairs half-edges of the same vertices and the same label.
fn joined(triangles: &[[u32; 3]], label: impl Fn(u32) -> [u32; 2]) -> Result<OppositeEdges, SurfaceError> {
    let mut opposite = vec![FREE; 3 * triangles.len()];
    let mut labelled: Vec<(u64, [u32; 2], u32)> =
        sorted_edges(triangles).into_iter().map(|(key, h)| (key, label(h), h)).collect();
    labelled.sort_unstable();
    for group in labelled.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        match *group {
            [_] => {}
            [(_, _, g), (_, _, h)] => {
                opposite[g as usize] = h;
                opposite[h as usize] = g;
            }
            _ => {
                let (a, b) = ((group[0].0 >> 32) as u32, group[0].0 as u32);
                return Err(SurfaceError::NonManifoldEdge { a, b, triangles: group.len() });
            }
        }
    }
    Ok(opposite)
}

/// Makes pieces of the joined half-edges.
fn gather(
    positions: &[Point3<f64>],
    triangles: &[[u32; 3]],
    opposite: &[u32],
) -> Result<SurfacePieces, SurfaceError> {
    let (mut triangles, mut opposite) = (triangles.to_vec(), opposite.to_vec());
    let component = components(&opposite);
    let mut turned = orient_all(&mut triangles, &mut opposite, &component)?;
    let inside_out = inside_out(&triangles, &opposite, &component);
    let marked: Vec<bool> = component.iter().map(|&c| inside_out[c as usize]).collect();
    if marked.contains(&true) {
        turn_marked(&mut triangles, &mut opposite, &marked);
        let sizes = component.iter().fold(vec![0; turned.len()], |mut sizes, &c| {
            sizes[c as usize] += 1;
            sizes
        });
        (0..turned.len()).filter(|&c| inside_out[c]).for_each(|c| turned[c] = sizes[c] - turned[c]);
    }
    let corners = corner_vertices(&triangles, &opposite, positions.len());
    let mut members = vec![Vec::new(); component_count(&component)];
    component.iter().enumerate().for_each(|(t, &c)| members[c as usize].push(t as u32));
    let mut local = vec![FREE; corners.sources.len()];
    let mut pieces = Vec::with_capacity(members.len());
    for (list, turned) in members.into_iter().zip(turned) {
        pieces.push(piece(positions, &corners.triangles, &corners.sources, list, turned, &mut local)?);
    }
    let seams = find_seams(&pieces);
    Ok(SurfacePieces { pieces, seams })
}

fn piece(
    positions: &[Point3<f64>],
    triangles: &[[u32; 3]],
    sources: &[u32],
    members: Vec<u32>,
    turned: usize,
    local: &mut [u32],
) -> Result<SurfacePiece, SurfaceError> {
    let (mut places, mut vertices) = (Vec::new(), Vec::new());
    let mut mesh = Vec::with_capacity(members.len());
    for &t in &members {
        mesh.push(triangles[t as usize].map(|v| {
            if local[v as usize] == FREE {
                local[v as usize] = vertices.len() as u32;
                vertices.push(sources[v as usize]);
                places.push(positions[sources[v as usize] as usize]);
            }
            local[v as usize]
        }));
    }
    let surface = PieceSurface::new(places, mesh).map_err(|e| in_garment(e, &members, &vertices))?;
    let vertices = surface.sources().iter().map(|&v| vertices[v as usize]).collect();
    Ok(SurfacePiece { surface: surface.with_turned(turned), vertices, triangles: members })
}

/// The fault of a piece by the numbers of the garment.
fn in_garment(e: SurfaceError, triangles: &[u32], vertices: &[u32]) -> SurfaceError {
    let of = |t: usize| triangles[t] as usize;
    match e {
        SurfaceError::Closed { triangle } => SurfaceError::Closed { triangle: of(triangle) },
        SurfaceError::NotOrientable { triangle } => SurfaceError::NotOrientable { triangle: of(triangle) },
        SurfaceError::NonManifoldEdge { a, b, triangles } => {
            SurfaceError::NonManifoldEdge { a: vertices[a as usize], b: vertices[b as usize], triangles }
        }
        other => other,
    }
}
