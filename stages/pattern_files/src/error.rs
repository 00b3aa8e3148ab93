//! Why a pattern cannot be written.

use thiserror::Error;
use toile_core::artifact::{Artifact, Pattern};

/// No piece may reach farther from the origin than this, metres: beyond it no reader takes a file
/// for a garment.
pub const FARTHEST: f64 = 1000.0;

/// Why a pattern is refused, with its place.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum WriteError {
    /// The pattern itself is not sound.
    #[error("the pattern is not sound: {0}")]
    Unsound(String),
    /// A pattern without pieces.
    #[error("the pattern has no pieces")]
    NoPieces,
    /// A piece beyond [`FARTHEST`].
    #[error("piece \"{piece}\" reaches {metres:.0} m from its origin, {FARTHEST:.0} m are the most")]
    Far {
        /// The piece.
        piece: String,
        /// How far it reaches, metres.
        metres: f64,
    },
    /// A seam allowance that cannot be cut.
    #[error("the allowance of {place} is {mm} mm, it is at least 0 and at most {most_mm} mm")]
    Allowance {
        /// The edge, or which of the general allowances.
        place: String,
        /// What is asked for, millimetres.
        mm: f64,
        /// The greatest, millimetres.
        most_mm: f64,
    },
    /// An allowance for an edge that there is none of.
    #[error("an allowance is given for {edge}, which is no edge of the pattern")]
    NoEdge {
        /// The edge, as `piece.edge`.
        edge: String,
    },
    /// More pages than anybody prints.
    #[error("the pieces need {pages} pages, {most} are the most")]
    Pages {
        /// Pages that are needed.
        pages: usize,
        /// The most.
        most: usize,
    },
    /// A sheet that is larger than a page of a PDF may be.
    #[error("the pieces need a sheet of {width:.1} m by {height:.1} m, {most:.1} m are the most of a page")]
    Sheet {
        /// Its width, metres.
        width: f64,
        /// Its height, metres.
        height: f64,
        /// The most, metres.
        most: f64,
    },
    /// A page that is too small for what stands on each.
    #[error(
        "a page of {width:.0} mm by {height:.0} mm is too small for its margins and the test square: {} mm by {} mm are the least",
        .least[0], .least[1]
    )]
    SmallPage {
        /// Its width, millimetres.
        width: f64,
        /// Its height, millimetres.
        height: f64,
        /// The least width and height, millimetres.
        least: [f64; 2],
    },
    /// A page that is larger than one of a PDF may be.
    #[error("a page of {width:.0} mm by {height:.0} mm is too large: {most:.0} mm are the most")]
    LargePage {
        /// Its width, millimetres.
        width: f64,
        /// Its height, millimetres.
        height: f64,
        /// The most, millimetres.
        most: f64,
    },
    /// A piece that is wider than the roll it is plotted on.
    #[error("piece \"{piece}\" needs {needed:.0} mm across the roll, which is {width:.0} mm wide")]
    Roll {
        /// The piece.
        piece: String,
        /// Its size across the roll, millimetres.
        needed: f64,
        /// The roll's width, millimetres.
        width: f64,
    },
    /// A piece that is longer than a page of a plot.
    #[error("piece \"{piece}\" needs {needed:.0} mm along the roll, pages are {length:.0} mm long")]
    PlotPage {
        /// The piece.
        piece: String,
        /// Its size along the roll, millimetres.
        needed: f64,
        /// The length of the pages, millimetres.
        length: f64,
    },
    /// A plot beyond the numbers that plotters read.
    #[error("the plot needs {metres:.1} m of the roll, {most:.1} m are the most that plotters count")]
    PlotLength {
        /// Its length, metres.
        metres: f64,
        /// The most, metres.
        most: f64,
    },
    /// A unit of length that no plotter has.
    #[error("a plotter has {given} units a millimetre, {least} to {most} are taken")]
    PlotUnit {
        /// What is asked for.
        given: f64,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
}

impl WriteError {
    /// What can be done about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            WriteError::Unsound(_) => "correct the pattern before it is written",
            WriteError::NoPieces => "give a pattern that has pieces",
            WriteError::Far { .. } => "correct the unit of the pattern, which is the metre",
            WriteError::Allowance { .. } => "give the allowance in metres, such as 0.01",
            WriteError::NoEdge { .. } => "name a piece and an edge of its outline, such as \"front.hem\"",
            WriteError::Pages { .. } => "write fewer pieces at a time, on larger pages, or in one piece",
            WriteError::Sheet { .. } => "write it on A4 or Letter pages",
            WriteError::SmallPage { .. } => "take A4, Letter or a larger page",
            WriteError::LargePage { .. } => "take A0 or a smaller page",
            WriteError::Roll { .. } => "take a wider roll, or lay the long side of pieces along it",
            WriteError::PlotPage { .. } => "take longer pages, or none: the plot is one piece then",
            WriteError::PlotLength { .. } => "plot fewer pieces at a time, on a wider roll, or on pages",
            WriteError::PlotUnit { .. } => {
                "take 40, which is 1016 an inch, unless the plotter's manual has another number"
            }
        }
    }
}

/// A pattern that can be written: sound, with pieces, all of them near enough.
///
/// Errors: [`WriteError::Unsound`], [`WriteError::NoPieces`], [`WriteError::Far`].
pub(crate) fn writable(pattern: &Pattern) -> Result<(), WriteError> {
    pattern.check().map_err(WriteError::Unsound)?;
    if pattern.pieces.is_empty() {
        return Err(WriteError::NoPieces);
    }
    for p in &pattern.pieces {
        let loops = std::iter::once(&p.outer).chain(&p.holes);
        let corners = loops.flat_map(|l| l.corners.iter().map(|c| c.coords.amax()));
        let lengths = (0..p.outer.edges.len()).map(|k| p.outer.path(k).length());
        let drawn = p.lines.iter().flat_map(|l| l.points.iter().map(|q| q.coords.amax()));
        let marks = p.drill_holes.iter().chain(p.grain.iter().flatten()).map(|q| q.coords.amax());
        let place = p.pose.iter().map(|pose| pose.origin.coords.amax());
        let metres = corners.chain(lengths).chain(drawn).chain(marks).chain(place).fold(0.0, f64::max);
        if metres > FARTHEST {
            return Err(WriteError::Far { piece: p.name.clone(), metres });
        }
    }
    Ok(())
}
