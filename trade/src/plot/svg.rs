//! Marks as an SVG document.

use super::mark::{Anchor, Mark, SIZE};
use std::fmt::Write;

/// The document.
pub(crate) fn svg(marks: &[Mark]) -> String {
    let [w, h] = SIZE;
    let mut s = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
         font-family=\"system-ui, sans-serif\"><rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"
    );
    marks.iter().for_each(|m| mark(&mut s, m));
    s.push_str("</svg>\n");
    s
}

fn mark(s: &mut String, mark: &Mark) {
    let hex = |c: &[u8; 3]| format!("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
    let _ = match mark {
        Mark::Line { ends: [a, b], width, colour, dashed } => writeln!(
            s,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{}\" stroke-width=\"{width}\"{}/>",
            a[0],
            a[1],
            b[0],
            b[1],
            hex(colour),
            if *dashed { " stroke-dasharray=\"6 5\"" } else { "" }
        ),
        Mark::Rect { corners: [a, b], colour } => writeln!(
            s,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"/>",
            a[0].min(b[0]),
            a[1].min(b[1]),
            (b[0] - a[0]).abs(),
            (b[1] - a[1]).abs(),
            hex(colour)
        ),
        Mark::Dot { at, radius, colour, hollow } => {
            let (fill, stroke) =
                if *hollow { ("#fff".into(), hex(colour)) } else { (hex(colour), "#fff".into()) };
            writeln!(
                s,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.5\"/>",
                at[0], at[1]
            )
        }
        Mark::Text { at, anchor, text, colour, large } => writeln!(
            s,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{}\" fill=\"{}\" font-size=\"{}\">{}</text>",
            at[0],
            at[1],
            match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            },
            hex(colour),
            if *large { 18 } else { 14 },
            text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
        ),
    };
}
