//! The artifacts that stages pass to each other.
//!
//! Every artifact is immutable once made, carries SI units (metres, kilograms, seconds) and `f64`
//! coordinates, and can be digested, measured and shown. One mechanism, the [`Artifact`] trait,
//! serves the goldens, the report, `--until` and the cache.
//!
//! One file holds one kind.

mod body;
mod collider;
mod fabric;
mod figures;
mod files;
mod garment;
mod garment_check;
mod garment_sizes;
mod geometry;
mod hand;
mod locate;
mod mask;
mod measures;
mod model;
mod outline;
mod panel;
mod pattern;
mod phases;
mod photo;
mod picture;
mod sewing;
pub mod store;
pub mod stored;

pub use body::{Body, Landmark};
pub use collider::{BodyContact, Collide, Collider, ColliderCard, Penalty, SelfContact, Surface};
pub use fabric::{Curve, Fabric};
pub use figures::{
    Figures, GarmentFigures, GirthFigures, PanelFigures, PenetrationFigures, Shortfall, StrainFigures,
};
pub use files::{OutputFile, OutputFiles};
pub use garment::{
    Garment, GarmentPanel, GarmentSeam, GarmentStart, Held, RecordedMotion, SeamState, SolveStatus, quantile,
};
pub use geometry::{Point2, Point3, Vector2, Vector3, polygon_area, polyline_length};
pub use hand::Hand;
pub use locate::{Located, Locator};
pub use mask::Mask;
pub use measures::{Measure, Measures};
pub use model::{Material, Mesh, Model, Sheen, Texture, Variant};
pub use outline::{Edge, InnerKind, InnerLine, Loop, Outline, PhotoFrame};
pub use panel::{InnerChain, Panel, PanelEdge};
pub use pattern::{
    BodyPart, EdgeCurve, EdgePath, EdgeRole, EdgeUse, LinePurpose, Lowered, LoweringError, Notch, Pattern,
    PatternLoop, PatternSeam, Piece, PieceEdge, PieceLine, Pose, lacking_stops,
};
pub use phases::{Air, Phase, Phases};
pub use photo::Photo;
pub use picture::{GrayImage, Picture, RgbImage};
pub use sewing::gauge::{CHORD_TOLERANCE, Gauge};
pub use sewing::plan::{EdgeRef, Seam, SewingPlan};
pub use sewing::seam_kind::{PleatFold, SeamKind};
pub use sewing::weld::join_pairs;
pub use store::digest::{Digest, Digester};
pub use store::shared::Shared;

use std::any::Any;
use std::fmt::Debug;

/// The name of an artifact's type, as it stands in diagnostics and cards: `"photo"`, `"mask"`, ...
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Kind(pub &'static str);

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0)
    }
}

/// A value that one stage makes and others read.
pub trait Artifact: Any + Send + Sync + Debug {
    /// The artifact's kind.
    fn kind(&self) -> Kind;
    /// Feeds everything that makes this artifact what it is, in a fixed order: its kind and its
    /// record. What has no record says what makes it what it is.
    fn digest(&self, digester: &mut Digester) {
        digester.text(self.kind().0);
        if let Some(record) = self.record() {
            record.digest(digester);
        }
    }
    /// What is wrong with it, where no stage may give it: numbers that are not finite, indices
    /// beyond their lists, lists of unequal length. The runner asks after every stage.
    ///
    /// Errors: one sentence in lower case, such as `vertex 12 is not a finite number below 1e9`.
    fn check(&self) -> Result<(), String>;
    /// The figures that goldens and the report keep of it.
    fn measures(&self) -> Measures;
    /// The artifact as a record of plain fields, in which form it is stored and passed to plugins;
    /// `None` for a service.
    fn record(&self) -> Option<store::Record<'_>> {
        None
    }
    /// The artifact as ordinary files for `--until` and `--keep`: extension and bytes.
    ///
    /// An empty list where the kind has no file form, or one that the runner encodes: pictures, and
    /// tables as JSON.
    fn export(&self) -> Vec<(&'static str, Vec<u8>)>;
}

/// A concrete artifact type with a kind known at compile time.
pub trait ArtifactType: Artifact + Sized {
    /// The kind of every value of this type.
    const KIND: Kind;
    /// True where pipelines hold a *named set* of this kind (`"front"`, `"back"`, ...), so that a
    /// stage which takes one is mapped over the set.
    const IN_SETS: bool;
}
