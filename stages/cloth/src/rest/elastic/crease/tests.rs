#![allow(clippy::unwrap_used)]
use super::*;
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

fn creased(angle: f64) -> Elastic {
    let cloth = Fabric::isotropic(0.1, 1000.0, 0.0, 1e-4);
    Elastic::new(&flap(), &[&cloth], None, |_| 0).creased(vec![(0, angle)])
}

#[test]
fn a_crease_rests_at_its_angle() {
    for degrees in [20.0_f64, 90.0, 180.0, 250.0, 340.0] {
        let angle = degrees.to_radians();
        let elastic = creased(angle);
        let x = folded(angle);
        let mut force = vec![Vec3::zeros(); x.len()];
        elastic.hinges.iter().for_each(|h| {
            let moment = h.curvature(&x) * h.stiffness;
            h.nodes.iter().zip(&h.weights).for_each(|(&i, w)| force[i as usize] += moment * *w);
        });
        let alone = force.iter().map(|f| f.norm()).fold(0.0, f64::max);
        elastic.add_gradient_of_creases(&x, &mut force);
        let left = force.iter().map(|f| f.norm()).fold(0.0, f64::max);
        assert!(left < 1e-9 * (alone + 1e-6), "{degrees}: {left} of {alone}");
        let energy = |a: f64| {
            let x = folded(a);
            let plain: f64 =
                elastic.hinges.iter().map(|h| 0.5 * h.stiffness * h.curvature(&x).norm_squared()).sum();
            plain + elastic.value_of_creases(&x)
        };
        assert!(energy(angle).abs() < 1e-15, "{degrees}: {}", energy(angle));
        assert!(energy(angle + 0.1) > 1e-9 && energy(angle - 0.1) > 1e-9);
    }
}

#[test]
fn without_a_fold_nothing_changes() {
    let elastic = Elastic::new(&flap(), &[&Fabric::isotropic(0.1, 1000.0, 0.0, 1e-4)], None, |_| 0);
    assert_eq!(elastic.value_of_creases(&folded(1.0)), 0.0);
    assert!(elastic.creased(vec![(7, 1.0)]).creases.is_empty());
}
