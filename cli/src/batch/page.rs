//! The contact sheet: one page of HTML beside the folder of the garments, without scripts.

use super::record::ResultLine;
use super::tally::BatchTally;
use super::thumb;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;

/// How the page looks.
const STYLE: &str = "body{font:15px/1.4 sans-serif;margin:2em;color:#222}table{border-collapse:collapse;margin:1em 0}\
td,th{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:left}td.n{text-align:right}\
.sheet{display:flex;flex-wrap:wrap;gap:12px}figure{margin:0;width:180px}\
figure a{display:flex;height:180px;align-items:center;justify-content:center;background:#f3f3f3;color:#888}\
img{max-width:180px;max-height:180px}figcaption{font-size:12px;overflow-wrap:anywhere}";

/// The page; `pictured` says which garments have a small picture.
pub(crate) fn page(lines: &[ResultLine], tally: &BatchTally, pictured: &dyn Fn(&str) -> bool) -> String {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{0}</title><style>{STYLE}</style>\n<h1>{0}</h1>\n",
        escaped(&tally.words())
    );
    // Faults first, those without at the end.
    let mut kinds: BTreeMap<(bool, &str), Vec<&ResultLine>> = BTreeMap::new();
    for line in lines {
        let kind = line.fault.fault.as_deref();
        kinds.entry((kind.is_none(), kind.unwrap_or("good"))).or_default().push(line);
    }
    html += "<table><tr><th>ended with<th>garments\n";
    for ((_, kind), of_kind) in &kinds {
        let kind = escaped(kind);
        // A `String` takes whatever is written.
        let _ = writeln!(html, "<tr><td><a href=\"#{kind}\">{kind}</a><td class=\"n\">{}", of_kind.len());
    }
    html += "</table>\n";
    for ((_, kind), of_kind) in &kinds {
        let kind = escaped(kind);
        let _ = writeln!(html, "<h2 id=\"{kind}\">{kind}</h2>\n<div class=\"sheet\">");
        of_kind.iter().for_each(|line| html += &figure(line, pictured(&line.id)));
        html += "</div>\n<table><tr><th>garment<th>exit code<th>stage<th>seam gap<th>strain p99<th>certificate<th>message\n";
        of_kind.iter().for_each(|line| html += &row(line));
        html += "</table>\n";
    }
    html
}

fn figure(line: &ResultLine, is_pictured: bool) -> String {
    let id = escaped(&line.id);
    let picture = match is_pictured {
        true => format!("<img loading=\"lazy\" alt=\"{id}\" src=\"garments/{id}/{}\">", thumb::FILE),
        false => "no picture".to_owned(),
    };
    format!("<figure><a href=\"garments/{id}/\">{picture}</a><figcaption>{id}</figcaption></figure>\n")
}

fn row(line: &ResultLine) -> String {
    let figures = &line.quality["garment"];
    let scaled = |value: &Value, by: f64, unit: &str| {
        value.as_f64().map_or_else(String::new, |v| format!("{:.2} {unit}", v * by))
    };
    let text = |text: &Option<String>| escaped(text.as_deref().unwrap_or_default());
    let id = escaped(&line.id);
    format!(
        "<tr><td><a href=\"garments/{id}/\">{id}</a><td class=\"n\">{}<td>{}<td class=\"n\">{}<td class=\"n\">{}<td>{}<td>{}\n",
        line.exit,
        text(&line.fault.stage),
        scaled(&figures["seam_gap_max_m"], 1e3, "mm"),
        scaled(&figures["edge_strain"]["p99"], 1e2, "%"),
        escaped(line.certificate["verdict"].as_str().unwrap_or_default()),
        text(&line.fault.message),
    )
}

/// A text as it stands in HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::super::record::GarmentFault;
    use super::*;
    use toile_core::artifact::Digest;

    fn line(id: &str, fault: GarmentFault) -> ResultLine {
        ResultLine {
            id: id.into(),
            inputs: Digest::of(b""),
            exit: 0,
            fault,
            quality: serde_json::json!({ "garment": { "seam_gap_max_m": 0.0004, "edge_strain": { "p99": 0.015 } } }),
            certificate: serde_json::json!({ "verdict": "holds" }),
            files: 1,
            result: Digest::of(b""),
            version: "1".into(),
        }
    }

    #[test]
    fn faults_come_first_and_texts_are_escaped() {
        let lines =
            [line("a", GarmentFault::default()), line("b", GarmentFault::new("timeout", "a < b & \"c\""))];
        let tally = BatchTally { garments: 2, good: 1, faults: BTreeMap::from([("timeout".into(), 1)]) };
        let html = page(&lines, &tally, &|id| id == "a");
        let at = |text: &str| html.find(text).unwrap_or_else(|| unreachable!("{text} is not in {html}"));
        assert!(at("<h2 id=\"timeout\">") < at("<h2 id=\"good\">"));
        assert!(at("a &lt; b &amp; &quot;c&quot;") < at("<h2 id=\"good\">"));
        assert!(html.ends_with("0.40 mm<td class=\"n\">1.50 %<td>holds<td>\n</table>\n"), "{html}");
        assert!(html.contains("<img loading=\"lazy\" alt=\"a\" src=\"garments/a/thumb.jpg\">"), "{html}");
        assert!(html.contains("<a href=\"garments/b/\">no picture</a>"), "{html}");
    }
}
