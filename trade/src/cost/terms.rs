//! What the work of a stage grows with, by its role.

use toile_core::Role;
use toile_core::cost::{Quantity, Size};

/// Area of a garment's pattern where it is not known, square metres: a shirt's.
const USUAL_AREA: f64 = 0.6;

/// A term: an amount to a power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Term {
    /// The same for every input.
    Constant,
    /// Proportional to an amount.
    Of(Quantity),
    /// An amount to the power 3/2: steps or levels that grow with the side's length, sparse factors
    /// of a plane mesh (George, Nested dissection, 1973).
    Solve(Quantity),
    /// An amount over the edge length, by the garment's area: stable time steps shrink with the
    /// edge length (Courant, Friedrichs, Lewy 1928).
    Steps(Quantity),
    /// The root of an amount: a picture's side.
    Side(Quantity),
}

impl Term {
    /// Its value; 0 where the amount is not known.
    pub(super) fn at(self, size: &Size) -> f64 {
        match self {
            Term::Constant => 1.0,
            Term::Of(q) => size.get(q).unwrap_or(0.0),
            Term::Solve(q) => size.get(q).unwrap_or(0.0).powf(1.5),
            Term::Steps(q) => {
                let area = size.get(Quantity::Area).filter(|a| *a > 0.0).unwrap_or(USUAL_AREA);
                size.get(q).unwrap_or(0.0).powf(1.5) / area.sqrt()
            }
            Term::Side(q) => size.get(q).unwrap_or(0.0).sqrt(),
        }
    }
}

/// The terms of a role, the one that matters most first.
pub(super) fn terms(role: &str) -> &'static [Term] {
    use Quantity::{BodyTriangles, Bytes, Decoded, Pieces, Pixels, Points, Texels, Triangles};
    use Term::{Constant, Of, Side, Solve, Steps};
    match Role::named(role) {
        Some(Role::Reader) => &[Of(Decoded), Of(Pixels), Of(Bytes), Of(Triangles), Constant],
        Some(Role::Denoiser | Role::Binariser | Role::Panorama | Role::ViewInterpolator) => {
            &[Of(Pixels), Constant]
        }
        Some(Role::EdgeDetector) => &[Of(Pixels), Side(Pixels), Constant],
        Some(Role::Style) => &[Of(Pieces), Constant],
        Some(Role::Mesher | Role::Smoother | Role::Placement) => &[Of(Triangles), Of(Points), Constant],
        Some(Role::Collider) => &[Of(BodyTriangles), Constant],
        Some(Role::Stitcher | Role::Draper) => &[Steps(Triangles), Solve(Triangles), Of(Triangles), Constant],
        Some(Role::Flattener) => &[Solve(Triangles), Of(Triangles), Constant],
        Some(Role::Texturer) => &[Of(Texels), Of(Pixels), Of(Triangles), Constant],
        Some(Role::Writer) => &[Of(Texels), Of(Triangles), Of(BodyTriangles), Constant],
        Some(Role::Body | Role::Fabric) | None => &[Constant],
    }
}
