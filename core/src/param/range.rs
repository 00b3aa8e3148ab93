//! The range of a parameter's numbers.

use super::{Length, ParamDoc};

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
