//! `DxfPattern`: pieces of a garment from a DXF of AAMA or ASTM D6673, as CAD programs exchange
//! them.
//!
//! A block is a piece in one size. [`tags`] and [`entities`] read the file, [`pieces`] makes pieces
//! of blocks. DXF knows no seams: they come from a file beside it, or are proposed. Cost: some
//! milliseconds per piece.

mod damage;
mod decode;
mod entities;
mod pieces;
mod spline;
mod tags;
#[cfg(test)]
mod tests;
mod units;
mod words;

use super::copies::{MOST_COPIES, copies};
use super::unit::{DrawingUnit, worn};
use super::{faults, seams};
use damage::DxfDamage;
use entities::{Block, EntityShape, blocks};
use std::collections::{BTreeMap, BTreeSet};
use toile_core::Remarks;
use toile_core::prelude::*;

/// Pieces of a garment.
const MOST_PIECES: usize = 500;
/// Layers that have a meaning for a piece, by the standards; what is drawn on others is reported.
const KNOWN: std::ops::RangeInclusive<i32> = 1..=15;
const KNOWN_FINE: std::ops::RangeInclusive<i32> = 80..=87;
/// Greatest number of things left out of a file that are reported one by one.
const MOST_TOLD: usize = 6;

/// Reads the pieces of a garment from a DXF of AAMA or ASTM, in one size.
///
/// Takes the place of photos, outlines and a style. Half pieces are unfolded at their mirror line,
/// pieces are turned so that the grain runs up, and cut as often as their quantity says, the second
/// of a pair mirrored. DXF knows no seams: give them in a file, or take those that `seams.ron`
/// proposes and you have looked through. Nothing is sewn that nobody confirmed.
///
/// The names of pieces are read in the code page that the file names. A garment of a size that no
/// one wears is refused with the `unit` that fits.
#[stage(
    role = Reader,
    source = "AAMA DXF; ASTM D6673",
    version = 4,
    example = "DxfPattern(file: \"tank.dxf\", size: \"M\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct DxfPattern {
    /// The file, relative to the pipeline.
    #[param(default = String::new())]
    pub file: String,
    /// The size to read; empty for the file's sample size.
    #[param(default = String::new())]
    pub size: String,
    /// The unit of the file's numbers.
    #[param(default = DrawingUnit::Auto)]
    pub unit: DrawingUnit,
    /// The encoding of names, such as `windows-1251` or `shift_jis`; empty for the one that the
    /// file says.
    #[param(default = String::new())]
    pub encoding: String,
    /// The file with the seams, relative to the pipeline; empty where they are to be proposed.
    #[param(default = String::new())]
    pub seams: String,
}

#[stage]
impl DxfPattern {
    /// Runs the stage.
    pub fn run(&self, cx: &Context) -> Result<(Pattern, Set<Outline>, SewingPlan, OutputFiles), StageError> {
        self.named()?;
        let bytes = cx.read(&self.file).map_err(|e| e.at("file"))?;
        let mut told = Remarks::default();
        let refused =
            |all: Vec<DxfDamage>| faults::refused(&self.file, all.iter().map(DxfDamage::fault).collect());
        let pieces = pieces_of(&bytes, self, &mut told).map_err(refused)?;
        let unsewable = |what: String, remedy: &str| {
            refused(vec![DxfDamage::Unsewable { what, remedy: remedy.to_owned() }])
        };
        seams::sewn((super::stem(&self.file), pieces), &self.seams, told, unsewable, cx)
    }

    fn named(&self) -> Result<(), StageError> {
        super::named(&self.file, "tank.dxf")
    }

    /// Whether the files are there.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        seams::looked(self.named(), &self.file, &self.seams, placed)
    }
}

/// A block that draws a piece.
struct Drawn<'a> {
    block: &'a Block,
    name: String,
    /// Empty where nothing says it: then the piece is of every size.
    size: String,
}

/// The blocks that draw pieces, each with its name and size: by its texts, else by its name at the
/// last underscore, if what stands behind that is the size of another piece, too, or another size
/// of the same.
fn drawn<'a>(blocks: &'a [Block], asked: &str) -> Vec<Drawn<'a>> {
    let has_outline = |b: &&Block| b.lines(1).next().is_some() || b.lines(14).next().is_some();
    let all: Vec<&Block> = blocks.iter().filter(|b| !b.is_layout()).filter(has_outline).collect();
    let said: BTreeSet<String> =
        all.iter().filter_map(|b| b.value("Size")).map(str::to_ascii_lowercase).collect();
    let parts: Vec<Option<(&str, &str)>> = all.iter().map(|b| b.name.rsplit_once('_')).collect();
    let many = |of: fn((&str, &str)) -> String, value: String| {
        parts.iter().flatten().filter(|p| of(**p) == value).count() > 1
    };
    let is_size = |(stem, size): (&str, &str)| {
        let small = size.to_ascii_lowercase();
        let alike = many(|p| p.1.to_owned(), size.to_owned()) || many(|p| p.0.to_owned(), stem.to_owned());
        if said.is_empty() { alike || size.eq_ignore_ascii_case(asked.trim()) } else { said.contains(&small) }
    };
    let one = |(block, parts): (&&'a Block, &Option<(&str, &str)>)| {
        let split = parts.filter(|p| is_size(*p));
        let name = block.value("Piece Name").or(split.map(|p| p.0)).unwrap_or(&block.name);
        let size = block.value("Size").or(split.map(|p| p.1)).unwrap_or("");
        // A point in a name would end it where seams name an edge.
        Drawn { block, name: name.replace('.', "_"), size: size.to_owned() }
    };
    all.iter().zip(&parts).map(one).collect()
}

/// The pieces of one size, each as often as it is cut.
///
/// Errors: all that is wrong with them.
fn pieces_of(bytes: &[u8], asked: &DxfPattern, told: &mut Remarks) -> Result<Vec<Piece>, Vec<DxfDamage>> {
    let DxfPattern { size, unit, encoding, .. } = asked;
    let one = |damage| vec![damage];
    let tags = tags::tags(bytes, encoding, told).map_err(one)?;
    let (blocks, outside) = blocks(&tags).map_err(one)?;
    let drawn = drawn(&blocks, size);
    if drawn.is_empty() {
        return Err(one(DxfDamage::NoPieces));
    }
    let size = size_of(size, &drawn, &outside, told).map_err(one)?;
    let is_chosen = |d: &&Drawn<'_>| d.size.is_empty() || d.size.eq_ignore_ascii_case(&size);
    let chosen: Vec<&Drawn<'_>> = drawn.iter().filter(is_chosen).collect();
    other_sizes_alone(&drawn, &chosen, &size, told);
    let taken = units::unit(&tags, &outside, &chosen, *unit, told).map_err(one)?;
    let (mut out, mut faults): (Vec<Piece>, Vec<DxfDamage>) = (Vec::new(), Vec::new());
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for Drawn { block, name: own, .. } in &chosen {
        let again = count.entry(own).or_default();
        *again += 1;
        let name = if *again == 1 { own.clone() } else { format!("{own}_{again}") };
        // The sample size alone carries the quantity.
        let others = || drawn.iter().filter(|d| d.name == *own).find_map(|d| d.block.value("Quantity"));
        let quantity = block.value("Quantity").or_else(others);
        match pieces::piece(block, &name, taken.metres, told) {
            Ok(piece) => {
                let (plain, turned) = cut(quantity).unwrap_or_else(|word| {
                    told.warnings.push(format!(
                        "piece \"{name}\" (line {}): the quantity \"{word}\" is no number: cut once",
                        block.line
                    ));
                    (1, 0)
                });
                out.extend(copies(piece, plain, turned, told));
            }
            Err(damage) => faults.push(damage),
        }
        if out.len() > MOST_PIECES {
            return Err(one(DxfDamage::Many { what: "pieces", count: out.len(), most: MOST_PIECES }));
        }
    }
    if out.is_empty() && faults.is_empty() {
        faults.push(DxfDamage::NoPieces);
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    left_out(&blocks, &outside, &chosen, told);
    worn(&out, &taken).map_err(|m| one(DxfDamage::Size { what: m.what, remedy: m.remedy }))?;
    Ok(out)
}

/// The size that is read.
fn size_of(
    asked: &str,
    drawn: &[Drawn<'_>],
    outside: &Block,
    told: &mut Remarks,
) -> Result<String, DxfDamage> {
    let mut known: Vec<String> = Vec::new();
    for d in drawn {
        if !d.size.is_empty() && !known.contains(&d.size) {
            known.push(d.size.clone());
        }
    }
    let is = |size: &str| known.iter().find(|k| k.eq_ignore_ascii_case(size.trim())).cloned();
    if !asked.trim().is_empty() {
        return is(asked).ok_or_else(|| DxfDamage::NoSize { size: asked.trim().to_owned(), known });
    }
    let sample = outside.value("Sample Size").and_then(is);
    let chosen = sample.or_else(|| known.first().cloned()).unwrap_or_default();
    if known.len() > 1 {
        told.notes.push(format!("no size is asked for: \"{chosen}\" is read of {}", known.join(", ")));
    }
    Ok(chosen)
}

/// Reports the pieces that exist in other sizes only.
fn other_sizes_alone(drawn: &[Drawn<'_>], chosen: &[&Drawn<'_>], size: &str, told: &mut Remarks) {
    let mut seen: BTreeSet<&str> = chosen.iter().map(|d| d.name.as_str()).collect();
    for d in drawn {
        if seen.insert(&d.name) {
            told.warnings.push(format!(
                "piece \"{}\" (line {}) is not there in size \"{size}\", but in \"{}\": left out",
                d.name, d.block.line, d.size
            ));
        }
    }
}

/// Reports what is drawn and not read: in the pieces, and in blocks that are no pieces.
fn left_out(blocks: &[Block], outside: &Block, chosen: &[&Drawn<'_>], told: &mut Remarks) {
    let known = |layer: i32| KNOWN.contains(&layer) || KNOWN_FINE.contains(&layer);
    let mut out: Vec<String> = Vec::new();
    for d in chosen {
        let mut kinds: BTreeMap<String, (usize, usize)> = BTreeMap::new();
        for e in &d.block.entities {
            let kind = match &e.shape {
                EntityShape::Other(kind) => kind.clone(),
                EntityShape::Line(_) if !known(e.layer) => format!("line on layer \"{}\"", e.layer_name),
                EntityShape::Insert { block, .. } if !matches!(e.layer, 4 | 13 | 80..=83) => {
                    format!("block \"{block}\"")
                }
                EntityShape::Line(_)
                | EntityShape::Text(_)
                | EntityShape::Point { .. }
                | EntityShape::Insert { .. } => continue,
            };
            kinds.entry(kind).or_insert((0, e.line)).0 += 1;
        }
        out.extend(
            kinds.iter().map(|(kind, (n, line))| format!("{n} {kind} of piece \"{}\" (line {line})", d.name)),
        );
    }
    let layouts = blocks.iter().filter(|b| b.is_layout() && b.lines(1).next().is_some());
    out.extend(layouts.map(|b| format!("what is drawn on the layout \"{}\" (line {})", b.name, b.line)));
    let loose: Vec<usize> = outside.lines(1).map(|(line, _)| line).collect();
    if let Some(line) = loose.first() {
        out.push(format!("{} lines on layer 1 outside of blocks (line {line})", loose.len()));
    }
    if !out.is_empty() {
        let more = if out.len() > MOST_TOLD {
            format!(" and {} more", out.len() - MOST_TOLD)
        } else {
            String::new()
        };
        told.warnings.push(format!("left out: {}{more}", out[..out.len().min(MOST_TOLD)].join(", ")));
    }
    for e in &outside.entities {
        if let EntityShape::Insert { block, scale, .. } = &e.shape
            && chosen.iter().any(|d| d.block.name == *block)
            && scale.iter().any(|s| (s.abs() - 1.0).abs() > 1e-6)
        {
            told.warnings.push(format!(
                "block \"{block}\" (line {}) is placed {} times as large as it is drawn: it is read as it is drawn",
                e.line, scale[0]
            ));
        }
    }
}

/// How often a piece is cut as drawn and mirrored: `2` is a pair, the second mirrored, as is
/// `1 pair`; `1,1` is one as drawn and one mirrored.
///
/// Errors: what is no number of these.
fn cut(quantity: Option<&str>) -> Result<(usize, usize), String> {
    let Some(text) = quantity.filter(|q| !q.is_empty()) else { return Ok((1, 0)) };
    let numbers: Vec<usize> = text
        .split(|c: char| !c.is_ascii_digit())
        .filter(|n| !n.is_empty())
        .map(|n| n.parse::<usize>().unwrap_or(MOST_COPIES).min(MOST_COPIES))
        .collect();
    let small = text.to_ascii_lowercase();
    match numbers[..] {
        // A fraction, or a number below zero, is none.
        _ if text.contains('.') || text.contains('-') => Err(text.to_owned()),
        [n] if small.contains("pair") => Ok((n, n)),
        [n] => Ok((n - n / 2, n / 2)),
        [n, m] => Ok((n, m)),
        _ => Err(text.to_owned()),
    }
}
