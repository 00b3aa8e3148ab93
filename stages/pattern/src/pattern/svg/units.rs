//! The length of the file's own unit.
//!
//! `width` and `height` say how large the page is, `viewBox` how many units that is. Lengths in
//! pixels are those of CSS, of which an inch has 96; Illustrator's have 72. They say how large a
//! page is on a screen, which need not be how large the garment is.

use super::super::unit::{By, DrawingUnit, Taken};
use super::damage::SvgDamage;
use super::source::{place, short};
use roxmltree::Node;
use svgtypes::{Length, LengthUnit, ViewBox};

/// Metres of a pixel of CSS.
pub(super) const PIXEL: f64 = 0.0254 / 96.0;

/// A length in pixels; none where it depends on the page or the type.
pub(super) fn pixels(length: Length) -> Option<f64> {
    let unit = match length.unit {
        LengthUnit::None | LengthUnit::Px => 1.0,
        LengthUnit::In => 96.0,
        LengthUnit::Cm => 96.0 / 2.54,
        LengthUnit::Mm => 96.0 / 25.4,
        LengthUnit::Pt => 96.0 / 72.0,
        LengthUnit::Pc => 16.0,
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => return None,
    };
    Some(length.number * unit)
}

/// The unit of a whole file, by the parameter `unit`, by the page's size, else as a pixel.
pub(super) fn unit(root: Node<'_, '_>, text: &str, asked: DrawingUnit) -> Result<Taken, SvgDamage> {
    let view = match root.attribute("viewBox") {
        Some(value) => Some(view_box(root, value)?),
        None => None,
    };
    if let Some(metres) = asked.metres() {
        let fact = format!("`unit` says that the drawing's units are {}", asked.word());
        return Ok(Taken { metres, fact, by: By::Parameter });
    }
    let sides = [("width", view.map(|v| v.w)), ("height", view.map(|v| v.h))];
    let illustrator = text.get(..4096).unwrap_or(text).contains("Adobe Illustrator");
    let (pixel, inch) = if illustrator { (0.0254 / 72.0, 72) } else { (PIXEL, 96) };
    // Lengths of a ruler first; pictures are scaled alike both ways, to the lesser of the two.
    let found = |ruler: bool| {
        let side = |(side, units): (&'static str, Option<f64>)| {
            let length = root.attribute(side)?.trim().parse::<Length>().ok()?;
            let is_ruler = !matches!(length.unit, LengthUnit::None | LengthUnit::Px);
            let metres = Some(pixels(length)?).filter(|n| is_ruler == ruler && *n > 0.0)?;
            let metres = metres * if ruler { PIXEL } else { pixel };
            // Without a viewBox a unit is a pixel, whatever the page's size.
            let per_unit = match units.filter(|n| *n > 0.0) {
                Some(n) => metres / n,
                None if ruler => PIXEL,
                None => pixel,
            };
            Some((per_unit, side, root.attribute(side)?.trim(), units))
        };
        // Both sides say the same to the last digits.
        sides.into_iter().filter_map(side).reduce(|a, b| if b.0 < a.0 * (1.0 - 1e-6) { b } else { a })
    };
    let taken = |metres: f64, fact: String, by: By| {
        let fact = format!("{fact}: a unit of the drawing is {:.4} mm", metres * 1e3);
        Ok(Taken { metres, fact, by })
    };
    match (found(true), found(false)) {
        (Some((metres, side, length, Some(units))), _) => {
            let length = short(length);
            taken(metres, format!("the page's {side} is {length}, {units} units of its viewBox"), By::File)
        }
        (Some((metres, side, length, None)), _) => {
            let length = short(length);
            taken(
                metres,
                format!("the page's {side} is {length}, and without a viewBox a unit is a pixel"),
                By::File,
            )
        }
        (None, Some((metres, side, length, Some(units)))) => {
            let length = short(length).trim_end_matches("px").to_owned();
            let fact = format!(
                "the page's {side} is {length} pixels, {inch} an inch, and {units} units of its viewBox"
            );
            taken(metres, fact, By::Guess)
        }
        (None, _) => taken(
            pixel,
            format!("the page's size is given in no unit of length, and pixels are {inch} an inch"),
            By::Guess,
        ),
    }
}

fn view_box(root: Node<'_, '_>, value: &str) -> Result<ViewBox, SvgDamage> {
    let sound = |v: &ViewBox| [v.x, v.y, v.w, v.h].iter().all(|n| n.is_finite() && n.abs() <= 1e9);
    value.parse::<ViewBox>().ok().filter(sound).ok_or_else(|| SvgDamage::Attribute {
        place: place(root),
        attribute: "viewBox",
        value: short(value),
    })
}
