//! `SvgPattern`: pieces of a garment from an SVG, as FreeSewing drafts them or a drawing program saves them.
//!
//! [`source`] reads the text, [`units`] finds the length of its unit, [`drawing`] walks what is drawn ([`path`] its lines, [`role`] what they
//! are for), [`pieces`] makes pieces of it. Cost: some milliseconds a piece.

mod damage;
mod drawing;
mod path;
mod pieces;
mod role;
mod source;
#[cfg(test)]
mod tests;
mod units;

use super::seams;
use damage::Damage;
use toile_core::prelude::*;

/// Reads the pieces of a garment from an SVG: of FreeSewing, Inkscape, Illustrator.
///
/// Takes the place of photos, outlines and a style. A piece is a closed line in a group of its own, or lines that meet end to end; lines called
/// `grain`, `fold`, `notch`, `drill`, `hole` and `seam allowance` are what they say. Half pieces are unfolded at their fold, and cut as often
/// as a text in them says (`cut 2` is a pair, the second mirrored). SVG knows no seams: give them in a file, or take those that
/// `seams.ron` proposes and you have looked through. Nothing is sewn that nobody confirmed.
#[stage(
    role = Reader,
    source = "SVG 1.1; FreeSewing 4",
    example = "SvgPattern(file: \"teagan.svg\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct SvgPattern {
    /// The file, relative to the pipeline.
    #[param(default = String::new())]
    pub file: String,
    /// The file with the seams, relative to the pipeline; empty where they are to be proposed.
    #[param(default = String::new())]
    pub seams: String,
}

#[stage]
impl SvgPattern {
    /// Runs the stage.
    pub fn run(&self, cx: &Context) -> Result<(Pattern, Set<Outline>, SewingPlan, OutputFiles), StageError> {
        self.named()?;
        let bytes = cx.read(&self.file).map_err(|e| e.at("file"))?;
        let mut told = Vec::new();
        let pieces = pieces_of(&bytes, &mut told).map_err(|d| d.error(&self.file))?;
        let unsewable = |what: String, remedy: &str| {
            Damage::Unsewable { what, remedy: remedy.to_owned() }.error(&self.file)
        };
        seams::sewn((super::stem(&self.file), pieces), &self.seams, told, unsewable, cx)
    }

    fn named(&self) -> Result<(), StageError> {
        super::named(&self.file, "teagan.svg")
    }

    /// Whether the files are there.
    fn precheck(&self, placed: &Placed<'_>) -> Vec<StageError> {
        seams::looked(self.named(), &self.file, &self.seams, placed)
    }
}

/// The pieces of a file, each as often as it is cut.
fn pieces_of(bytes: &[u8], told: &mut Vec<String>) -> Result<Vec<Piece>, Damage> {
    let text = source::text(bytes)?;
    let tree = source::tree(text)?;
    let root = tree.root_element();
    let unit = units::unit(root, text)?;
    let drawing = drawing::drawing(root, unit.metres)?;
    // FreeSewing says which pairs are mirrored; a person who writes "cut 2" means a pair.
    let by_word = root.has_attribute("freesewing");
    let mut of_pieces = Vec::new();
    let pieces = pieces::pieces(&drawing, by_word, &mut of_pieces)?;
    told.push(match unit.said {
        true => unit.words,
        false => {
            let tall = pieces.iter().flat_map(|p| p.outer.corners.iter().map(|c| c.y));
            let (lo, hi) = tall.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
            let words = unit.words;
            format!("the page's size is given in no unit of length: read as {words}, with which the pieces are {:.0} mm tall together; \
                     write width and height in mm where that is wrong", (hi - lo) * 1e3)
        }
    });
    told.append(&mut of_pieces);
    Ok(pieces)
}
