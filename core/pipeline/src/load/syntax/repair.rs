//! Faulty texts, read as far as they can be understood.
//!
//! Method: the parser ends at the first fault and says what may have been meant there, a missing
//! comma, a wrong bracket, a text without its closing quote. Each of these is tried, and the one
//! with which the parser comes farthest is taken: it words the fault, and the text is read on with
//! it. Cost: some passes over the text for each fault. Limits: [`MAX_SYNTAX`] faults, and texts up
//! to [`MAX_REPAIRED`]; where nothing helps, the rest of the text is not read.

use crate::load::fault::Fault;
use crate::load::syntax::parser::{Meant, SyntaxFault, TextRepairs, repaired};
use crate::load::syntax::tree::ValueTree;

/// The most faults of syntax that are told at once.
const MAX_SYNTAX: usize = 12;

/// The longest text that is read on after a fault, bytes.
const MAX_REPAIRED: usize = 1 << 18;

/// The tree of a text, and its faults of syntax; no tree where the text cannot be understood.
pub(crate) fn read(text: &str) -> (Option<ValueTree>, Vec<Fault>) {
    let (mut repairs, mut faults) = (TextRepairs::default(), Vec::new());
    loop {
        let fault = match repaired(text, &repairs) {
            Ok(mut tree) => {
                repairs.mark(&mut tree);
                return (Some(tree), faults);
            }
            Err(fault) => fault,
        };
        let best = if text.len() <= MAX_REPAIRED { best(text, &repairs, &fault) } else { None };
        faults.push(worded(&fault, best.as_ref().map(|(meant, _)| meant)));
        match best {
            Some((_, better)) if faults.len() < MAX_SYNTAX => repairs = better,
            _ => return (None, faults),
        }
    }
}

/// What was meant: that with which the parser comes farthest, beyond the fault.
fn best(text: &str, repairs: &TextRepairs, fault: &SyntaxFault) -> Option<(Meant, TextRepairs)> {
    let mut best: Option<(usize, Meant, TextRepairs)> = None;
    for meant in &fault.meant {
        let tried = repairs.with(&meant.repair);
        let reached = match repaired(text, &tried) {
            Ok(_) => usize::MAX,
            Err(next) => next.reached(),
        };
        let least = best.as_ref().map_or(fault.reached(), |(so_far, ..)| *so_far);
        // A bracket that is closed at the end of the text leads to no later place.
        let is_end = fault.reached() >= text.len() && best.is_none();
        if reached > least || is_end {
            best = Some((reached, meant.clone(), tried));
        }
    }
    best.map(|(_, meant, repairs)| (meant, repairs))
}

/// The fault in the words of what was meant.
fn worded(fault: &SyntaxFault, meant: Option<&Meant>) -> Fault {
    match meant.and_then(|m| m.words.as_ref()) {
        Some((message, hint, span)) => Fault::new("syntax", message.clone()).at(span, "").hint(hint.clone()),
        None => plain(fault),
    }
}

/// The fault in the parser's own words.
pub(crate) fn plain(e: &SyntaxFault) -> Fault {
    let fault = Fault::new("syntax", e.message.clone()).at(&e.span, "").hint(e.hint.clone());
    e.also.iter().fold(fault, |f, (span, what)| f.at(span, *what))
}
