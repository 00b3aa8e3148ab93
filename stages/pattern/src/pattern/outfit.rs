//! `Outfit`: several patterns that are worn over each other.
//!
//! Method: each file is read as [`GarmentCode`] reads it; its pieces get the file's name before
//! their own, and a layer of their own. `Arrange` places outer layers farther out, and a static
//! solver sews them from the innermost and keeps the order. Cost: that of the files. Limits: files
//! of GarmentCode, since pieces need their places; one fabric for all.

use super::garment_code::GarmentCode;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_core::Remarks;
use toile_core::prelude::*;

/// Reads the patterns of several garments that are worn over each other on one body.
///
/// Takes the place of one pattern: the stages after it are the same. Pieces are called by their
/// garment and their own name: `shirt_front` of `shirt_specification.json`. The solver keeps every
/// garment outside those before it.
#[stage(
    role = Reader,
    source = "layers as in garment CAD; Korosteleva and Sorkine-Hornung 2023",
    example = "Outfit(garments: [\"shirt_specification.json\", \"pinafore_specification.json\"])",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Outfit {
    /// Files of GarmentCode, relative to the pipeline, from the innermost garment to the outermost;
    /// two at least.
    #[param(default = Vec::new())]
    pub garments: Vec<String>,
}

#[stage]
impl Outfit {
    fn run(&self, cx: &Context) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
        self.several()?;
        let mut outfit = Pattern { name: "outfit".into(), ..Pattern::default() };
        for (layer, (file, name)) in (0..).zip(self.garments.iter().zip(self.names())) {
            let garment = GarmentCode { file: file.clone() }.read(cx).map_err(|e| e.at("garments"))?;
            let full = |piece: &str| format!("{name}_{piece}");
            outfit.pieces.extend(garment.pieces.into_iter().map(|p| Piece {
                name: full(&p.name),
                layer,
                ..p
            }));
            outfit.seams.extend(garment.seams.into_iter().map(|s| renamed(s, full)));
        }
        cx.check()?;
        let lowered =
            outfit.lower().map_err(|e| StageError::invalid(e.to_string()).hint(e.remedy()).at("garments"))?;
        super::tell(Remarks { notes: lowered.notes, warnings: lowered.warnings }, cx);
        let outlines = lowered.outlines.into_iter().map(|(name, o)| (name, Arc::new(o))).collect();
        Ok((outfit, Set(outlines), lowered.plan))
    }

    fn several(&self) -> Result<(), StageError> {
        if self.garments.len() >= 2 {
            return Ok(());
        }
        let what = format!(
            "an outfit has two garments or more, here {} named",
            match self.garments.len() {
                0 => "none is",
                _ => "one is",
            }
        );
        let help = "write `garments: [\"shirt_specification.json\", \"pinafore_specification.json\"]`, the innermost \
                    first; a single pattern is read by `GarmentCode(file: ...)`";
        Err(StageError::new(ErrorCode::InvalidParameter, what).hint(help).at("garments"))
    }

    /// What each garment is called: its file's name, with a number where two have the same.
    fn names(&self) -> Vec<String> {
        let mut taken = BTreeSet::new();
        let name = |file: &String| {
            let stem = super::stem(file);
            let numbered = (2..).map(|k| format!("{stem}_{k}"));
            let free = std::iter::once(stem.clone()).chain(numbered).find(|n| taken.insert(n.clone()));
            free.unwrap_or(stem)
        };
        self.garments.iter().map(name).collect()
    }

    /// Whether the files are there; what stands in them is read by the run.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        if let Err(e) = self.several() {
            return vec![e];
        }
        let missing = |file: &String| placed.cx.look(file).err();
        self.garments.iter().filter_map(missing).map(|e| e.at("garments")).collect()
    }
}

/// A seam between pieces that are called otherwise.
fn renamed(seam: PatternSeam, full: impl Fn(&str) -> String) -> PatternSeam {
    let used = |u: EdgeUse| EdgeUse {
        edge: EdgeRef { panel: full(&u.edge.panel), edge: u.edge.edge },
        reversed: u.reversed,
    };
    let sides: Vec<Vec<EdgeUse>> =
        seam.sides.into_iter().map(|side| side.into_iter().map(used).collect()).collect();
    let words = |s: &Vec<EdgeUse>| s.iter().map(|u| u.edge.to_string()).collect::<Vec<_>>().join(" ");
    let name = sides.iter().map(words).collect::<Vec<_>>().join(" + ");
    PatternSeam { name, kind: seam.kind, sides }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn sample(name: &str) -> String {
        format!("{}/../../pipelines/samples/pattern/{name}_specification.json", env!("CARGO_MANIFEST_DIR"))
    }

    #[test]
    fn pieces_and_seams_are_called_by_their_garment_and_the_last_one_is_worn_outside() {
        let outfit = Outfit { garments: vec![sample("trousers"), sample("shirt"), sample("shirt")] };
        let (pattern, outlines, plan) = outfit.run(&Context::quiet()).unwrap();
        let layer = |name: &str| pattern.piece(name).unwrap().layer;
        assert_eq!((layer("trousers_left_front"), layer("shirt_front"), layer("shirt_2_front")), (0, 1, 2));
        assert_eq!(outlines.0.len(), pattern.pieces.len());
        assert!(plan.seams.iter().all(|s| outlines.get(&s.a.panel).is_some()));
        assert!(plan.seams.iter().any(|s| s.a.panel.starts_with("shirt_2_")));
    }

    #[test]
    fn one_garment_is_no_outfit() {
        let one = Outfit { garments: vec![sample("shirt")] }.run(&Context::quiet()).unwrap_err();
        assert_eq!(one.to_string(), "an outfit has two garments or more, here one is named");
        let none = Outfit { garments: Vec::new() }.run(&Context::quiet()).unwrap_err();
        assert_eq!(none.to_string(), "an outfit has two garments or more, here none is named");
    }
}
