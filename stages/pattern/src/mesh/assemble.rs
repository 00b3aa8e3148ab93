//! The frame around both meshers: check, divide, mesh, look at the angles, put the panel together.
//!
//! Where a panel is thinner than the edge length (a strap, a belt), triangles on the outline are
//! thin because their sides on it are long. Stretches without a name are then divided twice as
//! fine, and the panel is meshed anew; counts of named edges are agreed with other panels and stay.

use super::angles::least_angle;
use super::check::{check_outline, show};
use super::divide::{Cuts, Division, divide};
use super::layout::Layout;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// What a mesher makes: vertices, the division's first and in their order, and triangles.
#[derive(Debug, Clone)]
pub(crate) struct Meshed {
    /// Vertices; some may be in no triangle.
    pub points: Vec<Point2>,
    /// Counter-clockwise triangles.
    pub triangles: Vec<[u32; 3]>,
}

/// A triangle on the outline below this angle (degrees) asks for a finer division there.
const THIN: f64 = 20.0;

/// A side on the outline is to blame for a thin triangle if it is this much longer than another.
const LONG: f64 = 1.5;

/// How often stretches may be divided finer: three times is an eighth of the edge length.
const FINER: usize = 3;

/// Meshes an outline at an edge length `h` (metres) by a mesher of divided outlines.
pub(crate) fn mesh_outline(
    outline: &Outline,
    h: f64,
    cx: &Context,
    mesh: impl Fn(&Division) -> Result<Meshed, StageError>,
) -> Result<Panel, StageError> {
    check_outline(outline, h, cx)?;
    let layout = Layout::of(outline, h);
    let cuts = Cuts::even(&layout, h)?;
    mesh_cut(outline, &layout, cuts, h, cx, mesh)
}

/// Meshes an outline that has been checked, cut as `cuts` say; `h` is the greatest edge length,
/// metres.
pub(crate) fn mesh_cut(
    outline: &Outline,
    layout: &Layout<'_>,
    mut cuts: Cuts,
    h: f64,
    cx: &Context,
    mesh: impl Fn(&Division) -> Result<Meshed, StageError>,
) -> Result<Panel, StageError> {
    let mut division = divide(layout, &cuts, h)?;
    let mut meshed = mesh(&division)?;
    for _ in 0..FINER {
        let thin = thin_stretches(&division, &meshed);
        if thin.is_empty() {
            break;
        }
        let mut times = vec![1; division.stretches.len()];
        thin.iter().for_each(|&k| times[k] = 2);
        cx.check()?;
        cuts = cuts.finer(layout, &times);
        division = divide(layout, &cuts, h)?;
        meshed = mesh(&division)?;
    }
    assemble(outline, &division, meshed, h, cx)
}

/// Unnamed stretches on which a thin triangle has a long side.
fn thin_stretches(division: &Division, meshed: &Meshed) -> Vec<usize> {
    let mut next = vec![u32::MAX; meshed.points.len()];
    division.loop_segments().iter().for_each(|s| next[s[0] as usize] = s[1]);
    let at = |v: u32| meshed.points[v as usize];
    let mut thin = Vec::new();
    for t in &meshed.triangles {
        for k in 0..3 {
            let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            if next[a as usize] != b {
                continue;
            }
            let side = (at(b) - at(a)).norm();
            let long = side > LONG * (at(c) - at(b)).norm().min((at(c) - at(a)).norm());
            let stretch = division.stretches.partition_point(|s| s.0 <= a) - 1;
            if long && division.stretches[stretch].1 && least_angle(at(a), at(b), at(c)) < THIN.to_radians() {
                thin.push(stretch);
            }
        }
    }
    thin.sort_unstable();
    thin.dedup();
    thin
}

/// Puts a panel together and reports its figures.
fn assemble(
    outline: &Outline,
    division: &Division,
    meshed: Meshed,
    h: f64,
    cx: &Context,
) -> Result<Panel, StageError> {
    check_chains(division, &meshed)?;
    let meshed = without_unused(meshed, division.points.len());
    let photo_px = meshed.points.iter().filter_map(|p| outline.to_px(*p)).collect();
    let panel = Panel {
        positions: meshed.points,
        triangles: meshed.triangles,
        boundary: division.loops[0].clone(),
        holes: division.loops[1..].to_vec(),
        edges: division.edges.clone(),
        inner: division.chains.clone(),
        photo_px,
        outline_area: outline.area(),
        outline_length: outline.perimeter(),
    };
    tell(&panel, division, h, cx);
    Ok(panel)
}

/// Inner lines must lie in the cloth, and so on mesh edges.
fn check_chains(division: &Division, meshed: &Meshed) -> Result<(), StageError> {
    let mut sides: Vec<[u32; 2]> = Vec::new();
    let on_line = chain_vertices(division, meshed.points.len());
    for t in &meshed.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if on_line[a as usize] && on_line[b as usize] {
                sides.push([a.min(b), a.max(b)]);
            }
        }
    }
    sides.sort_unstable();
    for chain in &division.chains {
        let lies = |w: &[u32]| sides.binary_search(&[w[0].min(w[1]), w[0].max(w[1])]).is_ok();
        if !chain.vertices.windows(2).all(lies) {
            return Err(StageError::invalid(format!("inner line \"{}\" lies outside the cloth", chain.name)));
        }
    }
    Ok(())
}

fn chain_vertices(division: &Division, vertices: usize) -> Vec<bool> {
    let mut on_line = vec![false; vertices];
    division.chains.iter().flat_map(|c| &c.vertices).for_each(|&v| on_line[v as usize] = true);
    on_line
}

/// The same mesh without vertices that no triangle uses; the first `fixed` keep their numbers.
fn without_unused(meshed: Meshed, fixed: usize) -> Meshed {
    let mut used = vec![false; meshed.points.len()];
    meshed.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    used[..fixed].fill(true);
    let mut number = vec![0; used.len()];
    let mut points = Vec::with_capacity(used.len());
    for (v, p) in meshed.points.into_iter().enumerate().filter(|(v, _)| used[*v]) {
        number[v] = points.len() as u32;
        points.push(p);
    }
    let renumber = |t: &[u32; 3]| t.map(|v| number[v as usize]);
    Meshed { points, triangles: meshed.triangles.iter().map(renumber).collect() }
}

fn tell(panel: &Panel, division: &Division, h: f64, cx: &Context) {
    cx.figure("triangles", panel.triangles.len() as f64, "");
    cx.figure("least_angle", panel.least_angle(), "deg");
    cx.figure("outline_deviation", division.deviation * 1e3, "mm");
    if division.deviation > CHORD_TOLERANCE * h {
        cx.warn(format!(
            "{} leaves the outline by {:.2} mm, more than {:.0} % of the edge of {}; a smoother outline or a smaller edge helps",
            division.deviates,
            division.deviation * 1e3,
            CHORD_TOLERANCE * 100.0,
            show(h)
        ));
    }
}
