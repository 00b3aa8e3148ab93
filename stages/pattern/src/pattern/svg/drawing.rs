//! What is drawn in a file: lines with their roles, groups and texts, in metres, y up.
//!
//! Method: the tree is walked with its transforms; `use` is followed. What is hidden, defined but
//! not used, or drawn by pixels is left out. Cost: linear in what is drawn. Limits: 100,000
//! elements after clones are followed, groups 100 deep; of style sheets only rules of a single
//! class or id that hide.

use super::damage::SvgDamage;
use super::path::{Line, ellipse, path, polyline, rectangle};
use super::role::{Role, is_generated, of_group, role};
use super::source::{place, short};
use super::units::pixels;
use kurbo::Affine;
use roxmltree::Node;
use std::collections::{BTreeMap, BTreeSet};
use svgtypes::{Length, PointsParser, Transform, ViewBox};
use toile_core::prelude::*;

const MOST_ELEMENTS: usize = 100_000;
const MOST_DEPTH: usize = 100;
/// A line leads to a dimension's arrow that ends as near as this, metres.
const LEADER: f64 = 5e-4;
/// Greater coordinates are no garment's, metres.
const FAR: f64 = 1e4;

/// A group of elements.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    pub name: Option<Name>,
    pub parent: Option<usize>,
    /// Whether it is a layer, which may hold many pieces.
    pub layer: bool,
    /// The piece that it is by FreeSewing's ids.
    pub part: Option<String>,
    /// Whether it only says what its lines are for.
    pub role: bool,
}

/// What an element is called.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Name {
    pub text: String,
    /// Whether a program made it up.
    pub generated: bool,
}

/// An element with its lines.
#[derive(Debug, Clone)]
pub(super) struct DrawnShape<'t> {
    pub node: Node<'t, 't>,
    pub name: Option<Name>,
    pub role: Option<Role>,
    pub group: usize,
    pub lines: Vec<Line>,
}

/// A text, where it begins.
#[derive(Debug, Clone)]
pub(super) struct Words {
    pub text: String,
    pub group: usize,
    pub at: Point2,
}

/// All that is drawn.
#[derive(Default)]
pub(super) struct Drawing<'t> {
    /// The first one is the whole file.
    pub groups: Vec<Group>,
    pub shapes: Vec<DrawnShape<'t>>,
    pub texts: Vec<Words>,
    /// Pictures of pixels.
    pub pictures: usize,
    /// Arrows of dimensions, and the lines that lead to them.
    pub dimensions: usize,
}

/// What holds where the walk is.
#[derive(Clone)]
struct State {
    to: Affine,
    group: usize,
    role: Option<Role>,
    depth: usize,
}

struct Walk<'t> {
    drawing: Drawing<'t>,
    ids: BTreeMap<&'t str, Node<'t, 't>>,
    /// Classes and ids that a style sheet hides, with `.` or `#` before them.
    hidden: BTreeSet<String>,
    /// Groups that are left out, by where they begin in the file.
    others: BTreeSet<usize>,
    visited: usize,
}

/// What is drawn below the root, without the groups that begin at the bytes `others`; `unit` is the
/// length of the file's unit in metres.
pub(super) fn drawing<'t>(
    root: Node<'t, 't>,
    unit: f64,
    others: &BTreeSet<usize>,
) -> Result<Drawing<'t>, SvgDamage> {
    let ids = root.descendants().filter_map(|n| Some((n.attribute("id")?, n)));
    let styles = root.descendants().filter(|n| n.has_tag_name_local("style"));
    let hidden = styles.flat_map(|n| hidden_by(&inner_text(n))).collect();
    let drawing = Drawing { groups: vec![Group { layer: true, ..Group::default() }], ..Drawing::default() };
    let mut walk = Walk { drawing, ids: ids.collect(), hidden, others: others.clone(), visited: 0 };
    let to = Affine::scale_non_uniform(unit, -unit);
    walk.children(root, &State { to, group: 0, role: None, depth: 0 })?;
    walk.drawing.without_dimensions();
    Ok(walk.drawing)
}

impl Drawing<'_> {
    /// Leaves out the arrows of dimensions, and the marks that lead straight to an end of one in
    /// their group.
    fn without_dimensions(&mut self) {
        let is = |s: &&DrawnShape<'_>| s.role == Some(Role::Dimension);
        let ends = |s: &DrawnShape<'_>| s.lines.iter().flat_map(|l| [l.start, l.end()]).collect::<Vec<_>>();
        let arrows: Vec<(usize, Vec<Point2>)> =
            self.shapes.iter().filter(is).map(|s| (s.group, ends(s))).collect();
        if arrows.is_empty() {
            return;
        }
        let leads = |s: &DrawnShape<'_>| {
            let straight = matches!(&s.lines[..], [l] if matches!(l.parts[..], [(EdgeCurve::Line, _)]));
            let meets = |p: &Point2| {
                arrows
                    .iter()
                    .any(|(group, ends)| *group == s.group && ends.iter().any(|q| (p - q).norm() <= LEADER))
            };
            s.role == Some(Role::Mark) && straight && ends(s).iter().any(meets)
        };
        let before = self.shapes.len();
        self.shapes.retain(|s| s.role != Some(Role::Dimension) && !leads(s));
        self.dimensions = before - self.shapes.len();
    }
}

pub(super) trait Local {
    fn has_tag_name_local(&self, name: &str) -> bool;
}

impl Local for Node<'_, '_> {
    fn has_tag_name_local(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

/// The classes and ids that rules of a style sheet hide.
fn hidden_by(style: &str) -> Vec<String> {
    let rules = style.split('}').filter_map(|rule| rule.split_once('{'));
    let hides = |body: &str| hides(&body.to_lowercase());
    let names = |selectors: &str| {
        let one = |s: &str| s.trim().to_owned();
        let simple =
            |s: &String| s.starts_with(['.', '#']) && !s[1..].contains([' ', '.', '#', '>', ':', '[']);
        selectors.split(',').map(one).filter(simple).collect::<Vec<_>>()
    };
    rules.filter(|(_, body)| hides(body)).flat_map(|(selectors, _)| names(selectors)).collect()
}

/// Whether declarations hide what they hold for.
fn hides(declarations: &str) -> bool {
    declarations.split(';').filter_map(|d| d.split_once(':')).any(|(property, value)| {
        matches!((property.trim(), value.trim()), ("display", "none") | ("visibility", "hidden" | "collapse"))
    })
}

fn inner_text(node: Node<'_, '_>) -> String {
    let pieces: Vec<&str> = node.descendants().filter(Node::is_text).filter_map(|n| n.text()).collect();
    pieces.join(" ")
}

/// The value of an attribute by its name without a prefix.
pub(super) fn local<'t>(node: Node<'t, 't>, name: &str) -> Option<&'t str> {
    node.attributes().find(|a| a.name() == name).map(|a| a.value())
}

/// What an element is called: by its label, the name that Illustrator keeps, its title, its id.
pub(super) fn name(node: Node<'_, '_>) -> Option<Name> {
    let label = node.attributes().find(|a| a.name() == "label" && a.namespace().is_some()).map(|a| a.value());
    let title = || node.children().find(|n| n.has_tag_name_local("title")).map(inner_text);
    let given = label.or_else(|| node.attribute("data-name")).map(str::to_owned).or_else(title);
    let given = given.map(|t| t.trim().to_owned()).filter(|t| !t.is_empty());
    let id = || node.attribute("id").map(unescaped);
    let generated = given.is_none() && id().is_some_and(|id| is_generated(&id));
    let text = given.or_else(id)?.chars().take(80).collect::<String>().trim().to_owned();
    (!text.is_empty()).then_some(Name { text, generated })
}

/// An id with the characters that Illustrator writes as `_x20_`.
fn unescaped(id: &str) -> String {
    let mut out = String::new();
    let mut rest = id;
    while let Some(k) = rest.find("_x") {
        let code = rest[k + 2..].split_once('_').filter(|(hex, _)| (2..=4).contains(&hex.len()));
        let char =
            code.and_then(|(hex, after)| Some((char::from_u32(u32::from_str_radix(hex, 16).ok()?)?, after)));
        out.push_str(&rest[..k]);
        match char {
            Some((c, after)) => {
                out.push(c);
                rest = after;
            }
            None => {
                out.push_str("_x");
                rest = &rest[k + 2..];
            }
        }
    }
    out + rest
}

/// All that may say what an element is for.
fn names<'t>(node: Node<'t, 't>) -> Vec<&'t str> {
    let told = ["class", "id", "data-name", "data-text", "marker-start", "marker-end", "href"];
    let title = node.children().find(|n| n.has_tag_name_local("title")).and_then(|n| n.text());
    let label = node.attributes().find(|a| a.name() == "label" && a.namespace().is_some()).map(|a| a.value());
    told.iter().filter_map(|name| local(node, name)).chain(title).chain(label).collect()
}

impl<'t> Walk<'t> {
    fn children(&mut self, node: Node<'t, 't>, state: &State) -> Result<(), SvgDamage> {
        node.children().filter(Node::is_element).try_for_each(|child| self.element(child, state))
    }

    fn is_hidden(&self, node: Node<'_, '_>) -> bool {
        let style = node.attribute("style").is_some_and(|s| hides(&s.to_lowercase()));
        let attribute = node.attribute("display") == Some("none")
            || matches!(node.attribute("visibility"), Some("hidden" | "collapse"));
        let classes = node.attribute("class").unwrap_or("");
        let by_class = classes.split_whitespace().any(|c| self.hidden.contains(&format!(".{c}")));
        let by_id = node.attribute("id").is_some_and(|id| self.hidden.contains(&format!("#{id}")));
        style || attribute || by_class || by_id
    }

    fn element(&mut self, node: Node<'t, 't>, state: &State) -> Result<(), SvgDamage> {
        self.visited += 1;
        if self.visited > MOST_ELEMENTS {
            return Err(SvgDamage::Many { what: "elements", most: MOST_ELEMENTS });
        }
        if state.depth > MOST_DEPTH {
            return Err(SvgDamage::Many { what: "groups within each other", most: MOST_DEPTH });
        }
        if self.is_hidden(node) || self.others.contains(&node.range().start) {
            return Ok(());
        }
        let own = match node.attribute("transform") {
            Some(value) => transform(node, value)?,
            None => Affine::IDENTITY,
        };
        let inner = State { to: state.to * own, depth: state.depth + 1, ..state.clone() };
        match node.tag_name().name() {
            "g" | "a" | "switch" => self.group(node, &inner),
            "svg" => self.group(node, &State { to: inner.to * nested(node)?, ..inner }),
            "use" => self.cloned(node, &inner),
            "image" => {
                self.drawing.pictures += 1;
                Ok(())
            }
            "text" => {
                let number =
                    |name: &str| node.attribute(name).and_then(|v| v.split([' ', ',']).next()?.parse().ok());
                let at = inner.to * kurbo::Point::new(number("x").unwrap_or(0.0), number("y").unwrap_or(0.0));
                let at = Point2::new(at.x, at.y);
                self.drawing.texts.push(Words { text: inner_text(node), group: inner.group, at });
                Ok(())
            }
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" => {
                self.shape(node, &inner)
            }
            _ => Ok(()),
        }
    }

    fn group(&mut self, node: Node<'t, 't>, state: &State) -> Result<(), SvgDamage> {
        let id = node.attribute("id").unwrap_or("");
        let part =
            id.strip_prefix("fs-stack-").and_then(|rest| rest.split_once("-part-")).map(|(_, part)| {
                let bare = part.rsplit_once('.').map_or(part, |(_, bare)| bare);
                bare.to_owned()
            });
        let freesewing = id.starts_with("fs-");
        let own = if freesewing { None } else { of_group(names(node)) };
        if matches!(own, Some(Role::Nothing | Role::Dimension)) {
            return Ok(());
        }
        self.drawing.groups.push(Group {
            name: name(node),
            parent: Some(state.group),
            layer: local(node, "groupmode") == Some("layer") || node.tag_name().name() != "g",
            part,
            role: own.is_some(),
        });
        let group = self.drawing.groups.len() - 1;
        self.children(node, &State { group, role: own.or(state.role), ..state.clone() })
    }

    /// What a `use` shows: the element that it names, moved.
    fn cloned(&mut self, node: Node<'t, 't>, state: &State) -> Result<(), SvgDamage> {
        let target =
            local(node, "href").and_then(|h| h.trim().strip_prefix('#')).and_then(|id| self.ids.get(id));
        let Some(&target) = target else { return Ok(()) };
        if node.ancestors().any(|a| a == target) || state.depth >= MOST_DEPTH {
            return Err(SvgDamage::Loop { place: place(node) });
        }
        let [x, y] = [length(node, "x", 0.0)?, length(node, "y", 0.0)?];
        let to = state.to * Affine::translate((x.unwrap_or(0.0), y.unwrap_or(0.0)));
        let own = role(names(node));
        let inner = State { to, role: own.or(state.role), ..state.clone() };
        match own {
            Some(Role::Nothing) => Ok(()),
            // A mark stands where it is put, whatever it looks like.
            Some(Role::Notch | Role::Drill) => {
                let dot = Line { start: Point2::origin(), parts: Vec::new(), closed: false };
                self.push(node, own, &inner, vec![dot]);
                Ok(())
            }
            _ if target.has_tag_name_local("symbol") => self.children(target, &inner),
            _ => self.element(target, &inner),
        }
    }

    fn shape(&mut self, node: Node<'t, 't>, state: &State) -> Result<(), SvgDamage> {
        let own = role(names(node)).or(state.role);
        if own == Some(Role::Nothing) {
            return Ok(());
        }
        if let Some(lines) = lines(node)? {
            self.push(node, own, state, lines);
        }
        Ok(())
    }

    fn push(&mut self, node: Node<'t, 't>, role: Option<Role>, state: &State, lines: Vec<Line>) {
        let to = |p: Point2| {
            let q = state.to * kurbo::Point::new(p.x, p.y);
            Point2::new(q.x, q.y)
        };
        let moved = |l: &Line| Line {
            start: to(l.start),
            parts: l.parts.iter().map(|(curve, end)| (curve.moved(to, false), to(*end))).collect(),
            closed: l.closed,
        };
        let lines: Vec<Line> = lines.iter().map(moved).collect();
        let near = |p: &Point2| p.coords.amax() <= FAR;
        // Farther than ten kilometres is a damaged transform: nothing of a garment.
        if lines.iter().all(|l| near(&l.start) && l.parts.iter().all(|(_, end)| near(end))) {
            self.drawing.shapes.push(DrawnShape { node, name: name(node), role, group: state.group, lines });
        }
    }
}

/// A number that an attribute gives as a length in the file's units; `least` bounds it. None where
/// it depends on the page.
fn length(node: Node<'_, '_>, attribute: &'static str, least: f64) -> Result<Option<f64>, SvgDamage> {
    let Some(value) = node.attribute(attribute) else { return Ok(Some(0.0)) };
    let bad = || SvgDamage::Attribute { place: place(node), attribute, value: short(value) };
    let length = value.trim().parse::<Length>().map_err(|_| bad())?;
    let signed = ["x", "y", "cx", "cy", "x1", "y1", "x2", "y2"].contains(&attribute);
    let sound = |n: &f64| n.is_finite() && n.abs() <= 1e9 && (signed || *n >= least);
    match pixels(length) {
        Some(n) => Some(n).filter(sound).ok_or_else(bad).map(Some),
        None => Ok(None),
    }
}

fn transform(node: Node<'_, '_>, value: &str) -> Result<Affine, SvgDamage> {
    let bad = || SvgDamage::Attribute { place: place(node), attribute: "transform", value: short(value) };
    let t = value.parse::<Transform>().map_err(|_| bad())?;
    let all = [t.a, t.b, t.c, t.d, t.e, t.f];
    all.iter().all(|n| n.is_finite() && n.abs() <= 1e9).then(|| Affine::new(all)).ok_or_else(bad)
}

/// Where the inside of a nested `svg` lies.
fn nested(node: Node<'_, '_>) -> Result<Affine, SvgDamage> {
    let number = |name| length(node, name, 0.0).map(|n| n.unwrap_or(0.0));
    let (x, y, w, h) = (number("x")?, number("y")?, number("width")?, number("height")?);
    let view = node.attribute("viewBox").and_then(|v| v.parse::<ViewBox>().ok());
    let Some(v) = view.filter(|v| v.w > 0.0 && v.h > 0.0 && w > 0.0 && h > 0.0) else {
        return Ok(Affine::translate((x, y)));
    };
    let scale = (w / v.w).min(h / v.h);
    let centred = ((w - v.w * scale) / 2.0 + x, (h - v.h * scale) / 2.0 + y);
    Ok(Affine::translate(centred) * Affine::scale(scale) * Affine::translate((-v.x, -v.y)))
}

/// The lines of a shape in its own units; none where it has no size.
fn lines(node: Node<'_, '_>) -> Result<Option<Vec<Line>>, SvgDamage> {
    let bad = |attribute: &'static str| SvgDamage::Attribute {
        place: place(node),
        attribute,
        value: short(node.attribute(attribute).unwrap_or("")),
    };
    let all = |names: &[&'static str]| -> Result<Option<Vec<f64>>, SvgDamage> {
        names.iter().map(|name| length(node, name, 0.0)).collect()
    };
    let (made, attribute) = match node.tag_name().name() {
        "path" => (path(node.attribute("d").unwrap_or("")), "d"),
        "line" => {
            let Some(n) = all(&["x1", "y1", "x2", "y2"])? else { return Ok(None) };
            (polyline(&[Point2::new(n[0], n[1]), Point2::new(n[2], n[3])], false), "x1")
        }
        "rect" => {
            let Some(n) = all(&["x", "y", "width", "height", "rx", "ry"])? else { return Ok(None) };
            if n[2] == 0.0 || n[3] == 0.0 {
                return Ok(None);
            }
            let given = |name: &str| node.attribute(name).is_some_and(|v| v != "auto");
            let radii = [if given("rx") { n[4] } else { n[5] }, if given("ry") { n[5] } else { n[4] }];
            (rectangle(Point2::new(n[0], n[1]), [n[2], n[3]], radii), "width")
        }
        "circle" => {
            let Some(n) = all(&["cx", "cy", "r"])? else { return Ok(None) };
            if n[2] == 0.0 {
                return Ok(None);
            }
            (ellipse(Point2::new(n[0], n[1]), [n[2], n[2]]), "r")
        }
        "ellipse" => {
            let Some(n) = all(&["cx", "cy", "rx", "ry"])? else { return Ok(None) };
            if n[2] == 0.0 || n[3] == 0.0 {
                return Ok(None);
            }
            (ellipse(Point2::new(n[0], n[1]), [n[2], n[3]]), "rx")
        }
        tag => {
            let points: Vec<Point2> = PointsParser::from(node.attribute("points").unwrap_or(""))
                .map(|(x, y)| Point2::new(x, y))
                .collect();
            if points.len() < 2 {
                return Ok(None);
            }
            (polyline(&points, tag == "polygon"), "points")
        }
    };
    made.map(Some).ok_or_else(|| bad(attribute))
}
