//! The measures of the body, for sliders.

use crate::live::shown::ShownArtifacts;
use crate::project::text::BodyStage;
use serde_json::{Value, json};
use toile_core::Length;

/// Parameters that are measures, and how ISO 8559-1 calls them.
const MEASURES: [(&str, &str); 8] = [
    ("height", "5.1.1 height"),
    ("bust", "5.3.4 bust girth"),
    ("waist", "5.3.10 waist girth"),
    ("hip", "5.3.13 hip girth"),
    ("shoulder_width", "shoulder width"),
    ("neck", "neck girth"),
    ("arm", "arm length"),
    ("inseam", "inside leg length"),
];

/// Sizes that a mannequin of no stated figure takes; a test tries each.
pub(crate) const SIZES: [&str; 30] = [
    "XS", "S", "M", "L", "XL", "XXL", "EU 32", "EU 34", "EU 36", "EU 38", "EU 40", "EU 42", "EU 44", "EU 46",
    "EU 48", "EU 50", "EU 52", "EU 54", "EU 86", "EU 92", "EU 98", "EU 104", "EU 110", "EU 116", "EU 122",
    "EU 128", "EU 134", "EU 140", "EU 146", "EU 152",
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
    let sizes: &[&str] = if takes("size").is_some() { &SIZES } else { &[] };
    json!({
        "stage": stage.name,
        "sizes": sizes,
        "measures": MEASURES.iter().filter_map(one).collect::<Vec<_>>(),
    })
}
