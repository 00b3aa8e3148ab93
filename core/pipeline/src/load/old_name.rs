//! Old names where a file is loaded: the fault of each, and the name that stands in its place now.

use crate::load::fault::Fault;
use toile_core::{Change, Registry};

/// What a user does about an old name.
const REPAIR: &str = "`toile migrate` rewrites the file to the new names";

/// The fault of an old stage name, and the new name.
pub(in crate::load) fn old_stage(registry: &Registry, name: &str) -> Option<(Fault, &'static str)> {
    let Now { name: to, with } = renamed(registry, name)?;
    let message = match with {
        "" => format!("the stage `{name}` is now called `{to}`"),
        _ => format!("the stage `{name}` is now `{to}({with})`"),
    };
    Some((Fault::new("old_name", message).hint(REPAIR.to_owned()), to))
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

/// What a stage is now.
#[derive(Clone, Copy)]
pub(super) struct Now {
    pub(super) name: &'static str,
    /// The argument that says what the old name said; empty where there is none.
    pub(super) with: &'static str,
}

/// What a stage is now; none where it never changed, or where it is a stage's name again.
pub(super) fn renamed(registry: &Registry, name: &str) -> Option<Now> {
    let step = |name: &str| {
        registry.migrations().iter().find_map(|m| match m.change {
            Change::Stage { to, with } if m.stage == name && registry.card(name).is_none() => {
                Some(Now { name: to, with })
            }
            _ => None,
        })
    };
    let mut now = step(name)?;
    // Each change is taken once at most, so that a circle ends.
    for _ in registry.migrations() {
        let with = |next: Now| if next.with.is_empty() { now.with } else { next.with };
        now = step(now.name).map_or(now, |next| Now { with: with(next), ..next });
    }
    Some(now)
}
