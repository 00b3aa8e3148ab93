//! Where the camera stands: framed so that what matters fills the picture.
//!
//! The distance is the least at which every framed point falls inside the margins, and never so
//! small that anything of the model lies behind the camera; so no triangle is ever clipped.

use toile_core::artifact::{Model, Point3, Vector3};

/// What of a model fills the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// The garment; the body may run out of the picture.
    Garment,
    /// Everything.
    Whole,
}

/// A picture to be made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Turn of the camera about the vertical, radians: 0 sees the wearer's front, pi/2 the
    /// wearer's left side, pi the back.
    pub azimuth: f64,
    /// Height of the camera above the horizon, radians.
    pub elevation: f64,
    /// Vertical angle of view, radians; 0 for a parallel projection.
    pub angle: f64,
    /// Width of the picture, px.
    pub width: u32,
    /// Height of the picture, px.
    pub height: u32,
    /// What fills the picture.
    pub frame: Frame,
    /// Share of the picture left free at each side.
    pub margin: f64,
}

/// About that of an 85 mm portrait lens: near enough for depth, far enough to keep proportions.
pub(super) const PORTRAIT_ANGLE: f64 = 0.32;
/// A little from above, as a person looks at another.
pub(super) const EYE_ELEVATION: f64 = 0.06;
/// Room around the garment, so that it does not touch the picture's edge.
const MARGIN: f64 = 0.09;

impl View {
    /// A view from a turn about the vertical, four wide to five high.
    pub fn turned(azimuth: f64, height: u32) -> View {
        View {
            azimuth,
            elevation: EYE_ELEVATION,
            angle: PORTRAIT_ANGLE,
            width: height * 4 / 5,
            height,
            frame: Frame::Garment,
            margin: MARGIN,
        }
    }

    /// The wearer's front.
    pub fn front(height: u32) -> View {
        View::turned(0.0, height)
    }

    /// The wearer's back.
    pub fn back(height: u32) -> View {
        View::turned(std::f64::consts::PI, height)
    }

    /// Between the wearer's front and left side.
    pub fn three_quarter(height: u32) -> View {
        View::turned(std::f64::consts::FRAC_PI_4, height)
    }

    /// The wearer's left side.
    pub fn side(height: u32) -> View {
        View::turned(std::f64::consts::FRAC_PI_2, height)
    }
}

/// A point as the rasteriser takes it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projected {
    /// Pixels from the left edge.
    pub(super) x: f64,
    /// Pixels from the top edge.
    pub(super) y: f64,
    /// Greater is nearer; linear over the picture plane.
    pub(super) near: f64,
    /// Weight that makes attributes linear over the picture plane: 1 / depth, or 1 in parallel
    /// projection.
    pub(super) inv_w: f64,
}

/// A view fitted to a model.
#[derive(Debug, Clone)]
pub(super) struct Camera {
    pub(super) right: Vector3,
    pub(super) up: Vector3,
    /// From the model to the camera.
    pub(super) back: Vector3,
    pub(super) target: Point3,
    /// Distance of the eye from the target, metres; infinite in parallel projection.
    pub(super) distance: f64,
    /// Pixels a metre at the target's depth (parallel), or pixels at depth 1 (perspective).
    pub(super) focal: f64,
    pub(super) centre: [f64; 2],
}

/// No nearer than this to the camera, metres: keeps 1 / depth bounded.
pub(super) const NEAREST: f64 = 0.05;
/// Half the size that an empty or point-like model is given, metres.
const LEAST_EXTENT: f64 = 1e-3;

impl Camera {
    /// The camera of a view, fitted to the model.
    pub(super) fn fit(model: &Model, view: &View) -> Camera {
        let [right, up, back] = axes(view.azimuth, view.elevation);
        let along = |p: &Point3| Vector3::new(right.dot(&p.coords), up.dot(&p.coords), back.dot(&p.coords));
        let framed: Vec<Vector3> = framed_points(model, view.frame).map(along).collect();
        let (lo, hi) = bounds(&framed);
        let middle = (lo + hi) / 2.0;
        let half = [f64::from(view.width) / 2.0, f64::from(view.height) / 2.0];
        let room = half.map(|h| h * (1.0 - 2.0 * view.margin.clamp(0.0, 0.45)));
        let target = Point3::from(right * middle.x + up * middle.y + back * middle.z);
        let mut camera =
            Camera { right, up, back, target, distance: f64::INFINITY, focal: 1.0, centre: half };
        if view.angle > 0.0 {
            camera.focal = half[1] / (view.angle / 2.0).tan();
            let fits = |p: &Vector3| {
                let p = p - middle;
                let need = (p.x.abs() / room[0]).max(p.y.abs() / room[1]) * camera.focal;
                p.z + need
            };
            let nearest =
                framed_points(model, Frame::Whole).map(|p| along(p).z - middle.z).fold(0.0, f64::max);
            let least = (LEAST_EXTENT / room[1]) * camera.focal;
            camera.distance = framed.iter().map(fits).fold(least, f64::max).max(nearest + NEAREST);
        } else {
            let extent = (hi - lo) / 2.0;
            camera.focal = (room[0] / extent.x.max(LEAST_EXTENT)).min(room[1] / extent.y.max(LEAST_EXTENT));
        }
        camera
    }

    /// Where a point falls.
    pub(super) fn project(&self, p: &Point3) -> Projected {
        let d = p - self.target;
        let (x, y, z) = (self.right.dot(&d), self.up.dot(&d), self.back.dot(&d));
        let (inv_w, near) = match self.distance.is_finite() {
            true => (1.0 / (self.distance - z), 1.0 / (self.distance - z)),
            false => (1.0, z),
        };
        let scale = self.focal * inv_w;
        Projected { x: self.centre[0] + x * scale, y: self.centre[1] - y * scale, near, inv_w }
    }

    /// A direction given in the camera's axes (right, up, towards the camera), in the world's.
    pub(super) fn to_world(&self, v: [f64; 3]) -> Vector3 {
        (self.right * v[0] + self.up * v[1] + self.back * v[2]).normalize()
    }
}

/// Right, up and from the model to the camera, by its turn about the vertical and its height above
/// the horizon, radians.
pub(super) fn axes(azimuth: f64, elevation: f64) -> [Vector3; 3] {
    let ((se, ce), (sa, ca)) = (elevation.sin_cos(), azimuth.sin_cos());
    let (right, back) = (Vector3::new(ca, 0.0, -sa), Vector3::new(ce * sa, se, ce * ca));
    [right, back.cross(&right), back]
}

/// Finite points of what is to be framed; everything where there is no garment.
pub(super) fn framed_points(model: &Model, frame: Frame) -> impl Iterator<Item = &Point3> {
    let garment = model.meshes.iter().any(|m| m.name != super::BODY);
    let skip_body = frame == Frame::Garment && garment;
    model
        .meshes
        .iter()
        .filter(move |m| !(skip_body && m.name == super::BODY))
        .flat_map(|m| &m.positions)
        .filter(|p| p.iter().all(|c| c.is_finite()))
}

/// Least and greatest corner; a point at the origin for an empty list.
pub(super) fn bounds(points: &[Vector3]) -> (Vector3, Vector3) {
    let Some(&first) = points.first() else { return (Vector3::zeros(), Vector3::zeros()) };
    points.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)))
}
