//! Checks of a text as the value of a parameter.

use super::range::check_number;
use super::words::type_fault;
use super::{Check, ParamDoc, ParamFault, ParamType, ron_options};

impl Check {
    /// Checks by the type `T`.
    pub fn of<T: ParamType + 'static>() -> Self {
        Check::by(check_param::<T>)
    }
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
