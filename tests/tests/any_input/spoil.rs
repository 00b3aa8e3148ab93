//! Edits of artifacts: an odd number here, a list cut short there, two entries exchanged.

use image::{GrayImage, RgbImage};
use proptest::prelude::*;
use std::any::Any;
use std::sync::Arc;
use toile_core::artifact::{
    Artifact, Body, Fabric, Garment, Gauge, InnerKind, InnerLine, Mask, Mesh, Model, Outline, Panel, Photo,
    Point2, SewingPlan, Shared,
};

/// One edit: which list, where in it, how, and with what number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edit {
    /// Which entry of a named set is spared.
    pub(crate) entry: usize,
    list: usize,
    at: usize,
    how: How,
    number: f64,
}

#[derive(Debug, Clone, Copy)]
enum How {
    Put,
    Exchange,
    Copy,
    Cut,
    Clear,
    Reverse,
}

impl Arbitrary for Edit {
    type Parameters = ();
    type Strategy = BoxedStrategy<Edit>;

    fn arbitrary_with((): ()) -> Self::Strategy {
        let how = prop_oneof![
            4 => Just(How::Put),
            2 => Just(How::Exchange),
            2 => Just(How::Copy),
            2 => Just(How::Cut),
            1 => Just(How::Clear),
            1 => Just(How::Reverse),
        ];
        let number = prop_oneof![
            4 => -2.0..2.0f64,
            1 => Just(0.0),
            1 => Just(1e9),
            1 => Just(-1e200),
            1 => Just(f64::MAX),
            1 => Just(1e-300),
            1 => Just(f64::NAN),
            1 => Just(f64::INFINITY),
        ];
        let fields = (0..3usize, 0..12usize, any::<u16>(), how, number);
        fields
            .prop_map(|(entry, list, at, how, number)| Edit { entry, list, at: at.into(), how, number })
            .boxed()
    }
}

impl Edit {
    /// Edits a list: `put` changes the entry it is given to.
    fn apply<T: Clone>(&self, list: &mut Vec<T>, put: impl Fn(&mut T, f64)) {
        let n = list.len();
        if n == 0 {
            return;
        }
        let (at, other) = (self.at % n, (self.at / 7) % n);
        match self.how {
            How::Put => put(&mut list[at], self.number),
            How::Exchange => list.swap(at, other),
            How::Copy => list[at] = list[other].clone(),
            How::Cut => list.truncate(at),
            How::Clear => list.clear(),
            How::Reverse => list.reverse(),
        }
    }

    fn point2(&self, list: &mut Vec<Point2>) {
        let k = self.at % 2;
        self.apply(list, |p, x| p[k] = x);
    }

    fn points<P: Clone + std::ops::IndexMut<usize, Output = f64>>(&self, list: &mut Vec<P>) {
        let k = self.at % 3;
        self.apply(list, |p, x| p[k] = x);
    }

    fn triangles(&self, list: &mut Vec<[u32; 3]>) {
        let k = self.at % 3;
        self.apply(list, |t, x| t[k] = index(x));
    }

    fn indices(&self, list: &mut Vec<u32>) {
        self.apply(list, |i, x| *i = index(x));
    }

    /// Picks one of a list's entries.
    fn one<'a, T>(&self, list: &'a mut [T]) -> Option<&'a mut T> {
        let n = list.len();
        if n == 0 { None } else { list.get_mut(self.at % n) }
    }
}

/// A small index for small numbers, one beyond every list for large ones.
fn index(x: f64) -> u32 {
    (x.abs() * 20.0) as u32
}

/// The artifact after the edits; the same where it is of a kind without anything to edit.
pub(crate) fn artifact(original: &Arc<dyn Artifact>, edits: &[Edit]) -> Arc<dyn Artifact> {
    fn typed<T: Artifact + Clone>(
        original: &Arc<dyn Artifact>,
        edits: &[Edit],
        edit: fn(&Edit, &mut T),
    ) -> Option<Arc<dyn Artifact>> {
        let any: &dyn Any = original.as_ref();
        let mut copy = any.downcast_ref::<T>()?.clone();
        edits.iter().for_each(|e| edit(e, &mut copy));
        Some(Arc::new(copy))
    }
    typed(original, edits, photo)
        .or_else(|| typed(original, edits, mask))
        .or_else(|| typed(original, edits, outline))
        .or_else(|| typed(original, edits, panel))
        .or_else(|| typed(original, edits, garment))
        .or_else(|| typed(original, edits, body))
        .or_else(|| typed(original, edits, fabric))
        .or_else(|| typed(original, edits, plan))
        .or_else(|| typed(original, edits, model))
        .unwrap_or_else(|| original.clone())
}

/// Sizes that a picture may suddenly have.
const SIZES: [(u32, u32); 6] = [(0, 0), (1, 1), (1, 300), (3, 2), (64, 1), (500, 500)];

fn photo(e: &Edit, p: &mut Photo) {
    let (w, h) = SIZES[e.at % SIZES.len()];
    let grain = |x: u32, y: u32| ((x * 31 + y * 17 + e.at as u32) % 251) as u8;
    match e.list {
        0 => p.pixels = Shared::new(RgbImage::new(w, h)),
        1 => p.pixels = Shared::new(RgbImage::from_fn(w, h, |x, y| image::Rgb([grain(x, y); 3]))),
        2 => p.px_per_metre = Some(e.number),
        3 => p.garment_width = Some(e.number),
        4 => p.px_per_metre = None,
        5 => p.garment_width = None,
        6 => p.alpha = Some(Shared::new(GrayImage::new(p.pixels.width(), p.pixels.height()))),
        7 => p.mirrored = !p.mirrored,
        8 => p.pixels = Shared::new(image::imageops::rotate90(p.pixels.as_ref())),
        _ => p.pixels = Shared::new(image::imageops::flip_vertical(p.pixels.as_ref())),
    }
}

fn mask(e: &Edit, m: &mut Mask) {
    let (w, h) = SIZES[e.at % SIZES.len()];
    let side = m.pixels.dimensions();
    let filled = |w, h, level| Shared::new(GrayImage::from_pixel(w, h, image::Luma([level])));
    let noise = |x: u32, y: u32| if (x * 7919 + y * 104_729 + e.at as u32) % 97 < 40 { 255 } else { 0 };
    match e.list % 6 {
        0 => m.pixels = filled(w, h, 0),
        1 => m.pixels = filled(w, h, 255),
        2 => m.pixels = filled(side.0, side.1, 255),
        3 => m.pixels = filled(side.0, side.1, 0),
        4 => m.pixels = Shared::new(GrayImage::from_fn(side.0, side.1, |x, y| image::Luma([noise(x, y)]))),
        _ => m.pixels = Shared::new(image::imageops::rotate180(m.pixels.as_ref())),
    }
}

fn outline(e: &Edit, o: &mut Outline) {
    match e.list % 9 {
        0 | 1 => e.point2(&mut o.outer.points),
        2 => e.apply(&mut o.outer.corners, |c, x| *c = index(x) as usize),
        3 => e.apply(&mut o.edges, |edge, x| edge.start = index(x) as usize),
        4 => e.apply(&mut o.edges, |edge, x| edge.gauge.length = x),
        5 => e.apply(&mut o.edges, |edge, x| edge.gauge = Gauge::straight(x.abs())),
        6 => o.holes.push(o.outer.clone()),
        7 => {
            let first = o.outer.points.first().copied().unwrap_or_default();
            o.inner.push(InnerLine {
                name: "dart".into(),
                kind: InnerKind::Dart,
                points: vec![Point2::new(e.number, 0.1), Point2::new(0.0, e.number), first],
                gauge: None,
            })
        }
        _ => o.frame = None,
    }
}

fn panel(e: &Edit, p: &mut Panel) {
    match e.list % 9 {
        0 => e.point2(&mut p.positions),
        1 => e.triangles(&mut p.triangles),
        2 => e.indices(&mut p.boundary),
        3 => e.apply(&mut p.edges, |edge, x| edge.vertices.truncate(index(x) as usize)),
        4 => e.one(&mut p.edges).into_iter().for_each(|edge| e.indices(&mut edge.vertices)),
        5 => e.point2(&mut p.photo_px),
        6 => p.outline_area = e.number,
        7 => p.outline_length = e.number,
        _ => p.holes.push(p.boundary.clone()),
    }
}

fn garment(e: &Edit, g: &mut Garment) {
    match e.list {
        0 | 1 => e.points(&mut g.positions),
        2 => e.point2(&mut g.rest),
        3 => e.triangles(&mut g.triangles),
        4 => e.points(&mut g.velocities),
        5 => e.indices(&mut g.weld),
        6 => e.one(&mut g.seams).into_iter().for_each(|s| e.apply(&mut s.pairs, |p, x| p[0] = index(x))),
        7 => e.apply(&mut g.seams, |s, _| s.pairs.clear()),
        8 => e.one(&mut g.panels).into_iter().for_each(|p| e.indices(&mut p.boundary)),
        9 => e.one(&mut g.panels).into_iter().for_each(|p| e.point2(&mut p.photo_px)),
        10 => e.one(&mut g.panels).into_iter().for_each(|p| fabric(e, Arc::make_mut(&mut p.fabric))),
        _ => g.positions.iter_mut().for_each(|p| *p *= e.number),
    }
}

fn body(e: &Edit, b: &mut Body) {
    let mut names: Vec<String> = b.landmarks.keys().cloned().collect();
    let name = e.one(&mut names).cloned().unwrap_or_default();
    match e.list % 6 {
        0 => e.points(&mut b.positions),
        1 => e.triangles(&mut b.triangles),
        2 => drop(b.landmarks.remove(&name)),
        3 => b.landmarks.entry(name).and_modify(|p| p.y = e.number).or_default().x += 0.1,
        4 => drop(b.measurements.insert("height".into(), e.number)),
        _ => b.positions.iter_mut().for_each(|p| *p *= e.number),
    }
}

fn fabric(e: &Edit, f: &mut Fabric) {
    match e.list {
        0 => f.area_density = e.number,
        1 => e.apply(&mut f.warp.0, |p, x| p.1 = x),
        2 => e.apply(&mut f.weft.0, |p, x| p.0 = x),
        3 => e.apply(&mut f.shear.0, |p, x| *p = (x, x)),
        4 => f.bending_warp = e.number,
        5 => f.bending_weft = e.number,
        6 => f.thickness = e.number,
        7 => f.friction = e.number,
        _ => f.damping = e.number,
    }
}

fn plan(e: &Edit, s: &mut SewingPlan) {
    match e.list % 3 {
        0 => e.apply(&mut s.seams, |seam, _| seam.reversed = !seam.reversed),
        1 => e.apply(&mut s.seams, |seam, _| seam.a = seam.b.clone()),
        _ => e.apply(&mut s.seams, |seam, _| seam.b.edge = "nowhere".into()),
    }
}

fn model(e: &Edit, m: &mut Model) {
    let mesh = |m: &mut Model, edit: &dyn Fn(&mut Mesh)| e.one(&mut m.meshes).into_iter().for_each(edit);
    match e.list % 7 {
        0 => mesh(m, &|x| e.points(&mut x.positions)),
        1 => mesh(m, &|x| e.points(&mut x.normals)),
        2 => mesh(m, &|x| e.triangles(&mut x.triangles)),
        3 => mesh(m, &|x| e.apply(&mut x.uv, |uv, v| uv[0] = v as f32)),
        4 => e.apply(&mut m.materials, |x, v| x.colour[0] = v as f32),
        5 => e.apply(&mut m.textures, |t, _| t.pixels = Shared::new(RgbImage::new(0, 0))),
        _ => e.apply(&mut m.meshes, |x, _| x.name = "a/b\n\"c\"".into()),
    }
}
