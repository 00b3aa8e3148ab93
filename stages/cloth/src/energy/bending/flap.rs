//! Two neighbouring triangles at rest, unfolded: how a small lift of their four vertices turns into
//! a fold.

use nalgebra::Vector2;

use crate::mesh::{Edge, Sheet, Side};

/// A fold line and what stands on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flap {
    /// Edge start, edge end, left tip, right tip.
    pub vertices: [u32; 4],
    /// A small fold angle is the sum of these times the lifts, 1/m.
    pub weights: [f64; 4],
    /// Edge length squared over the area of the two triangles.
    pub slenderness: f64,
    /// Distance of the two tips at rest, m.
    pub span: f64,
    /// Rest area of both triangles, m².
    pub area: f64,
    /// The two triangles.
    pub triangles: [u32; 2],
}

impl Flap {
    /// Its triangles, each with the corner opposite the fold.
    pub(super) fn sides(&self, sheet: &Sheet) -> [(usize, usize); 2] {
        let side = |k: usize| {
            let corners = &sheet.triangles()[self.triangles[k] as usize];
            let tip = corners.iter().position(|&v| !self.vertices[..2].contains(&v));
            (self.triangles[k] as usize, tip.unwrap_or(0))
        };
        [side(0), side(1)]
    }
}

/// All inner edges of a sheet as flaps, in the order of the edges.
pub(crate) fn flaps(sheet: &Sheet) -> Vec<Flap> {
    sheet.edges().iter().filter_map(|e| flap(sheet, e)).collect()
}

fn flap(sheet: &Sheet, e: &Edge) -> Option<Flap> {
    let (left, right) = (e.sides.0, e.sides.1?);
    let (l, mut r) = (leaf_of(sheet, &left), leaf_of(sheet, &right));
    // The right triangle runs through the edge backwards, so its share along the edge counts from
    // the other end; but where a seam sews the right side of one sheet to the wrong side of the
    // other.
    let (t, k) = (sheet.triangles()[right.triangle as usize], right.corner as usize);
    if t[(k + 1) % 3] == e.vertices[0] {
        r.along = 1.0 - r.along;
    }
    let weights = [
        -(1.0 - l.along) / l.height - r.along / r.height,
        -l.along / l.height - (1.0 - r.along) / r.height,
        1.0 / l.height,
        1.0 / r.height,
    ];
    let area = sheet.areas()[left.triangle as usize] + sheet.areas()[right.triangle as usize];
    Some(Flap {
        vertices: [e.vertices[0], e.vertices[1], left.opposite, right.opposite],
        weights,
        slenderness: e.rest_length * e.rest_length / area,
        span: (l.height + r.height).hypot((l.along + r.along - 1.0) * e.rest_length),
        area,
        triangles: [left.triangle, right.triangle],
    })
}

/// A rest triangle seen from one of its edges.
pub(super) struct RestLeaf {
    /// Height over the edge, m.
    pub height: f64,
    /// Foot of the height along the edge, 0 at its start.
    pub along: f64,
    /// Unit direction across the edge, away from the triangle, in its rest frame.
    pub across: Vector2<f64>,
}

fn leaf_of(sheet: &Sheet, side: &Side) -> RestLeaf {
    leaf(sheet, side.triangle as usize, side.corner as usize)
}

/// Triangle `t` seen from the edge opposite corner `k`.
pub(super) fn leaf(sheet: &Sheet, t: usize, k: usize) -> RestLeaf {
    let corners = &sheet.rest()[t];
    let (a, b, p) = (corners[(k + 1) % 3], corners[(k + 2) % 3], corners[k]);
    let e = b - a;
    let length = e.norm();
    RestLeaf {
        height: e.perp(&(p - a)) / length,
        along: e.dot(&(p - a)) / (length * length),
        across: Vector2::new(e.y, -e.x) / length,
    }
}
