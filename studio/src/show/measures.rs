//! The measures of the body, for sliders.

use crate::live::shown::ShownArtifacts;
use crate::project::text::BodyStage;
use serde_json::{Value, json};
use toile_core::Length;
use toile_core::param::ron_options;

/// Parameters that are measures, and how ISO 8559-1 calls them.
const MEASURES: [(&str, &str); 8] = [
    ("height", "stature"),
    ("bust", "bust girth"),
    ("waist", "waist girth"),
    ("hip", "hip girth"),
    ("shoulder_width", "shoulder width"),
    ("neck", "neck girth"),
    ("arm", "arm length"),
    ("inseam", "inside leg length"),
];

/// The measures of the text's body: as the text gives them, else as the last run made it.
///
/// A body whose stage takes no measures (one that is fitted to the garment, or read from a file)
/// shows those that it has, without a path.
pub(crate) fn measures(stage: Option<&BodyStage>, shown: &ShownArtifacts) -> Value {
    let Some(stage) = stage else { return json!({ "stage": null, "sizes": [], "measures": [] }) };
    let takes = |name: &str| stage.card.params.iter().find(|p| p.name == name);
    let one = |(name, iso): &(&str, &str)| {
        let doc = takes(name);
        let given = stage.given.get(*name).and_then(|text| text.trim_matches('"').parse::<Length>().ok());
        let made = shown.body.as_ref().and_then(|b| b.measurements.get(*name).copied());
        let value = given.map(Length::metres).or(made);
        (doc.is_some() || value.is_some()).then(|| {
            json!({
                "name": name,
                "path": doc.map(|_| format!("{}.{name}", stage.path)),
                "value_m": value,
                "min_m": doc.and_then(|d| d.min),
                "max_m": doc.and_then(|d| d.max),
                "iso": iso,
            })
        })
    };
    let figure = stage.given.get("figure").and_then(|text| ron_options().from_str(text).ok().flatten());
    let sizes = takes("size").map_or_else(Vec::new, |_| toile_body::size_names(figure));
    json!({
        "stage": stage.name,
        "sizes": sizes,
        "measures": MEASURES.iter().filter_map(one).collect::<Vec<_>>(),
    })
}
