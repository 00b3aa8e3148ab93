//! Artifacts moved, turned and scaled, and results compared with what they should have become.
//!
//! Pictures move by whole pixels and scale by their px per metre, so that their pixels stay the
//! same; outlines and panels move exactly. Compared are shapes, not lists: a closed line may start
//! elsewhere.

use crate::artifact::*;
use crate::{Card, Contract, Inputs, PortValue};
use image::{ImageBuffer, Pixel};
use std::any::Any;
use std::sync::Arc;

/// How far shapes may leave each other, as a share of their size: rounding, and what it tips over
/// in a search.
pub const TOLERANCE: f64 = 1e-6;
/// How far the outline of a photo that was moved by whole pixels may be off, px.
pub const TOLERANCE_PX: f64 = 0.02;
/// Pixels that pictures are moved by.
const SHIFT_PX: [u32; 2] = [5, 3];

/// A motion of the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InputMotion {
    /// By metres.
    Shift(f64, f64),
    /// About the origin, radians.
    Turn(f64),
    /// About the origin.
    Scale(f64),
}

/// The motion by which a contract is checked.
pub fn of(contract: Contract) -> Option<InputMotion> {
    match contract {
        Contract::TranslationEquivariant => Some(InputMotion::Shift(0.125, -0.0625)),
        Contract::RotationEquivariant => Some(InputMotion::Turn(0.7)),
        Contract::ScaleEquivariant => Some(InputMotion::Scale(1.5)),
        _ => None,
    }
}

/// True where every kind that a card takes can be moved so, and every kind that it gives be
/// compared.
pub fn applies(card: &Card, motion: InputMotion) -> bool {
    let turns = matches!(motion, InputMotion::Turn(_));
    let takes =
        |k: Kind| k == Outline::KIND || k == Panel::KIND || (!turns && (k == Photo::KIND || k == Mask::KIND));
    let gives = |k: Kind| k == Outline::KIND || k == Panel::KIND || k == SewingPlan::KIND;
    let required = card.inputs.iter().filter(|p| !p.optional);
    required.clone().count() > 0
        && required.clone().all(|p| takes(p.kind))
        && card.outputs.iter().all(|p| gives(p.kind))
}

/// The inputs moved; `None` where one cannot be.
pub fn moved(inputs: &Inputs, motion: InputMotion) -> Option<Inputs> {
    let one = |v: &PortValue| match v {
        PortValue::One(a) => Some(PortValue::One(artifact(a, motion)?)),
        PortValue::Set(kind, set) => {
            let set = set.iter().map(|(k, a)| Some((k.clone(), artifact(a, motion)?)));
            Some(PortValue::Set(*kind, set.collect::<Option<_>>()?))
        }
    };
    let all = inputs.0.iter().map(|v| v.as_ref().map_or(Some(None), |v| one(v).map(Some)));
    all.collect::<Option<_>>().map(Inputs)
}

fn artifact(a: &Arc<dyn Artifact>, motion: InputMotion) -> Option<Arc<dyn Artifact>> {
    let any: &dyn Any = a.as_ref();
    if let Some(o) = any.downcast_ref::<Outline>() {
        return Some(Arc::new(outline(o, motion)));
    }
    if let Some(p) = any.downcast_ref::<Panel>() {
        return Some(Arc::new(panel(p, motion)));
    }
    if let Some(p) = any.downcast_ref::<Photo>() {
        return match motion {
            InputMotion::Shift(..) => Some(Arc::new(p.with_pixels(shifted(p.pixels.as_ref())))),
            InputMotion::Scale(s) => {
                Some(Arc::new(Photo { px_per_metre: p.px_per_metre.map(|x| x / s), ..p.clone() }))
            }
            InputMotion::Turn(_) => None,
        };
    }
    let mask = any.downcast_ref::<Mask>()?;
    match motion {
        InputMotion::Shift(..) => Some(Arc::new(Mask { pixels: Shared::new(shifted(mask.pixels.as_ref())) })),
        InputMotion::Scale(_) => Some(Arc::new(mask.clone())),
        InputMotion::Turn(_) => None,
    }
}

/// The picture with more ground to the left and above.
fn shifted<P: Pixel + 'static>(image: &ImageBuffer<P, Vec<P::Subpixel>>) -> ImageBuffer<P, Vec<P::Subpixel>> {
    let [dx, dy] = SHIFT_PX;
    let (w, h) = image.dimensions();
    ImageBuffer::from_fn(w + dx, h + dy, |x, y| {
        image.get_pixel(x.saturating_sub(dx), y.saturating_sub(dy)).to_owned()
    })
}

/// A point moved.
pub fn point(q: Point2, motion: InputMotion) -> Point2 {
    match motion {
        InputMotion::Shift(x, y) => q + Vector2::new(x, y),
        InputMotion::Turn(a) => nalgebra::Rotation2::new(a) * q,
        InputMotion::Scale(s) => q * s,
    }
}

fn outline(o: &Outline, motion: InputMotion) -> Outline {
    let map = |l: &Loop| Loop {
        points: l.points.iter().map(|q| point(*q, motion)).collect(),
        corners: l.corners.clone(),
    };
    let line = |l: &InnerLine| InnerLine {
        points: l.points.iter().map(|q| point(*q, motion)).collect(),
        ..l.clone()
    };
    let mut out = Outline {
        outer: map(&o.outer),
        holes: o.holes.iter().map(map).collect(),
        inner: o.inner.iter().map(line).collect(),
        frame: None,
        lies: vec![],
        edges: o.edges.clone(),
    };
    if matches!(motion, InputMotion::Scale(_)) {
        let gauges: Vec<Gauge> = out.edges.iter().map(|e| Gauge::of(&out.edge_points(e), &[])).collect();
        out.edges.iter_mut().zip(gauges).for_each(|(e, g)| e.gauge = g);
    }
    out
}

fn panel(p: &Panel, motion: InputMotion) -> Panel {
    let by = if let InputMotion::Scale(s) = motion { s } else { 1.0 };
    Panel {
        positions: p.positions.iter().map(|q| point(*q, motion)).collect(),
        outline_area: p.outline_area * by * by,
        outline_length: p.outline_length * by,
        ..p.clone()
    }
}

/// Holds what came of moved input against what came of the input.
///
/// Errors: where they part, and by how much.
pub fn compare(
    before: &[PortValue],
    after: &[PortValue],
    motion: InputMotion,
    pictures: bool,
) -> Result<(), String> {
    for (a, b) in before.iter().zip(after) {
        let (a, b) = (a.entries(), b.entries());
        if a.len() != b.len() {
            return Err(format!("it gave {} artifacts, and {} of the moved input", a.len(), b.len()));
        }
        for ((name, a), (_, b)) in a.iter().zip(&b) {
            same(a.as_ref(), b.as_ref(), motion, pictures)
                .map_err(|e| format!("{} {name}: {e}", a.kind()))?;
        }
    }
    Ok(())
}

fn same(a: &dyn Artifact, b: &dyn Artifact, motion: InputMotion, pictures: bool) -> Result<(), String> {
    let (a, b): (&dyn Any, &dyn Any) = (a, b);
    if let (Some(a), Some(b)) = (a.downcast_ref::<Outline>(), b.downcast_ref::<Outline>()) {
        return if pictures { pictured(a, b, motion) } else { outlines(a, b, motion) };
    }
    if let (Some(a), Some(b)) = (a.downcast_ref::<Panel>(), b.downcast_ref::<Panel>()) {
        return panels(a, b, motion);
    }
    match (a.downcast_ref::<SewingPlan>(), b.downcast_ref::<SewingPlan>()) {
        (Some(a), Some(b)) => plans(a, b, motion),
        _ => Err("the kit cannot compare it".into()),
    }
}

fn size(points: &[Point2]) -> f64 {
    points.iter().map(|q| q.coords.amax()).fold(0.0, f64::max).max(1e-9)
}

fn panels(a: &Panel, b: &Panel, motion: InputMotion) -> Result<(), String> {
    if a.triangles != b.triangles {
        return Err("its triangles differ".into());
    }
    let expected: Vec<Point2> = a.positions.iter().map(|q| point(*q, motion)).collect();
    let off = expected.iter().zip(&b.positions).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    near(off, TOLERANCE * size(&expected), 1e3, "mm")
}

fn near(off: f64, most: f64, scale: f64, unit: &str) -> Result<(), String> {
    match off <= most {
        true => Ok(()),
        false => Err(format!("it is {:.6} {unit} off, at most {:.6} are allowed", off * scale, most * scale)),
    }
}

fn outlines(a: &Outline, b: &Outline, motion: InputMotion) -> Result<(), String> {
    let names = |o: &Outline| o.edges.iter().map(|e| e.name.clone()).collect::<Vec<_>>();
    if names(a) != names(b) {
        return Err(format!("its edges are {}, then {}", names(a).join(", "), names(b).join(", ")));
    }
    let expected = outline(a, motion);
    let most = TOLERANCE * size(&expected.outer.points);
    near(apart(&expected.outer.points, &b.outer.points), most, 1e3, "mm")?;
    for (e, f) in expected.edges.iter().zip(&b.edges) {
        let off = (expected.outer.points[e.start] - b.outer.points[f.start]).norm();
        near(off, most, 1e3, "mm").map_err(|w| format!("the start of \"{}\": {w}", e.name))?;
    }
    Ok(())
}

/// Outlines of pictures: moved ones are compared in pixels, scaled ones from their least corner.
fn pictured(a: &Outline, b: &Outline, motion: InputMotion) -> Result<(), String> {
    if a.outer.corners.len() != b.outer.corners.len() || a.holes.len() != b.holes.len() {
        let counts = |o: &Outline| format!("{} corners and {} holes", o.outer.corners.len(), o.holes.len());
        return Err(format!("it has {}, then {}", counts(a), counts(b)));
    }
    let (Some(fa), Some(fb)) = (a.frame, b.frame) else { return Err("it does not know its place".into()) };
    match motion {
        InputMotion::Scale(s) => {
            let from_low = |o: &Outline, by: f64| {
                let low = o.bounds().0;
                o.outer.points.iter().map(|q| Point2::from((q - low) * by)).collect::<Vec<_>>()
            };
            let (p, q) = (from_low(a, s), from_low(b, 1.0));
            near(apart(&p, &q), TOLERANCE * size(&p), 1e3, "mm")
        }
        _ => {
            let shift = Vector2::new(f64::from(SHIFT_PX[0]), f64::from(SHIFT_PX[1]));
            let p: Vec<Point2> = a.outer.points.iter().map(|q| fa.to_px(*q) + shift).collect();
            let q: Vec<Point2> = b.outer.points.iter().map(|q| fb.to_px(*q)).collect();
            near(apart(&p, &q), TOLERANCE_PX, 1.0, "px")
        }
    }
}

/// The farthest that a corner of one closed line is from the other line.
fn apart(a: &[Point2], b: &[Point2]) -> f64 {
    let from = |q: &Point2, line: &[Point2]| {
        let n = line.len();
        (0..n).map(|k| to_segment(*q, line[k], line[(k + 1) % n])).fold(f64::INFINITY, f64::min)
    };
    let one_way = |a: &[Point2], b: &[Point2]| a.iter().map(|q| from(q, b)).fold(0.0, f64::max);
    one_way(a, b).max(one_way(b, a))
}

/// Distance of a point from a segment.
pub fn to_segment(q: Point2, a: Point2, b: Point2) -> f64 {
    let d = b - a;
    let t = ((q - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (q - (a + d * t)).norm()
}

fn plans(a: &SewingPlan, b: &SewingPlan, motion: InputMotion) -> Result<(), String> {
    if a.seams.iter().map(Seam::name).ne(b.seams.iter().map(Seam::name)) {
        return Err("its seams differ".into());
    }
    for (name, place) in &a.placements {
        let Some(other) = b.placements.get(name) else {
            return Err(format!("\"{name}\" has no place any more"));
        };
        let expected = point(place.anchor, motion);
        let off = (expected - other.anchor).norm();
        near(off, TOLERANCE * size(&[expected, Point2::new(1.0, 1.0)]), 1e3, "mm")
            .map_err(|w| format!("the anchor of \"{name}\": {w}"))?;
    }
    Ok(())
}
