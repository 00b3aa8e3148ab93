//! A piece of the pattern: its outline, and what is drawn on it.

use super::super::draft::{DraftObject, DraftTool, Drafting, Failed};
use super::super::fault::{SeamlyFault, ToolPlace};
use super::super::plane::direction;
use super::super::source::{attribute, children, line, number, says, short};
use super::allowance::{self, NodeAllowance};
use super::loops::without_loops;
use super::model::Modeling;
use super::path::{DraftedPath, Nearness, OutlinePart, PathNode, joined};
use kurbo::{Point, Vec2};
use roxmltree::Node;

/// Points lie on a curve that are this near to it, metres.
const ON: f64 = 2e-4;
/// Ends meet that are this near to each other, metres.
const SAME: f64 = 1e-5;

/// Longer loops that are left out are told, millimetres.
const TOLD: f64 = 0.2;

/// At which line a piece is mirrored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PieceFold {
    /// At none.
    None,
    /// It is cut on the fold; which of its edges lies there is not said.
    Unsaid,
    /// At the line through two points.
    Line([Point; 2]),
}

/// A path within a piece.
#[derive(Debug, Clone, PartialEq)]
pub struct InnerPath {
    /// Its name, which may be empty.
    pub name: String,
    /// Whether the cloth is cut along it.
    pub cut: bool,
    /// How it runs.
    pub path: DraftedPath,
}

/// A piece, y up, in the unit of the pattern.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftedPiece {
    /// Its name, which may be empty or that of another piece, too.
    pub name: String,
    /// Where it stands in the file.
    pub place: ToolPlace,
    /// The line along which it is sewn, closed.
    pub outline: DraftedPath,
    /// Paths within it.
    pub inner: Vec<InnerPath>,
    /// Where notches stand.
    pub notches: Vec<Point>,
    /// The direction of the grain, where it is drawn.
    pub grain: Option<Vec2>,
    /// At which line it is mirrored.
    pub fold: PieceFold,
    /// How often it is cut.
    pub quantity: u32,
    /// Whether every second one may be turned over.
    pub turns: bool,
    /// The width of its seam allowance, where it has one.
    pub allowance: Option<f64>,
    /// Other widths of it, at nodes.
    pub node_allowances: Vec<NodeAllowance>,
    /// Whether the outline is the line along which it is cut, the seam allowance within it.
    pub built_in: bool,
}

/// What a piece is called.
pub(super) fn name(node: Node<'_, '_>) -> String {
    short(attribute(node, "name").unwrap_or(""))
}

fn place(node: Node<'_, '_>, block: &str) -> ToolPlace {
    ToolPlace { block: block.to_owned(), tool: format!("piece \"{}\"", name(node)), line: line(node) }
}

/// The piece of an element.
pub(super) fn piece(
    node: Node<'_, '_>,
    block: &str,
    model: &Modeling<'_, '_>,
    draft: &mut Drafting,
    metres: f64,
) -> Result<DraftedPiece, Failed> {
    let place = place(node, block);
    let mut reader = PieceReader { model, draft, place: &place, metres };
    let nodes: Vec<Node<'_, '_>> = path_nodes(node);
    let outline = reader.path(&nodes, true)?;
    let Some(outline) = outline.filter(|o| o.parts.len() >= 2) else {
        let what = "its nodes draw no closed line";
        return Err(draft.fail(SeamlyFault::Piece { place, what }));
    };
    let notches = reader.notches(&nodes)?;
    let inner = reader.inner(node)?;
    let grain = reader.grain(node)?;
    let (quantity, on_fold) = quantity(node);
    let fold = match reader.mirror_line(node)? {
        Some(line) => PieceFold::Line(line),
        None if on_fold => PieceFold::Unsaid,
        None => PieceFold::None,
    };
    let allowance = allowance::of_piece(node, &place, reader.draft);
    let node_allowances = match allowance {
        Some(own) => reader.node_allowances(&nodes, own)?,
        None => Vec::new(),
    };
    Ok(DraftedPiece {
        name: name(node),
        outline,
        inner,
        notches,
        grain,
        fold,
        quantity,
        turns: says(node, "forbidFlipping") != Some(true),
        allowance,
        node_allowances,
        built_in: says(node, "seamAllowanceBuiltIn") == Some(true),
        place,
    })
}

/// The nodes of a piece or of a path that are not left out; older pieces have them without a list.
pub(super) fn path_nodes<'a, 't: 'a>(of: Node<'a, 't>) -> Vec<Node<'a, 't>> {
    let listed = children(of, &["nodes"]).flat_map(|n| children(n, &["node"]));
    listed.chain(children(of, &["node"])).filter(|n| says(*n, "excluded") != Some(true)).collect()
}

/// Why objects that a piece names are not drawn, each once.
pub(super) fn causes(node: Node<'_, '_>, model: &Modeling<'_, '_>, draft: &Drafting) -> Vec<usize> {
    let ids = path_nodes(node).into_iter().filter_map(|n| number(n, "idObject"));
    let objects = ids.filter_map(|id| draft.objects.get(&model.object(id)));
    let failed = objects.filter_map(|o| match o {
        DraftObject::Failed(Failed(why)) => Some(*why),
        DraftObject::Point { .. } | DraftObject::Curve(_) => None,
    });
    failed.collect()
}

/// How often a piece is cut, and whether on the fold.
fn quantity(node: Node<'_, '_>) -> (u32, bool) {
    let Some(data) = children(node, &["data"]).next() else { return (1, false) };
    // Older files list it for each material.
    let listed = children(data, &["mcp"]).next();
    let count = number(data, "quantity").or_else(|| number(listed?, "cutNumber"));
    let on_fold = says(data, "onFold").or_else(|| Some(number(listed?, "placement")? == 1));
    (count.unwrap_or(1).max(1), on_fold.unwrap_or(false))
}

/// What is asked of the draft for one piece.
struct PieceReader<'d, 'a, 't> {
    model: &'d Modeling<'a, 't>,
    draft: &'d mut Drafting,
    place: &'d ToolPlace,
    metres: f64,
}

impl PieceReader<'_, '_, '_> {
    /// The object of the draft that a number of the piece stands for.
    fn object(&mut self, id: u32) -> Result<u32, Failed> {
        let object = self.model.object(id);
        if [id, object].iter().any(|n| self.model.united.contains(n)) {
            let place =
                ToolPlace { tool: format!("{} (unionDetails)", self.place.tool), ..self.place.clone() };
            return Err(self.draft.fail(SeamlyFault::Unsupported { place }));
        }
        Ok(object)
    }

    fn point(&mut self, id: u32) -> Result<(String, Point), Failed> {
        let object = self.object(id)?;
        self.draft.point_of(self.place, "idObject", object)
    }

    fn node(&mut self, node: Node<'_, '_>) -> Result<PathNode, Failed> {
        let Some(id) = number(node, "idObject") else {
            let (place, attribute) = (self.place.clone(), "idObject".to_owned());
            return Err(self.draft.fail(SeamlyFault::Lacking { place, attribute }));
        };
        match attribute(node, "type") {
            Some("NodePoint") => self.point(id).map(|(name, at)| PathNode::Point { name, at }),
            Some("NodeArc" | "NodeElArc" | "NodeSpline" | "NodeSplinePath") => {
                let object = self.object(id)?;
                let curve = self.draft.curve_of(self.place, "idObject", object)?.curve;
                let reverse = says(node, "reverse") == Some(true);
                Ok(PathNode::Curve(if reverse { curve.reversed() } else { curve }))
            }
            other => {
                let tool = format!("{} ({})", self.place.tool, short(other.unwrap_or("node")));
                let place = ToolPlace { tool, ..self.place.clone() };
                Err(self.draft.fail(SeamlyFault::Unsupported { place }))
            }
        }
    }

    /// Nodes as a path, its points named by those of the draft that lie there.
    fn path(&mut self, nodes: &[Node<'_, '_>], closed: bool) -> Result<Option<DraftedPath>, Failed> {
        let nodes = nodes.iter().map(|n| self.node(*n)).collect::<Result<Vec<_>, Failed>>()?;
        let near = Nearness { on: ON / self.metres, same: SAME / self.metres };
        let mut path = joined(&nodes, closed, near, &mut self.draft.boxes);
        if let Some(path) = path.as_mut().filter(|_| closed) {
            let taken = without_loops(path, near, &mut self.draft.boxes);
            let most = taken.iter().fold(0.0, |a: f64, b| a.max(*b)) * self.metres * 1e3;
            if most > TOLD {
                self.draft.warnings.push(format!(
                    "{}: its outline crosses itself: {} loops of up to {most:.1} mm are left out",
                    self.place,
                    taken.len()
                ));
            }
        }
        if let Some(DraftedPath { start, parts }) = &mut path {
            let mut from = *start;
            for OutlinePart { from: name, end, .. } in parts {
                if name.is_empty()
                    && let Some(known) = self.draft.values.point_at(from, near.on)
                {
                    known.clone_into(name);
                }
                from = *end;
            }
        }
        Ok(path)
    }

    fn notches(&mut self, nodes: &[Node<'_, '_>]) -> Result<Vec<Point>, Failed> {
        let marked = |n: &&Node<'_, '_>| {
            let is = says(**n, "notch").or_else(|| says(**n, "passmark")) == Some(true);
            is && says(**n, "showNotch") != Some(false) && attribute(**n, "type") == Some("NodePoint")
        };
        let ids: Vec<u32> = nodes.iter().filter(marked).filter_map(|n| number(*n, "idObject")).collect();
        ids.into_iter().map(|id| self.point(id).map(|(_, at)| at)).collect()
    }

    /// The paths within a piece that have a length.
    fn inner(&mut self, node: Node<'_, '_>) -> Result<Vec<InnerPath>, Failed> {
        let records = children(node, &["iPaths"]).flat_map(|n| children(n, &["record"]));
        let ids: Vec<u32> = records.filter_map(|n| number(n, "path")).collect();
        let mut out = Vec::new();
        for id in ids {
            let Some(node) = self.model.paths.get(&id).copied() else {
                let (place, attribute) = (self.place.clone(), "path".to_owned());
                return Err(self.draft.fail(SeamlyFault::Reference { place, attribute, id, later: false }));
            };
            if let Some(path) = self.path(&path_nodes(node), false)? {
                out.push(InnerPath { name: name(node), cut: says(node, "cut") == Some(true), path });
            }
        }
        Ok(out)
    }

    /// The direction of the grain: from one pin to the other, else by its angle.
    fn grain(&mut self, node: Node<'_, '_>) -> Result<Option<Vec2>, Failed> {
        let Some(grain) = children(node, &["grainline"]).next() else { return Ok(None) };
        let is_drawn = says(grain, "enabled").or_else(|| says(grain, "visible"));
        if is_drawn != Some(true) {
            return Ok(None);
        }
        let pin = |names: [&str; 2]| names.iter().find_map(|n| number(grain, n)).filter(|id| *id > 0);
        let pins = (pin(["bottomPin", "bottomAnchor"]), pin(["topPin", "topAnchor"]));
        if let (Some(bottom), Some(top)) = pins {
            let way = self.point(top)?.1 - self.point(bottom)?.1;
            if way.hypot() > SAME / self.metres {
                return Ok(Some(way));
            }
        }
        let tool = DraftTool { node: grain, place: self.place.clone() };
        self.draft.formula_or(&tool, "rotation", 90.0).map(|degrees| Some(direction(degrees)))
    }

    fn mirror_line(&mut self, node: Node<'_, '_>) -> Result<Option<[Point; 2]>, Failed> {
        let Some(line) = children(node, &["mirrorLine"]).next() else { return Ok(None) };
        let (Some(a), Some(b)) = (number(line, "p1"), number(line, "p2")) else { return Ok(None) };
        if a == 0 || b == 0 {
            return Ok(None);
        }
        Ok(Some([self.point(a)?.1, self.point(b)?.1]))
    }

    /// The widths of seam allowances at nodes that have others than that of the piece.
    fn node_allowances(&mut self, nodes: &[Node<'_, '_>], own: f64) -> Result<Vec<NodeAllowance>, Failed> {
        let mut out = Vec::new();
        for node in nodes.iter().filter(|n| attribute(**n, "type") == Some("NodePoint")) {
            if attribute(*node, "before").is_none() && attribute(*node, "after").is_none() {
                continue;
            }
            let Some(id) = number(*node, "idObject") else { continue };
            let (_, at) = self.point(id)?;
            out.extend(allowance::of_node(*node, at, own, self.place, self.draft));
        }
        Ok(out)
    }
}
