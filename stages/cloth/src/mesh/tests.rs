#![allow(clippy::unwrap_used)]
use nalgebra::Vector2;

use super::*;

fn square() -> (Vec<Vector2<f64>>, Vec<[u32; 3]>) {
    let uv = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y)).to_vec();
    (uv, vec![[0, 1, 2], [0, 2, 3]])
}

#[test]
fn square_has_five_edges_and_lumps_its_mass() {
    let (uv, t) = square();
    let sheet = Sheet::flat(&uv, &t, 0.3).unwrap();
    assert_eq!(sheet.edges().len(), 5);
    assert_eq!(sheet.edges().iter().filter(|e| !e.is_boundary()).count(), 1);
    for (mass, expected) in sheet.masses().iter().zip([0.1, 0.05, 0.1, 0.05]) {
        assert!((mass - expected).abs() < 1e-16);
    }
    let diagonal = &sheet.edges()[sheet.triangle_edges()[0][1] as usize];
    assert_eq!((diagonal.vertices, diagonal.sides.0.opposite), ([2, 0], 1));
    assert_eq!(diagonal.sides.1.unwrap().opposite, 3);
}

#[test]
fn faults_are_named() {
    let (uv, t) = square();
    let error = |uv: &[Vector2<f64>], t: &[[u32; 3]], rho| Sheet::flat(uv, t, rho).unwrap_err().to_string();
    assert_eq!(error(&uv, &[], 0.1), "the scene has no triangles");
    assert_eq!(error(&uv, &t, 0.0), "density = 0 is out of range: above 0 kg/m^2");
    assert_eq!(error(&uv, &t, f64::NAN), "density[0] is not a finite number");
    assert_eq!(error(&uv, &[[0, 1, 9]], 0.1), "triangle 0 refers to vertex 9, but there are 4");
    assert_eq!(
        error(&uv, &[[0, 2, 1]], 0.1),
        "triangle 0 is turned over in the rest shape; list its corners counter-clockwise"
    );
    let mut bad = uv.clone();
    bad[1] = uv[0];
    assert_eq!(
        error(&bad, &t, 0.1),
        "the edge between vertices 0 and 1 has no length; merge the two vertices"
    );
    bad[1] = Vector2::new(0.5, 0.5);
    assert_eq!(
        error(&bad, &t, 0.1),
        "triangle 0 is degenerate (quality 0.0e0, least 1e-5); remesh or remove it"
    );
    bad[1].x = f64::INFINITY;
    assert_eq!(error(&bad, &t, 0.1), "rest[0] is not a finite number");
    let above = [uv[0], Vector2::new(2.0, 1.0), uv[1], uv[2], uv[3]];
    let fins = [[0, 2, 3], [0, 3, 4], [0, 1, 3]];
    assert_eq!(
        error(&above, &fins, 0.1),
        "the edge between vertices 0 and 3 is not manifold: more than two triangles share it; separate them"
    );
    assert_eq!(
        error(&uv, &[[0, 1, 2], [0, 2, 3], [1, 2, 0]], 0.1),
        "triangles 0 and 2 are the same: both join vertices 0, 1 and 2; remove one of them"
    );
    let overlap = [[0, 2, 3], [0, 1, 3]];
    assert_eq!(
        error(&above, &overlap, 0.1),
        "the edge between vertices 0 and 3 is not manifold: its two triangles disagree on which side is up; turn one of them over"
    );
}

#[test]
fn deformation_of_a_stretched_square() {
    let (uv, t) = square();
    let sheet = Sheet::flat(&uv, &t, 0.3).unwrap();
    let x: Vec<_> = uv.iter().map(|p| Vector3::new(1.2 * p.x, 0.0, 0.9 * p.y)).collect();
    let f = sheet.deformation(1, &x);
    assert!((f - nalgebra::Matrix3x2::new(1.2, 0.0, 0.0, 0.0, 0.0, 0.9)).norm() < 1e-15);
    assert!((sheet.greatest_strain(&x).1 - 0.2).abs() < 1e-15);
}
