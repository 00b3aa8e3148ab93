//! The length of the file's own unit.
//!
//! `width` and `height` say how large the page is, `viewBox` how many units that is. Where neither is an absolute length, a unit is a
//! pixel of CSS, of which an inch has 96; Illustrator's have 72.

use super::damage::Damage;
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

/// How many metres a unit of the file is, and what was found.
pub(super) struct Unit {
    pub metres: f64,
    /// Whether the file says it.
    pub said: bool,
    pub words: String,
}

/// The unit of a whole file.
pub(super) fn unit(root: Node<'_, '_>, text: &str) -> Result<Unit, Damage> {
    let view = match root.attribute("viewBox") {
        Some(value) => Some(view_box(root, value)?),
        None => None,
    };
    let absolute = |name: &str| {
        let length = root.attribute(name)?.trim().parse::<Length>().ok()?;
        let says = !matches!(length.unit, LengthUnit::None | LengthUnit::Px);
        Some(pixels(length)?).filter(|n| says && *n > 0.0).map(|n| (n * PIXEL, length.unit))
    };
    let name = |unit: LengthUnit| match unit {
        LengthUnit::Mm => "millimetres",
        LengthUnit::Cm => "centimetres",
        LengthUnit::In => "inches",
        _ => "points",
    };
    // Without a viewBox a unit is a pixel, whatever the page's size.
    let found = [("width", view.map(|v| v.w)), ("height", view.map(|v| v.h))].into_iter().filter_map(
        |(side, units)| {
            let (metres, unit) = absolute(side)?;
            Some((units.map_or(PIXEL, |n| metres / n), unit))
        },
    );
    let found: Vec<(f64, LengthUnit)> = found.collect();
    // Pictures are scaled alike both ways, to the lesser of the two.
    if let Some((metres, unit)) = found.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0)) {
        let words = format!(
            "the page's size is given in {}: a unit of the file is {:.4} mm",
            name(unit),
            metres * 1e3
        );
        return Ok(Unit { metres, said: true, words });
    }
    let illustrator = text.get(..4096).unwrap_or(text).contains("Adobe Illustrator");
    let (metres, words) =
        if illustrator { (0.0254 / 72.0, "points of Illustrator") } else { (PIXEL, "pixels, 96 an inch") };
    Ok(Unit { metres, said: false, words: words.to_owned() })
}

fn view_box(root: Node<'_, '_>, value: &str) -> Result<ViewBox, Damage> {
    let sound = |v: &ViewBox| [v.x, v.y, v.w, v.h].iter().all(|n| n.is_finite() && n.abs() <= 1e9);
    value.parse::<ViewBox>().ok().filter(sound).ok_or_else(|| Damage::Attribute {
        place: place(root),
        attribute: "viewBox",
        value: short(value),
    })
}
