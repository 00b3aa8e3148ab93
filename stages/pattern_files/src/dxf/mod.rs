//! DXF of AAMA and ASTM D6673: release 12, ASCII, a block a piece, millimetres.
//!
//! Layers: 1 boundary, as open polylines that are split where seams end, and the texts by which
//! programs know a piece; 2 turn points, 3 curve points, 4 notches, 7 grain, 8 lines inside, 11
//! cut-outs, 13 drill holes, 14 the line that is sewn along where there is a seam allowance (1 is
//! the cut line then), 15 texts for people; of ASTM also 84, the boundary as it is checked. Curves
//! become polylines within 0.01 mm. [`text`] knows the tags, [`block`] what is drawn of a piece.
//!
//! Cost: a millisecond a piece. Limits: the format has no seams, no places around the body, no
//! layers of clothes and no purposes of lines inside pieces; each is told, and seams stand in the
//! file beside it. Pieces are written whole: there is no mirror line (layer 6). No grading: one
//! size.

mod block;
mod text;

use crate::allowance::{CutLines, cut_lines};
use crate::error::{WriteError, writable};
use crate::marks;
use crate::names::{FileNames, one_line, sewable, unique};
use crate::options::DrawingOptions;
use crate::shelf::pack;
use crate::sidecar;
use crate::written::Written;
use block::PieceBlock;
use std::collections::BTreeSet;
use text::{Tags, encoded, held};
use toile_core::artifact::{Pattern, Piece};

/// Characters of a piece's name.
const MOST_NAME: usize = 60;
/// Characters of a block's name in release 12.
const MOST_BLOCK: usize = 31;
/// Between pieces, mm.
const GAP: f64 = 50.0;
/// What a size without a name is called.
const ONE_SIZE: &str = "ONE";

/// Which of the two forms of the format is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standard {
    /// ANSI/AAMA 292.
    Aama,
    /// ASTM D6673.
    Astm,
}

/// A pattern as a DXF, with its seams in the file beside it.
///
/// Characters beyond Latin-1 are written as `\U+XXXX`, as release 12 knows none of them. An edge
/// whose ends are nearer to each other than 0.2 mm is no edge to readers: it becomes a part of the
/// edge before it where it is short, and is halved where it is long.
///
/// Errors: a pattern that is not sound, that has no pieces, or with a piece beyond
/// [`FARTHEST`](crate::FARTHEST); a seam allowance that cannot be cut.
pub fn to_dxf(
    pattern: &Pattern,
    standard: Standard,
    options: &DrawingOptions,
) -> Result<Written, WriteError> {
    writable(pattern)?;
    let cut = cut_lines(pattern, &options.allowances)?;
    let plain = made(pattern, standard, options, &cut, false);
    // Letters of Latin-1 that happen to be UTF-8 would be read as other letters.
    let mistaken = !plain.bytes.is_ascii() && std::str::from_utf8(&plain.bytes).is_ok();
    Ok(if mistaken { made(pattern, standard, options, &cut, true) } else { plain })
}

fn made(
    pattern: &Pattern,
    standard: Standard,
    options: &DrawingOptions,
    cut: &CutLines,
    ascii: bool,
) -> Written {
    let (mut notes, mut warnings) = (left_out(&pattern.pieces), cut.notes.clone());
    let numbers = marks::seam_marks(pattern);
    let size = match one_line(&options.size, MOST_NAME) {
        size if size.is_empty() => ONE_SIZE.to_owned(),
        size => encoded(&size, ascii),
    };
    let (mut names, mut taken, mut block_names) = (FileNames::default(), BTreeSet::new(), BTreeSet::new());
    let mut blocks = Vec::with_capacity(pattern.pieces.len());
    for (k, p) in pattern.pieces.iter().enumerate() {
        let label = unique(&mut taken, &sewable(&held(&one_line(&p.name, MOST_NAME))));
        if label != p.name {
            notes.push(format!("piece \"{}\" is called \"{label}\" in the file", p.name));
        }
        let name = block_name(&label, &size, &mut block_names);
        let block = PieceBlock::new(p, cut.lines[k].as_deref(), &cut.widths[k], &numbers[k], [name, label]);
        warnings.extend(block.notes.iter().cloned());
        names.insert(&p.name, block.names.clone());
        blocks.push(block);
    }
    let mut tags = Tags::default();
    tags.section("HEADER").tag(9, "$ACADVER").tag(1, "AC1009").tag(9, "$DWGCODEPAGE").tag(3, "ansi_1252");
    tags.end().section("BLOCKS");
    blocks.iter().for_each(|b| b.write(&mut tags, standard, &size, ascii));
    tags.end().section("ENTITIES");
    entities(&mut tags, pattern, &blocks, standard, options, &size, ascii);
    tags.end().tag(0, "EOF");
    let (seams, mut told) = sidecar::along(pattern, &names);
    warnings.append(&mut told);
    Written { bytes: tags.bytes(), seams, notes, warnings }
}

/// What the format has no place for, a sentence for each kind.
fn left_out(pieces: &[Piece]) -> Vec<String> {
    let count = |what: &str, of: fn(&Piece) -> usize| {
        let n: usize = pieces.iter().map(of).sum();
        (n > 0).then(|| format!("{n} {what} are left out: the format has none"))
    };
    let all = [
        count("places around the body", |p| usize::from(p.pose.is_some())),
        count("layers of pieces", |p| usize::from(p.layer > 0)),
        count("purposes of lines inside pieces", |p| p.lines.len()),
    ];
    all.into_iter().flatten().collect()
}

/// A name that release 12 takes for a block, unlike those that are taken.
fn block_name(piece: &str, size: &str, taken: &mut BTreeSet<String>) -> String {
    let plain =
        |c: char| if c.is_ascii_alphanumeric() || "$-_".contains(c) { c.to_ascii_uppercase() } else { '_' };
    let bare = |text: &str, most: usize| text.chars().map(plain).take(most).collect::<String>();
    let size = bare(size, 8);
    let mut k = 1;
    loop {
        let number = if k == 1 { String::new() } else { format!("_{k}") };
        let most = MOST_BLOCK.saturating_sub(size.len() + number.len() + 1);
        let name = format!("{}{number}_{size}", bare(piece, most));
        if taken.insert(name.clone()) {
            return name;
        }
        k += 1;
    }
}

/// The texts of the whole style, and the blocks side by side.
fn entities(
    tags: &mut Tags,
    pattern: &Pattern,
    blocks: &[PieceBlock<'_>],
    standard: Standard,
    options: &DrawingOptions,
    size: &str,
    ascii: bool,
) {
    let value = |text: &str| encoded(&one_line(text, MOST_NAME), ascii);
    let mut texts = vec![format!("Style Name: {}", value(&pattern.name))];
    if !options.date.is_empty() {
        texts.push(format!("Creation Date: {}", value(&options.date)));
    }
    texts.push(format!("Sample Size: {size}"));
    texts.push("Units: METRIC".to_owned());
    match standard {
        Standard::Aama => texts.push(format!("TOLERANCE: {:.3}", block::TOLERANCE * 1e3)),
        Standard::Astm => {
            texts.push(format!("Curve Tolerance: {:.3}", block::TOLERANCE * 1e3));
            texts.push("ASTM/D13Proposal 1 Version: D 6673-04".to_owned());
        }
    }
    let sizes: Vec<[f64; 2]> = blocks.iter().map(PieceBlock::size).collect();
    let area: f64 = sizes.iter().map(|s| (s[0] + GAP) * (s[1] + GAP)).sum();
    let (places, _) = pack(&sizes, area.sqrt() * 1.2, GAP);
    for (k, text) in texts.iter().enumerate() {
        tags.text(1, [0.0, GAP + 10.0 * (texts.len() - k) as f64], text);
    }
    for (b, [x, y]) in blocks.iter().zip(&places) {
        let low = b.low();
        tags.tag(0, "INSERT").tag(8, 1).tag(2, &b.name).point(10, [x - low[0], y - low[1]]);
    }
}
