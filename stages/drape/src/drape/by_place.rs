//! Rule `by-place`: whether a garment is sewn or goes on from where it is, and what counts as rest,
//! follow from the stages before it.
//!
//! Fact: which stage made the garment that `StaticEquilibrium` takes, past those that only move it
//! or cut its mesh. A placement of a pattern puts its pieces around the body, far apart and with
//! others in between, so cloth passes through cloth while its seams close. Between two panels of an
//! outline nothing lies, and sewn plainly they end in the same folds from a start that is moved by
//! a millimetre. Behind a draper the garment hangs already: it continues from there, with the same
//! settings. A prepared scene lies as its author laid it, and is solved to its last vertex: its
//! result is held against others, and it need not lie in the folds of a figure's skin, where some
//! vertices never come to rest.

use toile_core::Known;
use toile_core::artifact::{ArtifactType, Garment, Kind, Pattern, Phases};
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};
use toile_core::{ByPlace, Feed, Node, Role};

/// 95 % of the surface lie within so many metres of where another way of sewing brings it: friction
/// has many states of rest.
const APART: f64 = 0.04;

/// Rest to the last vertex.
const TO_THE_LAST: [(&str, &str); 3] = [("speed", "0.001"), ("non_static", "0.0"), ("proof", "Short")];

/// What the garment of a stage comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum GarmentOrigin {
    /// A placement of a pattern's pieces.
    Placed(usize),
    /// A draper.
    Draped(usize),
    /// The reader of a prepared scene.
    Scene,
}

/// Whence the garment of stage `index` comes.
fn origin(nodes: &[Node], index: usize) -> Option<GarmentOrigin> {
    let node = nodes.get(index)?;
    let mut ports = node.card.inputs.iter().zip(&node.inputs);
    let (_, feed) = ports.find(|(port, _)| port.kind == Garment::KIND && !port.original)?;
    let Feed::Node { node: before, .. } = *feed else { return None };
    let maker = nodes.get(before)?;
    let takes = |kind: Kind| maker.card.inputs.iter().any(|p| p.kind == kind && !p.original);
    let makes = |kind: Kind| maker.card.outputs.iter().any(|p| p.kind == kind);
    match maker.card.role {
        Role::Reader if makes(Phases::KIND) => Some(GarmentOrigin::Scene),
        Role::Draper => Some(GarmentOrigin::Draped(before)),
        Role::Placement if takes(Garment::KIND) => origin(nodes, before),
        Role::Placement if takes(Pattern::KIND) => Some(GarmentOrigin::Placed(before)),
        _ => None,
    }
}

/// The parameters of a stage that stands there.
pub(super) fn by_place(nodes: &[Node], index: usize) -> ByPlace {
    let set = |name: &'static str| vec![(name, "true".to_owned())];
    let own = nodes.get(index).map(|n| n.card.name);
    match origin(nodes, index) {
        Some(GarmentOrigin::Placed(_)) => ByPlace { like: None, set: set("sew_through") },
        Some(GarmentOrigin::Draped(k)) => {
            let is_alike = nodes.get(k).map(|n| n.card.name) == own;
            let mut set = set("from_here");
            set.push(("sew_through", "false".to_owned()));
            ByPlace { like: Some(k).filter(|_| is_alike), set }
        }
        Some(GarmentOrigin::Scene) => ByPlace {
            like: None,
            set: TO_THE_LAST.iter().map(|&(name, value)| (name, value.to_owned())).collect(),
        },
        None => ByPlace::default(),
    }
}

/// The parameters of a stage that steps in time and stands there.
pub(crate) fn in_time(nodes: &[Node], index: usize) -> ByPlace {
    let sews = matches!(origin(nodes, index), Some(GarmentOrigin::Placed(_)));
    let set = sews.then(|| ("sew_through", "true".to_owned())).into_iter().collect();
    ByPlace { like: None, set }
}

/// The decision of a stage that steps in time.
pub(crate) fn in_time_rule(known: &Known<'_>) -> Vec<Decision> {
    let is_placed = matches!(origin(known.nodes, known.index), Some(GarmentOrigin::Placed(_)));
    rule(known).filter(|_| is_placed).into_iter().collect()
}

/// The decision that follows from the stage's place, unless the file sets the parameter.
pub(super) fn rule(known: &Known<'_>) -> Option<Decision> {
    let is_written = |name: &str| known.node().params.contains_key(name);
    let (from, what, fact, name) = match origin(known.nodes, known.index)? {
        GarmentOrigin::Placed(k) => (
            k,
            "seams close through what lies between them",
            "puts a pattern's pieces around the body",
            "sew_through",
        ),
        GarmentOrigin::Draped(k) => (k, "goes on from where the garment hangs", "has draped it", "from_here"),
        GarmentOrigin::Scene => return None,
    };
    let maker = known.nodes.get(from)?;
    (!is_written(name)).then(|| Decision {
        rule: "by-place".into(),
        state: State::On,
        what: what.into(),
        fact: format!("`{}` {fact}", maker.id),
        tolerance: Tolerance::Distance(APART),
        saves: Saves::Modelled,
        source: "docs/reference/solver.md".into(),
        turn: Turn::Param { name: name.into(), value: "false".into() },
    })
}
