use super::*;
use crate::energy::WovenStiffness;
use crate::frames::flat_area;
use crate::newton::StoppingLimits;
use crate::shapes::{PlainMesh, apart, bump, cylinder, grid, surface};
use nalgebra::{Point3, Rotation3, Vector3};
use proptest::prelude::*;

type Method = fn(&PieceSurface, &Placement) -> Result<Flattening, FlattenError>;

const METHODS: [(&str, Method); 5] = [
    ("lscm", lscm),
    ("arap", |s, p| arap(s, ArapOptions::default(), p)),
    ("symmetric_dirichlet", |s, p| symmetric_dirichlet(s, StoppingLimits::default(), p)),
    ("springs", |s, p| springs(s, StoppingLimits::default(), p)),
    ("woven", |s, p| woven(s, WovenStiffness::COTTON, StoppingLimits::default(), p)),
];

fn flat(method: Method, mesh: PlainMesh, placement: &Placement) -> (PieceSurface, Flattening) {
    let s = surface(mesh);
    let flat = method(&s, placement).unwrap_or_else(|e| unreachable!("{e}"));
    (s, flat)
}

/// The exact piece of [`cylinder`]: chords of the circle along x.
fn unrolled(m: usize, n: usize) -> Vec<Point2<f64>> {
    let chord = 2.0 * 1.5 * (std::f64::consts::PI / 3.0 / m as f64).sin();
    let row = move |j: usize| (0..=m).map(move |i| Point2::new(chord * i as f64, 2.0 * j as f64 / n as f64));
    (0..=n).flat_map(row).collect()
}

#[test]
fn a_developable_surface_comes_out_exact_and_upright() {
    for (name, method) in METHODS {
        let (_, flat) = flat(method, cylinder(24, 16), &Placement::default());
        let exact = unrolled(24, 16);
        assert!(apart(&flat.points, &exact) < if name == "lscm" { 1e-3 } else { 2e-5 }, "{name}");
        // The grain is y: vertices of one column share their x, and rise.
        let (low, high) = (flat.points[0], flat.points[16 * 25]);
        assert!((high.x - low.x).abs() < 1e-4 && high.y - low.y > 1.99, "{name}");
        // Not mirrored: seen from outside the piece runs to the right.
        assert!(flat.points[24].x > flat.points[0].x, "{name}");
    }
}

#[test]
fn no_method_flips_a_triangle_on_a_steep_bump_with_a_hole() {
    for (name, method) in METHODS {
        let (places, mut triangles) = bump(16, 16, 2.5);
        triangles.retain(|t| !t.contains(&60));
        let (s, flat) = flat(method, (places, triangles), &Placement::default());
        assert_eq!(flat.flipped(&s), [0usize; 0], "{name}");
        assert!(flat.report.remaining < 1e-7, "{name}: {:?}", flat.report);
    }
}

#[test]
fn a_turned_and_scaled_garment_gives_the_same_piece() {
    let turn = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
    for (name, method) in METHODS {
        let (_, here) = flat(method, bump(10, 10, 0.7), &Placement::default());
        let (places, triangles) = bump(10, 10, 0.7);
        let moved = places.iter().map(|p| turn * (p * 100.0) + Vector3::new(5.0, 6.0, 7.0)).collect();
        let grain = Grain::Direction(turn * Vector3::y());
        let (_, there) = flat(method, (moved, triangles), &Placement { grain, ..Placement::default() });
        let there: Vec<_> = there.points.iter().map(|p| p / 100.0).collect();
        assert!(apart(&there, &here.points) < 1e-3, "{name}");
    }
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    for (name, method) in METHODS {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.map(|p| p.install(|| flat(method, bump(40, 40, 1.0), &Placement::default()).1.points)).ok()
        };
        let one = on(1);
        assert!(one.is_some() && one == on(2) && one == on(5), "{name}");
    }
}

#[test]
fn tension_is_taken_out() {
    let placement = Placement { tension: Tension { warp: 0.25, weft: 0.1 }, ..Placement::default() };
    for (name, method) in METHODS {
        let (s, flat) = flat(method, cylinder(24, 16), &placement);
        let shrunk = s.area() / 1.25 / 1.1;
        assert!((flat_area(s.triangles(), &flat.points) / shrunk - 1.0).abs() < 1e-4, "{name}");
        let height = flat.points[16 * 25].y - flat.points[0].y;
        assert!((height - 2.0 / 1.25).abs() < 1e-3, "{name}");
    }
}

#[test]
fn woven_cloth_strains_its_threads_less_than_half() {
    let of = |method: Method| {
        let (s, flat) = flat(method, bump(30, 30, 0.6), &Placement::default());
        crate::distortion::distortion(&s, &flat.points).map(|d| (d.warp.p99, d.weft.p99)).unwrap_or_default()
    };
    let (even, woven) = (of(METHODS[1].1), of(METHODS[4].1));
    assert!(woven.0 < 0.5 * even.0 && woven.1 < 0.5 * even.1, "{woven:?} {even:?}");
}

#[test]
fn arap_pairs_lead_to_the_same_minimum() {
    let s = surface(bump(20, 20, 0.8));
    let after = |pairs| {
        let newton = StoppingLimits { tolerance: 1e-15, ..StoppingLimits::default() };
        arap(&s, ArapOptions { pairs, newton }, &Placement::default())
            .map(|f| f.report.energy)
            .unwrap_or(f64::NAN)
    };
    assert!((after(0) - after(30)).abs() < 1e-12);
}

#[test]
fn the_grain_can_be_an_edge_or_a_place() {
    let grains = [(Grain::Edge([0, 24]), 0.0), (Grain::At { triangle: 100, direction: Vector3::y() }, 2.0)];
    for (grain, rise) in grains {
        let placement = Placement { grain, ..Placement::default() };
        let (_, flat) = flat(METHODS[1].1, cylinder(24, 16), &placement);
        let (corner, other) = (flat.points[0], flat.points[if rise == 0.0 { 24 } else { 16 * 25 }]);
        assert!((other.x - corner.x).abs() < 1e-4 && other.y > corner.y + 1.9);
    }
}

#[test]
fn a_piece_across_the_grain_is_left_as_it_is() {
    let (_, flat) = flat(METHODS[1].1, grid(4, 4, |u, v| [u, 0.0, -v]), &Placement::default());
    assert!(!flat.upright);
}

#[test]
fn what_is_out_of_range_is_refused() {
    let s = surface(cylinder(4, 4));
    let refused = |placement: Placement| {
        METHODS.map(|(_, m)| m(&s, &placement).map_or_else(|e| e.to_string(), |_| String::new()))
    };
    let stretched = Placement { tension: Tension { warp: 12.0, weft: 0.0 }, ..Placement::default() };
    assert_eq!(refused(stretched)[0], "tension.warp = 12 is out of range: a strain above -0.9 and below 10");
    let nowhere = Placement { grain: Grain::Direction(Vector3::zeros()), ..Placement::default() };
    assert_eq!(refused(nowhere)[1], "grain = 0 is out of range: a finite direction other than zero");
    let beyond = Placement { grain: Grain::Edge([0, 99]), ..Placement::default() };
    assert_eq!(refused(beyond)[2], "the grain names vertex 99, but the piece has 25");
    let at = Grain::At { triangle: 77, direction: Vector3::x() };
    let nothing = Placement { grain: at, ..Placement::default() };
    assert_eq!(refused(nothing)[3], "grain.triangle = 77 is out of range: a triangle of the piece");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Crumpled sheets: every method answers without flips, or says why not.
    #[test]
    fn crumpled_sheets_are_flattened_without_flips(
        heights in prop::collection::vec(-0.6..0.6f64, 49),
        which in 0usize..5,
    ) {
        let (mut places, triangles) = bump(6, 6, 0.0);
        places.iter_mut().zip(&heights).for_each(|(p, h)| *p += Vector3::new(0.2 * h, -0.1 * h, *h));
        let s = surface((places, triangles));
        if let Ok(flat) = METHODS[which].1(&s, &Placement::default()) {
            prop_assert!(flat.flipped(&s).is_empty());
            prop_assert!(flat.points.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
        }
    }

    /// Soups of triangles in space, whatever they are.
    #[test]
    fn no_mesh_makes_a_method_panic(
        places in prop::collection::vec(prop::array::uniform3(prop_oneof![-1.0..1.0f64, Just(0.0), Just(f64::NAN), Just(1e200), -1e-9..1e-9f64]), 3..9),
        triangles in prop::collection::vec(prop::array::uniform3(0u32..9), 1..8),
        which in 0usize..5,
    ) {
        let places = places.iter().map(|&p| Point3::from(p)).collect();
        if let Ok(s) = PieceSurface::new(places, triangles)
            && let Ok(flat) = METHODS[which].1(&s, &Placement::default()) {
            prop_assert!(flat.points.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
        }
    }
}
