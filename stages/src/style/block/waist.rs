//! The waist of a skirt: as its outline, or gathered to a band.
//!
//! A gathered skirt that lies flat shows how long it is, and how wide at waist and hem; how much cloth its gathers hold it does not show. That is
//! stated: `fullness` times the waist. The hem is as wide as the photo shows it, or as the gathered edge, if that is wider. The photo is laid over the
//! skirt as it lies, so that its gathers are drawn apart.

use super::curve::Curve;
use super::form::Form;
use super::pieces::{Flat, Layer, Run, Side};
use toile_core::artifact::BodyPart;
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
}

impl Waist {
    /// Refuses what cannot be cut.
    pub(super) fn check(self, form: &Form, length: f64) -> Result<(), StageError> {
        let Waist::Gathered { fullness, band } = self else { return Ok(()) };
        if form.edges.last().is_none_or(|e| e.name != "waist") || form.has_legs() {
            return Err(StageError::invalid(format!(
                "only a skirt is gathered at the waist, and this is {}",
                form.word
            ))
            .hint("take `waist` out, or say `style: Block(style: Skirt)` where it is a skirt")
            .at("waist"));
        }
        if !(1.0..=4.0).contains(&fullness) {
            return Err(StageError::invalid(format!("a fullness of {fullness} is not between 1 and 4"))
                .hint("1.5 is usual, 2 is full")
                .at("waist"));
        }
        let most = (0.5 * length).min(0.2);
        if !(0.005..=most).contains(&band.metres()) {
            return Err(StageError::invalid(format!(
                "a band of {band} is not between 5 mm and {}",
                Length::m(most)
            ))
            .hint("3 cm is usual")
            .at("waist"));
        }
        Ok(())
    }
}

/// The skirt and the band of a layer, as they are cut or as they lie in the photo.
pub(super) fn gathered(sides: &[Side; 2], layer: Layer, fullness: f64, band: f64, is_cut: bool) -> Vec<Flat> {
    let halves = [0, 1].map(|k| Half::of(&sides[k], fullness, band, is_cut));
    let both = |of: fn(&Half) -> Curve| [0, 1].map(|k: usize| sides[k].laid(of(&halves[k])));
    let side = |k: usize| sides[k].own(&[("side", halves[k].side.clone())]);
    let end = |k: usize| sides[k].own(&[("end", Run::Cubic(halves[k].end))]);
    let ([right, left], [right_hem, left_hem]) = (both(|h| h.top), both(|h| h.hem));
    let skirt = side(0)
        .into_iter()
        .chain([("waist".to_owned(), Run::Chain(vec![right, left]))])
        .chain(side(1))
        .chain([("hem".to_owned(), Run::Chain(vec![left_hem, right_hem]))]);
    let ([right, left], [right_low, left_low]) = (both(|h| h.upper), both(|h| h.lower));
    let upper = Run::Chain(vec![right, left]);
    let lower = Run::Chain(vec![left_low, right_low]);
    let strip = end(0)
        .into_iter()
        .chain([("waist".to_owned(), upper)])
        .chain(end(1))
        .chain([("joint".to_owned(), lower)]);
    let flat = |name: String, edges: Vec<(String, Run)>| Flat {
        name,
        edges,
        part: BodyPart::Body,
        origin: Point2::origin(),
        turn: 0.0,
    };
    let word = layer.word();
    vec![flat(word.to_owned(), skirt.collect()), flat(format!("band_{word}"), strip.collect())]
}

/// One half of the skirt, upwards, and of its band.
struct Half {
    /// From the middle to the side.
    hem: Curve,
    side: Run,
    /// From the side to the middle.
    top: Curve,
    /// The band's lower edge, from the middle to its end; its end; its upper edge back to the middle.
    lower: Curve,
    end: Curve,
    upper: Curve,
}

impl Half {
    fn of(side: &Side, fullness: f64, band: f64, is_cut: bool) -> Half {
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
            return Half {
                hem,
                side: Run::Cubic(straight(hem.0[3], top)),
                top: straight(top, down(middle)),
                lower: straight(down(middle), low),
                end: straight(low, high),
                upper: straight(high, middle),
            };
        }
        let (below, top) = cut_at(&edges[1..edges.len() - 1], corner.y - band);
        Half {
            hem,
            side: Run::of(below),
            top: straight(top, down(middle)),
            lower: straight(down(middle), top),
            end: straight(top, corner),
            upper: waist,
        }
    }
}

fn straight(a: Point2, b: Point2) -> Curve {
    Curve([a, a + (b - a) / 3.0, a + (b - a) * (2.0 / 3.0), b])
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
