#![allow(clippy::unwrap_used)]
use nalgebra::Vector2;
use proptest::prelude::*;

use super::*;
use crate::energy::{Clamp, Cloth, Energy, Vec3, gradient_error, hessian_error};
use crate::fabric::{Fabric, Rigidity};
use crate::mesh::Sheet;

fn sheet() -> Sheet {
    let uv = [[0.0, 0.0], [0.1, 0.01], [0.12, 0.09], [-0.01, 0.1], [0.05, -0.08]]
        .map(|p| Vector2::new(p[0], p[1]));
    Sheet::flat(&uv, &[[0, 1, 2], [0, 2, 3], [0, 4, 1]], 0.2).unwrap()
}

fn folded() -> Vec<Vec3> {
    [[0.0, 0.0, 0.0], [0.11, 0.0, 0.01], [0.11, 0.1, 0.06], [0.0, 0.09, -0.02], [0.05, -0.02, 0.07]]
        .map(Vec3::from)
        .to_vec()
}

fn fabric(warp: f64, weft: f64) -> Fabric {
    Fabric { bending_warp: warp, bending_weft: weft, ..Fabric::isotropic(0.2, 100.0, 0.0, 0.0) }
}

/// Models that do not know where space is.
fn free_models() -> Vec<Box<dyn Energy>> {
    let (s, f) = (sheet(), fabric(2e-5, 1e-5));
    let fabrics = [&f];
    let cloth = Cloth::of(&s, &fabrics);
    vec![
        Box::new(Hinge::new(&cloth)),
        Box::new(Quadratic::new(&cloth)),
        Box::new(DiscreteShell::new(&cloth)),
        Box::new(SkipOne::new(&cloth)),
    ]
}

/// Models with a rest shape or a direction of their own.
fn bound_models() -> Vec<Box<dyn Energy>> {
    let (s, f) = (sheet(), fabric(2e-5, 1e-5));
    let fabrics = [&f];
    let outward = Vec3::new(0.3, -1.0, 0.2).normalize();
    let clamp = Clamp { chosen: &|v| v == 4 || v == 1, outward: &|_| outward };
    let clamped = Cloth { clamp: Some(clamp), ..Cloth::of(&s, &fabrics) };
    let half: Vec<Vec3> = folded().iter().map(|p| Vec3::new(p.x, p.y, 0.3 * p.z)).collect();
    let mut pressed = Hinge::new(&Cloth::of(&s, &fabrics));
    pressed.0.rest_at(&half);
    // With all corners of a border the sum of angles is constant.
    let open = Cloth { fixed: &[false, false, true], ..Cloth::of(&s, &fabrics) };
    vec![
        Box::new(pressed),
        Box::new(Hinge::new(&clamped)),
        Box::new(ClampedEdge::new(&clamped)),
        Box::new(FreeEdge::new(&open)),
    ]
}

#[test]
fn derivatives_agree_with_differences() {
    for m in free_models().into_iter().chain(bound_models()) {
        assert!(gradient_error(&*m, &folded(), 1e-6) < 1e-6, "{} gradient", m.name());
        let error = hessian_error(&*m, &folded(), 1e-6);
        assert!(error < 1e-6, "{} Hessian {error:e}", m.name());
    }
}

#[test]
fn a_flat_sheet_has_no_moment() {
    let s = sheet();
    let mut x = vec![Vec3::zeros(); 5];
    for (t, corners) in s.triangles().iter().zip(s.rest()) {
        t.iter().zip(corners).for_each(|(&v, c)| x[v as usize] = Vec3::new(c.x, c.y, 2.0));
    }
    for m in free_models() {
        assert!(m.value(&x).abs() < 1e-19, "{}: {:e}", m.name(), m.value(&x));
    }
}

/// Rows of equilateral triangles.
fn equilateral(n: usize) -> Sheet {
    let at = |i: usize, j: usize| Vector2::new(i as f64 + 0.5 * (j % 2) as f64, j as f64 * 0.75_f64.sqrt());
    let uv: Vec<_> = (0..n * n).map(|k| at(k % n, k / n)).collect();
    let mut t = Vec::new();
    for (j, i) in (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| (j, i))) {
        let [a, b, c, d] = [j * n + i, j * n + i + 1, (j + 1) * n + i, (j + 1) * n + i + 1].map(|v| v as u32);
        t.extend(if j % 2 == 0 { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] });
    }
    Sheet::flat(&uv, &t, 0.2).unwrap()
}

#[test]
fn equilateral_mesh_needs_no_calibration_but_for_its_border() {
    let factor = |n: usize| Calibration::of(&equilateral(n)).factor;
    let (coarse, fine) = ((factor(12) - 1.0).abs(), (factor(24) - 1.0).abs());
    assert!(coarse < 0.06 && fine < 0.03, "{coarse} {fine}");
}

/// Two panels sewn at an edge are judged like the same two apart.
#[test]
fn calibration_does_not_see_seams() {
    let one = equilateral(8);
    let joined = |sewn: bool| {
        // The second panel shares the first one's lowest row, if sewn, with a frame of its own.
        let n = one.vertex_count() as u32;
        let second = |v: u32| if sewn && v < 8 { 7 - v } else { v + n };
        let t =
            one.triangles().iter().copied().chain(one.triangles().iter().map(|t| t.map(second))).collect();
        let far = Vector2::new(50.0, 3.0);
        let rest = one.rest().iter().copied().chain(one.rest().iter().map(|r| r.map(|p| p + far))).collect();
        let sheet = Sheet::new(2 * n as usize, t, rest, 0.2).unwrap();
        let factor = Calibration::of(&sheet).factor;
        (factor, calibrate::calibrated(&sheet, &vec![Rigidity::uniform(1.0); sheet.triangles().len()]))
    };
    let (sewn, apart) = (joined(true), joined(false));
    assert!((sewn.0 - apart.0).abs() < 1e-9, "{} {}", sewn.0, apart.0);
    assert!(sewn.1.iter().zip(&apart.1).all(|(a, b)| (a - b).norm() < 1e-9));
}

/// The cylinder's energy per area, rows counted without the border, must be D kappa²/2 whatever its
/// direction.
#[test]
fn cylinder_costs_the_same_in_every_direction() {
    let (s, kappa) = (equilateral(24), 1e-3);
    let inner = |p: &Vector2<f64>| (p - Vector2::new(11.5, 10.0)).norm() < 7.0;
    let flaps = flap::flaps(&s);
    for degrees in [0.0_f64, 17.0, 45.0, 80.0, 120.0] {
        let d = Vector2::new(degrees.to_radians().cos(), degrees.to_radians().sin());
        let mut x = vec![Vec3::zeros(); s.vertex_count()];
        let mut flat = vec![Vector2::zeros(); s.vertex_count()];
        for (t, corners) in s.triangles().iter().zip(s.rest()) {
            for (&v, c) in t.iter().zip(corners) {
                let along = d.dot(c) * kappa;
                let lift = (1.0 - along.cos()) / kappa;
                let p = d * (along.sin() / kappa) + Vector2::new(-d.y, d.x) * d.perp(c);
                (x[v as usize], flat[v as usize]) = (Vec3::new(p.x, p.y, lift), *c);
            }
        }
        let (mut energy, mut area) = (0.0, 0.0);
        for f in flaps.iter().filter(|f| f.vertices.iter().all(|&v| inner(&flat[v as usize]))) {
            let [a, b, p, q] = f.vertices.map(|v| x[v as usize]);
            energy += 0.5 * 3.0 * f.slenderness * angle::angle(&a, &b, &p, &q).powi(2);
            area += f.area / 3.0;
        }
        let ratio = energy / (0.5 * 3.0 * kappa * kappa * area);
        assert!((ratio - 1.0).abs() < 0.03, "{degrees} degrees: {ratio}");
    }
}

/// A sheet bent to a quadratic surface, of small slopes, costs what the plate costs, triangle by
/// triangle, before calibration.
#[test]
fn a_quadratic_surface_has_its_energy_on_any_mesh() {
    use crate::solver::layout::{Layout, Rectangle};
    let d = Rigidity { warp: 3.0, weft: 2.0 };
    for layout in Layout::ALL {
        let mesh = Rectangle::new(layout, 1.0, 1.0, 8);
        let sheet = mesh.sheet(1.0).unwrap();
        for k in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5], [0.3, -0.7, 1.2]] {
            let k = nalgebra::Vector3::from(k);
            let lift = |p: &Vector2<f64>| 0.5 * k.x * p.x * p.x + 0.5 * k.y * p.y * p.y + k.z * p.x * p.y;
            let exact = 0.5 * k.dot(&(d.tensor() * k));
            for p in patch::patches(&sheet, |_| None) {
                if p.beyond.contains(&patch::Beyond::Free) {
                    continue;
                }
                let angle = |w: &[f64; 6]| -> f64 {
                    w.iter().zip(p.vertices).map(|(w, v)| w * lift(&mesh.uv[v as usize])).sum()
                };
                let angles = nalgebra::Vector3::from(p.weights.each_ref().map(angle));
                let energy = 0.5 * angles.dot(&(p.stiffness(&d.tensor()) * angles)) / p.area;
                assert!((energy / exact - 1.0).abs() < 1e-8, "{}: {energy} not {exact}", layout.name());
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn energy_does_not_see_rigid_motion(r in prop::array::uniform3(-3.0..3.0f64), t in prop::array::uniform3(-9.0..9.0f64)) {
        let turn = nalgebra::Rotation3::new(Vec3::from(r));
        let moved: Vec<Vec3> = folded().iter().map(|p| turn * p + Vec3::from(t)).collect();
        for m in free_models() {
            prop_assert!((m.value(&moved) / m.value(&folded()) - 1.0).abs() < 1e-8, "{}", m.name());
        }
    }

    #[test]
    fn internal_forces_cancel(seed in 0..1000u32) {
        let x: Vec<Vec3> = folded().iter().enumerate().map(|(i, p)| p + Vec3::new((f64::from(seed) + i as f64).sin(), (f64::from(seed) * 1.7 + i as f64).cos(), 0.0) * 0.02).collect();
        for m in free_models() {
            let mut g = vec![Vec3::zeros(); x.len()];
            m.add_gradient(&x, &mut g);
            let scale: f64 = g.iter().map(|v| v.norm()).sum();
            let sum: Vec3 = g.iter().sum();
            let turn: Vec3 = g.iter().zip(&x).map(|(g, x)| x.cross(g)).sum();
            prop_assert!(sum.norm() <= 1e-9 * scale && turn.norm() <= 1e-9 * scale, "{}", m.name());
        }
    }
}
