//! Marks as an SVG document.

use super::mark::{Anchor, PlotMark, SIZE};

/// The document.
pub fn svg(marks: &[PlotMark]) -> String {
    let [w, h] = SIZE;
    let mut s = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
         font-family=\"system-ui, sans-serif\"><rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"
    );
    marks.iter().for_each(|m| s.push_str(&mark(m)));
    s.push_str("</svg>\n");
    s
}

fn mark(mark: &PlotMark) -> String {
    match mark {
        PlotMark::Line { ends, width, colour, dashed } => line(*ends, *width, hex(colour), *dashed),
        PlotMark::Rect { corners, colour } => rect(*corners, hex(colour)),
        PlotMark::Dot { at, radius, colour, hollow } => dot(*at, *radius, hex(colour), *hollow),
        PlotMark::Text { at, anchor, text, colour, large } => {
            letters(*at, *anchor, text, hex(colour), *large)
        }
    }
}

fn hex(c: &[u8; 3]) -> String {
    format!("#{:02x}{:02x}{:02x}", c[0], c[1], c[2])
}

fn line([a, b]: [[f64; 2]; 2], width: f64, colour: String, dashed: bool) -> String {
    let dashes = if dashed { " stroke-dasharray=\"6 5\"" } else { "" };
    format!(
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\"{dashes}/>\n",
        a[0], a[1], b[0], b[1]
    )
}

fn rect([a, b]: [[f64; 2]; 2], colour: String) -> String {
    format!(
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{colour}\"/>\n",
        a[0].min(b[0]),
        a[1].min(b[1]),
        (b[0] - a[0]).abs(),
        (b[1] - a[1]).abs()
    )
}

fn dot(at: [f64; 2], radius: f64, colour: String, hollow: bool) -> String {
    let white = "#fff".to_owned();
    let (fill, stroke) = if hollow { (white, colour) } else { (colour, white) };
    format!(
        "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.5\"/>\n",
        at[0], at[1]
    )
}

fn letters(at: [f64; 2], anchor: Anchor, text: &str, colour: String, large: bool) -> String {
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\" font-size=\"{}\">{}</text>\n",
        at[0],
        at[1],
        if large { 18 } else { 14 },
        text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
    )
}
