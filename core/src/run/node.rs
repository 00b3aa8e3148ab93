//! Runs one stage: once, or once for each entry of its named sets.

use crate::pipeline::Node;
use crate::{Arity, Context, Inputs, PortValue, StageError};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A failure with the entry at work.
type Failure = (String, StageError);

pub(super) fn run_node(node: &Node, inputs: &Inputs, cx: &Context) -> Result<Vec<PortValue>, Failure> {
    if !node.card.is_mapped() {
        return guarded(node, inputs, cx).map_err(|e| (String::new(), e));
    }
    let names = entry_names(node, inputs)?;
    let runs: Vec<Result<_, Failure>> = names
        .par_iter()
        .map(|name| {
            let own = cx.for_entry(name);
            let one = entry_inputs(node, inputs, name)?;
            let made = guarded(node, &one, &own).map_err(|e| (name.clone(), e))?;
            Ok((made, own.take_notes()))
        })
        .collect();
    let mut sets: Vec<BTreeMap<_, _>> = vec![BTreeMap::new(); node.card.outputs.len()];
    for (name, run) in names.iter().zip(runs) {
        let (made, (figures, warnings)) = run?;
        cx.absorb(name, figures, warnings);
        for (set, value) in sets.iter_mut().zip(made) {
            if let PortValue::One(artifact) = value {
                set.insert(name.clone(), artifact);
            }
        }
    }
    Ok(node.card.outputs.iter().zip(sets).map(|(port, set)| PortValue::Set(port.kind, set)).collect())
}

/// A stage that panics is a bug of the stage, not the end of the program.
fn guarded(node: &Node, inputs: &Inputs, cx: &Context) -> Result<Vec<PortValue>, StageError> {
    match catch_unwind(AssertUnwindSafe(|| node.stage.run_ports(inputs, cx))) {
        Ok(outcome) => outcome.and_then(checked),
        Err(payload) if payload.is::<StageError>() => {
            Err(payload.downcast::<StageError>().map_or_else(|_| StageError::internal(""), |e| *e))
        }
        Err(payload) => {
            let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
            let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
            Err(StageError::internal(format!("the stage panicked: {text}"))
                .hint("this is a bug, please report it"))
        }
    }
}

/// A stage that gives what cannot be is named here, not where a later stage stumbles over it.
fn checked(made: Vec<PortValue>) -> Result<Vec<PortValue>, StageError> {
    for value in &made {
        for (name, artifact) in value.entries() {
            artifact.check().map_err(|fault| {
                let of = if name.is_empty() { String::new() } else { format!(" \"{name}\"") };
                StageError::internal(format!("its {}{of} cannot be used: {fault}", artifact.kind()))
                    .hint("this is a bug of the stage, please report it to its author")
            })?;
        }
    }
    Ok(made)
}

/// The names of the sets on the mapped ports, which must all be the same.
fn entry_names(node: &Node, inputs: &Inputs) -> Result<Vec<String>, Failure> {
    let mut sets =
        node.card.inputs.iter().zip(&inputs.0).filter_map(|(port, value)| match (port.arity, value) {
            (Arity::Each, Some(PortValue::Set(kind, set))) => {
                Some((*kind, set.keys().cloned().collect::<Vec<_>>()))
            }
            _ => None,
        });
    let Some((first_kind, names)) = sets.next() else { return Ok(Vec::new()) };
    for (kind, other) in sets {
        if other != names {
            let message = format!(
                "the {first_kind}s are named {} but the {kind}s {}",
                names.join(", "),
                other.join(", ")
            );
            return Err((String::new(), StageError::invalid(message)));
        }
    }
    Ok(names)
}

/// The inputs of one entry: its own values on mapped ports, the others as they are.
fn entry_inputs(node: &Node, inputs: &Inputs, name: &str) -> Result<Inputs, Failure> {
    let of_entry = |(port, value): (&crate::InPort, &Option<PortValue>)| match (port.arity, value) {
        (Arity::Each, Some(PortValue::Set(_, set))) => set.get(name).cloned().map(PortValue::One),
        _ => value.clone(),
    };
    Ok(Inputs(node.card.inputs.iter().zip(&inputs.0).map(of_entry).collect()))
}
