//! `Outline`: the outline of each photo itself is the panel.
//!
//! Method: a template of the garment, as [`Block`] fits it, is laid over each outline. Its corners
//! name those of the outline: of the points near a corner of the template, the one that lies
//! farthest out in the direction in which that corner points. So it does not matter which corners
//! the edge detector found. Cost: a fit of each template, some hundredths of a second. Limits: as
//! those of the templates; nothing is straightened, and sleeves stay part of front and back.

mod threads;

use super::block::template::complete::mark;
use super::block::template::fit::Fit;
use super::block::template::form::{Form, LONG, TEE, VEST};
use super::block::{Block, BlockStyle, Fitted, LAY, Layer, Stand, check_wearable, no_front};
use super::sewing::{pairs, sew};
use nalgebra::Rotation2;
use toile_core::artifact::Outline as Shape;
use toile_core::param::ron_options;
use toile_core::prelude::*;
use toile_core::{Node, StageMeta};

/// Tilts above which the user is told, and warned, degrees: the grain is then off by as much.
const TILT: [f64; 2] = [4.0, 8.0];
/// A corner lies within this share of the garment's size of the template's (3 cm of a vest), and
/// within this share of the shorter edge that it ends.
const REACH: f64 = 0.06;
const OF_EDGE: f64 = 0.4;
/// The shoulder of a garment without sleeves reaches no farther from the axis than so many times
/// the armpit.
const BEYOND: f64 = 1.2;

/// What the garment is.
#[choice]
#[derive(Copy, Eq)]
pub enum OutlineStyle {
    /// Found by the outlines.
    Auto,
    /// No sleeves: vest, tank, strap top.
    Vest,
    /// Sleeves that are part of front and back.
    TShirt,
}

/// A template, with the style that it belongs to and how that is written.
struct Template {
    style: OutlineStyle,
    block: BlockStyle,
    name: &'static str,
    form: &'static Form,
}

const TEMPLATES: [Template; 3] = [
    Template { style: OutlineStyle::Vest, block: BlockStyle::Vest, name: "Vest", form: &VEST },
    Template { style: OutlineStyle::TShirt, block: BlockStyle::TShirt, name: "TShirt", form: &TEE },
    Template { style: OutlineStyle::TShirt, block: BlockStyle::LongSleeve, name: "TShirt", form: &LONG },
];

impl Template {
    /// The edges between hem and neck, from below, each with the number of the form's edge that it
    /// begins with. The top of a sleeve goes on as the shoulder.
    fn half(&self) -> impl DoubleEndedIterator<Item = (EdgeRole, usize)> {
        let edges = self.form.edges;
        let named = |k: usize| match (edges[k].role, edges[k - 1].role) {
            (EdgeRole::Shoulder, EdgeRole::Top) => None,
            (EdgeRole::Top, _) => Some((EdgeRole::Shoulder, k)),
            (role, _) => Some((role, k)),
        };
        (1..edges.len() - 1).filter_map(named)
    }

    /// The names of all edges of a panel.
    fn edges(&self) -> Vec<String> {
        let both = self.half().flat_map(|(role, _)| Hand::BOTH.map(|hand| role.name(Some(hand))));
        both.chain([EdgeRole::Neck, EdgeRole::Hem].map(|role| role.name(None))).collect()
    }

    /// The edges at which front and back are sewn, from the shoulders down.
    fn sewn(&self) -> Vec<String> {
        let is_sewn = |role| matches!(role, EdgeRole::Shoulder | EdgeRole::Underarm | EdgeRole::Side);
        let sewn = self.half().rev().filter(|(role, _)| is_sewn(*role));
        sewn.flat_map(|(role, _)| Hand::BOTH.map(|hand| role.name(Some(hand)))).collect()
    }
}

/// Takes the outline of each photo itself for the panel, names its edges and sews them.
///
/// Nothing is fitted or straightened: panels are cut as the photos show them, sleeves with them.
/// Edges, counter-clockwise on each panel: `side`, of a vest `armhole`, of a T-shirt `underarm`
/// (armpit to cuff) and `cuff`, then `shoulder` (of a T-shirt along the top of the sleeve), each
/// with `_left` or `_right` (the wearer's), `neck` and `hem`. Panels: `front` and `back`. Sleeves
/// are not turned onto the arms: spread the arms as they lie (`arm_angle` of the mannequin).
#[stage(
    role = Style,
    source = "outlines as panels: 3D garment modelling based on image-based rendering, about 2012; templates: Aldrich 2008",
    example = "Outline(style: Vest)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Outline {
    /// What the garment is. `Auto` takes the style that names the edges of every outline, and that
    /// lies nearer where both do.
    #[param(default = OutlineStyle::Auto)]
    style: OutlineStyle,
}

#[stage]
impl Outline {
    pub(crate) fn run(
        &self,
        outlines: Set<Shape>,
        body: &Body,
        #[original] photos: Option<Set<Photo>>,
        cx: &Context,
    ) -> Result<(Pattern, Set<Shape>, SewingPlan), StageError> {
        let (template, laid) = self.best(&outlines, cx)?;
        for l in &laid {
            let photo = photos.as_ref().and_then(|all| all.get(l.panel));
            photo.map_or(Ok(()), |photo| whole(l, &outlines, photo))?;
        }
        if self.style == OutlineStyle::Auto {
            cx.note(format!(
                "the outlines are taken for {}; to say what they are: --set 'style.style={}'",
                template.form.word, template.name
            ));
        }
        let seams: Vec<String> = template.sewn();
        let seams = pairs(&outlines, &seams.iter().map(String::as_str).collect::<Vec<_>>(), cx);
        for l in &laid {
            tell_tilt(l, cx);
            check_wearable(template.name, template.form, &l.fitted.lying, body, None)?;
        }
        let named = laid.iter().map(|l| (l.panel.to_owned(), l.named.clone())).collect();
        let (outlines, plan) = sew(&named, seams, cx)?;
        let mut pattern = Pattern::of_outlines("outlines", outlines.iter(), &plan.seams);
        for (piece, laid) in pattern.pieces.iter_mut().zip(&laid) {
            piece.body_part = Some(BodyPart::Body);
            piece.pose = Some(pose(laid, body)?);
        }
        threads::in_the_way(&outlines, &pattern, &plan.seams, body)
            .into_iter()
            .for_each(|what| cx.warn(what));
        Ok((pattern, outlines, plan))
    }
}

/// Refuses an outline that the frame cuts: it would be cut as it ends there.
fn whole(l: &Laid<'_>, outlines: &Set<Shape>, photo: &Photo) -> Result<(), StageError> {
    let Some(outline) = outlines.get(l.panel) else { return Ok(()) };
    let mut upright = l.fitted.upright.clone();
    let is_cut = mark(&mut upright, outline, photo.pixels.dimensions(), l.panel).is_err();
    match is_cut || upright.unseen.contains(&true) {
        false => Ok(()),
        true => Err(StageError::invalid(format!(
            "the frame cuts \"{}\", and its outline would be cut as it ends there",
            l.panel
        ))
        .hint("photograph the garment with ground on all four sides; or let one half complete the other: --set 'style=Block()'")),
    }
}

/// An outline with its template, and its edges named by it.
struct Laid<'a> {
    panel: &'a str,
    fitted: Fitted,
    named: Shape,
}

impl Outline {
    fn templates(&self) -> impl Iterator<Item = &'static Template> {
        let style = self.style;
        TEMPLATES.iter().filter(move |t| style == OutlineStyle::Auto || t.style == style)
    }

    /// The template that lies nearest to all outlines together.
    fn best<'a>(
        &self,
        outlines: &'a Set<Shape>,
        cx: &Context,
    ) -> Result<(&'static Template, Vec<Laid<'a>>), StageError> {
        if outlines.iter().next().is_none() {
            return Err(no_front());
        }
        let (mut found, mut refused): (Vec<(&'static Template, Vec<Laid<'a>>)>, _) = (Vec::new(), Vec::new());
        for template in self.templates() {
            let all = outlines.iter().map(|(panel, outline)| laid(template, panel, outline, cx)).collect();
            match all {
                Ok(all) => found.push((template, all)),
                Err(e) => refused.push(e),
            }
        }
        let score = |all: &[Laid<'_>]| all.iter().map(|l| l.fitted.lying.score).sum::<f64>();
        let best = found.into_iter().min_by(|a, b| score(&a.1).total_cmp(&score(&b.1)));
        best.ok_or_else(|| match (self.style, refused.into_iter().next()) {
            (OutlineStyle::Vest | OutlineStyle::TShirt, Some(e)) => {
                e.hint(format!("{LAY}; or let it be named: --set 'style.style=Auto'"))
            }
            _ => StageError::invalid("the outlines are neither those of a vest nor those of a T-shirt").hint(
                format!("{LAY}; other garments are cut by a template: --set 'style=Block(style: Auto)'"),
            ),
        })
    }
}

/// The edges that a style gives every panel, where its parameters tell.
pub(super) fn edges_of(style: &Node) -> Option<Vec<String>> {
    let outline = (style.card.name == Outline::NAME).then(|| style.stage.params())?;
    let outline: Outline = ron_options().from_str(&outline).ok()?;
    (outline.style != OutlineStyle::Auto).then(|| outline.templates().next().map(Template::edges))?
}

/// A template laid over an outline, whose edges it names.
fn laid<'a>(
    template: &Template,
    panel: &'a str,
    outline: &Shape,
    cx: &Context,
) -> Result<Laid<'a>, StageError> {
    let block = Block::as_it_lies(template.block);
    let found = block.best(panel, outline, None, vec![(template.name, template.form)], cx)?;
    block.explains(panel, &found, cx)?;
    let (.., fitted) = found;
    let refuse = |reason: &str| {
        StageError::invalid(format!("\"{panel}\" does not look like {}: {reason}", template.form.word))
    };
    if has_sleeves(template, &fitted.lying) {
        return Err(refuse("its shoulders reach far beyond its armpits, as sleeves do"));
    }
    let named = named(template, panel, outline, &fitted);
    let named = named.ok_or_else(|| refuse("its corners are not in their usual order"))?;
    Ok(Laid { panel, fitted, named })
}

/// Whether what was taken for an armhole ends a sleeve.
fn has_sleeves(template: &Template, lying: &Fit) -> bool {
    let armhole = template.form.at(EdgeRole::Armhole);
    armhole.is_some_and(|k| lying.sides.iter().any(|s| s[k].b.x > BEYOND * s[k].a.x))
}

/// The outline with its edges; `None` where their corners do not follow each other.
fn named(template: &Template, panel: &str, outline: &Shape, fitted: &Fitted) -> Option<Shape> {
    let layer = Layer::of_name(panel);
    let [plus, minus] = [0, 1].map(|k| layer.hand(k));
    let corner = |k: usize, side: usize| corner(outline, fitted, k, side);
    let neck = template.form.edges.len() - 1;
    let half: Vec<(EdgeRole, usize)> = template.half().collect();
    // Upwards an edge starts at its lower corner, downwards at its upper one.
    let mut starts: Vec<(String, usize)> =
        half.iter().map(|(role, k)| (role.name(Some(plus)), corner(*k, 0))).collect();
    starts.push((EdgeRole::Neck.name(None), corner(neck, 0)));
    let upper = half.iter().skip(1).map(|(_, k)| *k).chain([neck]);
    let down: Vec<_> =
        half.iter().zip(upper).map(|((role, _), k)| (role.name(Some(minus)), corner(k, 1))).collect();
    starts.extend(down.into_iter().rev());
    starts.push((EdgeRole::Hem.name(None), corner(half[0].1, 1)));
    let (n, first) = (outline.outer.points.len(), starts[0].1);
    let way = |i: usize| (i + n - first) % n;
    if !starts.windows(2).all(|w| way(w[0].1) < way(w[1].1)) {
        return None;
    }
    let ends: Vec<usize> = starts.iter().skip(1).map(|s| s.1).chain([first]).collect();
    let mut named = outline.clone();
    named.edges = starts
        .into_iter()
        .zip(ends)
        .map(|((name, start), end)| Edge { name, start, end, gauge: Gauge::default() })
        .collect();
    named.outer.corners.extend(named.edges.iter().map(|e| e.start));
    named.outer.corners.sort_unstable();
    named.outer.corners.dedup();
    Some(named)
}

/// The point of the outline at the corner where the form's edge `k` starts on a side.
fn corner(outline: &Shape, Fitted { upright, lying, .. }: &Fitted, k: usize, side: usize) -> usize {
    let (before, after) = (&lying.sides[side][k - 1], &lying.sides[side][k]);
    let place = |p: Point2| upright.given(lying.laid(p, side));
    let unit = |v: Vector2| v.try_normalize(1e-9).unwrap_or_default();
    let at = place(after.a);
    let out = place(after.a + unit(before.direction(1.0)) - unit(after.direction(0.0))) - at;
    let reach = (REACH * upright.size).min(OF_EDGE * before.length().min(after.length()));
    let points = &outline.outer.points;
    let far = |i: usize| (points[i] - at).norm();
    let near = (0..points.len()).filter(|i| far(*i) <= reach);
    let farthest = near.max_by(|a, b| (points[*a] - at).dot(&out).total_cmp(&(points[*b] - at).dot(&out)));
    let nearest = || (0..points.len()).min_by(|a, b| far(*a).total_cmp(&far(*b)));
    farthest.or_else(nearest).unwrap_or_default()
}

fn tell_tilt(laid: &Laid<'_>, cx: &Context) {
    let Fitted { upright, lying, .. } = &laid.fitted;
    let tilt = (upright.tilt + lying.turn.to_degrees()).abs();
    let text = format!(
        "\"{}\" lies {tilt:.0} degrees askew in its photo; it is sewn as it lies, so its grain is off by as much",
        laid.panel
    );
    match tilt {
        _ if tilt > TILT[1] => cx.warn(text),
        _ if tilt > TILT[0] => cx.note(text),
        _ => {}
    }
}

/// Upright before the body or behind it, its neck points at the body's neck.
fn pose(laid: &Laid<'_>, body: &Body) -> Result<Pose, StageError> {
    let Fitted { upright, lying, .. } = &laid.fitted;
    let Fit { sides, turn, shift, .. } = lying;
    let top = 0.5 * sides.iter().filter_map(|s| s.last()).map(|neck| neck.a.y).sum::<f64>();
    let stand = Stand::of(body, &Hand::Left.name("neck"), top)?;
    let turn = upright.tilt.to_radians() + turn;
    let origin = Rotation2::new(-turn) * -upright.centre - Vector2::new(*shift, 0.0);
    Ok(stand.pose(origin, -turn, Layer::of_name(laid.panel)))
}
