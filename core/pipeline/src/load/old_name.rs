//! Old names where a file is loaded: the fault of each, and the name that stands in its place now.

use crate::load::fault::Fault;
use toile_core::{Change, Registry};

/// What a user does about an old name.
const REPAIR: &str = "`toile migrate` rewrites the file to the new names";

/// The fault of an old stage name, and the new name.
pub(in crate::load) fn old_stage(registry: &Registry, name: &str) -> Option<(Fault, &'static str)> {
    let to = renamed(registry, name)?;
    let fault = Fault::new("old_name", format!("the stage `{name}` is now called `{to}`"));
    Some((fault.hint(REPAIR.to_owned()), to))
}

/// The fault of a parameter's old name.
pub(in crate::load) fn old_param(registry: &Registry, stage: &str, param: &str) -> Option<Fault> {
    let migration = registry.migrations().iter().find(|m| m.of_param(stage, param))?;
    let message = match migration.change {
        Change::Stage { .. } => return None,
        Change::Param { to, .. } => format!("the parameter `{param}` is now called `{to}`"),
        Change::Removed { why, .. } => format!("the parameter `{param}` was removed: {why}"),
    };
    Some(Fault::new("old_name", message).hint(REPAIR.to_owned()))
}

/// The name that a stage has now; none where it never changed, or where it is a stage's name again.
pub(super) fn renamed(registry: &Registry, name: &str) -> Option<&'static str> {
    let step = |name: &str| {
        registry.migrations().iter().find_map(|m| match m.change {
            Change::Stage { to } if m.stage == name && registry.card(name).is_none() => Some(to),
            _ => None,
        })
    };
    let mut to = step(name)?;
    // Each change is taken once at most, so that a circle ends.
    for _ in registry.migrations() {
        to = step(to).unwrap_or(to);
    }
    Some(to)
}
