//! Stages for tests: the ports and parameters of a garment pipeline, and no work.

use std::collections::BTreeMap;
use toile_core::prelude::*;

/// A photo's file and width.
#[choice]
pub(crate) struct PhotoFile {
    /// Its path.
    file: String,
    /// The width it shows.
    width: Length,
}

/// Neighbours.
#[choice]
pub(crate) enum Mask4or8 {
    /// Up, down, left, right.
    Four,
    /// The diagonals too.
    Eight,
}

/// One seam.
#[choice]
pub(crate) enum SeamLine {
    /// Equal lengths.
    Match(EdgeRef, EdgeRef),
}

/// A mean.
#[stage(role = Denoiser)]
pub(crate) struct Mean {
    /// Neighbours.
    #[param(default = Mask4or8::Eight)]
    mask: Mask4or8,
    /// How far.
    #[param(default = 1, min = 1, max = 9, unit = "px")]
    radius: u32,
}

/// A threshold.
#[stage(role = Binariser)]
pub(crate) struct Otsu {
    /// Added to the threshold.
    #[param(default = 0.0, min = -255, max = 255, unit = "grey levels")]
    bias: f64,
}

/// A threshold by neighbourhood.
#[stage(role = Binariser)]
pub(crate) struct Local {}

/// Edges by gradient.
#[stage(role = EdgeDetector, contracts(Deterministic))]
pub(crate) struct Canny {
    /// Weak edges.
    #[param(default = 20.0, min = 0, max = 255)]
    low: f64,
    /// Strong edges.
    #[param(default = 60.0, min = 0, max = 255)]
    high: f64,
}

/// Names edges.
#[stage(role = Style)]
pub(crate) struct Vest {}

/// Body from measurements.
#[stage(role = Body)]
pub(crate) struct Mannequin {
    /// Height.
    #[param(default = Length::cm(172.0), min = 0.5, max = 2.5)]
    height: Length,
}

/// Cloth by name.
#[stage(role = Fabric)]
pub(crate) struct Preset {
    /// Its name.
    #[param(default = "cotton poplin".to_owned())]
    name: String,
    /// Thickness.
    #[param(default = 1.0, min = 0.1, max = 10)]
    scale: f64,
}

/// Reads photos.
#[stage(role = Reader)]
pub(crate) struct Photos {
    /// By side.
    photos: BTreeMap<String, PhotoFile>,
}

/// Adds seams.
#[stage(role = Style)]
pub(crate) struct Seams {
    /// Seams.
    seams: Vec<SeamLine>,
}

/// Regular grid.
#[stage(role = Mesher)]
pub(crate) struct GridMesher {
    /// Edge length.
    #[param(default = Length::mm(12.0), min = 0.001, max = 0.1)]
    edge: Length,
}

/// Delaunay.
#[stage(role = Mesher)]
pub(crate) struct DelaunayMesher {
    /// Edge length.
    #[param(default = Length::mm(12.0), min = 0.001, max = 0.1)]
    edge: Length,
}

/// Smooths a panel.
#[stage(role = Smoother)]
pub(crate) struct Taubin {}

/// Joins all panels into one, for arity tests.
#[stage(role = Smoother)]
pub(crate) struct Merge {}

/// Takes a body apart: one for each panel, for arity tests.
#[stage(role = Body)]
pub(crate) struct Fit {}

/// Paints.
#[stage(role = Texturer)]
pub(crate) struct Painter {}

/// One of two stages of the same name.
pub(crate) mod edges {
    use toile_core::prelude::*;

    /// Finds edges.
    #[stage(role = EdgeDetector)]
    pub(crate) struct Laplacian {
        /// Weak edges.
        #[param(default = 6.0, min = 0, max = 255)]
        threshold: f64,
    }
}

/// The other of two stages of the same name.
pub(crate) mod smooth {
    use toile_core::prelude::*;

    /// Smooths.
    #[stage(role = Smoother)]
    pub(crate) struct Laplacian {
        /// How far.
        #[param(default = 0.5, min = 0, max = 1)]
        lambda: f64,
    }
}

/// Writes.
#[stage(role = Writer)]
pub(crate) struct Glb {}

/// Reports.
#[stage(role = Writer)]
pub(crate) struct Report {}

macro_rules! idle {
    ($($stage:ty: ($($(#[$m:meta])? $name:ident: $arg:ty),*) -> $out:ty;)*) => {$(
        #[stage]
        impl $stage {
            fn run(&self, $($(#[$m])? $name: $arg,)* _cx: &Context) -> Result<$out, StageError> {
                Err(StageError::internal("a test stage does nothing"))
            }
        }
    )*};
}

idle! {
    Photos: () -> Set<Photo>;
    Mannequin: () -> Body;
    Preset: () -> Fabric;
    Mean: (_photo: &Photo) -> Photo;
    Otsu: (_photo: &Photo) -> Mask;
    Local: (_photo: &Photo) -> Mask;
    Vest: (_outlines: Set<Outline>) -> (Set<Outline>, SewingPlan);
    Seams: (_outlines: Set<Outline>, _plan: &SewingPlan) -> (Set<Outline>, SewingPlan);
    GridMesher: (_outline: &Outline) -> Panel;
    DelaunayMesher: (_outline: &Outline) -> Panel;
    edges::Laplacian: (_photo: &Photo, _mask: &Mask) -> Outline;
    smooth::Laplacian: (_panel: &Panel) -> Panel;
    Taubin: (_panel: &Panel) -> Panel;
    Merge: (_panels: Set<Panel>) -> Panel;
    Fit: (_panel: &Panel, _body: &Body) -> Body;
    Painter: (_panels: Set<Panel>, #[original] _photos: Set<Photo>, _body: Option<&Body>, _fabric: Option<&Fabric>) -> Model;
    Glb: (_model: &Model) -> OutputFiles;
    Report: (_log: &RunLog) -> OutputFiles;
}

#[stage]
impl Canny {
    fn run(&self, _photo: &Photo, _mask: &Mask, _cx: &Context) -> Result<Outline, StageError> {
        Err(StageError::internal("a test stage does nothing"))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        let wrong = self.low > self.high;
        wrong.then(|| StageError::invalid("`low` is above `high`").at("low")).into_iter().collect()
    }
}

/// All of them, and the sections of a garment.
pub(crate) fn registry() -> Registry {
    let mut r = Registry::new();
    r.add::<Photos>().add::<Mannequin>().add::<Preset>().add::<Mean>().add::<Otsu>().add::<Local>();
    r.add::<Canny>().add::<Vest>().add::<Seams>().add::<GridMesher>().add::<DelaunayMesher>().add::<Taubin>();
    r.add::<Merge>().add::<Fit>().add::<Painter>().add::<Glb>().add::<Report>();
    r.add::<edges::Laplacian>().add::<smooth::Laplacian>();
    r.section(Section::table("photos", "Photos", "photos"));
    r.section(Section::stage("style", Role::Style));
    r.section(Section::stage("body", Role::Body));
    r.section(Section::stage("fabric", Role::Fabric));
    r.section(Section::table("seams", "Seams", "seams"));
    r
}

/// A file with every section.
pub(crate) const VEST: &str = r#"// A vest.
(
    name: "vest",
    photos: {
        "front": (file: "front.jpg", width: "52 cm"),
        "back":  (file: "back.jpg",  width: "52 cm"),
    },
    style: Vest(),
    body: Mannequin(height: "172 cm"),
    fabric: Preset("cotton poplin"),
    stages: [
        Mean(mask: Eight, radius: 1),
        Otsu(),
        Canny(low: 20, high: 60),
        GridMesher(edge: "12 mm"),
        Taubin(),
        Painter(),
        Glb(), Report(),
    ],
    seams: [ Match("front.side_left", "back.side_right") ],
)
"#;
