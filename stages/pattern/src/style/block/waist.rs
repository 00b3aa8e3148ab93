//! The waist of a skirt: as its outline, gathered to a band, or laid in pleats.
//!
//! A gathered skirt that lies flat shows how long it is, and how wide at waist and hem; how much
//! cloth its gathers hold it does not show. That is stated: `fullness` times the waist. The hem is
//! as wide as the photo shows it, or as the gathered edge, if that is wider. The photo is laid over
//! the skirt as it lies, so that its gathers are drawn apart.

use super::pleat::{Fold, Pleats};
use crate::style::block::template::curve::Curve;
use crate::style::block::template::flat::{Flat, FlatEdge, Run, Side, straight};
use crate::style::block::template::form::Form;
use crate::style::block::template::piece_role::{Layer, PieceRole};
use toile_core::prelude::*;

/// How a skirt is held at the waist.
#[choice]
#[derive(Copy)]
pub enum Waist {
    /// As the outline shows it.
    Plain,
    /// Gathered evenly to a band.
    Gathered {
        /// How many times as long as the band the skirt's upper edge is: 1 to 4.
        fullness: f64,
        /// Height of the band: 5 mm to 20 cm.
        band: Length,
    },
    /// Laid in pleats, that are sewn down from the waist.
    Pleated {
        /// Pleats in front, and as many behind: 1 to 24.
        count: u32,
        /// What each takes up: a knife pleat lies half as deep, each side of a box pleat a quarter.
        cloth: Length,
        /// How they are laid.
        fold: Fold,
        /// How far down they are sewn: 1 cm at least.
        stitched: Length,
    },
}

impl Waist {
    /// Its pleats.
    pub(super) fn pleats(self) -> Option<Pleats> {
        let Waist::Pleated { count, cloth, fold, stitched } = self else { return None };
        Some(Pleats { count, cloth: cloth.metres(), fold, stitched: stitched.metres() })
    }

    /// How its pleats are laid.
    pub(super) fn fold(self) -> PleatFold {
        self.pleats().map_or(PleatFold::Knife, |p| p.fold.into())
    }

    /// Refuses what cannot be cut from a garment so long, and as wide at the waist.
    pub(super) fn check(self, form: &Form, length: f64, width: f64) -> Result<(), StageError> {
        if self == Waist::Plain {
            return Ok(());
        }
        let wrong = |text: String, hint: &str| Err(StageError::invalid(text).hint(hint).at("waist"));
        if !form.ends_at(EdgeRole::Waist) || form.has_legs() {
            let word = if let Waist::Pleated { .. } = self { "pleated" } else { "gathered" };
            return wrong(
                format!("only a skirt is {word} at the waist, and this is {}", form.word),
                "take `waist` out, or say `style: Block(style: Skirt)` where it is a skirt",
            );
        }
        match self {
            Waist::Gathered { fullness, .. } if !(1.0..=4.0).contains(&fullness) => {
                wrong(format!("a fullness of {fullness} is not between 1 and 4"), "1.5 is usual, 2 is full")
            }
            Waist::Gathered { band, .. } => {
                let most = (0.5 * length).min(0.2);
                match (0.005..=most).contains(&band.metres()) {
                    true => Ok(()),
                    false => wrong(
                        format!("a band of {band} is not between 5 mm and {}", Length::m(most)),
                        "3 cm is usual",
                    ),
                }
            }
            Waist::Pleated { count, .. } if !(1..=24).contains(&count) => {
                wrong(format!("{count} pleats are not between 1 and 24"), "count those that the photo shows")
            }
            Waist::Pleated { count, cloth, .. }
                if !(0.01..=2.0 * width / f64::from(count)).contains(&cloth.metres()) =>
            {
                let most = Length::m(2.0 * width / f64::from(count));
                wrong(
                    format!(
                        "a pleat of {cloth} is not between 1 cm and {most}, twice the space between two of {count} pleats"
                    ),
                    "say less `cloth`, or a smaller `count`",
                )
            }
            Waist::Pleated { stitched, .. } if !(0.01..=0.8 * length).contains(&stitched.metres()) => {
                let most = Length::m(0.8 * length);
                wrong(
                    format!("pleats cannot be sewn down for {stitched}; 1 cm to {most} can be"),
                    "12 cm is usual",
                )
            }
            _ => Ok(()),
        }
    }
}

/// The skirt and the band of a layer, as they are cut or as they lie in the photo.
pub(super) fn gathered(sides: &[Side; 2], layer: Layer, fullness: f64, band: f64, is_cut: bool) -> Vec<Flat> {
    let halves = [0, 1].map(|k| SkirtHalf::of(&sides[k], fullness, band, is_cut));
    let both = |of: fn(&SkirtHalf) -> Curve| [0, 1].map(|k: usize| sides[k].laid(of(&halves[k])));
    let side = |k: usize| sides[k].own(&[(EdgeRole::Side, halves[k].side.clone())]);
    let end = |k: usize| sides[k].own(&[(EdgeRole::End, Run::Cubic(halves[k].end))]);
    let ([right, left], [right_hem, left_hem]) = (both(|h| h.top), both(|h| h.hem));
    let skirt = side(0)
        .into_iter()
        .chain([FlatEdge::only(EdgeRole::Waist, Run::Chain(vec![right, left]))])
        .chain(side(1))
        .chain([FlatEdge::only(EdgeRole::Hem, Run::Chain(vec![left_hem, right_hem]))]);
    let ([right, left], [right_low, left_low]) = (both(|h| h.upper), both(|h| h.lower));
    let upper = Run::Chain(vec![right, left]);
    let lower = Run::Chain(vec![left_low, right_low]);
    let strip = end(0)
        .into_iter()
        .chain([FlatEdge::only(EdgeRole::Waist, upper)])
        .chain(end(1))
        .chain([FlatEdge::only(EdgeRole::Joint, lower)]);
    let band = Flat::of_trunk(PieceRole::Band(layer), strip.collect());
    vec![Flat::of_trunk(PieceRole::Whole(layer), skirt.collect()), band]
}

/// One half of the skirt, upwards, and of its band.
struct SkirtHalf {
    /// From the middle to the side.
    hem: Curve,
    side: Run,
    /// From the side to the middle.
    top: Curve,
    /// The band's lower edge, from the middle to its end; its end; its upper edge back to the
    /// middle.
    lower: Curve,
    end: Curve,
    upper: Curve,
}

impl SkirtHalf {
    fn of(side: &Side, fullness: f64, band: f64, is_cut: bool) -> SkirtHalf {
        let edges: Vec<Curve> = side.edges.iter().map(|e| e.1).collect();
        let (hem, waist) = (edges[0], edges[edges.len() - 1]);
        let (corner, middle) = (waist.0[0], waist.0[3]);
        let down = |p: Point2| Point2::new(p.x, p.y - band);
        if is_cut {
            let top = down(Point2::new(fullness * corner.x, corner.y));
            let wider = (top.x / hem.0[3].x.max(1e-6)).max(1.0);
            let hem = hem.moved(|p| Point2::new(wider * p.x, p.y));
            let half = polyline_length(&waist.points(24));
            let [low, high] = [middle.y - band, middle.y].map(|y| Point2::new(half, y));
            return SkirtHalf {
                hem,
                side: Run::Cubic(straight(hem.0[3], top)),
                top: straight(top, down(middle)),
                lower: straight(down(middle), low),
                end: straight(low, high),
                upper: straight(high, middle),
            };
        }
        let (below, top) = cut_at(&edges[1..edges.len() - 1], corner.y - band);
        SkirtHalf {
            hem,
            side: Run::of(below),
            top: straight(top, down(middle)),
            lower: straight(down(middle), top),
            end: straight(top, corner),
            upper: waist,
        }
    }
}

/// Curves that rise one from the other, up to a height, and their place there.
fn cut_at(rising: &[Curve], height: f64) -> (Vec<Curve>, Point2) {
    let mut below = Vec::new();
    for curve in rising {
        let at = (0..=200)
            .map(|k| f64::from(k) / 200.0)
            .find(|t| curve.at(*t).y >= height && curve.0[3].y >= height);
        match at {
            Some(t) if t > 0.0 => {
                let [before, _] = curve.parted(t);
                below.push(before);
                return (below, before.0[3]);
            }
            Some(_) => break,
            None => below.push(*curve),
        }
    }
    let end = below.last().map_or_else(Point2::origin, |c| c.0[3]);
    (below, end)
}
