//! `Mannequin`: a closed, smooth figure made to measure.
//!
//! A [`BodyFigure`](super::figure::BodyFigure) is brought to its measures by
//! [`fit`](crate::measures::fit). What is not given follows from the size, the figure, the
//! height and the bust. Cost: mostly one meshing, a tenth of a second.

use super::wearer::Wearer;
use crate::form::{BodyForm, CHILD, MAN, WOMAN};
use crate::measures::fit::fit;
use crate::measures::sizes::{SizeRow, known, measures, of_child};
use crate::shape::{FigureSize, chin, level};
use toile_core::prelude::*;

/// Heights between which a figure that is not stated is half a child's, metres.
const GROWING: [f64; 2] = [1.35, 1.55];

/// Shares of the height up to the chin that make the arm's length where none is given: child and
/// grown up.
const ARM: [f64; 2] = [0.366, 0.384];

/// Height, bust, waist and hip of women, men and children where nothing is given, centimetres.
/// Girths of a child follow from its height where that is given; those of adults do not depend on
/// it.
const USUAL: [SizeRow; 3] =
    [[172.0, 88.0, 70.0, 96.0], [180.0, 100.0, 86.0, 100.0], [110.0, 58.0, 54.0, 60.0]];

/// A mannequin made to measure: closed and smooth, arms spread in A-pose, legs a little apart.
///
/// Measures are taken as ISO 8559-1 (2017) says: girths are those of a tape around the trunk at the
/// fullest bust, the waist and the fullest hip and around the neck; the arm's length goes from the
/// shoulder point over the elbow to the wrist, the inseam from the fork of the legs to the sole.
/// What is not given follows from `size`, else from the figure, the height and the bust. Sizes are
/// those of EN 13402-3. Children from 80 cm on have larger heads and shorter limbs.
#[stage(
    role = Body,
    version = 5,
    source = "measures: ISO 8559-1, 2017; sizes: EN 13402-3; proportions: Gordon and others, 1989; surface nets: Gibson, 1998",
    example = "Mannequin(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Mannequin {
    /// Crown to sole; where neither it nor a size is given, 172 cm for a woman, 180 cm for a man,
    /// 110 cm for a child.
    #[param(default = None, min = 0.8, max = 2.1)]
    height: Option<Length>,
    /// Girth at the fullest part of the chest; where neither it nor a size is given, 88 cm for a
    /// woman, 100 cm for a man, 58 cm for a child, or what is usual for a child of the given
    /// height.
    #[param(default = None, min = 0.4, max = 1.7)]
    bust: Option<Length>,
    /// Girth at the waist; where it is not given, 70 cm for a woman, 86 cm for a man, 54 cm for a
    /// child, or what is usual for a child of the given height.
    #[param(default = None, min = 0.35, max = 1.7)]
    waist: Option<Length>,
    /// Girth at the fullest part of the seat; where it is not given, 96 cm for a woman, 100 cm for
    /// a man, 60 cm for a child, or what is usual for a child of the given height.
    #[param(default = None, min = 0.4, max = 1.7)]
    hip: Option<Length>,
    /// Whose proportions; a woman's where it is not given, a child's below 135 cm, between the two
    /// up to 155 cm.
    #[param(default = None)]
    figure: Option<Wearer>,
    /// A size such as `M` or `EU 38`, for a child `EU 110`: measures that are not given follow from
    /// it.
    #[param(default = None)]
    size: Option<String>,
    /// Distance of the shoulders' outer points; follows from height and bust where it is not given.
    #[param(default = None, min = 0.15, max = 0.6)]
    shoulder_width: Option<Length>,
    /// Girth of the neck, square to its axis; follows from height and bust where it is not given.
    #[param(default = None, min = 0.18, max = 0.6)]
    neck: Option<Length>,
    /// Shoulder point over elbow to wrist; follows from the height where it is not given.
    #[param(default = None, min = 0.2, max = 0.9)]
    arm: Option<Length>,
    /// Fork of the legs to sole; follows from the height where it is not given.
    #[param(default = None, min = 0.25, max = 1.1)]
    inseam: Option<Length>,
    /// Angle between the arms and the vertical; 60 suits sleeves of shirts laid flat.
    #[param(default = 60.0, min = 30.0, max = 75.0, unit = "deg")]
    arm_angle: f64,
    /// Length of the mesh's edges; small bodies get shorter ones, hands, head and feet too.
    #[param(default = Length::mm(16.0), min = 0.006, max = 0.022, trades, finer = "less")]
    edge: Length,
}

#[stage]
impl Mannequin {
    /// Makes the body.
    pub fn run(&self, cx: &Context) -> Result<Body, StageError> {
        let (size, form) = self.measures()?;
        check(&size)?;
        fit(&size, &form, self.edge.metres(), cx)
    }

    /// Whether anybody has such measures.
    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.measures().and_then(|(size, _)| check(&size)).err().into_iter().collect()
    }
}

impl Mannequin {
    /// A mannequin of that height with bust, waist and hip, meshed at an edge length, all in
    /// metres.
    #[cfg(test)]
    pub fn of(height: f64, girths: [f64; 3], edge: f64) -> Self {
        Mannequin::made(height, girths, 60.0, edge)
    }

    /// A mannequin of that height with bust, waist and hip and the arms at that angle in degrees,
    /// meshed at an edge length, all in metres.
    pub fn made(height: f64, [bust, waist, hip]: [f64; 3], arm_angle: f64, edge: f64) -> Self {
        let [height, bust, waist, hip] = [height, bust, waist, hip].map(|l| Some(Length::m(l)));
        Mannequin { height, bust, waist, hip, arm_angle, edge: Length::m(edge), ..Mannequin::default() }
    }

    /// The measures that are given, those of the size, and those that follow.
    fn measures(&self) -> Result<(FigureSize, BodyForm), StageError> {
        let (wearer, usual) = self.usual()?;
        let given = |l: Option<Length>, or: f64| l.map_or(or, Length::metres);
        let [height, bust, waist, hip] = [self.height, self.bust, self.waist, self.hip];
        let height = given(height, usual[0] / 100.0);
        let bust = given(bust, usual[1] / 100.0);
        let (form, grown) = form(wearer, height);
        let follows = |[of_height, of_bust]: [f64; 2]| of_height * height + of_bust * bust;
        let size = FigureSize {
            height,
            bust,
            waist: given(waist, usual[2] / 100.0),
            hip: given(hip, usual[3] / 100.0),
            shoulder_width: given(self.shoulder_width, follows(form.shoulders)),
            neck: given(self.neck, follows(form.neck)),
            arm: given(self.arm, (ARM[0] + (ARM[1] - ARM[0]) * grown) * chin(height)),
            inseam: given(self.inseam, level::CROTCH * chin(height)),
            arm_angle: self.arm_angle.to_radians(),
        };
        Ok((size, form))
    }

    /// Whose figure it is, where that is known, and the measures of the size or those that are
    /// usual.
    fn usual(&self) -> Result<(Option<Wearer>, SizeRow), StageError> {
        let Some(size) = &self.size else {
            let usual = USUAL[self.figure.map_or(0, |w| w as usize)];
            let table = self.height.map_or(usual, |h| at_height(self.figure, h.metres(), usual));
            return Ok((self.figure, table));
        };
        let found = measures(size, self.figure).ok_or_else(|| no_size(size, self.figure))?;
        Ok((Some(found.0), found.1))
    }
}

/// Maturity of a figure that is not stated, by its height, metres: 0 for a child, 1 for an adult.
fn grown(height: f64) -> f64 {
    let [child, grown] = GROWING;
    ((height - child) / (grown - child)).clamp(0.0, 1.0)
}

/// What is usual at a height, metres: a child's girths follow from it.
fn at_height(wearer: Option<Wearer>, height: f64, usual: SizeRow) -> SizeRow {
    let child = of_child(height * 100.0);
    let share = match wearer {
        Some(Wearer::Woman | Wearer::Man) => 1.0,
        Some(Wearer::Child) => 0.0,
        None => grown(height),
    };
    std::array::from_fn(|k| child[k] + share * (usual[k] - child[k]))
}

/// The proportions, and the share in which they are a grown person's.
fn form(wearer: Option<Wearer>, height: f64) -> (BodyForm, f64) {
    let share = grown(height);
    match wearer {
        Some(Wearer::Woman) => (WOMAN, 1.0),
        Some(Wearer::Man) => (MAN, 1.0),
        Some(Wearer::Child) => (CHILD, 0.0),
        None => (CHILD.towards(&WOMAN, share), share),
    }
}

fn no_size(size: &str, wearer: Option<Wearer>) -> StageError {
    let whose = match wearer {
        None => "mannequin",
        Some(Wearer::Woman) => "woman",
        Some(Wearer::Man) => "man",
        Some(Wearer::Child) => "child",
    };
    StageError::new(ErrorCode::InvalidParameter, format!("no {whose} has a size of \"{size}\""))
        .hint(format!("the sizes are {}", known(wearer)))
        .at("size")
}

/// Shares of a length that people have, from thin to heavy: parameter, what it is compared to,
/// range.
fn check(size: &FigureSize) -> Result<(), StageError> {
    let h = size.height;
    let rules = [
        ("height", h, "", 1.0, (0.8, 2.1)),
        ("bust", size.bust, "a height", h, (0.40, 0.80)),
        ("waist", size.waist, "a height", h, (0.30, 0.78)),
        ("hip", size.hip, "a height", h, (0.42, 0.82)),
        ("waist", size.waist, "a bust", size.bust, (0.60, 1.12)),
        ("hip", size.hip, "a bust", size.bust, (0.75, 1.45)),
        ("hip", size.hip, "a waist", size.waist, (0.85, 1.75)),
        ("shoulder_width", size.shoulder_width, "a bust", size.bust, (0.34, 0.56)),
        ("neck", size.neck, "a bust", size.bust, (0.30, 0.52)),
        ("arm", size.arm, "a height", h, (0.25, 0.40)),
        ("inseam", size.inseam, "a height", h, (0.36, 0.52)),
        // 30 degrees converted from radians have rounding in their last digits.
        ("arm_angle", (size.arm_angle.to_degrees() * 1e9).round() / 1e9, "", 1.0, (30.0, 75.0)),
    ];
    rules.into_iter().try_for_each(|(name, value, to, base, (lo, hi))| {
        let share = value / base;
        // Not a number is out of range as well.
        if share >= lo && share <= hi { Ok(()) } else { Err(misfit(name, value, to, base, (lo, hi))) }
    })
}

fn misfit(name: &'static str, value: f64, to: &str, base: f64, (lo, hi): (f64, f64)) -> StageError {
    let (amount, range) = match name {
        "arm_angle" => (format!("{value} degrees"), format!("{lo} to {hi} degrees")),
        _ => (cm(value), format!("{} to {}", cm(lo * base), cm(hi * base))),
    };
    let what = name.replace('_', " ");
    let beside = if to.is_empty() { String::new() } else { format!(" beside {to} of {}", cm(base)) };
    StageError::new(
        ErrorCode::InvalidParameter,
        format!("nobody has {} {what} of {amount}{beside}", article(name)),
    )
    .hint(format!(
        "{} {what} of {range} would fit{}",
        article(name),
        if to.is_empty() { "" } else { "; check the units as well" }
    ))
    .at(name)
}

fn article(name: &str) -> &'static str {
    if name.starts_with(['a', 'i']) { "an" } else { "a" }
}

fn cm(metres: f64) -> String {
    format!("{} cm", (metres * 1e3).round() / 10.0)
}
