//! The length of a drawing's own unit, and whether a garment of it is of a size that someone wears.

use std::ops::RangeInclusive;
use toile_core::prelude::*;

/// The unit of the numbers in a drawing.
#[choice]
#[derive(Copy, Eq)]
pub enum DrawingUnit {
    /// The one that the file says, or by which its pieces are of a garment's size.
    Auto,
    /// Millimetres.
    Millimetres,
    /// Centimetres.
    Centimetres,
    /// Metres.
    Metres,
    /// Inches.
    Inches,
    /// Points, of which an inch has 72.
    Points,
    /// Pixels, of which an inch has 96.
    Px,
}

/// The longest side of a garment's largest piece, metres; a unit that the file states is used if
/// this size is within these: half a circle of a ball gown is 6 m wide.
pub(super) const WORN: RangeInclusive<f64> = 0.15..=8.0;
/// The same size, metres, where nothing states the unit.
pub(super) const LIKELY: RangeInclusive<f64> = 0.25..=2.5;
/// What that side is most often, metres.
const USUAL: f64 = 0.7;

impl DrawingUnit {
    /// Those that a person may mean, the likelier first.
    const MEANT: [DrawingUnit; 6] = [
        DrawingUnit::Millimetres,
        DrawingUnit::Centimetres,
        DrawingUnit::Inches,
        DrawingUnit::Metres,
        DrawingUnit::Points,
        DrawingUnit::Px,
    ];

    /// Its length, metres; none where it is to be found.
    pub(super) fn metres(self) -> Option<f64> {
        match self {
            DrawingUnit::Auto => None,
            DrawingUnit::Millimetres => Some(1e-3),
            DrawingUnit::Centimetres => Some(1e-2),
            DrawingUnit::Metres => Some(1.0),
            DrawingUnit::Inches => Some(0.0254),
            DrawingUnit::Points => Some(0.0254 / 72.0),
            DrawingUnit::Px => Some(0.0254 / 96.0),
        }
    }

    /// Its name as a person writes it.
    pub(super) fn word(self) -> &'static str {
        match self {
            DrawingUnit::Auto => "the file's unit",
            DrawingUnit::Millimetres => "millimetres",
            DrawingUnit::Centimetres => "centimetres",
            DrawingUnit::Metres => "metres",
            DrawingUnit::Inches => "inches",
            DrawingUnit::Points => "points, 72 an inch",
            DrawingUnit::Px => "pixels, 96 an inch",
        }
    }

    /// Its name as a pipeline writes it.
    fn choice(self) -> &'static str {
        match self {
            DrawingUnit::Auto => "Auto",
            DrawingUnit::Millimetres => "Millimetres",
            DrawingUnit::Centimetres => "Centimetres",
            DrawingUnit::Metres => "Metres",
            DrawingUnit::Inches => "Inches",
            DrawingUnit::Points => "Points",
            DrawingUnit::Px => "Px",
        }
    }

    /// Of these units the one by which something of that many units is nearest to the usual size of
    /// a garment.
    pub(super) fn likeliest(size: f64, of: &[DrawingUnit]) -> Option<DrawingUnit> {
        let off = |u: &DrawingUnit| (size * u.metres().unwrap_or(1.0) / USUAL).ln().abs();
        of.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)))
    }
}

/// A unit that was taken for a file, and by which fact.
pub(super) struct Taken {
    /// Its length, metres.
    pub metres: f64,
    /// Why it was taken: "the file says that its units are millimetres".
    pub fact: String,
    pub by: By,
}

/// Who says a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum By {
    /// A person, whose unit is always used.
    Parameter,
    /// The file, by the name of a unit of length.
    File,
    /// No one.
    Guess,
}

/// The error for pieces that have no garment's size in the unit that was used.
#[derive(Debug, PartialEq)]
pub(super) struct Misfit {
    pub what: String,
    pub remedy: String,
}

/// Looks whether the largest of the pieces is of a size that someone wears.
///
/// Errors: it is not; the remedy is the unit that would fit.
pub(super) fn worn(pieces: &[Piece], taken: &Taken) -> Result<(), Misfit> {
    let Some((size, largest)) = largest(pieces) else { return Ok(()) };
    let sizes = match taken.by {
        By::Parameter => return Ok(()),
        By::File => WORN,
        By::Guess => LIKELY,
    };
    if sizes.contains(&size) {
        return Ok(());
    }
    let units = size / taken.metres;
    let long = |unit: &DrawingUnit| units * unit.metres().unwrap_or(1.0);
    let fits = |unit: &DrawingUnit| LIKELY.contains(&long(unit));
    let fitting: Vec<DrawingUnit> = DrawingUnit::MEANT[..4].iter().copied().filter(fits).collect();
    let fitting = match fitting.is_empty() {
        true => DrawingUnit::MEANT[4..].iter().copied().filter(fits).take(1).collect(),
        false => fitting,
    };
    let set = |unit: &DrawingUnit| {
        format!("`--set pattern.unit={}` makes it {} long", unit.choice(), words(long(unit)))
    };
    let nearest = DrawingUnit::MEANT.into_iter().find(|u| (long(u) / size - 1.0).abs() < 1e-6);
    let meant = nearest.map_or_else(String::new, |unit| {
        format!("; where it is meant to be of that size, `--set pattern.unit={}` says so", unit.choice())
    });
    let remedy = match fitting.is_empty() {
        true => format!("no usual unit makes a garment of it: is it the file that is meant?{meant}"),
        false => fitting.iter().map(set).collect::<Vec<_>>().join(", ") + &meant,
    };
    let what = format!(
        "no one wears a garment of that size: its largest piece, \"{largest}\", would be {} long, as {}",
        words(size),
        taken.fact
    );
    Err(Misfit { what, remedy })
}

/// The longest side of the largest piece, metres, and its name.
fn largest(pieces: &[Piece]) -> Option<(f64, &str)> {
    let size = |p: &Piece| {
        let points = p.outer.points().0;
        let span = |of: fn(&Point2) -> f64| {
            let all = || points.iter().map(of);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        span(|p| p.x).max(span(|p| p.y))
    };
    pieces.iter().map(|p| (size(p), p.name.as_str())).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// The longest side of the largest piece in words: "58 cm".
pub(super) fn longest(pieces: &[Piece]) -> String {
    words(largest(pieces).map_or(0.0, |(size, _)| size))
}

/// A length in words.
fn words(metres: f64) -> String {
    match metres {
        m if m < 0.1 => format!("{:.1} cm", m * 1e2),
        m if m < 10.0 => format!("{:.0} cm", m * 1e2),
        m => format!("{m:.0} m"),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn of_height(metres: f64) -> Vec<Piece> {
        let corners =
            [[0.0, 0.0], [0.01, 0.0], [0.01, metres], [0.0, metres]].map(|[x, y]| Point2::new(x, y));
        let edges = ["a", "b", "c", "d"].map(|n| PieceEdge { name: n.into(), curve: EdgeCurve::Line });
        let outer = PatternLoop { corners: corners.into(), edges: edges.into() };
        vec![Piece { name: "FRONT".into(), outer, ..Piece::default() }]
    }

    fn taken(metres: f64, by: By) -> Taken {
        Taken { metres, fact: "the file says that its units are millimetres".into(), by }
    }

    #[test]
    fn a_size_that_no_one_wears_is_refused_with_the_unit_that_fits() {
        let misfit = worn(&of_height(0.058), &taken(1e-3, By::File)).unwrap_err();
        assert_eq!(
            misfit.what,
            "no one wears a garment of that size: its largest piece, \"FRONT\", would be 5.8 cm long, as the file says that its units are millimetres"
        );
        assert_eq!(
            misfit.remedy,
            "`--set pattern.unit=Centimetres` makes it 58 cm long, `--set pattern.unit=Inches` makes it 147 cm long; \
             where it is meant to be of that size, `--set pattern.unit=Millimetres` says so"
        );
        let misfit = worn(&of_height(2e4), &taken(1e-3, By::File)).unwrap_err();
        assert!(misfit.remedy.starts_with("no usual unit makes a garment of it: "), "{}", misfit.remedy);
        assert_eq!(worn(&of_height(0.2), &taken(1e-3, By::File)), Ok(()));
        assert_eq!(worn(&of_height(0.02), &taken(1e-3, By::Parameter)), Ok(()));
        assert!(worn(&of_height(0.2), &taken(0.0254 / 96.0, By::Guess)).is_err());
    }

    #[test]
    fn of_several_units_the_one_of_a_garments_size_is_the_likeliest() {
        let all =
            [DrawingUnit::Millimetres, DrawingUnit::Centimetres, DrawingUnit::Inches, DrawingUnit::Metres];
        let found = |size| DrawingUnit::likeliest(size, &all).unwrap();
        assert_eq!(
            [700.0, 70.0, 27.6, 0.7].map(found),
            [DrawingUnit::Millimetres, DrawingUnit::Centimetres, DrawingUnit::Inches, DrawingUnit::Metres]
        );
    }
}
