//! Words of a name by which a drawing tells what a line is for: one list for who writes drawings
//! and who reads them.

/// The line that is cut along.
pub const ALLOWANCE: [&str; 6] = ["sa", "allowance", "seamallowance", "cutline", "cuttingline", "cutting"];
/// Where a half piece is cut on the fold.
pub const FOLD: [&str; 4] = ["fold", "foldline", "mirror", "mirrorline"];
/// Notches.
pub const NOTCH: [&str; 3] = ["notch", "notches", "bnotch"];
/// Points inside.
pub const DRILL: [&str; 3] = ["drill", "drillhole", "drills"];
/// Cut-outs.
pub const HOLE: [&str; 3] = ["hole", "holes", "cutout"];
/// Lines inside that change nothing.
pub const MARK: [&str; 8] = ["mark", "marks", "help", "contrast", "internal", "inner", "placement", "dart"];
/// What is no part of the pattern.
pub const NOTHING: [&str; 9] =
    ["hidden", "logo", "scalebox", "note", "notes", "dimension", "dimensions", "guide", "background"];
/// The line that is sewn along.
pub const OUTLINE: [&str; 7] = ["fabric", "seam", "seamline", "sewline", "stitchline", "outline", "pattern"];

/// Whether a word, in small letters, tells what a line is for.
pub fn tells(word: &str) -> bool {
    [&ALLOWANCE[..], &FOLD, &NOTCH, &DRILL, &HOLE, &MARK, &NOTHING, &OUTLINE]
        .iter()
        .any(|t| t.contains(&word))
        || word.starts_with("grain")
        || word.ends_with("grainline")
        || word.starts_with("cutonfold")
}
