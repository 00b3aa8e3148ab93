//! Own kernels beside those of the libraries that could stand in for them: times and differences on
//! the same input.

use crate::Progress;
use image::{GrayImage, Luma, RgbImage};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::PointQuery;
use parry3d_f64::query::details::closest_points_segment_segment_with_locations;
use parry3d_f64::shape::{Segment, TriMesh, TriMeshFlags, Triangle};
use serde::Serialize;
use std::fmt;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use toile_core::prelude::{Context, Photo, Shared, Stage, StageError};
use toile_core::{Inputs, PortValue};
use toile_geometry::Vec3;
use toile_geometry::closest::{between_segments, on_triangle};
use toile_geometry::shapes::{numbers, sphere};
use toile_geometry::signed_distance::SignedDistance;
use toile_geometry::volume::Aabb;
use toile_stages::binarise::Otsu;
use toile_stages::denoise::{Gaussian, Median};

/// Pairs of features, and points around a body.
const QUERIES: usize = 200_000;
/// Side of the picture, px.
const SIDE: u32 = 1500;

/// One kernel.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// What is computed.
    pub kernel: &'static str,
    /// The library.
    pub library: &'static str,
    /// Time of the own, s.
    pub own_s: f64,
    /// Time of the library's, s.
    pub library_s: f64,
    /// How far the results differ.
    pub differ: String,
}

/// All kernels.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// A row a kernel.
    pub rows: Vec<Row>,
    /// Threads that kernels may use.
    pub threads: usize,
}

/// Measures all kernels, or those before the one at which `progress` stops.
///
/// # Errors
/// A kernel that refuses its input.
pub fn libraries(progress: &mut Progress<'_>) -> Result<Report, StageError> {
    let kernels: [fn() -> Result<Row, StageError>; 7] =
        [triangle, segments, distance, || median(1), || median(5), gaussian, otsu];
    let mut rows = Vec::new();
    for (k, kernel) in kernels.iter().enumerate() {
        if progress(k as f64 / kernels.len() as f64, "kernels").is_break() {
            break;
        }
        rows.push(kernel()?);
    }
    Ok(Report { rows, threads: rayon::current_num_threads() })
}

fn points(seed: u64, count: usize, size: f64) -> Vec<Vec3> {
    let mut next = numbers(seed);
    (0..count).map(|_| Vec3::new(next(), next(), next()) * size).collect()
}

fn vector(p: &Vec3) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

/// The best time of three.
fn best<T>(mut work: impl FnMut() -> T) -> (T, f64) {
    let mut timed = || {
        let start = Instant::now();
        let done = black_box(work());
        (done, start.elapsed().as_secs_f64())
    };
    let (mut done, mut least) = timed();
    for _ in 0..2 {
        let (again, seconds) = timed();
        (done, least) = (again, least.min(seconds));
    }
    (done, least)
}

fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

fn triangle() -> Result<Row, StageError> {
    let p = points(1, 4 * QUERIES, 1.0);
    let corners = |k: usize| [p[4 * k + 1], p[4 * k + 2], p[4 * k + 3]];
    let (own, own_s) =
        best(|| (0..QUERIES).map(|k| on_triangle(&p[4 * k], &corners(k)).point).collect::<Vec<_>>());
    let (theirs, library_s) = best(|| {
        let at = |k: usize| {
            let [a, b, c] = corners(k).map(|c| vector(&c));
            Triangle::new(a, b, c).project_local_point(vector(&p[4 * k]), false).point
        };
        (0..QUERIES).map(at).collect::<Vec<_>>()
    });
    let apart = greatest(
        own.iter()
            .zip(&theirs)
            .enumerate()
            .map(|(k, (a, b))| (p[4 * k] - a).norm() - (vector(&p[4 * k]) - *b).length()),
    );
    Ok(row(
        "closest point of a triangle",
        "parry3d",
        own_s,
        library_s,
        format!("distances by {apart:.0e} of 1"),
    ))
}

fn segments() -> Result<Row, StageError> {
    let p = points(2, 4 * QUERIES, 1.0);
    let at = |k: usize| [p[4 * k], p[4 * k + 1], p[4 * k + 2], p[4 * k + 3]];
    let between = |[a, b, c, d]: [Vec3; 4], (s, t): (f64, f64)| (a + (b - a) * s - c - (d - c) * t).norm();
    let (own, own_s) = best(|| {
        let one = |k| {
            let [a, b, c, d] = at(k);
            between([a, b, c, d], between_segments(&[a, b], &[c, d]))
        };
        (0..QUERIES).map(one).collect::<Vec<_>>()
    });
    let (theirs, library_s) = best(|| {
        let one = |k| {
            let [a, b, c, d] = at(k).map(|p| vector(&p));
            let (one, two) = (Segment::new(a, b), Segment::new(c, d));
            let (s, t) = closest_points_segment_segment_with_locations(&Pose::IDENTITY, &one, &two);
            let ([s0, s1], [t0, t1]) = (s.barycentric_coordinates(), t.barycentric_coordinates());
            (a * s0 + b * s1 - c * t0 - d * t1).length()
        };
        (0..QUERIES).map(one).collect::<Vec<_>>()
    });
    let apart = greatest(own.iter().zip(&theirs).map(|(a, b)| a - b));
    Ok(row(
        "closest points of two segments",
        "parry3d",
        own_s,
        library_s,
        format!("distances by {apart:.0e} of 1"),
    ))
}

fn distance() -> Result<Row, StageError> {
    let (vertices, triangles) = sphere(0.5, 64, 128);
    let p = points(3, QUERIES / 4, 1.0);
    let index = SignedDistance::<Aabb>::new(vertices.clone(), triangles.clone());
    let (own, own_s) = best(|| p.iter().map(|p| index.distance(p)).collect::<Vec<_>>());
    let mesh = TriMesh::with_flags(vertices.iter().map(vector).collect(), triangles, TriMeshFlags::ORIENTED)
        .map_err(|e| StageError::internal(e.to_string()))?;
    let (theirs, library_s) = best(|| {
        let one = |p: &Vec3| {
            let found = mesh.project_local_point(vector(p), false);
            let distance = (vector(p) - found.point).length();
            if found.is_inside { -distance } else { distance }
        };
        p.iter().map(one).collect::<Vec<_>>()
    });
    let apart = greatest(own.iter().zip(&theirs).map(|(a, b)| a - b));
    let words = format!("by {apart:.0e} m");
    Ok(row("signed distance to a mesh of 16,000 triangles", "parry3d", own_s, library_s, words))
}

/// A dark shape on a light, noisy ground.
fn picture() -> RgbImage {
    let mut state = 1u32;
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = (state >> 27) as u8;
        let is_cloth = (SIDE / 4..3 * SIDE / 4).contains(&x) && (SIDE / 5..4 * SIDE / 5).contains(&y);
        let base = if is_cloth { [60u8, 80, 120] } else { [200, 190, 180] };
        image::Rgb(base.map(|c| c + noise))
    })
}

fn photo(pixels: RgbImage) -> PortValue {
    PortValue::One(Arc::new(Photo {
        pixels: Shared::new(pixels),
        alpha: None,
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: "picture".into(),
    }))
}

fn run(stage: &dyn Stage, input: &PortValue) -> Result<PortValue, StageError> {
    let out = stage.run_ports(&Inputs(vec![Some(input.clone())]), &Context::quiet())?;
    out.into_iter().next().ok_or_else(|| StageError::internal("no output"))
}

fn pixels(out: &PortValue) -> Option<&RgbImage> {
    match out {
        PortValue::One(one) => {
            (one.as_ref() as &dyn std::any::Any).downcast_ref::<Photo>().map(|p| &*p.pixels)
        }
        _ => None,
    }
}

/// A filter of one channel, on each of three.
fn by_channel(image: &RgbImage, filter: impl Fn(&GrayImage) -> GrayImage) -> RgbImage {
    let channel = |c: usize| {
        filter(&GrayImage::from_fn(image.width(), image.height(), |x, y| Luma([image.get_pixel(x, y)[c]])))
    };
    let [r, g, b] = [channel(0), channel(1), channel(2)];
    RgbImage::from_fn(image.width(), image.height(), |x, y| {
        image::Rgb([&r, &g, &b].map(|c| c.get_pixel(x, y)[0]))
    })
}

/// How far two pictures differ more than `border` px from the frame, grey levels.
fn levels(a: Option<&RgbImage>, b: &RgbImage, border: u32) -> String {
    let Some(a) = a else { return "no picture".into() };
    let inner = |x: u32, y: u32| x.min(y).min(SIDE - 1 - x).min(SIDE - 1 - y) >= border;
    let pairs = a.enumerate_pixels().filter(|(x, y, _)| inner(*x, *y));
    let apart = pairs.flat_map(|(x, y, p)| (0..3).map(move |c| p[c].abs_diff(b.get_pixel(x, y)[c]))).max();
    format!("by {} grey levels", apart.unwrap_or(0))
}

fn median(radius: u32) -> Result<Row, StageError> {
    let (picture, stage) = (picture(), Median { radius });
    let input = photo(picture.clone());
    let (own, own_s) = best(|| run(&stage, &input));
    let (theirs, library_s) =
        best(|| by_channel(&picture, |c| imageproc::filter::median_filter(c, radius, radius)));
    let kernel = if radius == 1 { "median, radius 1, of a photo" } else { "median, radius 5, of a photo" };
    Ok(row(kernel, "imageproc", own_s, library_s, levels(pixels(&own?), &theirs, radius)))
}

fn gaussian() -> Result<Row, StageError> {
    let picture = picture();
    let input = photo(picture.clone());
    let (own, own_s) = best(|| run(&Gaussian { sigma: 1.0 }, &input));
    let (theirs, library_s) = best(|| by_channel(&picture, |c| imageproc::filter::gaussian_blur_f32(c, 1.0)));
    Ok(row(
        "Gaussian, sigma 1 px, of a photo",
        "imageproc",
        own_s,
        library_s,
        levels(pixels(&own?), &theirs, 6),
    ))
}

fn otsu() -> Result<Row, StageError> {
    let picture = picture();
    let input = photo(picture.clone());
    let (own, own_s) = best(|| run(&Otsu::default(), &input).map(drop));
    own?;
    let (_, library_s) = best(|| {
        let grey = image::imageops::grayscale(&picture);
        let level = imageproc::contrast::otsu_level(&grey);
        imageproc::contrast::threshold(&grey, level, imageproc::contrast::ThresholdType::BinaryInverted)
    });
    let words = "own: holes, specks and the frame's rim as well";
    Ok(row("Otsu's threshold, of a photo", "imageproc", own_s, library_s, words.into()))
}

fn row(kernel: &'static str, library: &'static str, own_s: f64, library_s: f64, differ: String) -> Row {
    Row { kernel, library, own_s, library_s, differ }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} threads; the best of three runs\n", self.threads)?;
        writeln!(
            f,
            "| kernel | library | own, ms | library, ms | library over own | results differ |\n|---|---|---|---|---|---|"
        )?;
        for r in &self.rows {
            let (own, theirs, ratio) = (1e3 * r.own_s, 1e3 * r.library_s, r.library_s / r.own_s);
            let (kernel, library, differ) = (r.kernel, r.library, &r.differ);
            writeln!(f, "| {kernel} | {library} | {own:.1} | {theirs:.1} | {ratio:.1} | {differ} |")?;
        }
        Ok(())
    }
}

impl Report {
    /// As one JSON object.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}
