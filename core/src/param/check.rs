//! Checks of a text as the value of a parameter.

use super::words::type_fault;
use super::{Length, ParamDoc, ParamType, ron_options};
use std::sync::Arc;

/// How a parameter's text is checked: by its own type, or by the plugin that knows the type.
#[derive(Clone)]
pub struct Check(Arc<CheckFn>);

type CheckFn = dyn Fn(&str, &ParamDoc) -> Result<(), ParamFault> + Send + Sync;

impl Check {
    /// Checks by the type `T`.
    pub fn of<T: ParamType + 'static>() -> Self {
        Check(Arc::new(check_param::<T>))
    }

    /// Checks by a function.
    pub fn by(check: impl Fn(&str, &ParamDoc) -> Result<(), ParamFault> + Send + Sync + 'static) -> Self {
        Check(Arc::new(check))
    }

    /// Checks a text as the value of that parameter.
    pub fn run(&self, text: &str, doc: &ParamDoc) -> Result<(), ParamFault> {
        (self.0)(text, doc)
    }
}

impl std::fmt::Debug for Check {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Check")
    }
}

/// Why a text is no value for a parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParamFault {
    /// The reason with the parameter's name, lower case.
    pub message: String,
    /// The reason alone, for a fault deep inside a value.
    pub reason: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// Byte offset of the fault in the text, where the parser knows it.
    pub offset: Option<usize>,
}

/// The check behind [`ParamDoc::check`] for a parameter of type `T`.
fn check_param<T: ParamType>(text: &str, doc: &ParamDoc) -> Result<(), ParamFault> {
    let value: T = ron_options().from_str(text).map_err(|e| type_fault(text, doc, &e))?;
    for x in value.numbers() {
        check_number(x, doc).map_err(|message| ParamFault {
            reason: message.clone(),
            message,
            hint: None,
            offset: None,
        })?;
    }
    Ok(())
}

/// Checks that every number of a value is finite and in range; used when a value is set from code.
pub fn check_number(x: f64, doc: &ParamDoc) -> Result<(), String> {
    let show = |v: f64| if doc.kind.contains("length") { Length::m(v).to_string() } else { v.to_string() };
    let unit = if doc.unit.is_empty() { String::new() } else { format!(" {}", doc.unit) };
    if !x.is_finite() {
        return Err(format!("`{}` is {x}, which is not a finite number", doc.name));
    }
    match (doc.min, doc.max) {
        (Some(lo), _) if x < lo => {
            Err(format!("`{}` is {}, below its least value {}{unit}", doc.name, show(x), show(lo)))
        }
        (_, Some(hi)) if x > hi => {
            Err(format!("`{}` is {}, above its greatest value {}{unit}", doc.name, show(x), show(hi)))
        }
        _ => Ok(()),
    }
}
