//! Pictures of small models whose pixels are known beforehand.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::camera::Projected;
use super::cover::{CoveredTriangle, STEPS};
use super::{Frame, ModelScene, OverlayLine, PictureForm, View, garment_model, pictures_of, render};
use image::{Rgb, RgbImage};
use proptest::prelude::*;
use toile_core::artifact::*;
use toile_fixtures::photographed;

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

/// A square of 1 m across the z axis at depth `z`.
fn square(name: &str, z: f64, half: f64, material: usize) -> Mesh {
    let corner = |x: f64, y: f64| Point3::new(x * half, y * half, z);
    Mesh {
        name: name.to_owned(),
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        normals: vec![Vector3::z(); 4],
        uv: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material,
    }
}

fn paint(colour: [f32; 3]) -> Material {
    Material { colour, unlit: true, roughness: 1.0, ..crate::render::parts::plain_cloth("paint", colour) }
}

fn red_square() -> Model {
    Model { meshes: vec![square("a", 0.0, 0.5, 0)], materials: vec![paint(RED)], ..Model::default() }
}

/// A view straight from the front in parallel projection.
fn flat(width: u32, height: u32) -> View {
    View { azimuth: 0.0, elevation: 0.0, angle: 0.0, width, height, frame: Frame::Whole, margin: 0.25 }
}

#[test]
fn a_square_covers_the_expected_pixels() {
    for angle in [0.0, 0.5] {
        let picture = render(&red_square(), &View { angle, ..flat(40, 40) });
        for (x, y, p) in picture.enumerate_pixels() {
            let inside = (10..30).contains(&x) && (10..30).contains(&y);
            assert_eq!(p.0 == [255, 0, 0], inside, "at {x}, {y} with angle {angle}: {p:?}");
        }
    }
}

#[test]
fn both_faces_are_drawn() {
    let mut model = red_square();
    model.meshes[0].triangles.iter_mut().for_each(|t| t.reverse());
    assert_eq!(render(&model, &flat(40, 40)), render(&red_square(), &flat(40, 40)));
}

#[test]
fn the_nearer_surface_hides_the_farther_in_any_order() {
    let meshes = vec![square("near", 0.1, 0.25, 0), square("far", 0.0, 0.5, 1)];
    let materials = vec![paint(RED), paint(BLUE)];
    let model = Model { meshes, materials, ..Model::default() };
    let mut turned = model.clone();
    turned.meshes.reverse();
    for view in [flat(40, 40), View { angle: 0.4, ..flat(40, 40) }] {
        let picture = render(&model, &view);
        assert_eq!(picture.get_pixel(20, 20).0, [255, 0, 0]);
        assert_eq!(picture.get_pixel(12, 12).0, [0, 0, 255]);
        assert_eq!(picture, render(&turned, &view));
    }
    // From behind the blue square hides the red one.
    let behind = View { azimuth: std::f64::consts::PI, ..flat(40, 40) };
    assert_eq!(render(&model, &behind).get_pixel(20, 20).0, [0, 0, 255]);
}

#[test]
fn the_wearers_left_is_at_the_right_from_the_front_and_faces_us_from_the_side() {
    let mut model = red_square();
    model.materials.push(paint(BLUE));
    let mut left = square("b", 0.0, 0.1, 1);
    left.positions.iter_mut().for_each(|p| *p = Point3::new(0.4, p.y, p.x));
    model.meshes.push(left);
    let blue = |view: View| {
        let picture = render(&model, &View { angle: 0.0, elevation: 0.0, ..view });
        picture
            .enumerate_pixels()
            .filter(|(_, _, p)| p.0[2] > 200 && p.0[0] < 100)
            .map(|(x, ..)| x)
            .collect::<Vec<_>>()
    };
    let front = blue(View::front(100));
    assert!(front.iter().all(|&x| x > 50), "{front:?}");
    assert!(!blue(View::side(100)).is_empty());
}

#[test]
fn a_texture_stands_upright() {
    let pixels = RgbImage::from_fn(2, 2, |x, y| match (x, y) {
        (0, 0) => Rgb([255, 0, 0]),
        (1, 0) => Rgb([0, 255, 0]),
        (0, _) => Rgb([0, 0, 255]),
        _ => Rgb([255, 255, 255]),
    });
    let texture = Texture { name: "t".into(), pixels: Shared::new(pixels), repeats: false };
    let material = Material { texture: Some(0), ..paint([1.0; 3]) };
    let model = Model {
        meshes: vec![square("a", 0.0, 0.5, 0)],
        materials: vec![material],
        textures: vec![texture],
        ..Model::default()
    };
    let picture = render(&model, &flat(80, 80));
    assert_eq!(picture.get_pixel(22, 22).0, [255, 0, 0]);
    assert_eq!(picture.get_pixel(57, 22).0, [0, 255, 0]);
    assert_eq!(picture.get_pixel(22, 57).0, [0, 0, 255]);
    assert_eq!(picture.get_pixel(57, 57).0, [255, 255, 255]);
}

#[test]
fn a_texture_that_repeats_goes_on_beyond_its_edges() {
    let pixels = RgbImage::from_fn(2, 1, |x, _| Rgb([if x == 0 { 255 } else { 0 }, 0, 255]));
    let texture = Texture { name: "t".into(), pixels: Shared::new(pixels), repeats: true };
    let mut square = square("a", 0.0, 0.5, 0);
    // Two repeats across.
    square.uv.iter_mut().for_each(|uv| uv[0] = uv[0] * 2.0 - 7.0);
    let material = Material { texture: Some(0), ..paint([1.0; 3]) };
    let model = Model {
        meshes: vec![square],
        materials: vec![material],
        textures: vec![texture],
        ..Model::default()
    };
    let picture = render(&model, &flat(80, 80));
    let reds: Vec<u8> = [25, 35, 45, 55].map(|x| picture.get_pixel(x, 40).0[0]).to_vec();
    assert!(reds[0] > 200 && reds[1] < 100 && reds[2] > 200 && reds[3] < 100, "{reds:?}");
}

#[test]
fn a_fine_pattern_seen_from_afar_turns_even() {
    let pixels = RgbImage::from_fn(512, 512, |x, y| Rgb([if (x + y) % 2 == 0 { 255 } else { 0 }; 3]));
    let texture = Texture { name: "t".into(), pixels: Shared::new(pixels), repeats: false };
    let material = Material { texture: Some(0), ..paint([1.0; 3]) };
    let model = Model {
        meshes: vec![square("a", 0.0, 0.5, 0)],
        materials: vec![material],
        textures: vec![texture],
        ..Model::default()
    };
    let picture = render(&model, &flat(64, 64));
    // Half of the light is level 188 in sRGB.
    for p in (20..44).map(|x| picture.get_pixel(x, 30).0) {
        assert!(p.iter().all(|c| c.abs_diff(188) <= 2), "{p:?}");
    }
}

#[test]
fn empty_degenerate_and_broken_models_give_a_picture() {
    let background = render(&Model::default(), &flat(32, 24));
    assert_eq!(background.dimensions(), (32, 24));
    let mut model = red_square();
    model.meshes[0].triangles = vec![[0, 0, 1], [0, 1, 99], [1, 1, 1]];
    assert_eq!(render(&model, &flat(32, 24)), background);
    let mut model = red_square();
    model.meshes[0].positions.iter_mut().for_each(|p| p.x = f64::NAN);
    assert_eq!(render(&model, &flat(32, 24)), background);
    let mut model = red_square();
    model.meshes[0].positions.iter_mut().for_each(|p| *p = Point3::origin());
    assert_eq!(render(&model, &flat(32, 24)), background);
    let mut model = red_square();
    model.meshes[0].normals.clear();
    model.materials.clear();
    assert_eq!(render(&model, &flat(32, 24)), background);
}

#[test]
fn one_and_two_threads_give_the_same_bits() {
    let model = garment_model(&photographed::garment(10), Some(&photographed::body()));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| ModelScene::draft(&model).render(&View::front(150)))
    };
    assert_eq!(with(1), with(2));
}

#[test]
fn what_stands_in_a_hollow_is_darker() {
    // A lit plate with a tall wall to its left, the side from which the key light comes.
    let lit = Material { unlit: false, ..paint([0.5; 3]) };
    let mut wall = square("wall", 0.5, 0.5, 0);
    wall.positions.iter_mut().for_each(|p| *p = Point3::new(-0.5, p.y, p.x + 0.5));
    wall.normals = vec![Vector3::x(); 4];
    let fine = |n: usize| {
        let at = |k: usize| k as f64 / n as f64 - 0.5;
        let mut plate = square("plate", 0.0, 0.5, 0);
        plate.positions =
            (0..=n).flat_map(|j| (0..=n).map(move |i| Point3::new(at(i), at(j), 0.0))).collect();
        plate.normals = vec![Vector3::z(); plate.positions.len()];
        plate.uv = Vec::new();
        let cell = |i: usize, j: usize| {
            let v = |i: usize, j: usize| (j * (n + 1) + i) as u32;
            [[v(i, j), v(i + 1, j), v(i + 1, j + 1)], [v(i, j), v(i + 1, j + 1), v(i, j + 1)]]
        };
        plate.triangles = (0..n).flat_map(|j| (0..n).flat_map(move |i| cell(i, j))).collect();
        plate
    };
    let model = Model { meshes: vec![fine(20), wall], materials: vec![lit], ..Model::default() };
    let picture = render(&model, &flat(80, 80));
    let (near_wall, open) = (picture.get_pixel(23, 40).0[0], picture.get_pixel(57, 40).0[0]);
    assert!(near_wall + 30 < open, "{near_wall} against {open}");
}

#[test]
fn lines_are_drawn_over_the_model() {
    let model = red_square();
    let line = OverlayLine {
        ends: [Point3::new(-1.0, 0.0, -1.0), Point3::new(1.0, 0.0, -1.0)],
        colour: [0, 0, 0],
        width: 3.0,
    };
    let picture = ModelScene::new(&model).render_with(&flat(41, 41), &[line]);
    assert_eq!(picture.get_pixel(20, 20).0, [0, 0, 0]);
    assert_eq!(picture.get_pixel(20, 12).0, [255, 0, 0]);
}

#[test]
fn every_kind_that_has_a_look_has_pictures() {
    let (garment, body, photos) = (photographed::garment(4), photographed::body(), photographed::photos());
    let count = |artifact: &dyn Artifact| pictures_of(artifact, Some(&body), 60).len();
    assert_eq!(count(photos.get("front").unwrap()), 1);
    assert_eq!(count(&garment), 2);
    assert_eq!(count(&body), 2);
    assert_eq!(count(&garment_model(&garment, None)), 2);
    assert_eq!(count(&SewingPlan::default()), 0);
    let mask = Mask { pixels: Shared::new(image::GrayImage::new(0, 0)) };
    assert!(count(&mask) <= 1, "a mask without pixels is no panic");
}

#[test]
fn an_edge_name_cannot_leave_its_label() {
    let panel = Panel {
        positions: vec![Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)],
        triangles: vec![[0, 1, 2]],
        boundary: vec![0, 1, 2],
        holes: Vec::new(),
        edges: vec![PanelEdge { name: "<script>&".into(), vertices: vec![0, 1] }],
        inner: Vec::new(),
        photo_px: Vec::new(),
        outline_area: 0.5,
        outline_length: 3.4,
    };
    let pictures = pictures_of(&panel, None, 100);
    let PictureForm::Svg(svg) = &pictures[0].form else { panic!("no drawing") };
    assert!(svg.contains(">&lt;script&gt;&amp;</text>"), "{svg}");
}

fn corner() -> impl Strategy<Value = (f64, f64)> {
    (-10.0..30.0, -10.0..30.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// Two triangles on both sides of an edge cover, between them, every sample of the quadrangle's
    /// inside.
    #[test]
    fn neighbours_leave_no_gap(a in corner(), b in corner(), c in corner(), d in corner()) {
        let at = |(x, y): (f64, f64)| Projected { x, y, near: 0.0, inv_w: 1.0 };
        let side = |p: (f64, f64), q: (f64, f64), r: (f64, f64)| {
            let snap = |v: f64| (v * STEPS as f64).round();
            let [p, q, r] = [p, q, r].map(|(x, y)| (snap(x), snap(y)));
            (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0)
        };
        // c and d on different sides of ab.
        prop_assume!(side(a, b, c) > 0.0 && side(a, b, d) < 0.0);
        let mut hits = vec![0; 20 * 20];
        for t in [[a, b, c], [b, a, d]] {
            if let Some(patch) = CoveredTriangle::new(t.map(at)) {
                patch.scan(20, 0..20, &[[128, 128]], |_, x, y, _| hits[y * 20 + x] += 1);
            }
        }
        for (i, count) in hits.into_iter().enumerate() {
            let p = ((i % 20) as f64 + 0.5, (i / 20) as f64 + 0.5);
            let within = |u, v, w| side(u, v, p) >= 0.0 && side(v, w, p) >= 0.0 && side(w, u, p) >= 0.0;
            let want = i32::from(within(a, b, c)) + i32::from(within(b, a, d));
            prop_assert_eq!(count, want, "at {:?}", p);
        }
    }

    #[test]
    fn any_floats_are_survived(v in proptest::collection::vec(proptest::num::f64::ANY, 9)) {
        let mut model = red_square();
        model.meshes[0].positions[..3].iter_mut().zip(v.chunks(3)).for_each(|(p, v)| *p = Point3::new(v[0], v[1], v[2]));
        let picture = ModelScene::draft(&model).render(&View::front(20));
        prop_assert_eq!(picture.dimensions(), (16, 20));
    }
}

#[test]
fn a_normal_map_turns_the_light_as_its_normals_lean() {
    let brightness = |texel: [u8; 3]| {
        let pixels = Shared::new(RgbImage::from_pixel(4, 4, image::Rgb(texel)));
        let map = Texture { name: "n".into(), pixels, repeats: true };
        let material = Material { normal_texture: Some(0), unlit: false, ..paint([0.5; 3]) };
        let model = Model {
            meshes: vec![square("a", 0.0, 0.5, 0)],
            materials: vec![material],
            textures: vec![map],
            ..Model::default()
        };
        let picture = render(&model, &View::front(40));
        picture.get_pixel(picture.width() / 2, 20).0[0]
    };
    // The key light comes from above left.
    let (flat, left, right) =
        (brightness([128, 128, 255]), brightness([60, 128, 236]), brightness([196, 128, 236]));
    assert!(left > right + 10, "{left} {flat} {right}");
    let (up, down) = (brightness([128, 196, 236]), brightness([128, 60, 236]));
    assert!(up > down + 10, "{up} {flat} {down}");
}

#[test]
fn sheen_brightens_what_is_seen_at_a_slant() {
    let brightness = |sheen: f32, turn: f64| {
        let sheen = (sheen > 0.0).then_some(Sheen { colour: [sheen; 3], roughness: 0.5 });
        let material = Material { sheen, unlit: false, ..paint([0.2; 3]) };
        let mut board = square("a", 0.0, 0.5, 0);
        let turned = nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), turn);
        board.positions.iter_mut().for_each(|p| *p = turned * *p);
        board.normals.iter_mut().for_each(|n| *n = turned * *n);
        let model = Model { meshes: vec![board], materials: vec![material], ..Model::default() };
        let picture = render(&model, &View::front(40));
        i32::from(picture.get_pixel(picture.width() / 2, 20).0[0])
    };
    let gain = |turn: f64| brightness(0.5, turn) - brightness(0.0, turn);
    assert!(gain(0.0) >= 0 && gain(-1.3) > gain(0.0) + 5, "{} {}", gain(0.0), gain(-1.3));
}
