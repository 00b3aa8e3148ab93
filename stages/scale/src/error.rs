//! What the crate refuses, each with the place and a remedy.

use thiserror::Error;

/// Why a photo gives no scale. Places are pixels of the photo, x to the right, y downwards.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ScaleError {
    /// Nothing in the photo is the object.
    #[error(
        "no {object} was found; lay it flat beside the garment, whole in the frame, on a ground of another colour, and photograph from above"
    )]
    NoneFound {
        /// What was looked for.
        object: &'static str,
    },
    /// Several places are equally good.
    #[error(
        "{} places look like a {object} ({}); leave one in the frame", .places.len(), list(.places)
    )]
    Several {
        /// What was looked for.
        object: &'static str,
        /// The middles of the places.
        places: Vec<[f64; 2]>,
    },
    /// The object leaves the photo.
    #[error(
        "the {object} at ({:.0}, {:.0}) is cut by the photo's frame; lay it whole into the frame", .place[0], .place[1]
    )]
    Cut {
        /// What was looked for.
        object: &'static str,
        /// Its middle.
        place: [f64; 2],
    },
    /// The object has too few pixels to be measured.
    #[error(
        "the {object} at ({:.0}, {:.0}) is {short:.0} px on its shorter side, {least:.0} are needed; use a photo of more pixels or a larger object",
        .place[0], .place[1]
    )]
    TooSmall {
        /// What was looked for.
        object: &'static str,
        /// Its middle.
        place: [f64; 2],
        /// Its shorter side, pixels.
        short: f64,
        /// The shorter side that is needed, pixels.
        least: f64,
    },
    /// The camera looks too flat over the ground.
    #[error(
        "the {object} at ({:.0}, {:.0}) is seen at {degrees:.0} degrees from straight above, at most 60 are allowed, and 35 without the lens's focal length; photograph from above",
        .place[0], .place[1]
    )]
    Tilted {
        /// What was looked for.
        object: &'static str,
        /// Its middle.
        place: [f64; 2],
        /// Angle between the line of sight and the ground's normal, degrees.
        degrees: f64,
    },
    /// The marks of a ruler grow wider along it, so that one scale does not hold.
    #[error(
        "the marks of the ruler at ({:.0}, {:.0}) widen by {percent:.1} % along it, so the camera was tilted and a ruler gives no tilt; photograph from straight above or use a sheet",
        .place[0], .place[1]
    )]
    RulerTilted {
        /// The middle of its marks.
        place: [f64; 2],
        /// Growth of the spacing from one end to the other, percent.
        percent: f64,
    },
    /// The marks of a ruler have too few pixels to be recognised.
    #[error(
        "the marks of the ruler at ({:.0}, {:.0}) are {apart:.1} px apart, {least:.0} are needed; go nearer or use a photo of more pixels",
        .place[0], .place[1]
    )]
    RulerFine {
        /// The middle of its marks.
        place: [f64; 2],
        /// From a mark to the next, pixels.
        apart: f64,
        /// What is needed, pixels.
        least: f64,
    },
    /// A photo too small or too large to be looked at.
    #[error(
        "the photo is {width} x {height} px; give one of 32 to 30000 px a side and at most 200 megapixels"
    )]
    Size {
        /// Its width, pixels.
        width: u32,
        /// Its height, pixels.
        height: u32,
    },
    /// A chessboard's square that is out of range.
    #[error("a chessboard's square of {square_um} um is out of range; give 1000 to 1000000 um")]
    Square {
        /// The side that was stated, micrometres.
        square_um: u32,
    },
    /// A chessboard's counts that are out of range.
    #[error("a chessboard of {m} x {n} inner corners is out of range; give 3 to 60 each")]
    Corners {
        /// Inner corners along one direction.
        m: u32,
        /// Inner corners along the other direction.
        n: u32,
    },
    /// A focal length that no camera has.
    #[error("a focal length of {focal} mm (35 mm film) is out of range; give 8 to 400 mm, or none")]
    Focal {
        /// The focal length that was stated.
        focal: f64,
    },
    /// NaN or infinity in a homography, or one that cannot be inverted.
    #[error("the homography has no finite inverse; take the one that `find` gave")]
    NotFinite,
    /// A resolution that is out of range.
    #[error("a resolution of {px_per_metre} px per metre is out of range; give 10 to 100000, or none")]
    Resolution {
        /// What was requested.
        px_per_metre: f64,
    },
}

/// Places as text.
fn list(places: &[[f64; 2]]) -> String {
    let texts: Vec<String> = places.iter().map(|[x, y]| format!("({x:.0}, {y:.0})")).collect();
    texts.join(", ")
}
