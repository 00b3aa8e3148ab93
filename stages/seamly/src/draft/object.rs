//! What tools draw.

use super::super::plane::DraftCurve;
use kurbo::Point;

/// Which tools drew a curve: formulas name its length by that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CurveFamily {
    Spline,
    Path,
    Arc,
    Ellipse,
}

impl CurveFamily {
    /// How the names of such curves begin.
    pub(crate) fn prefix(self) -> &'static str {
        match self {
            CurveFamily::Spline => "Spl_",
            CurveFamily::Path => "SplPath_",
            CurveFamily::Arc => "Arc_",
            CurveFamily::Ellipse => "ElArc_",
        }
    }
}

/// A curve with what formulas may ask of it.
#[derive(Debug, Clone)]
pub(crate) struct DrawnCurve {
    pub(crate) curve: DraftCurve,
    pub(crate) family: CurveFamily,
    /// Its name behind the prefix of its family; empty until it is put.
    pub(crate) name: String,
    /// The name of the centre of an arc.
    pub(crate) centre: String,
    /// The angles at which an arc of an ellipse begins and ends before it is turned.
    pub(crate) angles: Option<[f64; 2]>,
}

/// What a tool has drawn.
#[derive(Debug, Clone)]
pub(crate) enum DraftObject {
    Point { name: String, at: Point },
    Curve(DrawnCurve),
    Failed(super::values::Failed),
}
