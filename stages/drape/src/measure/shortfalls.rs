//! Limits that a garment misses, in the words of who sews it: what is wrong, how far from good, and
//! what to do.

use std::collections::BTreeMap;
use toile_core::artifact::{GarmentFigures, PanelFigures, Shortfall};
use toile_core::prelude::*;

/// Pieces that are named before the rest is counted.
const NAMED: usize = 3;

/// The limits.
pub(super) struct FigureLimits {
    pub(super) gap: Length,
    pub(super) area_error: f64,
    pub(super) outline_error: f64,
    pub(super) strain: f64,
    pub(super) body_crossings: usize,
}

impl FigureLimits {
    /// The limits that are missed, with the errors of the panels and the strain (99th percentile)
    /// but for what the body stretches.
    pub(super) fn missed(
        &self,
        garment: &Garment,
        g: &GarmentFigures,
        panels: &BTreeMap<String, PanelFigures>,
        strain: f64,
    ) -> Vec<Shortfall> {
        use ErrorCode::{BodyIntersection, FastFinish, SelfIntersection, StaticEquilibrium, StitchingError};
        let inside = g.body_penetration.unwrap_or_default();
        let (through, own) = (g.body_crossings.unwrap_or(0), g.self_crossings.unwrap_or(0));
        let all = [
            (StitchingError, self.open_seam(garment)),
            (StaticEquilibrium, self.area(panels)),
            (StaticEquilibrium, self.outline(panels)),
            (StaticEquilibrium, (strain > self.strain).then(|| self.strained(strain))),
            (BodyIntersection, (inside.vertices > 0).then(|| {
                format!(
                    "the cloth lies in the body at {}, the deepest by {}; make the mesh finer, or take a body that fits better",
                    places(inside.vertices),
                    Length::m(inside.max_m)
                )
            })),
            (BodyIntersection, (through > self.body_crossings).then(|| {
                format!(
                    "the body comes through the cloth at {} (at most {} is good); make the mesh finer, or take a body that fits better",
                    places(through),
                    self.body_crossings
                )
            })),
            (SelfIntersection, (own > 0).then(|| {
                format!("cloth goes through cloth at {}; make the mesh finer, or place the pieces farther apart", places(own))
            })),
            (StaticEquilibrium, (g.steps > 0 && !g.converged).then(|| {
                "the cloth was still moving when the solver stopped; give it more steps, or make the mesh coarser".into()
            })),
            (FastFinish, (g.steps == 0 && g.converged).then(|| {
                "the garment was not draped: the solver called it at rest before its first step; see that the cloth has weight and starts off the body".into()
            })),
        ];
        let told = all.into_iter().filter_map(|(code, message)| Some((code, message?)));
        told.map(|(code, message)| Shortfall { code, message }).collect()
    }

    fn open_seam(&self, garment: &Garment) -> Option<String> {
        let width = |s: &GarmentSeam| {
            let apart =
                |&[a, b]: &[u32; 2]| (garment.positions[a as usize] - garment.positions[b as usize]).norm();
            s.pairs.iter().map(apart).fold(0.0, f64::max)
        };
        let open = garment.seams.iter().map(|s| (s, width(s))).filter(|(_, w)| *w > self.gap.metres());
        let (count, worst) = open.fold((0, None::<(&GarmentSeam, f64)>), |(n, worst), this| {
            (n + 1, Some(worst.filter(|w| w.1 >= this.1).unwrap_or(this)))
        });
        let (seam, width) = worst?;
        let more = match count {
            1 => String::new(),
            n => format!(", as do {} more, less widely", n - 1),
        };
        Some(format!(
            "the seam \"{}\" stands open by {} (at most {} is good){more}; see that both sides are equally long, run the same way and start near \
             each other",
            seam.name,
            Length::m(width),
            self.gap
        ))
    }

    fn area(&self, panels: &BTreeMap<String, PanelFigures>) -> Option<String> {
        let list = beyond(panels, self.area_error, |p| p.area_error)?;
        let limit = percent(self.area_error);
        Some(format!(
            "{list} in area than it was cut (at most {limit} is good): the cloth folds more finely than its mesh, or is drawn out; make the mesh \
             finer, or allow more: `Measure(max_area_error: {})`",
            enough(panels, |p| p.area_error)
        ))
    }

    fn outline(&self, panels: &BTreeMap<String, PanelFigures>) -> Option<String> {
        let list = beyond(panels, self.outline_error, |p| p.outline_error)?;
        let limit = percent(self.outline_error);
        Some(format!(
            "{list} around its outline than it was cut (at most {limit} is good): its edges fold more finely than the mesh, or are drawn out; make \
             the mesh finer, or allow more: `Measure(max_outline_error: {})`",
            enough(panels, |p| p.outline_error)
        ))
    }

    fn strained(&self, strain: f64) -> String {
        format!(
            "the cloth is stretched or pressed together by more than {} in places (at most {} is good); take a cloth that stretches less, or one \
             that weighs less",
            percent(strain),
            percent(self.strain)
        )
    }
}

fn places(n: usize) -> String {
    if n == 1 { "1 place".into() } else { format!("{n} places") }
}

fn percent(share: f64) -> String {
    format!("{:.2} %", share * 1e2)
}

/// `piece "front" is 2.00 % smaller`, with what others miss the limit; none where none does. The
/// worst stands first.
fn beyond(
    panels: &BTreeMap<String, PanelFigures>,
    limit: f64,
    of: fn(&PanelFigures) -> f64,
) -> Option<String> {
    let mut all: Vec<(&String, f64)> =
        panels.iter().map(|(n, p)| (n, of(p))).filter(|p| p.1.abs() > limit).collect();
    all.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let (worst, rest) = all.split_first()?;
    let way = |error: f64| if error > 0.0 { "smaller" } else { "larger" };
    let mut others: Vec<String> = rest
        .iter()
        .take(NAMED - 1)
        .map(|(n, e)| format!("\"{n}\" {} {}", percent(e.abs()), way(*e)))
        .collect();
    if rest.len() >= NAMED {
        others.push(format!("{} more", rest.len() + 1 - NAMED));
    }
    let others = if others.is_empty() { String::new() } else { format!(" ({})", others.join(", ")) };
    Some(format!("piece \"{}\" is {} {}{others}", worst.0, percent(worst.1.abs()), way(worst.1)))
}

/// The limit that all of these keep, in whole per cent.
fn enough(panels: &BTreeMap<String, PanelFigures>, of: fn(&PanelFigures) -> f64) -> f64 {
    let worst = panels.values().map(|p| of(p).abs()).fold(0.0, f64::max);
    (worst * 1e2).ceil() / 1e2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn missed(errors: &[(&str, f64)]) -> Vec<String> {
        let limits = FigureLimits {
            gap: Length::mm(1.0),
            area_error: 0.01,
            outline_error: 0.01,
            strain: 0.05,
            body_crossings: 0,
        };
        let of = |e: f64| PanelFigures { area_error: e, outline_error: 0.0 };
        let panels = errors.iter().map(|(n, e)| ((*n).to_owned(), of(*e))).collect();
        let garment = toile_core::testkit::dress::sewn_garment();
        let figures = GarmentFigures { steps: 1, converged: true, ..GarmentFigures::default() };
        limits.missed(&garment, &figures, &panels, 0.0).into_iter().map(|s| s.message).collect()
    }

    #[test]
    fn pieces_that_miss_a_limit_are_told_in_one_sentence_the_worst_first() {
        assert!(missed(&[("front", 0.01)]).is_empty());
        assert_eq!(
            missed(&[("front", 0.021)]),
            [
                "piece \"front\" is 2.10 % smaller in area than it was cut (at most 1.00 % is good): the cloth folds more finely than its mesh, or is \
                 drawn out; make the mesh finer, or allow more: `Measure(max_area_error: 0.03)`"
            ]
        );
        let many = missed(&[("a", 0.02), ("b", -0.05), ("c", 0.03), ("d", 0.04), ("e", 0.0)]);
        assert!(
            many[0].starts_with("piece \"b\" is 5.00 % larger (\"d\" 4.00 % smaller, \"c\" 3.00 % smaller, 1 more) in area than it was cut"),
            "{many:?}"
        );
    }
}
