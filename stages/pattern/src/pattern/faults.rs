//! All that is wrong with a file as one error.

use toile_core::{ErrorCode, StageError};

/// Greatest number of faults that are reported one by one; of the others only the number is.
const MOST: usize = 12;

/// What is wrong in one place, and what may be done.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PatternFault {
    pub code: ErrorCode,
    /// The parameter that names what is at fault.
    pub param: &'static str,
    pub what: String,
    pub remedy: Option<String>,
}

/// The faults of a file, at least one, as an error: each in a line of its own where there are
/// several.
pub(super) fn refused(file: &str, faults: Vec<PatternFault>) -> StageError {
    let Some(first) = faults.first() else {
        return StageError::internal("a file without faults was refused");
    };
    let (code, param, n) = (first.code, first.param, faults.len());
    let error = |message: String| StageError::new(code, message).at(param);
    if let [PatternFault { what, remedy, .. }] = &faults[..] {
        let error = error(format!("\"{file}\": {what}"));
        return remedy.iter().fold(error, |error, hint| error.hint(hint));
    }
    let told = faults.iter().take(MOST).enumerate();
    let whats: String = told.clone().map(|(k, f)| format!("\n{}. {}", k + 1, f.what)).collect();
    let more = if n > MOST { format!("\nand {} more", n - MOST) } else { String::new() };
    let remedies: Vec<String> =
        told.filter_map(|(k, f)| Some(format!("{}. {}", k + 1, f.remedy.as_ref()?))).collect();
    let error = error(format!("\"{file}\" has {n} faults{whats}{more}"));
    if remedies.is_empty() { error } else { error.hint(remedies.join("\n")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(what: &str, remedy: &str) -> PatternFault {
        let remedy = Some(remedy.to_owned());
        PatternFault { code: ErrorCode::PatternLoading, param: "file", what: what.into(), remedy }
    }

    #[test]
    fn several_faults_stand_in_a_line_each() {
        let one = refused("a.json", vec![fault("it is empty", "give another")]);
        assert_eq!(
            (one.message.as_str(), one.hint.as_deref()),
            ("\"a.json\": it is empty", Some("give another"))
        );
        let two = refused("a.json", vec![fault("no hem", "draw it"), fault("no waist", "draw that")]);
        assert_eq!(two.message, "\"a.json\" has 2 faults\n1. no hem\n2. no waist");
        assert_eq!(two.hint.as_deref(), Some("1. draw it\n2. draw that"));
        let many = refused("a.json", vec![fault("no hem", "draw it"); 20]);
        assert!(many.message.ends_with("12. no hem\nand 8 more"), "{}", many.message);
    }
}
