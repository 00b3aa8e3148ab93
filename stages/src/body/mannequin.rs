//! `Mannequin`: a closed, smooth figure made to measure.
//!
//! A [`Figure`]'s sections are scaled until a tape around bust, waist and hip reads what is wanted;
//! then it is meshed (surface nets with Newton steps onto the skin) and the mesh is measured: where
//! it misses, the aim is corrected and the figure meshed again. Cost: mostly one meshing, some
//! tenths of a second. Limits: see [`Figure`].

use super::figure::{Figure, Size, level};
use super::isosurface::{Grid, TriMesh, mesh};
use super::landmarks::landmarks;
use super::slice::{convex_hull, slice, trunk};
use super::topology::Topology;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// Girths agree to this share of the wanted one.
const GIRTH_TOLERANCE: f64 = 0.002;
/// Girths of the smooth figure agree to this share before it is meshed.
const FIT_TOLERANCE: f64 = 2e-4;
/// Corrections of the sections before giving up; five suffice for ordinary figures.
const MAX_FITS: usize = 30;
/// Meshings before giving up; one suffices for ordinary figures.
const MAX_MESHINGS: usize = 4;
/// Rays around the trunk when the smooth figure is measured: a polygon of so many corners is
/// short by 0.02 %.
const RAYS: usize = 96;
/// The finest mesh of the smallest body still has edges of this share of its height; it also keeps
/// wrists and thumbs several cells thick for children.
const LARGEST_EDGE: f64 = 1.0 / 95.0;

/// A mannequin made to measure: closed and smooth, arms spread in A-pose, legs a little apart.
///
/// Girths are those of a tape around the trunk at the fullest bust, the waist and the fullest hip.
/// Shoulder width and neck follow from height and bust where they are not given. Children from
/// 80 cm on have larger heads and shorter limbs.
#[stage(
    role = Body,
    source = "surface nets: Gibson, 1998; proportions: Gordon and others, 1989",
    example = "Mannequin(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Mannequin {
    /// Crown to sole.
    #[param(default = Length::cm(172.0), min = 0.8, max = 2.1)]
    height: Length,
    /// Girth at the fullest part of the chest.
    #[param(default = Length::cm(88.0), min = 0.4, max = 1.7)]
    bust: Length,
    /// Girth at the waist.
    #[param(default = Length::cm(70.0), min = 0.35, max = 1.7)]
    waist: Length,
    /// Girth at the fullest part of the seat.
    #[param(default = Length::cm(96.0), min = 0.4, max = 1.7)]
    hip: Length,
    /// Distance of the shoulders' outer points; follows from height and bust where it is not given.
    #[param(default = None, min = 0.15, max = 0.6)]
    shoulder_width: Option<Length>,
    /// Girth of the neck; follows from height and bust where it is not given.
    #[param(default = None, min = 0.18, max = 0.6)]
    neck: Option<Length>,
    /// Angle between the arms and the vertical; 60 suits sleeves of shirts laid flat.
    #[param(default = 60.0, min = 30.0, max = 75.0, unit = "degrees")]
    arm_angle: f64,
    /// Length of the mesh's edges; small bodies get shorter ones.
    #[param(default = Length::mm(16.0), min = 0.006, max = 0.022, trades, finer = "less")]
    edge: Length,
}

#[stage]
impl Mannequin {
    pub(crate) fn run(&self, cx: &Context) -> Result<Body, StageError> {
        let size = self.size();
        check(&size)?;
        fit(&size, self.edge.metres(), cx)
    }

    /// Whether anybody has such measures.
    fn precheck(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check(&self.size()).err().into_iter().collect()
    }
}

impl Mannequin {
    /// A mannequin of that height with bust, waist and hip, meshed at an edge length, all in metres.
    #[cfg(test)]
    pub(crate) fn of(height: f64, [bust, waist, hip]: [f64; 3], edge: f64) -> Self {
        let [height, bust, waist, hip, edge] = [height, bust, waist, hip, edge].map(Length::m);
        Mannequin { height, bust, waist, hip, edge, ..Mannequin::default() }
    }

    /// A mannequin of that height with bust, waist and hip and the arms at that angle in degrees, meshed at an edge length, all in metres.
    pub(crate) fn made(height: f64, [bust, waist, hip]: [f64; 3], arm_angle: f64, edge: f64) -> Self {
        let [height, bust, waist, hip, edge] = [height, bust, waist, hip, edge].map(Length::m);
        Mannequin { height, bust, waist, hip, arm_angle, edge, ..Mannequin::default() }
    }

    fn size(&self) -> Size {
        let [height, bust, waist, hip] = [self.height, self.bust, self.waist, self.hip].map(Length::metres);
        let given = |l: Option<Length>, or: f64| l.map_or(or, Length::metres);
        Size {
            height,
            bust,
            waist,
            hip,
            shoulder_width: given(self.shoulder_width, 0.13 * height + 0.185 * bust),
            neck: given(self.neck, 0.085 * height + 0.225 * bust),
            arm_angle: self.arm_angle.to_radians(),
        }
    }
}

/// Shares of a length that people have, from thin to heavy: parameter, what it is compared to, range.
fn check(size: &Size) -> Result<(), StageError> {
    let h = size.height;
    let rules = [
        ("height", h, "", 1.0, (0.8, 2.1)),
        ("bust", size.bust, "a height", h, (0.40, 0.80)),
        ("waist", size.waist, "a height", h, (0.30, 0.78)),
        ("hip", size.hip, "a height", h, (0.42, 0.82)),
        ("waist", size.waist, "a bust", size.bust, (0.60, 1.12)),
        ("hip", size.hip, "a bust", size.bust, (0.75, 1.45)),
        ("hip", size.hip, "a waist", size.waist, (0.85, 1.75)),
        ("shoulder_width", size.shoulder_width, "a bust", size.bust, (0.34, 0.56)),
        ("neck", size.neck, "a bust", size.bust, (0.30, 0.52)),
        // From radians, 30 degrees come back with the last digits of a rounding.
        ("arm_angle", (size.arm_angle.to_degrees() * 1e9).round() / 1e9, "", 1.0, (30.0, 75.0)),
    ];
    rules.into_iter().try_for_each(|(name, value, to, base, (lo, hi))| {
        let share = value / base;
        // Not a number is out of range as well.
        if share >= lo && share <= hi { Ok(()) } else { Err(misfit(name, value, to, base, (lo, hi))) }
    })
}

fn misfit(name: &'static str, value: f64, to: &str, base: f64, (lo, hi): (f64, f64)) -> StageError {
    let (amount, range) = match name {
        "arm_angle" => (format!("{value} degrees"), format!("{lo} to {hi} degrees")),
        _ => (cm(value), format!("{} to {}", cm(lo * base), cm(hi * base))),
    };
    let what = name.replace('_', " ");
    let beside = if to.is_empty() { String::new() } else { format!(" beside {to} of {}", cm(base)) };
    StageError::new(
        ErrorCode::InvalidParameter,
        format!("nobody has {} {what} of {amount}{beside}", article(name)),
    )
    .hint(format!(
        "a {what} of {range} would fit{}",
        if to.is_empty() { "" } else { "; check the units as well" }
    ))
    .at(name)
}

fn article(name: &str) -> &'static str {
    if name.starts_with('a') { "an" } else { "a" }
}

fn cm(metres: f64) -> String {
    format!("{} cm", (metres * 1e3).round() / 10.0)
}

/// Fits the figure's sections, meshes it, and corrects by what the mesh's chords cut off.
fn fit(size: &Size, edge: f64, cx: &Context) -> Result<Body, StageError> {
    let wanted = [size.hip, size.waist, size.bust];
    let (mut aim, cell) = (wanted, edge.min(size.height * LARGEST_EDGE));
    let mut scale = [size.hip / 0.96, size.waist / 0.70, size.bust / 0.88];
    for round in 0..MAX_MESHINGS {
        cx.check()?;
        cx.progress(round as f64 / MAX_MESHINGS as f64, "fitting the girths");
        let figure = fitted(size, aim, &mut scale).ok_or_else(|| unfit("bust, waist and hip"))?;
        let skin = skin(&figure, cell);
        let girths = girths(&skin, figure.chin).ok_or_else(|| unfit("trunk"))?;
        let ratio = [0, 1, 2].map(|k| wanted[k] / girths[k]);
        if ratio.iter().all(|r| (r - 1.0).abs() < GIRTH_TOLERANCE) {
            return finish(&figure, skin, girths);
        }
        aim = [0, 1, 2].map(|k| aim[k] * ratio[k]);
    }
    Err(unfit("bust, waist and hip"))
}

/// The figure whose sections have the girths that are aimed at; `scale` is where the search begins
/// and where it ends.
fn fitted(size: &Size, aim: [f64; 3], scale: &mut [f64; 3]) -> Option<Figure> {
    for _ in 0..MAX_FITS {
        let figure = Figure::new(size, *scale);
        let girths = [level::HIP, level::WAIST, level::BUST].map(|l| trunk_girth(&figure, l * figure.chin));
        let ratio = [0, 1, 2].map(|k| aim[k] / girths[k]);
        if ratio.iter().all(|r| (r - 1.0).abs() < FIT_TOLERANCE) {
            return Some(figure);
        }
        (0..3).for_each(|k| scale[k] *= ratio[k]);
    }
    None
}

/// The length of a tape around the trunk at height `y`: rays from the axis meet the skin.
fn trunk_girth(figure: &Figure, y: f64) -> f64 {
    let ring = (0..RAYS).map(|i| {
        let (sin, cos) = ((i as f64 + 0.5) * std::f64::consts::TAU / RAYS as f64).sin_cos();
        let at = |r: f64| Point3::new(r * sin, y, r * cos);
        let (mut near, mut far) = (0.01, 0.5);
        for parts in [16, 8, 8, 8, 8] {
            // The first skin on the way out: beyond may lie the other leg.
            let step = (far - near) / f64::from(parts);
            let outside = |k: &i32| figure.without_arms(at(near + step * f64::from(*k))) > 0.0;
            near += step * f64::from((1..parts).find(outside).unwrap_or(parts) - 1);
            far = near + step;
        }
        Point2::new((near + far) / 2.0 * sin, (near + far) / 2.0 * cos)
    });
    let hull = convex_hull(ring.collect());
    (0..hull.len()).map(|i| (hull[(i + 1) % hull.len()] - hull[i]).norm()).sum()
}

fn unfit(what: &str) -> StageError {
    StageError::new(
        ErrorCode::InvalidParameter,
        format!("the mannequin's {what} cannot be brought to these measures"),
    )
    .hint("bring bust, waist, hip and shoulder width nearer to each other, or raise `arm_angle`")
}

/// The figure's mesh, brought to the exact height with its soles at zero.
fn skin(figure: &Figure, cell: f64) -> TriMesh {
    let (mut positions, triangles) = mesh(figure, &Grid { bounds: figure.bounds(), cell });
    let (lo, hi) = positions.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p.y), h.max(p.y)));
    let stretch = figure.size().height / (hi - lo);
    positions.iter_mut().for_each(|p| p.y = (p.y - lo) * stretch);
    (positions, triangles)
}

/// Tape measures at hip, waist and bust.
fn girths((positions, triangles): &TriMesh, chin: f64) -> Option<[f64; 3]> {
    let at = |level: f64| trunk(&slice(positions, triangles, level * chin), 0.0).map(|l| l.girth);
    Some([at(level::HIP)?, at(level::WAIST)?, at(level::BUST)?])
}

fn finish(figure: &Figure, skin: TriMesh, [hip, waist, bust]: [f64; 3]) -> Result<Body, StageError> {
    let (positions, triangles) = skin;
    let topology = Topology::of(positions.len(), &triangles);
    if !topology.is_closed() || topology.components != 1 || topology.euler() != 2 {
        return Err(unfit("skin"));
    }
    let size = figure.size();
    let landmarks = landmarks(figure, &positions, &triangles).ok_or_else(|| unfit("armpits"))?;
    let across = |a: &str, b: &str| Some((landmarks.get(a)? - landmarks.get(b)?).norm());
    let arm =
        across("shoulder_left", "elbow_left").zip(across("elbow_left", "wrist_left")).map(|(u, f)| u + f);
    let measured = [
        ("height", Some(size.height)),
        ("bust", Some(bust)),
        ("waist", Some(waist)),
        ("hip", Some(hip)),
        ("shoulder_width", across("shoulder_left", "shoulder_right")),
        ("arm_length", arm),
    ];
    let measurements: BTreeMap<String, f64> =
        measured.into_iter().filter_map(|(name, v)| Some((name.to_owned(), v?))).collect();
    Ok(Body { positions, triangles, landmarks, measurements })
}
