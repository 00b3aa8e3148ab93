//! What stages are for.

/// What a stage is for. The eight roles of the product, and those that stand around them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Reads photos, bodies, patterns.
    Reader,
    /// Removes noise from photos.
    Denoiser,
    /// Overlapping photos of a camera that turns to one picture.
    Panorama,
    /// Photos from several places to the view from another place.
    ViewInterpolator,
    /// Photo to mask.
    Binariser,
    /// Photo and mask to outline.
    EdgeDetector,
    /// Names edges, keeps seams.
    Style,
    /// Outline to panel.
    Mesher,
    /// Moves panel vertices.
    Smoother,
    /// Makes or reads the body.
    Body,
    /// Chooses the cloth.
    Fabric,
    /// Panels into space.
    Placement,
    /// Body to collision service.
    Collider,
    /// Sews.
    Stitcher,
    /// Drapes.
    Draper,
    /// Garment to flat pattern.
    Flattener,
    /// Garment and photos to model.
    Texturer,
    /// Writes files.
    Writer,
}

impl Role {
    /// Every role, in the order of a pipeline.
    pub const ALL: [Role; 18] = [
        Role::Reader,
        Role::Denoiser,
        Role::Panorama,
        Role::ViewInterpolator,
        Role::Binariser,
        Role::EdgeDetector,
        Role::Style,
        Role::Mesher,
        Role::Smoother,
        Role::Body,
        Role::Fabric,
        Role::Placement,
        Role::Collider,
        Role::Stitcher,
        Role::Draper,
        Role::Flattener,
        Role::Texturer,
        Role::Writer,
    ];

    /// The role of that word.
    pub fn named(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|r| r.as_str() == word)
    }

    /// The role in words: `edge detector`.
    pub fn as_str(self) -> &'static str {
        match self {
            Role::Reader => "reader",
            Role::Denoiser => "denoiser",
            Role::Panorama => "panorama",
            Role::ViewInterpolator => "view interpolator",
            Role::Binariser => "binariser",
            Role::EdgeDetector => "edge detector",
            Role::Style => "style",
            Role::Mesher => "mesher",
            Role::Smoother => "smoother",
            Role::Body => "body",
            Role::Fabric => "fabric",
            Role::Placement => "placement",
            Role::Collider => "collider",
            Role::Stitcher => "stitcher",
            Role::Draper => "draper",
            Role::Flattener => "flattener",
            Role::Texturer => "texturer",
            Role::Writer => "writer",
        }
    }
}
