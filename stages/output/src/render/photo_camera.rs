//! Where points of a model fall in a photo of it that was taken from a known side, and which of
//! them are seen.
//!
//! Method: turn and height of the camera and its focal length are given; how far it is and where it
//! points follow from the box that the garment fills in the photo. What lies no deeper than the
//! nearest surface at its pixel is seen. Cost: one pass over the triangles. Limits: the camera is
//! held upright; the box is matched, not the outline.

use super::camera::{Camera, Frame, NEAREST, View, framed_points};
use super::cover::CoveredTriangle;
use toile_core::artifact::{Model, Point3, Vector3};

/// What lies this much deeper than the nearest surface is still seen, metres.
const TOLERANCE: f64 = 4e-3;

/// Rounds in which distance and aim are matched: each moves what the others had matched a little.
const ROUNDS: usize = 8;

/// The middle of a pixel, sub-pixel steps.
const MIDDLE: [[i64; 2]; 1] = [[128, 128]];

/// The camera of a photo.
#[derive(Debug)]
pub(crate) struct PhotoCamera {
    camera: Camera,
    /// The nearness of the nearest surface at each pixel; 0 where there is none.
    nearest: Vec<f64>,
    size: [usize; 2],
}

/// How a photo was taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PhotoShot {
    /// Turn of the camera about the vertical, radians; 0 sees the wearer's front.
    pub(crate) azimuth: f64,
    /// Height of the camera above the horizon, radians.
    pub(crate) elevation: f64,
    /// Focal length, px.
    pub(crate) focal: f64,
    /// Width and height of the photo, px.
    pub(crate) size: [u32; 2],
    /// The box that the garment fills: left, top, right, bottom, px from the corner of the photo.
    pub(crate) filled: [f64; 4],
}

impl PhotoCamera {
    /// The camera with which the garment of the model fills the box.
    pub(crate) fn new(model: &Model, shot: &PhotoShot) -> PhotoCamera {
        let [width, height] = shot.size;
        let view = View {
            azimuth: shot.azimuth,
            elevation: shot.elevation,
            angle: 2.0 * (0.5 * f64::from(height) / shot.focal).atan(),
            width,
            height,
            frame: Frame::Garment,
            margin: 0.0,
        };
        let mut camera = Camera::fit(model, &view);
        let deep = |c: &Camera, p: &Point3| c.back.dot(&(p - c.target));
        let least =
            framed_points(model, Frame::Whole).map(|p| deep(&camera, p)).fold(0.0, f64::max) + NEAREST;
        for _ in 0..ROUNDS {
            let own = filled(&camera, model);
            let scale =
                ((side(&own, 0) * side(&own, 1)) / (side(&shot.filled, 0) * side(&shot.filled, 1))).sqrt();
            camera.distance = (camera.distance * scale).max(least);
            let own = filled(&camera, model);
            for k in 0..2 {
                camera.centre[k] += middle(&shot.filled, k) - middle(&own, k);
            }
        }
        let size = shot.size.map(|n| n as usize);
        let nearest = nearest(&camera, model, size);
        PhotoCamera { camera, nearest, size }
    }

    /// Where a point falls, px from the corner of the photo, if it is seen.
    pub(crate) fn seen(&self, p: &Point3) -> Option<[f64; 2]> {
        let at = self.camera.project(p);
        let within = at.x >= 0.0 && at.y >= 0.0 && at.x < self.size[0] as f64 && at.y < self.size[1] as f64;
        let nearest = within.then(|| self.nearest[at.y as usize * self.size[0] + at.x as usize])?;
        // At the very outline no surface covers the middle of the pixel.
        let is_seen = nearest == 0.0 || 1.0 / at.near <= 1.0 / nearest + TOLERANCE;
        is_seen.then_some([at.x, at.y])
    }

    /// The direction from a point to the camera.
    pub(crate) fn towards(&self, p: &Point3) -> Vector3 {
        (self.camera.target + self.camera.back * self.camera.distance - p).normalize()
    }
}

fn side(filled: &[f64; 4], axis: usize) -> f64 {
    (filled[axis + 2] - filled[axis]).max(1e-9)
}

fn middle(filled: &[f64; 4], axis: usize) -> f64 {
    f64::midpoint(filled[axis], filled[axis + 2])
}

/// The box that the garment fills in the picture.
fn filled(camera: &Camera, model: &Model) -> [f64; 4] {
    let none = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    framed_points(model, Frame::Garment)
        .map(|p| camera.project(p))
        .fold(none, |b, p| [b[0].min(p.x), b[1].min(p.y), b[2].max(p.x), b[3].max(p.y)])
}

/// The nearness of the nearest surface at each pixel.
fn nearest(camera: &Camera, model: &Model, [width, height]: [usize; 2]) -> Vec<f64> {
    let mut nearest = vec![0.0; width * height];
    for mesh in &model.meshes {
        for t in &mesh.triangles {
            let corners = t.map(|v| camera.project(&mesh.positions[v as usize]));
            let Some(covered) = CoveredTriangle::new(corners) else { continue };
            covered.scan(width as i64, 0..height as i64, &MIDDLE, |_, x, y, near| {
                let slot: &mut f64 = &mut nearest[y * width + x];
                *slot = slot.max(near);
            });
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::render::parts;
    use toile_core::artifact::Mesh;

    /// A square of `half` metres to each side of a place, that looks forwards.
    fn square(name: &str, at: Point3, half: f64) -> Mesh {
        let corner = |x: f64, y: f64| at + Vector3::new(x * half, y * half, 0.0);
        Mesh {
            name: name.to_owned(),
            positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            normals: vec![Vector3::z(); 4],
            uv: Vec::new(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            material: 0,
        }
    }

    fn model(meshes: Vec<Mesh>) -> Model {
        Model { meshes, materials: vec![parts::plain_cloth("cloth", [1.0; 3])], ..Model::default() }
    }

    #[test]
    fn the_garment_fills_its_box() {
        let model = model(vec![square("front", Point3::new(0.3, 1.1, 0.2), 0.4)]);
        let filled = [40.0, 30.0, 140.0, 130.0];
        let shot = PhotoShot { azimuth: 0.0, elevation: 0.0, focal: 400.0, size: [200, 160], filled };
        let camera = PhotoCamera::new(&model, &shot);
        let corner = |k: usize| camera.seen(&model.meshes[0].positions[k]);
        let near =
            |a: Option<[f64; 2]>, b: [f64; 2]| a.is_some_and(|a| (0..2).all(|k| (a[k] - b[k]).abs() < 0.1));
        assert!(
            near(corner(0), [40.0, 130.0]) && near(corner(2), [140.0, 30.0]),
            "{:?} {:?}",
            corner(0),
            corner(2)
        );
        // 0.8 m fill 100 px at a focal length of 400 px: the camera is 3.2 m away.
        let away = camera.towards(&Point3::new(0.3, 1.1, 0.2));
        assert!((away - Vector3::z()).norm() < 0.1, "{away}");
        assert!((camera.camera.distance - 3.2).abs() < 0.01, "{}", camera.camera.distance);
    }

    #[test]
    fn what_is_behind_something_else_is_not_seen() {
        let behind = square("back", Point3::new(0.0, 1.0, -0.1), 0.2);
        let model = model(vec![square("front", Point3::new(0.0, 1.0, 0.1), 0.4), behind]);
        let filled = [10.0, 10.0, 150.0, 150.0];
        let shot = PhotoShot { azimuth: 0.0, elevation: 0.0, focal: 400.0, size: [160, 160], filled };
        let camera = PhotoCamera::new(&model, &shot);
        assert!(camera.seen(&Point3::new(0.0, 1.0, 0.1)).is_some());
        assert!(camera.seen(&Point3::new(0.0, 1.0, -0.1)).is_none());
    }
}
