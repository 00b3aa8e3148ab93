#![allow(clippy::unwrap_used)]
use super::*;
use crate::energy::Energy;
use crate::energy::bending::Quadratic;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use nalgebra::Vector2;

/// Two triangles at an edge along y, of unlike size.
fn flap() -> Sheet {
    let uv = [[0.0, 0.0], [0.0, 0.1], [-0.06, 0.04], [0.09, 0.07]].map(|[x, y]| Vector2::new(x, y));
    Sheet::flat(&uv, &[[0, 1, 2], [0, 3, 1]], 0.1).unwrap()
}

/// The flap with that angle between its outsides, which look along z where it lies flat.
fn folded(angle: f64) -> Vec<Vec3> {
    let up = 0.5 * (PI - angle);
    [[0.0, 0.0], [0.0, 0.1], [-0.06, 0.04], [0.09, 0.07]]
        .map(|[x, y]: [f64; 2]| Vec3::new(x * up.cos(), y, x.abs() * up.sin()))
        .to_vec()
}

fn plain_and_creased(angle: f64) -> (Assembled<4, Quadratic>, Assembled<4, Creases>) {
    let (sheet, fabric) = (flap(), Fabric::isotropic(0.1, 1000.0, 0.0, 1e-4));
    let fabrics = [&fabric];
    let cloth = Cloth::of(&sheet, &fabrics);
    (Quadratic::new(&cloth), Creases::new(&cloth, &[(0, angle)]))
}

#[test]
fn a_crease_rests_at_its_angle() {
    for degrees in [20.0_f64, 90.0, 180.0, 250.0, 340.0] {
        let angle = degrees.to_radians();
        let (plain, creased) = plain_and_creased(angle);
        let x = folded(angle);
        let mut force = vec![Vec3::zeros(); x.len()];
        plain.add_gradient(&x, &mut force);
        let alone = force.iter().map(|f| f.norm()).fold(0.0, f64::max);
        creased.add_gradient(&x, &mut force);
        let left = force.iter().map(|f| f.norm()).fold(0.0, f64::max);
        assert!(left < 1e-9 * (alone + 1e-6), "{degrees}: {left} of {alone}");
        let energy = |a: f64| plain.value(&folded(a)) + creased.value(&folded(a));
        assert!(energy(angle).abs() < 1e-15, "{degrees}: {}", energy(angle));
        assert!(energy(angle + 0.1) > 1e-9 && energy(angle - 0.1) > 1e-9);
    }
}

#[test]
fn a_hinge_that_is_not_there_has_no_crease() {
    let (sheet, fabric) = (flap(), Fabric::isotropic(0.1, 1000.0, 0.0, 1e-4));
    let creases = Creases::new(&Cloth::of(&sheet, &[&fabric]), &[(7, 1.0)]);
    assert_eq!((creases.0.count(), creases.value(&folded(1.0))), (0, 0.0));
}
