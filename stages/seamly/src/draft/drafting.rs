//! The objects of a draft under construction, and what tools ask of it.

use super::super::fault::{SeamlyFault, ToolPlace};
use super::super::plane::{DraftCurve, DraftStroke};
use super::super::source::{attribute, number, place, short};
use super::object::{CurveFamily, DraftObject, DrawnCurve};
use super::values::{Asked, DraftValues, Failed};
use kurbo::Point;
use roxmltree::Node;
use std::collections::{BTreeMap, BTreeSet};

/// Strokes of curves that all tools and pieces together are made of: a small file can ask for any
/// number of them.
const MOST_STROKES: usize = 100_000;

/// A tool of the file.
pub(crate) struct DraftTool<'a, 't> {
    pub(crate) node: Node<'a, 't>,
    pub(crate) place: ToolPlace,
}

impl<'a, 't> DraftTool<'a, 't> {
    pub(crate) fn new(node: Node<'a, 't>, block: &str) -> Self {
        DraftTool { node, place: place(node, block) }
    }

    /// What kind of tool it is.
    pub(crate) fn kind(&self) -> &'a str {
        attribute(self.node, "type").unwrap_or("")
    }

    /// The name that it gives to its point, or to one of its two curves.
    pub(crate) fn name(&self, attribute_name: &str) -> String {
        attribute(self.node, attribute_name).unwrap_or("").to_owned()
    }

    /// Its own number.
    pub(crate) fn id(&self) -> Option<u32> {
        number(self.node, "id")
    }
}

/// The draft as far as it is drawn.
#[derive(Debug, Default)]
pub(crate) struct Drafting {
    pub(crate) objects: BTreeMap<u32, DraftObject>,
    pub(crate) values: DraftValues,
    /// All numbers of objects that tools of the file have.
    pub(crate) ids: BTreeSet<u32>,
    /// What is told of the draft.
    pub(crate) warnings: Vec<String>,
    /// Pairs of boxes that have been looked at to find where curves cross.
    pub(crate) boxes: usize,
    /// Strokes of curves that tools and pieces have asked for.
    strokes: usize,
    /// The fault of the first that asked for too many.
    spent: Option<Failed>,
}

impl Drafting {
    /// A draft with nothing drawn.
    pub(crate) fn of(values: DraftValues) -> Self {
        Drafting { values, ..Drafting::default() }
    }

    pub(crate) fn fail(&mut self, fault: SeamlyFault) -> Failed {
        self.values.fail(fault)
    }

    /// A construction that has no result.
    pub(crate) fn impossible(&mut self, tool: &DraftTool<'_, '_>, what: &'static str) -> Failed {
        self.fail(SeamlyFault::Impossible { place: tool.place.clone(), what })
    }

    pub(crate) fn unsupported(&mut self, tool: &DraftTool<'_, '_>) -> Failed {
        self.fail(SeamlyFault::Unsupported { place: tool.place.clone() })
    }

    pub(crate) fn lacking(&mut self, tool: &DraftTool<'_, '_>, attribute: &str) -> Failed {
        self.fail(SeamlyFault::Lacking { place: tool.place.clone(), attribute: attribute.to_owned() })
    }

    /// A number that is no formula.
    pub(crate) fn figure(
        &mut self,
        tool: &DraftTool<'_, '_>,
        name: &str,
        otherwise: f64,
    ) -> Result<f64, Failed> {
        let Some(text) = attribute(tool.node, name) else { return Ok(otherwise) };
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let (place, attribute) = (tool.place.clone(), name.to_owned());
                Err(self.fail(SeamlyFault::Number { place, attribute, value: short(text) }))
            }
        }
    }

    /// The value of an attribute's formula.
    pub(crate) fn formula(&mut self, tool: &DraftTool<'_, '_>, name: &str) -> Result<f64, Failed> {
        match attribute(tool.node, name) {
            Some(formula) => self.values.value(Asked { place: &tool.place, attribute: name, formula }),
            None => Err(self.lacking(tool, name)),
        }
    }

    /// The same, or a value where the attribute is not there.
    pub(crate) fn formula_or(
        &mut self,
        tool: &DraftTool<'_, '_>,
        name: &str,
        otherwise: f64,
    ) -> Result<f64, Failed> {
        match attribute(tool.node, name) {
            Some(_) => self.formula(tool, name),
            None => Ok(otherwise),
        }
    }

    /// The object that an attribute names.
    pub(crate) fn object(
        &mut self,
        tool: &DraftTool<'_, '_>,
        name: &str,
    ) -> Result<(u32, DraftObject), Failed> {
        match number(tool.node, name) {
            Some(id) => self.object_of(&tool.place, name, id).map(|o| (id, o)),
            None => Err(self.lacking(tool, name)),
        }
    }

    /// The object of a number.
    pub(crate) fn object_of(
        &mut self,
        place: &ToolPlace,
        name: &str,
        id: u32,
    ) -> Result<DraftObject, Failed> {
        match self.objects.get(&id) {
            Some(DraftObject::Failed(why)) => Err(*why),
            Some(object) => {
                let object = object.clone();
                self.count(&object)?;
                Ok(object)
            }
            None => {
                let (place, attribute, later) = (place.clone(), name.to_owned(), self.ids.contains(&id));
                Err(self.fail(SeamlyFault::Reference { place, attribute, id, later }))
            }
        }
    }

    /// Counts the strokes of an object that is asked for.
    fn count(&mut self, object: &DraftObject) -> Result<(), Failed> {
        if let DraftObject::Curve(drawn) = object {
            self.strokes += drawn.curve.strokes.len();
        }
        if self.strokes <= MOST_STROKES {
            return Ok(());
        }
        let why = match self.spent {
            Some(why) => why,
            None => {
                self.fail(SeamlyFault::Many { what: "curves in its tools and pieces", most: MOST_STROKES })
            }
        };
        self.spent = Some(why);
        Err(why)
    }

    fn wrong_kind(&mut self, place: &ToolPlace, name: &str, id: u32, expected: &'static str) -> Failed {
        let (place, attribute) = (place.clone(), name.to_owned());
        self.fail(SeamlyFault::Kind { place, attribute, id, expected })
    }

    /// The point that an attribute names.
    pub(crate) fn point(&mut self, tool: &DraftTool<'_, '_>, name: &str) -> Result<Point, Failed> {
        self.named_point(tool, name).map(|(_, at)| at)
    }

    /// The point that an attribute names, with its own name.
    pub(crate) fn named_point(
        &mut self,
        tool: &DraftTool<'_, '_>,
        name: &str,
    ) -> Result<(String, Point), Failed> {
        match self.object(tool, name)? {
            (_, DraftObject::Point { name, at }) => Ok((name, at)),
            (id, _) => Err(self.wrong_kind(&tool.place, name, id, "point")),
        }
    }

    /// The point of a number.
    pub(crate) fn point_of(
        &mut self,
        place: &ToolPlace,
        name: &str,
        id: u32,
    ) -> Result<(String, Point), Failed> {
        match self.object_of(place, name, id)? {
            DraftObject::Point { name, at } => Ok((name, at)),
            _ => Err(self.wrong_kind(place, name, id, "point")),
        }
    }

    /// The curve that an attribute names.
    pub(crate) fn curve(&mut self, tool: &DraftTool<'_, '_>, name: &str) -> Result<DrawnCurve, Failed> {
        match self.object(tool, name)? {
            (_, DraftObject::Curve(curve)) => Ok(curve),
            (id, _) => Err(self.wrong_kind(&tool.place, name, id, "curve")),
        }
    }

    /// The curve of a number.
    pub(crate) fn curve_of(&mut self, place: &ToolPlace, name: &str, id: u32) -> Result<DrawnCurve, Failed> {
        match self.object_of(place, name, id)? {
            DraftObject::Curve(curve) => Ok(curve),
            _ => Err(self.wrong_kind(place, name, id, "curve")),
        }
    }

    /// The point of a tool.
    pub(crate) fn put_point(&mut self, id: Option<u32>, name: String, at: Point) {
        self.values.set_point(&name, at);
        if let Some(id) = id {
            self.objects.insert(id, DraftObject::Point { name, at });
        }
    }

    /// A curve under its own name, and under others that the file gives it.
    pub(crate) fn put_curve(&mut self, id: u32, mut drawn: DrawnCurve, others: &[String], more: &str) {
        let own = match drawn.family {
            CurveFamily::Spline | CurveFamily::Path => {
                let label = |l: Option<&String>| l.cloned().unwrap_or_default();
                format!("{}_{}{more}", label(drawn.curve.labels.first()), label(drawn.curve.labels.last()))
            }
            CurveFamily::Arc | CurveFamily::Ellipse => format!("{}_{id}{more}", drawn.centre),
        };
        for name in std::iter::once(&own).chain(others.iter().filter(|n| !n.is_empty())) {
            self.name_curve(&drawn, name);
        }
        if drawn.name.is_empty() {
            drawn.name = own;
        }
        self.objects.insert(id, DraftObject::Curve(drawn));
    }

    /// The lengths and angles of a curve for formulas.
    fn name_curve(&mut self, drawn: &DrawnCurve, name: &str) {
        let full = format!("{}{name}", drawn.family.prefix());
        let curve = &drawn.curve;
        let ends = match (drawn.angles, curve.strokes.first()) {
            (Some(angles), _) => angles,
            (None, Some(DraftStroke::Arc(arc))) => [arc.start, arc.start + arc.sweep],
            (None, _) => [curve.start_angle(), curve.end_angle()],
        };
        let [start, end] = ends.map(|a| a.rem_euclid(360.0));
        self.values.set(full.clone(), curve.length());
        self.values.set(format!("Angle1{full}"), start);
        self.values.set(format!("Angle2{full}"), end);
        match (drawn.family, curve.strokes.first()) {
            (CurveFamily::Arc, Some(DraftStroke::Arc(arc))) => {
                self.values.set(format!("Radius{full}"), arc.radius);
            }
            (CurveFamily::Spline | CurveFamily::Path, _) => self.name_handles(drawn, &full),
            _ => {}
        }
    }

    /// The lengths of the control lines at the ends.
    fn name_handles(&mut self, drawn: &DrawnCurve, full: &str) {
        let strokes = &drawn.curve.strokes;
        if let (Some(first), Some(last)) = (strokes.first(), strokes.last()) {
            self.values.set(format!("C1Length{full}"), handles(first)[0]);
            self.values.set(format!("C2Length{full}"), handles(last)[1]);
        }
    }

    /// The lengths and angles of the parts of a path.
    pub(crate) fn name_parts(&mut self, drawn: &DrawnCurve, more: &str) {
        let label = |l: Option<&String>| l.cloned().unwrap_or_default();
        let labels = &drawn.curve.labels;
        let full = format!("SplPath_{}_{}{more}", label(labels.first()), label(labels.last()));
        for (k, stroke) in drawn.curve.strokes.iter().enumerate() {
            let part = format!("{full}_Seg_{}", k + 1);
            let one = DraftCurve::single(*stroke, "", "");
            self.values.set(part.clone(), one.length());
            self.values.set(format!("Angle1{part}"), one.start_angle());
            self.values.set(format!("Angle2{part}"), one.end_angle());
            self.values.set(format!("C1Length{part}"), handles(stroke)[0]);
            self.values.set(format!("C2Length{part}"), handles(stroke)[1]);
        }
    }
}

/// The lengths of the control lines of a stroke.
fn handles(stroke: &DraftStroke) -> [f64; 2] {
    match stroke {
        DraftStroke::Cubic(c) => [(c.p1 - c.p0).hypot(), (c.p2 - c.p3).hypot()],
        DraftStroke::Arc(_) => [0.0, 0.0],
    }
}
