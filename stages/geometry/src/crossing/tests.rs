#![allow(clippy::panic, clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::cloth_tree::ClothTree;
use crate::shapes::{ShapeMesh, cube, numbers, sheet, soup, sphere};
use crate::volume::{BoundingSphere, KDop, Obb};

fn found<V: BoundingVolume>(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    ClothTree::<V>::of(triangles, positions).exact_crossings(positions)
}

/// Three points and a triangle of the plane z = 0 with corners at 0, x and y.
fn against_unit(points: [[f64; 3]; 3]) -> bool {
    let mut positions = vec![Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    positions.extend(points.map(Vec3::from));
    cross(&positions, &[0, 1, 2], &[3, 4, 5])
}

#[test]
fn piercing_crosses_and_touching_does_not() {
    assert!(against_unit([[0.2, 0.2, -1.0], [0.2, 0.2, 1.0], [5.0, 5.0, 1.0]]), "an edge pierces");
    assert!(against_unit([[0.2, 0.2, 1.0], [0.2, 0.2, -1e-300], [5.0, 5.0, 1.0]]), "by a hair");
    assert!(!against_unit([[0.2, 0.2, 1.0], [0.2, 0.2, 0.0], [5.0, 5.0, 1.0]]), "a vertex in the plane");
    assert!(!against_unit([[0.1, 0.1, 0.0], [0.5, 0.1, 0.0], [0.1, 0.5, 0.0]]), "coplanar");
    assert!(!against_unit([[0.2, 0.2, 1.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]]), "parallel");
    assert!(!against_unit([[f64::NAN, 0.2, -1.0], [0.2, 0.2, 1.0], [5.0, 5.0, 1.0]]), "no number");
}

#[test]
fn a_fold_about_one_shared_vertex_can_cross() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, -0.2], [0.3, 0.3, 0.2]]
        .map(Vec3::from);
    assert!(cross(&positions, &[0, 1, 2], &[0, 3, 4]), "the far edge pierces the neighbour");
    assert!(!cross(&positions, &[0, 1, 2], &[0, 1, 4]), "a shared edge never does");
}

#[test]
fn agrees_with_brute_force_for_all_volumes() {
    let (positions, triangles) = soup(11, 400, 0.25);
    let mut brute = Vec::new();
    for i in 0..triangles.len() {
        for j in i + 1..triangles.len() {
            if cross(&positions, &triangles[i], &triangles[j]) {
                brute.push([i as u32, j as u32]);
            }
        }
    }
    assert!(brute.len() > 200, "{} crossings are too few to tell", brute.len());
    assert_eq!(found::<Aabb>(&positions, &triangles), brute);
    assert_eq!(found::<BoundingSphere>(&positions, &triangles), brute);
    assert_eq!(found::<Obb>(&positions, &triangles), brute);
    assert_eq!(found::<KDop<9>>(&positions, &triangles), brute);
}

#[test]
fn a_smooth_sheet_does_not_cross_itself() {
    let (positions, triangles) = sheet(20, |x, y| 0.1 * (9.0 * x).sin() * (7.0 * y).cos());
    assert!(found::<Aabb>(&positions, &triangles).is_empty());
}

#[test]
fn the_inner_side_has_positive_volume() {
    let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from);
    assert!(volume(&a, &b, &c, &Vec3::new(0.0, 0.0, -1.0)) > 0.0);
}

/// Three points against the triangle of the plane z = 0 with corners at 0, x and y.
fn insides_cross_unit(points: [[f64; 3]; 3]) -> bool {
    let unit = [Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let other = points.map(Vec3::from);
    let found = insides_cross(&unit, &other);
    assert_eq!(found, insides_cross(&other, &unit), "either way");
    found
}

#[test]
fn insides_cross_where_they_have_a_segment_in_common() {
    assert!(insides_cross_unit([[0.2, 0.2, -1.0], [0.2, 0.2, 1.0], [5.0, 5.0, 1.0]]), "an edge pierces");
    assert!(insides_cross_unit([[0.2, 0.2, 1.0], [0.2, 0.2, -1e-300], [5.0, 5.0, 1.0]]), "by a hair");
    assert!(
        insides_cross_unit([[0.2, 0.2, 0.0], [0.3, 0.2, 1.0], [0.3, 0.3, -1.0]]),
        "from a corner in it on"
    );
    assert!(
        insides_cross_unit([[0.5, 0.5, 1.0], [0.5, 0.5, -1.0], [-1.0, -1.0, 0.0]]),
        "edge through side, corner"
    );
    assert!(!insides_cross_unit([[0.5, 0.5, 1.0], [0.5, 0.5, -1.0], [1.0, 1.0, 0.0]]), "it touches a side");
    assert!(
        !insides_cross_unit([[0.2, 0.2, 1.0], [0.2, 0.2, 0.0], [5.0, 5.0, 1.0]]),
        "a vertex in the plane"
    );
    assert!(
        !insides_cross_unit([[0.2, 0.2, 0.0], [0.3, 0.2, 0.0], [0.3, 0.3, -1.0]]),
        "an edge in the plane"
    );
    assert!(!insides_cross_unit([[0.1, 0.1, 0.0], [0.5, 0.1, 0.0], [0.1, 0.5, 0.0]]), "coplanar");
    assert!(!insides_cross_unit([[0.2, 0.2, 1.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]]), "parallel");
    assert!(!insides_cross_unit([[2.0, 2.0, 1.0], [2.0, 2.0, -1.0], [3.0, 2.0, 1.0]]), "beside it");
}

/// The same in whole numbers: the segment that the one has in the other's plane, cut by the other's
/// sides.
fn insides_cross_exactly(a: &[[i128; 3]; 3], b: &[[i128; 3]; 3]) -> bool {
    let minus = |p: [i128; 3], q: [i128; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let dot = |p: [i128; 3], q: [i128; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross = |p: [i128; 3], q: [i128; 3]| {
        [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    };
    let normal = cross(minus(b[1], b[0]), minus(b[2], b[0]));
    let height = a.map(|p| dot(normal, minus(p, b[0])));
    if !(height.iter().any(|h| *h > 0) && height.iter().any(|h| *h < 0)) {
        return false;
    }
    // Points of the plane as whole numbers over one.
    let mut ends: Vec<([i128; 3], i128)> = Vec::new();
    for k in 0..3 {
        let (p, q, hp, hq) = (a[k], a[(k + 1) % 3], height[k], height[(k + 1) % 3]);
        if hp == 0 {
            ends.push((p, 1));
        } else if hp * hq < 0 {
            let (w, sign) = ((hp - hq).abs(), (hp - hq).signum());
            ends.push((std::array::from_fn(|c| sign * (hp * q[c] - hq * p[c])), w));
        }
    }
    let [(p, wp), (q, wq)] = ends[..] else { panic!("two ends") };
    // From 0 to 1 along the segment, as fractions with a positive denominator.
    let (mut low, mut high) = ((0, 1), (1, 1));
    for k in 0..3 {
        let inward = cross(normal, minus(b[(k + 1) % 3], b[k]));
        let at = |e: [i128; 3], w: i128| dot(inward, e) - w * dot(inward, b[k]);
        match (at(p, wp) * wq, at(q, wq) * wp) {
            (s, t) if s <= 0 && t <= 0 => return false,
            (s, t) if s < 0 => low = std::cmp::max_by(low, (-s, t - s), |x, y| (x.0 * y.1).cmp(&(y.0 * x.1))),
            (s, t) if t < 0 => {
                high = std::cmp::min_by(high, (s, s - t), |x, y| (x.0 * y.1).cmp(&(y.0 * x.1)))
            }
            _ => {}
        }
    }
    low.0 * high.1 < high.0 * low.1
}

#[test]
fn insides_cross_as_whole_numbers_say() {
    let mut next = numbers(7);
    let mut counts = [0; 2];
    for _ in 0..20_000 {
        let mut point = || [0; 3].map(|_: i32| (next() * 4.0) as i128);
        let a = [point(), point(), point()];
        let b = [point(), point(), point()];
        let of = |t: &[[i128; 3]; 3]| t.map(|p| Vec3::from(p.map(|c| c as f64)));
        let (found, right) = (insides_cross(&of(&a), &of(&b)), insides_cross_exactly(&a, &b));
        let is_flat = volume_is_zero(&of(&a)) || volume_is_zero(&of(&b));
        assert_eq!(found, right && !is_flat, "{a:?} {b:?}");
        counts[usize::from(found)] += 1;
    }
    assert!(counts[1] > 1000, "{} crossings are too few to tell", counts[1]);
}

fn volume_is_zero(t: &[Vec3; 3]) -> bool {
    (t[1] - t[0]).cross(&(t[2] - t[0])).norm() == 0.0
}

fn crossings(positions: &[Vec3], triangles: &[[u32; 3]], body: &ShapeMesh) -> Vec<[u32; 2]> {
    between_meshes((positions, triangles), (&body.0, &body.1))
}

/// The pairs of a cloth and a body, tested one by one.
fn brute(cloth: &ShapeMesh, body: &ShapeMesh) -> Vec<[u32; 2]> {
    let corners = |p: &[Vec3], t: &[u32; 3]| t.map(|i| p[i as usize]);
    let mut pairs = Vec::new();
    for (i, s) in cloth.1.iter().enumerate() {
        for (j, t) in body.1.iter().enumerate() {
            if insides_cross(&corners(&cloth.0, s), &corners(&body.0, t)) {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}

#[test]
fn cloth_and_body_cross_as_one_by_one() {
    for (cells, rows) in [(4, 24), (30, 6)] {
        let (mut positions, triangles) = sheet(cells, |x, y| 0.2 * (9.0 * x).sin() * (7.0 * y).cos());
        positions.iter_mut().for_each(|p| *p -= Vec3::new(0.5, 0.5, 0.0));
        let (cloth, ball) = ((positions, triangles), sphere(0.3, rows, 2 * rows));
        let right = brute(&cloth, &ball);
        assert!(right.len() > 40, "{} crossings are too few to tell", right.len());
        assert_eq!(crossings(&cloth.0, &cloth.1, &ball), right);
        let pierced = |[i, j]: &[u32; 2]| {
            let (s, t) = (cloth.1[*i as usize], ball.1[*j as usize]);
            let offset = cloth.0.len() as u32;
            let all: Vec<Vec3> = cloth.0.iter().chain(&ball.0).copied().collect();
            cross(&all, &s, &t.map(|v| v + offset))
        };
        assert!(right.iter().all(pierced), "where nothing is aligned, an edge pierces");
    }
}

#[test]
fn a_triangle_through_a_cube_crosses_four_of_its_faces() {
    let triangles = [[0, 1, 2]];
    for x in [0.0, 0.25] {
        let across = [[x, -9.0, -9.0], [x, 9.0, -9.0], [x, 0.0, 9.0]].map(Vec3::from);
        assert_eq!(crossings(&across, &triangles, &cube(1.0)).len(), 8, "at {x}");
    }
    let on = |y: f64| [[-9.0, y, -9.0], [9.0, y, -9.0], [0.0, y, 9.0]].map(Vec3::from);
    assert_eq!(crossings(&on(1.0), &triangles, &cube(1.0)), [[0u32; 2]; 0], "it lies on the cube");
    assert_eq!(crossings(&on(1.0 - 1e-12), &triangles, &cube(1.0)).len(), 8, "it lies in it");
    let inside = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]].map(Vec3::from);
    assert_eq!(crossings(&inside, &triangles, &cube(1.0)), [[0u32; 2]; 0], "nothing comes out");
    let unknown = [[f64::NAN, -9.0, -9.0], [0.0, 9.0, -9.0], [0.0, 0.0, 9.0]].map(Vec3::from);
    assert_eq!(crossings(&unknown, &triangles, &cube(1.0)), [[0u32; 2]; 0], "no number");
}
