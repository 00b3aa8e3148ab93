//! The checks of a garment.

use crate::laid::{ByPiece, Laid};
use crate::limits::CheckLimits;
use crate::rest::{RestFigures, rest};
use crate::seams::Gaps;
use crate::strain::{PanelStrain, Strain, strain};
use crate::subject::{Subject, WearerBody, finished};
use crate::{crossings, lay, mesh, seams};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{BodyContact, Collider, ColliderCard, Garment, GirthFigures, Point3};
use toile_core::prelude::Context;
use toile_drape::collide::{BvhScheme, Distances};
use toile_drape::measure::girth::girths;
use toile_geometry::volume::Aabb;

/// Distance at which cloth lies on the body, as `BvhCollider` has it by default, metres.
const THICKNESS: f64 = 1.5e-3;

/// What came of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// The value is within its limit.
    #[serde(rename = "holds")]
    Holds,
    /// It is not.
    #[serde(rename = "fails")]
    Fails,
    /// There is nothing to judge it by.
    #[serde(rename = "not judged")]
    NotJudged,
}

/// One figure against its limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureCheck {
    /// Its name, such as `self_crossings`.
    pub name: &'static str,
    /// What came of it.
    pub verdict: Verdict,
    /// The value; none where it is not judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Its unit; `1` for a share.
    pub unit: &'static str,
    /// The greatest value that holds.
    pub limit: f64,
    /// Where the value is, or why it is not judged; empty where nothing is to be said.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub words: String,
}

/// What is found of a garment.
#[derive(Debug, Clone, Default)]
pub struct Judgement {
    /// The checks.
    pub checks: Vec<FigureCheck>,
    /// Strain by panel; empty where the flat shape is not known.
    pub panels: BTreeMap<String, PanelStrain>,
    /// Gaps by seam.
    pub gaps: Gaps,
    /// Girths of cloth and body by level.
    pub girths: BTreeMap<String, GirthFigures>,
    /// Why there are no girths.
    pub no_girths: Option<String>,
    /// What it does when it is let go; none where that is not judged.
    pub rest: Option<RestFigures>,
    /// Vertices of the garment, each panel counted for itself.
    pub vertices: usize,
    /// Triangles of the garment.
    pub triangles: usize,
}

impl Judgement {
    /// Whether no check fails.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.checks.iter().all(|c| c.verdict != Verdict::Fails)
    }

    /// The check of that name.
    #[must_use]
    pub fn check(&self, name: &str) -> Option<&FigureCheck> {
        self.checks.iter().find(|c| c.name == name)
    }

    fn judge(&mut self, name: &'static str, value: f64, unit: &'static str, limit: f64, words: String) {
        // NaN does not hold.
        let verdict = if value <= limit { Verdict::Holds } else { Verdict::Fails };
        self.checks.push(FigureCheck { name, verdict, value: Some(value), unit, limit, words });
    }

    fn skip(&mut self, names: &[(&'static str, &'static str, f64)], why: &str) {
        for &(name, unit, limit) in names {
            let verdict = Verdict::NotJudged;
            self.checks.push(FigureCheck { name, verdict, value: None, unit, limit, words: why.to_owned() });
        }
    }
}

/// Judges a garment.
#[must_use]
pub fn judge(subject: &Subject, limits: &CheckLimits) -> Judgement {
    let mut garment = subject.garment.clone();
    let mut found = Judgement {
        vertices: garment.positions.len(),
        triangles: garment.triangles.len(),
        ..Judgement::default()
    };
    found.judge("files", subject.faults.len() as f64, "faults", 0.0, subject.faults.join("; "));
    let laid = on_pattern(subject, &garment, limits, &mut found);
    if garment.seams.is_empty()
        && let (Some(laid), Some(pattern)) = (&laid, &subject.pattern)
    {
        garment.seams = seams::pairs(&garment, pattern, &by_piece(laid));
        garment = finished(garment);
    }
    triangles(&garment, subject.flat.is_ok(), &mut found);
    let pairs = crossings::with_itself(&garment);
    let place = |p: &[u32; 2]| format!("the first at {}", between(&garment, p[0], p[1]));
    let words = pairs.first().map(place).unwrap_or_default();
    found.judge("self_crossings", pairs.len() as f64, "pairs", 0.0, words);
    let collider = on_body(subject, &garment, limits, &mut found);
    gaps(subject, &garment, laid.as_deref(), limits, &mut found);
    strains(subject, &garment, collider.as_ref(), limits, &mut found);
    ease(subject, &garment, &mut found);
    at_rest(subject, &garment, limits, &mut found);
    found
}

fn by_piece(laid: &[Option<Laid>]) -> ByPiece<'_> {
    laid.iter().enumerate().filter_map(|(k, l)| l.as_ref().map(|l| (l.piece, (k, l)))).collect()
}

/// Lays the panels on the pattern, and judges how far they are it.
fn on_pattern(
    subject: &Subject,
    garment: &Garment,
    limits: &CheckLimits,
    found: &mut Judgement,
) -> Option<Vec<Option<Laid>>> {
    let none = [
        ("panels_off_pattern", "panels", 0.0),
        ("outline_deviation", "m", limits.outline),
        ("holes", "holes", 0.0),
    ];
    let Some(pattern) = &subject.pattern else {
        found.skip(&none, "no pattern was given: name one with `--pattern`");
        return None;
    };
    if let Err(why) = &subject.flat {
        found.skip(&none, why);
        return None;
    }
    let laid = lay::lay(garment, pattern, limits);
    if laid.iter().all(Option::is_none) {
        let why = "no panel has the shape of a piece of the pattern: the texture is not the flat shape, or the pattern is another garment's";
        found.judge("panels_off_pattern", laid.len() as f64, "panels", 0.0, why.to_owned());
        found.skip(&none[1..], why);
        return None;
    }
    let strange = garment.panels.iter().zip(&laid).filter(|(_, l)| l.is_none()).map(|(p, _)| p.name.as_str());
    let pieces = by_piece(&laid);
    let bare = (0..pattern.pieces.len()).filter(|k| !pieces.contains_key(k));
    let bare = bare.map(|k| pattern.pieces[k].name.as_str());
    let mut words: Vec<String> =
        strange.map(|n| format!("panel \"{n}\" is no piece of the pattern")).collect();
    words.extend(bare.map(|n| format!("piece \"{n}\" is no panel of the garment")));
    found.judge("panels_off_pattern", words.len() as f64, "panels", 0.0, words.join("; "));
    let named = || garment.panels.iter().zip(&laid).filter_map(|(p, l)| Some((p.name.as_str(), l.as_ref()?)));
    let worst = named().reduce(|a, b| if b.1.deviation > a.1.deviation { b } else { a });
    if let Some((name, l)) = worst {
        let words = format!("panel \"{name}\" on piece \"{}\"", pattern.pieces[l.piece].name);
        found.judge("outline_deviation", l.deviation, "m", limits.outline, words);
    }
    let holed: Vec<&str> = named().filter(|(_, l)| l.holes > 0).map(|(n, _)| n).collect();
    let count: usize = named().map(|(_, l)| l.holes).sum();
    found.judge("holes", count as f64, "holes", 0.0, list("in panel", &holed));
    Some(laid)
}

fn triangles(garment: &Garment, flat_known: bool, found: &mut Judgement) {
    let faults = mesh::faults(garment, flat_known);
    let lists = [
        ("degenerate_triangles", &faults.degenerate),
        ("doubled_triangles", &faults.doubled),
        ("turned_triangles", &faults.turned),
        ("missing_triangles", &faults.pinholes),
    ];
    for (name, list) in lists {
        let words = list.first().map(|t| format!("the first at {}", at(garment, *t))).unwrap_or_default();
        found.judge(name, list.len() as f64, "triangles", 0.0, words);
    }
}

/// Judges cloth against the body; gives the collider where the body has an inside.
fn on_body(
    subject: &Subject,
    garment: &Garment,
    limits: &CheckLimits,
    found: &mut Judgement,
) -> Option<Collider> {
    let none = [("body_crossings", "pairs", 0.0), ("body_depth", "m", limits.depth)];
    let wearer = match &subject.body {
        Ok(wearer) => wearer,
        Err(why) => {
            found.skip(&none, why);
            return None;
        }
    };
    let pairs = crossings::with_body(garment, &wearer.body);
    let words = pairs.first().map(|p| format!("the first at {}", at(garment, p[0]))).unwrap_or_default();
    found.judge("body_crossings", pairs.len() as f64, "pairs", 0.0, words);
    match collider(wearer) {
        Err(why) => {
            found.skip(&none[1..], &why);
            None
        }
        Ok(collider) => {
            let mut contacts: Vec<BodyContact> = Vec::new();
            collider.scheme.body_contacts(&garment.positions, 0.0, &mut contacts);
            let deepest = contacts.iter().reduce(|a, b| if b.distance < a.distance { b } else { a });
            let words = deepest.map(|c| vertex_words(garment, c.vertex)).unwrap_or_default();
            let depth = deepest.map_or(0.0, |c| (-c.distance).max(0.0));
            found.judge("body_depth", depth, "m", limits.depth, words);
            Some(collider)
        }
    }
}

fn collider(wearer: &WearerBody) -> Result<Collider, String> {
    wearer.closed.clone()?;
    toile_drape::collide::check_body(&wearer.body).map_err(|e| e.message)?;
    let card = ColliderCard {
        thickness: THICKNESS,
        friction: 0.0,
        restitution: 0.0,
        self_collision: false,
        penalty: None,
    };
    let scheme = BvhScheme::<Aabb>::new(card, Some(&wearer.body), Distances::Asked, &Context::quiet());
    let scheme = scheme.map_err(|e| e.message)?;
    Ok(Collider { scheme: Arc::new(scheme), signature: String::new() })
}

fn gaps(
    subject: &Subject,
    garment: &Garment,
    laid: Option<&[Option<Laid>]>,
    limits: &CheckLimits,
    found: &mut Judgement,
) {
    let none = [("seam_gap", "m", limits.gap)];
    found.gaps = match (laid, &subject.pattern, &subject.seams) {
        (Some(laid), Some(pattern), known) if known.is_err() || !pattern.seams.is_empty() => {
            seams::by_pattern(garment, pattern, &by_piece(laid))
        }
        (_, _, Ok(())) => seams::by_pairs(garment),
        (_, _, Err(why)) => return found.skip(&none, why),
    };
    let worst = found.gaps.seams.iter().reduce(|a, b| if b.gap_m > a.gap_m { b } else { a }).cloned();
    match worst {
        Some(gap) => {
            let words = format!("seam \"{}\" at {}", gap.name, coordinates(&Point3::from(gap.at)));
            found.judge("seam_gap", gap.gap_m, "m", limits.gap, words);
        }
        None => found.skip(&none, "the garment has no seam that can be measured"),
    }
}

fn strains(
    subject: &Subject,
    garment: &Garment,
    collider: Option<&Collider>,
    limits: &CheckLimits,
    found: &mut Judgement,
) {
    let none = [
        ("area_error", "1", limits.area_error),
        ("outline_error", "1", limits.outline_error),
        ("strain_p99", "1", limits.strain),
        ("tight_p99", "1", limits.tight),
        ("strain_max", "1", limits.strain_max),
    ];
    if let Err(why) = &subject.flat {
        return found.skip(&none, why);
    }
    let Strain { panels, free_p99, tightest, worst } = match strain(garment, collider) {
        Ok(strain) => strain,
        Err(e) => return found.judge("area_error", f64::NAN, "1", limits.area_error, e.message),
    };
    let worst_of = |value: &dyn Fn(&PanelStrain) -> f64| {
        let all = panels.iter().map(|(name, p)| (name.clone(), value(p)));
        // What is no number is the worst.
        let worse = |a: &f64, b: &f64| a.is_nan() || !b.is_nan() && a > b;
        all.reduce(|a, b| if worse(&b.1, &a.1) { b } else { a })
    };
    let words = |name: &str| format!("panel \"{name}\"");
    let area = worst_of(&|p| p.area_error.abs());
    let outline = worst_of(&|p| p.outline_error.abs());
    let most = worst_of(&|p| p.p99);
    if let Some((name, error)) = area {
        found.judge("area_error", error, "1", limits.area_error, words(&name));
    }
    if let Some((name, error)) = outline {
        found.judge("outline_error", error, "1", limits.outline_error, words(&name));
    }
    let strained = most.map(|(name, _)| format!("most in panel \"{name}\"")).unwrap_or_default();
    let unexcused = match collider {
        None if free_p99 > limits.strain => format!("{strained}; no body is known that may stretch it"),
        _ => strained,
    };
    found.judge("strain_p99", free_p99, "1", limits.strain, unexcused);
    let (name, tight) = tightest.unwrap_or_default();
    let tight_words = if tight > 0.0 { words(&name) } else { String::new() };
    found.judge("tight_p99", tight, "1", limits.tight, tight_words);
    if let Some((_, max)) = worst_of(&|p| p.max) {
        let place = worst.map(|t| at(garment, t as u32)).unwrap_or_default();
        found.judge("strain_max", max, "1", limits.strain_max, place);
    }
    found.panels = panels;
}

fn ease(subject: &Subject, garment: &Garment, found: &mut Judgement) {
    let known = subject.flat.as_ref().map_err(String::as_str).and_then(|()| {
        let wearer = subject.body.as_ref().map_err(String::as_str)?;
        wearer.measured.as_ref().map_err(String::as_str)?;
        Ok(&wearer.body)
    });
    match known {
        Ok(body) => found.girths = girths(garment, body),
        Err(why) => found.no_girths = Some(why.to_owned()),
    }
}

fn at_rest(subject: &Subject, garment: &Garment, limits: &CheckLimits, found: &mut Judgement) {
    let none = [("rest_moving", "1", limits.moving), ("rest_shift", "m", limits.shift)];
    let known = subject
        .flat
        .as_ref()
        .map_err(Clone::clone)
        .and_then(|()| subject.cloth.as_ref().map_err(Clone::clone));
    let figures = known.and_then(|cloth| rest(garment, cloth).map_err(|e| e.message));
    match figures {
        Err(why) => found.skip(&none, &why),
        Ok(figures) => {
            found.judge("rest_moving", figures.moving, "1", limits.moving, String::new());
            let words = format!("farthest in {}", vertex_words(garment, figures.worst as u32));
            found.judge("rest_shift", figures.moved_m, "m", limits.shift, words);
            found.rest = Some(figures);
        }
    }
}

/// `panel "front" at (0.1000, 1.2000, 0.0500) m`.
fn at(garment: &Garment, triangle: u32) -> String {
    let t = garment.triangles[triangle as usize].map(|v| garment.positions[v as usize].coords);
    let centre = Point3::from((t[0] + t[1] + t[2]) / 3.0);
    format!("panel \"{}\" at {}", panel_name(garment, triangle as usize), coordinates(&centre))
}

fn between(garment: &Garment, one: u32, other: u32) -> String {
    let [a, b] = [one, other].map(|t| panel_name(garment, t as usize));
    match a == b {
        true => at(garment, one),
        false => format!("{}, with panel \"{b}\"", at(garment, one)),
    }
}

fn panel_name(garment: &Garment, triangle: usize) -> &str {
    garment.panels.iter().find(|p| p.triangles.contains(&triangle)).map_or("", |p| p.name.as_str())
}

fn vertex_words(garment: &Garment, vertex: u32) -> String {
    let panel = garment.panel_of(vertex as usize).map_or("", |p| p.name.as_str());
    format!("panel \"{panel}\" at {}", coordinates(&garment.positions[vertex as usize]))
}

pub(crate) fn coordinates(p: &Point3) -> String {
    format!("({:.4}, {:.4}, {:.4}) m", p.x, p.y, p.z)
}

fn list(what: &str, names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|n| format!("\"{n}\"")).collect();
    if quoted.is_empty() { String::new() } else { format!("{what} {}", quoted.join(", ")) }
}
