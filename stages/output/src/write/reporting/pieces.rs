//! The flat pieces with their seams: both sides of a seam have its number and colour.

use crate::render::{ArtifactPicture, PANEL_COLOURS, PictureForm, escaped};
use std::fmt::Write;
use toile_core::artifact::{Garment, GarmentPanel, Point2, Vector2};

/// Between pieces, mm.
const GAP: f64 = 60.0;
/// The sheet's pieces stand in rows of at most this width, mm.
const WIDEST: f64 = 2400.0;
/// Numbers stand so far from the seam, towards the piece, mm.
const INSIDE: f64 = 26.0;

/// Every piece of a garment on one sheet, millimetres; none where the flat shapes are not known.
pub(crate) fn pieces(garment: &Garment) -> Option<ArtifactPicture> {
    let placed = placed(garment)?;
    let (mut body, mut size) = (String::new(), [0.0f64; 2]);
    for (panel, to, extent) in &placed {
        let at = |v: u32| mm(garment.rest[v as usize]) + to;
        (0..2).for_each(|k| size[k] = size[k].max(extent[k]));
        let _ = writeln!(
            body,
            "<polygon fill=\"#fff\" stroke=\"#5b6470\" stroke-width=\"2\" points=\"{}\"/>",
            points(panel.boundary.iter().map(|v| at(*v)))
        );
        let middle =
            panel.boundary.iter().map(|v| at(*v)).sum::<Vector2>() / panel.boundary.len().max(1) as f64;
        label(&mut body, middle, "#1d2126", 34.0, &escaped(&panel.name));
    }
    for (number, seam) in garment.seams.iter().enumerate() {
        let colour = colour(number);
        for side in 0..2 {
            let run: Vec<u32> = seam.pairs.iter().map(|p| p[side]).collect();
            for part in run.chunk_by(|a, b| same_panel(garment, *a, *b)) {
                let Some((panel, to, _)) =
                    placed.iter().find(|(p, ..)| p.vertices.contains(&(part[0] as usize)))
                else {
                    continue;
                };
                let at = |v: u32| mm(garment.rest[v as usize]) + to;
                let _ = writeln!(
                    body,
                    "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"7\" stroke-linecap=\"round\" points=\"{}\"/>",
                    points(part.iter().map(|v| at(*v)))
                );
                let centre = panel.boundary.iter().map(|v| at(*v)).sum::<Vector2>()
                    / panel.boundary.len().max(1) as f64;
                let on = at(part[part.len() / 2]);
                let inwards = (centre - on).try_normalize(1e-9).unwrap_or_else(Vector2::x);
                label(&mut body, on + inwards * INSIDE, &colour, 30.0, &(number + 1).to_string());
            }
        }
    }
    let [w, h] = size.map(|s| s + GAP);
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.0} {:.0} {w:.0} {h:.0}\" font-family=\"sans-serif\">\n{body}</svg>\n",
        -GAP / 2.0,
        -GAP / 2.0
    );
    Some(ArtifactPicture {
        caption: "pieces as they are cut; equal numbers are sewn together".to_owned(),
        form: PictureForm::Svg(svg),
    })
}

fn mm(p: Point2) -> Vector2 {
    Vector2::new(1e3 * p.x, -1e3 * p.y)
}

fn same_panel(garment: &Garment, a: u32, b: u32) -> bool {
    let of = |v: u32| garment.panel_of(v as usize).map(|p| p.vertices.start);
    of(a) == of(b)
}

/// Each panel with the way to its place, and the far corner of that, in rows.
fn placed(garment: &Garment) -> Option<Vec<(&GarmentPanel, Vector2, [f64; 2])>> {
    let (mut x, mut y, mut row) = (0.0, 0.0, 0.0f64);
    let mut all = Vec::new();
    for panel in garment.panels.iter().filter(|p| p.boundary.len() > 2) {
        let own: Vec<Vector2> = panel.boundary.iter().map(|v| mm(garment.rest[*v as usize])).collect();
        let (lo, hi) = own.iter().fold((own[0], own[0]), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
        let size = hi - lo;
        if !(size.x > 0.0 && size.y > 0.0) {
            return None;
        }
        if x > 0.0 && x + size.x > WIDEST {
            (x, y, row) = (0.0, y + row + GAP, 0.0);
        }
        all.push((panel, Vector2::new(x, y) - lo, [x + size.x, y + size.y]));
        x += size.x + GAP;
        row = row.max(size.y);
    }
    (!all.is_empty()).then_some(all)
}

fn points(places: impl Iterator<Item = Vector2>) -> String {
    places.map(|p| format!("{:.0},{:.0} ", p.x, p.y)).collect()
}

fn label(svg: &mut String, at: Vector2, colour: &str, size: f64, text: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{:.0}\" y=\"{:.0}\" font-size=\"{size}\" text-anchor=\"middle\" dominant-baseline=\"central\" fill=\"{colour}\" \
         stroke=\"#fff\" stroke-width=\"8\" paint-order=\"stroke\">{text}</text>",
        at.x, at.y
    );
}

fn colour(number: usize) -> String {
    let [r, g, b] = PANEL_COLOURS[number % PANEL_COLOURS.len()];
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use toile_core::testkit::dress;

    #[test]
    fn both_sides_of_every_seam_have_its_number() {
        let PictureForm::Svg(svg) = pieces(&dress::garment()).unwrap().form else { panic!("an SVG") };
        for number in 1..=4 {
            assert_eq!(svg.matches(&format!(">{number}</text>")).count(), 2, "seam {number}");
        }
        assert_eq!(svg.matches("<polygon").count(), 2);
    }

    #[test]
    fn a_garment_whose_flat_shape_is_not_known_has_no_pieces() {
        let mut garment = dress::garment();
        garment.rest.iter_mut().for_each(|p| *p = Point2::origin());
        assert_eq!(pieces(&garment), None);
    }
}
