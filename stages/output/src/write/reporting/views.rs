//! Rule `report-views`: the report's head shows pictures that another stage has drawn.
//!
//! Fact: a `Preview` of the garment, at least as large, runs before the report and draws the same
//! model: no other model is made between them. Then the three views at the head are its pictures,
//! brought down, and the report draws none of the model itself. Tolerance: the same bits of
//! everything but the report's own page, whose views are in the finer light of `Preview`. Source: a
//! result is worked out once (common subexpressions, Cocke 1970).

use crate::write::preview::Preview;
use image::RgbImage;
use toile_core::Known;
use toile_core::RunLog;
use toile_core::artifact::{ArtifactType, Model, OutputFiles};
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};
use toile_core::param::ron_options;
use toile_core::{PortValue, StageMeta, choice};

/// Where the views at the report's head come from.
#[choice]
#[derive(Copy, Eq)]
pub enum Views {
    /// From `Preview`, where it has drawn the same model as large; else drawn.
    Taken,
    /// Drawn for the report.
    Drawn,
}

/// Share of the report's time that views which are taken save, on the vest.
const SHARE: f64 = 0.4;

/// The decision for views of that height, px, where a stage before the report draws them.
pub(crate) fn rule(known: &Known<'_>, views: Views, height: u32) -> Option<Decision> {
    let before = known.before().map(|n| {
        let makes_model = n.card.outputs.iter().any(|o| o.kind == Model::KIND);
        (n.card.name, n.stage.params(), makes_model)
    });
    (views == Views::Taken && drawing(before, height).is_some()).then(|| Decision {
        rule: "report-views".into(),
        state: State::Off,
        what: "views of the result, drawn for the report".into(),
        fact: "Preview draws the same model before it".into(),
        tolerance: Tolerance::SameBits,
        saves: Saves::Share(SHARE),
        source: "common subexpressions: Cocke 1970".into(),
        turn: Turn::Param { name: "views".into(), value: "Drawn".into() },
    })
}

/// Front, back and side as a stage before the report has drawn them; none where none has.
pub(crate) fn taken(run: &RunLog, height: u32) -> Option<[RgbImage; 3]> {
    let before = run.stages.iter().map(|s| {
        let makes_model = s.outputs.iter().any(|o| o.kind() == Model::KIND);
        (s.name.as_str(), s.params.clone(), makes_model)
    });
    let record = &run.stages[drawing(before, height)?];
    let picture = |name: &str| record.outputs.iter().find_map(|o| decoded(o, name));
    Some([picture("front.png")?, picture("back.png")?, picture("side.png")?])
}

/// The last of the stages, by name, parameters and whether it makes a model, that draws the last
/// model as large.
fn drawing<'a>(stages: impl Iterator<Item = (&'a str, String, bool)>, height: u32) -> Option<usize> {
    let draws = |name: &str, params: &str| {
        let preview = (name == Preview::NAME).then(|| ron_options().from_str::<Preview>(params).ok());
        preview.flatten().is_some_and(|p| p.is_of_garment(height))
    };
    stages.enumerate().fold(None, |found, (i, (name, params, makes_model))| match makes_model {
        true => None,
        false if draws(name, &params) => Some(i),
        false => found,
    })
}

fn decoded(value: &PortValue, name: &str) -> Option<RgbImage> {
    let of = |artifact: &dyn std::any::Any| {
        let files = &artifact.downcast_ref::<OutputFiles>()?.0;
        let bytes = &files.iter().find(|f| f.path == name)?.bytes;
        image::load_from_memory(bytes).ok().map(image::DynamicImage::into_rgb8)
    };
    value.entries().into_iter().find_map(|(_, a)| of(a.as_ref()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(stages: &[(&str, &str, bool)]) -> Option<usize> {
        drawing(stages.iter().map(|(name, params, model)| (*name, (*params).to_owned(), *model)), 640)
    }

    #[test]
    fn pictures_are_taken_from_a_preview_of_the_last_model_alone() {
        let (texturer, preview) = (("PhotoTexturer", "()", true), ("Preview", "(size: 900)", false));
        assert_eq!(found(&[texturer, preview, ("Obj", "()", false)]), Some(1));
        assert_eq!(found(&[texturer, ("Obj", "()", false)]), None);
        assert_eq!(found(&[preview, texturer]), None, "another model was made since");
        assert_eq!(found(&[texturer, ("Preview", "(size: 639)", false)]), None, "too small");
        assert_eq!(found(&[texturer, ("Preview", "(frame: Whole)", false)]), None, "another picture");
        assert_eq!(found(&[texturer, ("Preview", "nonsense", false)]), None);
    }
}
