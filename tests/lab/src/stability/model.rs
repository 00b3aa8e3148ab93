//! Input that must be refused by name before the first step: shapes, numbers, parameters.

use nalgebra::Vector2;

use super::{Check, Must, Verdict};
use crate::stability::Case;
use toile_cloth::constraint::Plane;
use toile_cloth::energy::Vec3;
use toile_cloth::error::ClothError;
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{ImplicitEuler, Model, Solver, State};

/// All of them.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = shapes();
    checks.extend(numbers());
    checks.extend(parameters());
    checks
}

/// Refused by an error that `right` accepts, and by no other.
fn refused<T>(result: Result<T, ClothError>, right: impl Fn(&ClothError) -> bool) -> Verdict {
    match result {
        Ok(_) => Verdict::Failed("accepted".into()),
        Err(e) if right(&e) => Verdict::Refused(e.to_string()),
        Err(e) => Verdict::Failed(format!("the wrong error: {e}")),
    }
}

fn flat(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> Result<Sheet, ClothError> {
    let uv: Vec<Vector2<f64>> = points.iter().map(|p| Vector2::new(p[0], p[1])).collect();
    Sheet::flat(&uv, triangles, 0.15)
}

/// What a value of an axis does to a case.
type Set = fn(&mut Case, f64);

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]];
const TWO: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn shapes() -> Vec<Check> {
    let degenerate = |e: &ClothError| matches!(e, ClothError::DegenerateTriangle { .. });
    let tangled = |e: &ClothError| matches!(e, ClothError::NonManifoldEdge { .. });
    let must = Must::Refuse;
    vec![
        Check::new("zero_area_triangle", "exact", must, move || {
            refused(flat(&[[0.0, 0.0], [0.05, 0.0], [0.1, 0.0]], &[[0, 1, 2]]), degenerate)
        }),
        Check::new("zero_area_triangle", "1e-12 m^2", must, move || {
            refused(flat(&[[0.0, 0.0], [0.1, 0.0], [0.05, 2e-11]], &[[0, 1, 2]]), degenerate)
        }),
        Check::new("coincident_vertices", "joined by an edge", must, || {
            let [a, _, c, d] = SQUARE;
            refused(flat(&[a, a, c, d], &TWO), |e| matches!(e, ClothError::ZeroLengthEdge { a: 0, b: 1 }))
        }),
        Check::new("empty", "no triangles", must, || {
            refused(flat(&SQUARE, &[]), |e| *e == ClothError::EmptyScene)
        }),
        Check::new("non_manifold", "edge with 3 triangles", must, move || {
            refused(
                flat(
                    &[[0.0, 0.0], [0.1, 0.05], [0.2, 0.1], [0.05, 0.0], [0.05, 0.2], [0.02, 0.15]],
                    &[[0, 1, 4], [0, 3, 1], [0, 2, 4], [0, 1, 5]],
                ),
                tangled,
            )
        }),
        Check::new("non_manifold", "flipped normal", must, || {
            refused(flat(&SQUARE, &[[0, 1, 2], [0, 3, 2]]), |e| {
                matches!(e, ClothError::InvertedTriangle { index: 1 })
            })
        }),
    ]
}

fn numbers() -> Vec<Check> {
    let fields: [(&'static str, Set); 4] = [
        ("stiffness", |c, v| c.stiffness = v),
        ("bending", |c, v| c.bending = v),
        ("dt", |c, v| c.dt = v),
        ("gravity", |c, v| c.gravity = v),
    ];
    let not_finite = |e: &ClothError| matches!(e, ClothError::NonFiniteInput { .. });
    let of_fields = fields.into_iter().flat_map(move |(name, set)| {
        [f64::NAN, f64::INFINITY].map(move |v| {
            Check::new("non_finite_input", format!("{name} {v}"), Must::Refuse, move || {
                let mut case = Case::default();
                set(&mut case, v);
                refused(case.run(3, 1), not_finite)
            })
        })
    });
    let of_positions = [f64::NAN, f64::INFINITY].map(|v| {
        Check::new("non_finite_input", format!("positions {v}"), Must::Refuse, move || {
            refused(step_from(v), |e| {
                matches!(e, ClothError::NonFiniteInput { field: "positions", index: 4 })
            })
        })
    });
    of_fields.chain(of_positions).collect()
}

fn step_from(v: f64) -> Result<(), ClothError> {
    let mesh = Rectangle::new(Layout::OneDiagonal, 0.1, 0.1, 2);
    let model = Model::of(&mesh.sheet(0.1)?);
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    state.x[4].y = v;
    ImplicitEuler::new(0.01, 1e-9).advance(&model, &mut state).map(drop)
}

fn parameters() -> Vec<Check> {
    let cases: [(&'static str, f64, Set); 6] = [
        ("density", 0.0, |c, v| c.density = v),
        ("density", -0.1, |c, v| c.density = v),
        ("stiffness", -1.0, |c, v| c.stiffness = v),
        ("bending", -1.0, |c, v| c.bending = v),
        ("dt", 0.0, |c, v| c.dt = v),
        ("dt", -0.01, |c, v| c.dt = v),
    ];
    let out_of_range = |e: &ClothError| matches!(e, ClothError::InvalidParameter { .. });
    let mut checks: Vec<Check> = cases
        .into_iter()
        .map(|(name, v, set)| {
            Check::new("negative_or_zero_parameter", format!("{name} {v}"), Must::Refuse, move || {
                let mut case = Case::default();
                set(&mut case, v);
                refused(case.run(3, 1), out_of_range)
            })
        })
        .collect();
    checks.push(Check::new("negative_or_zero_parameter", "friction -0.1", Must::Refuse, move || {
        refused(Plane::new(Vec3::zeros(), Vec3::y(), -0.1), out_of_range)
    }));
    checks
}
