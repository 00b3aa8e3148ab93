//! `DxfPattern`: pieces of a garment from a DXF of AAMA or ASTM D6673, as CAD programs exchange them.
//!
//! A block is a piece in one size. [`tags`] and [`entities`] read the file, [`pieces`] makes pieces of blocks. DXF knows no
//! seams: they come from a file beside it, or are proposed. Cost: some milliseconds a piece.

mod damage;
mod entities;
mod pieces;
mod tags;
#[cfg(test)]
mod tests;

use super::copies::{MOST_COPIES, copies};
use super::seams;
use damage::Damage;
use entities::{Block, blocks};
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// Pieces of a garment.
const MOST_PIECES: usize = 500;

/// Reads the pieces of a garment from a DXF of AAMA or ASTM, in one size.
///
/// Takes the place of photos, outlines and a style. Half pieces are unfolded at their mirror line, pieces are turned so that
/// the grain runs up, and cut as often as their quantity says, the second of a pair mirrored. DXF knows no seams: give them in a
/// file, or take those that `seams.ron` proposes and you have looked through. Nothing is sewn that nobody confirmed.
#[stage(
    role = Reader,
    source = "AAMA DXF; ASTM D6673",
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
        let mut told = Vec::new();
        let pieces = pieces_of(&bytes, &self.size, &mut told).map_err(|d| d.error(&self.file))?;
        let unsewable = |what: String, remedy: &str| {
            Damage::Unsewable { what, remedy: remedy.to_owned() }.error(&self.file)
        };
        seams::sewn((super::stem(&self.file), pieces), &self.seams, told, unsewable, cx)
    }

    fn named(&self) -> Result<(), StageError> {
        super::named(&self.file, "tank.dxf")
    }

    /// Whether the files are there.
    fn precheck(&self, placed: &Placed<'_>) -> Vec<StageError> {
        seams::looked(self.named(), &self.file, &self.seams, placed)
    }
}

/// The name and size of a block: by its texts, else by its name at the last underscore.
fn named(block: &Block) -> (String, String) {
    let split = block.name.rsplit_once('_').unwrap_or((&block.name, ""));
    let name = block.value("Piece Name").unwrap_or(split.0);
    let size = block.value("Size").unwrap_or(split.1);
    // A point in a name would end it where seams name an edge.
    (name.replace('.', "_"), size.to_owned())
}

/// The pieces of one size, each as often as it is cut.
fn pieces_of(bytes: &[u8], size: &str, told: &mut Vec<String>) -> Result<Vec<Piece>, Damage> {
    let (blocks, outside) = blocks(&tags::tags(bytes)?)?;
    let drawn: Vec<(&Block, String, String)> = blocks
        .iter()
        .filter(|b| b.lines(1).next().is_some() || b.lines(14).next().is_some())
        .map(|b| {
            let (name, size) = named(b);
            (b, name, size)
        })
        .collect();
    if drawn.is_empty() {
        return Err(Damage::NoPieces);
    }
    let size = size_of(size, &drawn, &outside, told)?;
    let chosen: Vec<_> = drawn.iter().filter(|(_, _, s)| s.eq_ignore_ascii_case(&size)).collect();
    let unit = unit(&outside, &chosen.iter().map(|(b, _, _)| *b).collect::<Vec<_>>(), told)?;
    let mut out: Vec<Piece> = Vec::new();
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for (block, own, _) in &chosen {
        let again = count.entry(own).or_default();
        *again += 1;
        let name = if *again == 1 { own.clone() } else { format!("{own}_{again}") };
        // The sample size alone carries the quantity.
        let quantity = block.value("Quantity").or_else(|| {
            drawn.iter().filter(|(_, other, _)| other == own).find_map(|(b, _, _)| b.value("Quantity"))
        });
        let piece = pieces::piece(block, &name, unit, told)?;
        let (plain, turned) = cut(quantity);
        out.extend(copies(piece, plain, turned, told));
        if out.len() > MOST_PIECES {
            return Err(Damage::Many { what: "pieces", count: out.len(), most: MOST_PIECES });
        }
    }
    match out.is_empty() {
        true => Err(Damage::NoPieces),
        false => Ok(out),
    }
}

/// The size that is read.
fn size_of(
    asked: &str,
    drawn: &[(&Block, String, String)],
    outside: &Block,
    told: &mut Vec<String>,
) -> Result<String, Damage> {
    let mut known: Vec<String> = Vec::new();
    for (_, _, size) in drawn {
        if !known.contains(size) {
            known.push(size.clone());
        }
    }
    let is = |size: &str| known.iter().find(|k| k.eq_ignore_ascii_case(size.trim())).cloned();
    if !asked.trim().is_empty() {
        return is(asked).ok_or_else(|| Damage::NoSize { size: asked.trim().to_owned(), known });
    }
    let sample = outside.value("Sample Size").and_then(is);
    let chosen = sample.or_else(|| known.first().cloned()).unwrap_or_default();
    if known.len() > 1 {
        told.push(format!("no size is asked for: \"{chosen}\" is read of {}", known.join(", ")));
    }
    Ok(chosen)
}

/// Metres in a unit: inches or millimetres as the file says, else those that make a garment of it.
fn unit(outside: &Block, blocks: &[&Block], told: &mut Vec<String>) -> Result<f64, Damage> {
    let said = outside.value("Units").or_else(|| blocks.iter().find_map(|b| b.value("Units")));
    match said {
        Some(word) if word.eq_ignore_ascii_case("ENGLISH") => {
            told.push("the file's units are inches".to_owned());
            Ok(0.0254)
        }
        Some(word) if word.eq_ignore_ascii_case("METRIC") => {
            told.push("the file's units are millimetres".to_owned());
            Ok(1e-3)
        }
        Some(word) => Err(Damage::Units { word: tags::short(word) }),
        None => {
            let points = blocks.iter().flat_map(|b| b.lines(1)).map(|(_, p, _)| p);
            let size = points.map(|p| (p[p.len() - 1] - p[0]).norm()).fold(0.0, f64::max);
            let (unit, word) = if size > 60.0 { (1e-3, "millimetres") } else { (0.0254, "inches") };
            told.push(format!(
                "the file does not say its units: read as {word}, with which its longest edge is {:.0} mm",
                size * unit * 1e3
            ));
            Ok(unit)
        }
    }
}

/// How often a piece is cut as drawn and mirrored: `2` is a pair, the second mirrored; `1,1` is one as drawn and one mirrored.
fn cut(quantity: Option<&str>) -> (usize, usize) {
    let number = |text: &str| text.trim().parse::<usize>().ok().map(|n| n.min(MOST_COPIES));
    match quantity.map(|q| q.split_once(',').map_or((number(q), None), |(a, b)| (number(a), number(b)))) {
        None | Some((None, _)) => (1, 0),
        Some((Some(n), Some(m))) => (n, m),
        Some((Some(n), None)) => (n - n / 2, n / 2),
    }
}
