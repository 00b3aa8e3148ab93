//! What is written on a piece, and which letters of it a file cannot show.

use crate::label;
use crate::options::DrawingOptions;
use toile_core::artifact::{Pattern, Piece};

/// What stands on a piece: its name, how often it is cut, the pattern and its size, the allowance.
pub(crate) fn words(
    pattern: &Pattern,
    p: &Piece,
    widths: &[f64],
    options: &DrawingOptions,
) -> Vec<label::LabelLine> {
    let mut out = vec![(p.name.clone(), 1.0, true), ("cut 1".to_owned(), 0.8, false)];
    let size = if options.size.is_empty() { String::new() } else { format!(", size {}", options.size) };
    out.push((format!("{}{size}", pattern.name), 0.6, false));
    out.push((allowance(widths), 0.6, false));
    out.retain(|(text, _, _)| !text.trim().is_empty());
    let short = |(text, share, bold): label::LabelLine| (text.chars().take(40).collect(), share, bold);
    out.into_iter().map(short).collect()
}

/// How many names have letters that a file cannot show, in a sentence; `holds` says of a text
/// whether the file shows it.
pub(crate) fn unknown_letters<'n>(
    names: impl Iterator<Item = &'n String>,
    holds: impl Fn(&str) -> bool,
) -> Option<String> {
    let count = names.filter(|n| !holds(n)).count();
    (count > 0)
        .then(|| format!("{count} names have letters that the fonts do not: question marks stand for them"))
}

/// The seam allowance of a piece in words.
pub(crate) fn allowance(widths: &[f64]) -> String {
    let mut all: Vec<f64> = widths.iter().map(|w| (w * 1e4).round() / 10.0).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    match all[..] {
        [0.0] => "no seam allowance".to_owned(),
        _ => {
            let each: Vec<String> = all.iter().map(|w| format!("{w}")).collect();
            format!("seam allowance {} mm", each.join(" / "))
        }
    }
}
